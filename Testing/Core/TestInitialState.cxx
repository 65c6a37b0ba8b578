// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/InitialState.h"
#include "Meshes.h"

#include <gtest/gtest.h>

#include <limits>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

const double NotANumber = std::numeric_limits<double>::quiet_NaN();

std::vector<std::int64_t> InputIds(const TriangleMesh& mesh)
{
  return { mesh.InputVertex().begin(), mesh.InputVertex().end() };
}

/// A disk with every third value missing, and a sphere.
struct Example
{
  std::shared_ptr<const TriangleMesh> Mesh = MakeMesh(Joined(Disk(5), Icosphere(2)));
  PointData Data = PointData::FromValues(Noise(*Mesh, 2));
  Index Second = Mesh->ComponentsBegin()[1];

  Example()
  {
    for (Index i = 0; i < this->Mesh->NumberOfVertices(); i += 3)
    {
      this->Data.Missing[i] = true;
    }
  }
  double KnownMean(Index begin, Index end, Eigen::Index k) const
  {
    double sum = 0.0;
    double area = 0.0;
    for (Index i = begin; i < end; ++i)
    {
      if (!this->Data.Missing[i])
      {
        sum += this->Mesh->ControlAreas()[i] * this->Data.Given(i, k);
        area += this->Mesh->ControlAreas()[i];
      }
    }
    return sum / area;
  }
};

} // namespace

TEST(InitialState, KnownValuesStartAsTheyAre)
{
  for (const InitialFill fill : { InitialFill::Input, InitialFill::Mean, InitialFill::Noise })
  {
    Example e;
    FillMissing(*e.Mesh, e.Data, fill, 0, InputIds(*e.Mesh));
    for (Index i = 0; i < e.Mesh->NumberOfVertices(); ++i)
    {
      if (!e.Data.Missing[i])
      {
        EXPECT_TRUE(e.Data.Start.row(i) == e.Data.Given.row(i));
      }
    }
  }
}

TEST(InitialState, MeanIsThatOfTheKnownValuesOfTheComponent)
{
  Example e;
  e.Data.Given.bottomRows(e.Data.Given.rows() - e.Second).array() += 10.0;
  FillMissing(*e.Mesh, e.Data, InitialFill::Mean, 0, InputIds(*e.Mesh));
  for (const Eigen::Index k : { 0, 1 })
  {
    const double first = e.KnownMean(0, e.Second, k);
    const double second = e.KnownMean(e.Second, e.Mesh->NumberOfVertices(), k);
    for (Index i = 0; i < e.Mesh->NumberOfVertices(); i += 3)
    {
      EXPECT_NEAR(e.Data.Start(i, k), i < e.Second ? first : second, 1e-13);
    }
  }
}

TEST(InitialState, AComponentWithNothingKnownTakesTheMeanOfAll)
{
  Example e;
  e.Data.Missing.head(e.Second) = true;
  FillMissing(*e.Mesh, e.Data, InitialFill::Mean, 0, InputIds(*e.Mesh));
  const double mean = e.KnownMean(0, e.Mesh->NumberOfVertices(), 1);
  for (Index i = 0; i < e.Second; ++i)
  {
    EXPECT_NEAR(e.Data.Start(i, 1), mean, 1e-14);
  }
}

TEST(InitialState, WithNothingKnownItIsZero)
{
  for (const InitialFill fill : { InitialFill::Mean, InitialFill::Noise })
  {
    Example e;
    e.Data.Missing.fill(true);
    FillMissing(*e.Mesh, e.Data, fill, 0, InputIds(*e.Mesh));
    EXPECT_TRUE(e.Data.Start.isZero(0.0));
  }
}

TEST(InitialState, InputKeepsDamagedValuesAndFillsNaNWithTheMean)
{
  Example e;
  e.Data.Given(0, 0) = NotANumber;
  e.Data.Given(0, 1) = 77.0;
  FillMissing(*e.Mesh, e.Data, InitialFill::Input, 0, InputIds(*e.Mesh));
  EXPECT_NEAR(e.Data.Start(0, 0), e.KnownMean(0, e.Second, 0), 1e-14);
  EXPECT_EQ(e.Data.Start(0, 1), 77.0);
}

TEST(InitialState, NoNaNIsLeftAnywhere)
{
  for (const InitialFill fill : { InitialFill::Input, InitialFill::Mean, InitialFill::Noise })
  {
    Example e;
    for (Index i = 0; i < e.Mesh->NumberOfVertices(); i += 3)
    {
      e.Data.Given.row(i).setConstant(NotANumber);
    }
    FillMissing(*e.Mesh, e.Data, fill, 0, InputIds(*e.Mesh));
    EXPECT_TRUE(e.Data.Start.allFinite());
    EXPECT_TRUE(e.Data.Given.allFinite());
  }
}

TEST(InitialState, NoiseIsUniformOverTheKnownRangeOfEachComponent)
{
  const auto mesh = MakeMesh(Icosphere(5));
  PointData data = PointData::FromValues(Noise(*mesh, 2));
  data.Given.col(1).array() = 3.0 + 2.0 * data.Given.col(1).array();
  const Index known = 200;
  data.Missing.tail(mesh->NumberOfVertices() - known) = true;
  FillMissing(*mesh, data, InitialFill::Noise, 4, InputIds(*mesh));
  for (const Eigen::Index k : { 0, 1 })
  {
    const double low = data.Given.col(k).head(known).minCoeff();
    const double high = data.Given.col(k).head(known).maxCoeff();
    const auto filled = data.Start.col(k).tail(mesh->NumberOfVertices() - known).array();
    EXPECT_GE(filled.minCoeff(), low);
    EXPECT_LE(filled.maxCoeff(), high);
    // Mean and variance of 10,042 uniform numbers, within five standard errors.
    const double width = high - low;
    const double variance = (filled - filled.mean()).square().mean();
    EXPECT_NEAR(filled.mean(), 0.5 * (low + high), 5.0 * width / std::sqrt(12.0 * 10042.0));
    EXPECT_NEAR(variance, width * width / 12.0, 0.03 * width * width / 12.0);
  }
}

TEST(InitialState, NoiseDependsOnSeedComponentAndIdAlone)
{
  const auto fill = [](const Surface& s, std::int64_t seed)
  {
    const auto mesh = MakeMesh(s);
    PointData data =
      PointData::FromValues(Sample(*mesh, s, [](const Eigen::RowVector3d&) { return 0.0; }));
    data.Given.conservativeResize(Eigen::NoChange, 2);
    data.Given.col(1).setZero();
    // One known vertex determines the range: the first of the input.
    data.Missing.fill(true);
    for (Index i = 0; i < mesh->NumberOfVertices(); ++i)
    {
      if (mesh->InputVertex()[i] < 2)
      {
        data.Missing[i] = false;
        data.Given.row(i).setConstant(mesh->InputVertex()[i]);
      }
    }
    FillMissing(*mesh, data, InitialFill::Noise, seed, InputIds(*mesh));
    return ToInput(*mesh, data.Start, s.NumberOfVertices());
  };
  const Surface s = Icosphere(2);
  const Values u = fill(s, 1);
  EXPECT_TRUE(fill(Rotated(s, 2.0), 1) == u); // another numbering inside
  EXPECT_FALSE(fill(s, 2) == u);
  EXPECT_FALSE(u.col(0) == u.col(1));
}
