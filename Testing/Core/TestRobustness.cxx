// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Operators/MeanCorrection.h"
#include "Heat.h"
#include "Meshes.h"

#include <gtest/gtest.h>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

const Scheme BothSchemes[] = { Scheme::BackwardEuler, Scheme::SDIRK2 };

/// u with the mean of each component taken for all of it.
Values ComponentMeans(const TriangleMesh& mesh, Values u)
{
  for (Index c = 0; c < mesh.NumberOfComponents(); ++c)
  {
    const Index begin = mesh.ComponentsBegin()[c];
    const Index size = mesh.ComponentsBegin()[c + 1] - begin;
    const auto areas = mesh.ControlAreas().segment(begin, size);
    const Eigen::RowVectorXd mean = areas.transpose() * u.middleRows(begin, size) / areas.sum();
    u.middleRows(begin, size).rowwise() = mean;
  }
  return u;
}

/// A flat band of triangles `aspect` times longer than high.
Surface Slivers(double aspect)
{
  return Strip(40, 4, 1.0, 0.1 / aspect);
}

} // namespace

TEST(Robustness, HugeStepsEndAtTheMean)
{
  for (const Surface& s : { Icosphere(3), Strip(16, 16), Tetrahedron(), ThreeFins(4), Torus(20, 10),
         Joined(Disk(5), Icosphere(2)),
         MakeSurface({ { 0, 0, 0 }, { 3, 0, 0 }, { 1, 2, 0 } }, { { 0, 1, 2 } }) })
  {
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    Values start = Noise(mesh, 2);
    start.col(1).array() += 1000.0;
    const Values means = ComponentMeans(mesh, start);
    for (const Scheme scheme : BothSchemes)
    {
      // Powers of two make the entries of the strip exact, so that M is lost altogether.
      for (const double step : { 1e12, 1e16, std::ldexp(1.0, 60), 1e20, 1e100, 1e300 })
      {
        const auto heat = MakeHeat(assembler, PointData::FromValues(start), { step, 0.0, scheme });
        Advance(*heat, 3);
        EXPECT_LT((heat->State() - means).cwiseAbs().maxCoeff(), 1e-9) << step;
      }
    }
  }
}

TEST(Robustness, HugeStepsWithFidelityEndAtTheSteadyState)
{
  for (const Surface& s : { Icosphere(3), Strip(16, 16) })
  {
    const auto assembler = MakeAssembler(s);
    PointData data = PointData::FromValues(Noise(assembler->Mesh()));
    data.Missing.head(20) = true;
    data.Start.topRows(20).setConstant(3.0);
    for (const double lambda : { 1e-10, 1.0, 1e10 })
    {
      const auto limit = MakeHeat(assembler, data, { 1.0, lambda, Scheme::SteadyState });
      Advance(*limit, 1);
      for (const Scheme scheme : BothSchemes)
      {
        for (const double step : { 1e20, 1e100 })
        {
          const auto heat = MakeHeat(assembler, data, { step, lambda, scheme });
          Advance(*heat, 3);
          EXPECT_LT((heat->State() - limit->State()).cwiseAbs().maxCoeff(), 1e-6)
            << lambda << " " << step;
        }
      }
    }
  }
}

TEST(Robustness, VerySmallFidelityLeavesTheMeanOfTheKnownValues)
{
  for (const Surface& s : { Icosphere(3), Strip(16, 16) })
  {
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    PointData data = PointData::FromValues(Noise(mesh));
    data.Missing.head(mesh.NumberOfVertices() / 2) = true;
    double sum = 0.0;
    double area = 0.0;
    for (Index i = mesh.NumberOfVertices() / 2; i < mesh.NumberOfVertices(); ++i)
    {
      sum += mesh.ControlAreas()[i] * data.Given(i, 0);
      area += mesh.ControlAreas()[i];
    }
    for (const double lambda : { 1e-12, 1e-18, 1e-30, 1e-100 })
    {
      const auto limit = MakeHeat(assembler, data, { 1.0, lambda, Scheme::SteadyState });
      Advance(*limit, 1);
      EXPECT_LT((limit->State().array() - sum / area).abs().maxCoeff(), 1e-9) << lambda;
    }
  }
}

TEST(Robustness, TinyStepsChangeNextToNothing)
{
  const auto assembler = MakeAssembler(Icosphere(3));
  const Values start = Noise(assembler->Mesh());
  for (const Scheme scheme : BothSchemes)
  {
    for (const double step : { 1e-12, 1e-30, 1e-300 })
    {
      const auto heat = MakeHeat(assembler, PointData::FromValues(start), { step, 0.0, scheme });
      Advance(*heat, 5);
      EXPECT_LT((heat->State() - start).cwiseAbs().maxCoeff(), 5.0 * 1e4 * step + 1e-13) << step;
    }
  }
}

TEST(Robustness, StrongFidelityReturnsTheData)
{
  const auto assembler = MakeAssembler(Icosphere(3));
  PointData data = PointData::FromValues(Noise(assembler->Mesh()));
  data.Start.setZero();
  for (const Scheme scheme : { Scheme::BackwardEuler, Scheme::SDIRK2, Scheme::SteadyState })
  {
    for (const double lambda : { 1e12, 1e100 })
    {
      const auto heat = MakeHeat(assembler, data, { 1.0, lambda, scheme });
      Advance(*heat, 1);
      EXPECT_LT((heat->State() - data.Given).cwiseAbs().maxCoeff(), 1e-7) << lambda;
    }
  }
}

TEST(Robustness, AnEmptySurfaceHasNothingToDo)
{
  const auto assembler =
    std::make_shared<Assembler>(std::make_shared<TriangleMesh>(Points(0, 3), Triangles(0, 3)));
  for (const Scheme scheme : { Scheme::BackwardEuler, Scheme::SDIRK2, Scheme::SteadyState })
  {
    const auto heat =
      MakeHeat(assembler, PointData::FromValues(Values(0, 2)), { 1.0, 1.0, scheme });
    Advance(*heat, 2);
    EXPECT_EQ(heat->State().rows(), 0);
    EXPECT_EQ(heat->Energy(), 0.0);
  }
}

TEST(Robustness, NoColumnsAreNothingToDo)
{
  const auto assembler = MakeAssembler(Icosphere(1));
  for (const Scheme scheme : { Scheme::BackwardEuler, Scheme::SDIRK2, Scheme::SteadyState })
  {
    for (const double lambda : { 0.0, 1.0 })
    {
      const auto heat =
        MakeHeat(assembler, PointData::FromValues(Values(42, 0)), { 1.0, lambda, scheme });
      Advance(*heat, 2);
      EXPECT_EQ(heat->State().cols(), 0);
    }
  }
}

TEST(Robustness, SliverTrianglesGiveFiniteConservedResults)
{
  for (const double aspect : { 1e2, 1e6, 1e10, 1e13 })
  {
    const auto assembler = MakeAssembler(Slivers(aspect));
    const TriangleMesh& mesh = assembler->Mesh();
    const Values start = Noise(mesh);
    for (const Scheme scheme : BothSchemes)
    {
      for (const double step : { 1e-6, 1e-2, 1.0 })
      {
        const auto heat = MakeHeat(assembler, PointData::FromValues(start), { step, 0.0, scheme });
        Advance(*heat, 5);
        EXPECT_LE(heat->State().cwiseAbs().maxCoeff(), 1.1) << aspect << " " << step;
        const double size = Total(mesh, start.cwiseAbs(), 0);
        EXPECT_NEAR(Total(mesh, heat->State(), 0), Total(mesh, start, 0), 1e-12 * size);
      }
    }
  }
}

TEST(Robustness, OneSliverAmongGoodTrianglesDoesNoHarm)
{
  // A vertex moved almost onto the opposite edge: some triangles nearly flat.
  for (const double height : { 1e-4, 1e-8, 1e-12, 1e-14 })
  {
    Surface s = Strip(8, 8);
    for (const Index i : { 20, 40, 60 })
    {
      s.Vertices(i, 0) += (1.0 - height) / 8.0;
    }
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    const Values start = Noise(mesh);
    const Values u =
      Diffuse(assembler, PointData::FromValues(start), 0.05, 5, 0.0, Scheme::BackwardEuler);
    EXPECT_LE(u.cwiseAbs().maxCoeff(), 1.0) << height;
    EXPECT_NEAR(Total(mesh, u, 0), Total(mesh, start, 0), 1e-12 * Total(mesh, start.cwiseAbs(), 0));
  }
}

TEST(Robustness, ResultsScaleWithTheData)
{
  const auto assembler = MakeAssembler(Icosphere(2));
  const Values start = Noise(assembler->Mesh(), 2);
  for (const auto make : { MakeCholeskySolver, MakeConjugateGradientSolver })
  {
    const auto run = [&](const Values& f)
    {
      const auto heat = MakeHeat(assembler, PointData::FromValues(f),
        HeatSettings(assembler->Mesh(), 0.02, 3.0), make(SerialFor()));
      Advance(*heat, 5);
      return heat->State();
    };
    const Values u = run(start);
    for (const int exponent : { -900, -500, 500, 900 })
    {
      const double factor = std::ldexp(1.0, exponent);
      EXPECT_TRUE(run(factor * start) == factor * u) << exponent;
    }
  }
}

TEST(Robustness, AnOffsetOfTheDataCostsNoAccuracy)
{
  const auto assembler = MakeAssembler(Icosphere(3));
  const Values start = Noise(assembler->Mesh());
  for (const auto make : { MakeCholeskySolver, MakeConjugateGradientSolver })
  {
    const auto run = [&](double offset)
    {
      const auto heat =
        MakeHeat(assembler, PointData::FromValues((start.array() + offset).matrix()),
          HeatSettings(assembler->Mesh(), 0.1, 1.0), make(SerialFor()));
      Advance(*heat, 5);
      return heat->State();
    };
    const double offset = 1e9;
    const Values difference = (run(offset).array() - offset).matrix() - run(0.0);
    EXPECT_LT(difference.cwiseAbs().maxCoeff(), 2e-6); // ten roundings of 1e9
  }
}

TEST(Robustness, DirectionsWithoutDiffusionAcrossStayFinite)
{
  const Surface s = Cylinder(24, 12);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  TangentVectors e1 = TangentVectors::Zero(mesh.NumberOfTriangles(), 2);
  e1.col(0).setOnes();
  const CornerWeights c = AnisotropicWeights(mesh, CotanWeights(mesh), e1, 1.0, 0.0);
  const Values start = Noise(mesh);
  LinearDiffusion heat(assembler, c, PointData::FromValues(start),
    HeatSettings(mesh, 0.1, 0.0, Scheme::BackwardEuler), MakeCholeskySolver());
  Advance(heat, 10);
  EXPECT_LE(heat.State().cwiseAbs().maxCoeff(), 1.5);
  EXPECT_NEAR(
    Total(mesh, heat.State(), 0), Total(mesh, start, 0), 1e-12 * Total(mesh, start.cwiseAbs(), 0));
}
