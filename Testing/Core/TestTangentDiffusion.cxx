// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "KindsOfNoise.h"
#include "Meshes.h"

#include "Core/Vectors/TangentDiffusion.h"
#include "Run/HeatSettings.h"
#include "Run/Solve.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <functional>
#include <string>

// Tangent vectors, which stay in the surface: exact fields, orders, and what is taken for them.

namespace SurfaceDiffusion
{

namespace
{

using Row = Eigen::RowVector3d;

/// Per point the value of a function of the place.
Values Field(const Testing::Surface& s, const std::function<Row(const Row&)>& f)
{
  Values values(s.Vertices.rows(), 3);
  for (Eigen::Index i = 0; i < values.rows(); ++i)
  {
    values.row(i) = f(s.Vertices.row(i));
  }
  return values;
}

Row RotationAboutZ(const Row& p)
{
  return { -p.y(), p.x(), 0.0 };
}

/// The gradient of z^2/2 on the unit sphere.
Row GradientOfSquare(const Row& p)
{
  return p.z() * (Row(0.0, 0.0, 1.0) - p.z() * p);
}

HeatSettings Tangent(VectorLaplacian laplacian, double time)
{
  HeatSettings settings;
  settings.Units = UnitsMode::Absolute;
  settings.Vectors = { VectorType::Tangent, laplacian, NormalPart::Drop };
  settings.TimeStep = time;
  settings.NumberOfTimeSteps = 1;
  settings.TimeIntegrator = TimeIntegrator::Exponential;
  settings.Tolerance = 1e-10;
  settings.Solver = SolverMethod::Direct;
  return settings;
}

double RelativeError(const Values& a, const Values& b)
{
  return (a - b).norm() / b.norm();
}

/// The largest part of vectors along the normals of the unit sphere.
double LargestNormalPart(const Testing::Surface& s, const Values& u)
{
  return s.Vertices.cwiseProduct(u).rowwise().sum().cwiseAbs().maxCoeff();
}

struct Decay
{
  const char* Name;
  Row (*Field)(const Row&);
  double Rates[3]; ///< of Connection, Hodge and Viscous
};

} // namespace

// The rates of gradients and curls of degree l: l(l+1) - 1 both; l(l+1) both; 2 l(l+1) - 2 and l(l+1) - 2.
TEST(TangentDiffusion, DecaysAtTheRatesOfTheThreeLaplaciansWithSecondOrder)
{
  const Decay decays[] = {
    { "rotation", &RotationAboutZ, { 1.0, 2.0, 0.0 } },
    { "gradient", [](const Row& p) -> Row { return Row(0.0, 0.0, 1.0) - p.z() * p; },
      { 1.0, 2.0, 2.0 } },
    { "gradient of degree 2", &GradientOfSquare, { 5.0, 6.0, 10.0 } },
    { "curl of degree 2", [](const Row& p) -> Row { return p.cross(GradientOfSquare(p)); },
      { 5.0, 6.0, 4.0 } },
  };
  constexpr double time = 0.05;
  for (const Decay& decay : decays)
  {
    for (int laplacian = 0; laplacian < 3; ++laplacian)
    {
      const auto errorOn = [&](int level)
      {
        const Testing::Surface s = Testing::Icosphere(level);
        const Values f = Field(s, decay.Field);
        HeatSettings settings = Tangent(static_cast<VectorLaplacian>(laplacian), time / 10.0);
        settings.TimeIntegrator = TimeIntegrator::SecondOrder;
        settings.NumberOfTimeSteps = 10;
        const Values u = Heat(s.Vertices, s.Faces, f, settings).Result;
        EXPECT_LT(LargestNormalPart(s, u), 1e-12);
        return RelativeError(u, std::exp(-decay.Rates[laplacian] * time) * f);
      };
      const double coarse = errorOn(3);
      const double fine = errorOn(4);
      const std::string name = std::string(decay.Name) + ", " + std::to_string(laplacian);
      if (decay.Rates[laplacian] == 0.0)
      {
        EXPECT_LT(fine, 1e-11) << name; // a rigid rotation
        continue;
      }
      EXPECT_LT(fine, 2e-3) << name;
      EXPECT_GT(Testing::ObservedOrder(coarse, fine), 1.8) << name;
    }
  }
}

TEST(TangentDiffusion, KeepsConstantsOfThePlaneAndTheParallelFieldsOfCylinders)
{
  const Testing::Surface plate =
    Testing::Jittered(Testing::Strip(12, 12), 0.03, 0.001, 0.999, 0.001, 0.999);
  const Testing::Surface cylinder = Testing::Cylinder(16, 8);
  for (const VectorLaplacian laplacian : { VectorLaplacian::Connection, VectorLaplacian::Hodge })
  {
    const HeatSettings settings = Tangent(laplacian, 0.1);
    const Values constant = Field(plate, [](const Row&) -> Row { return { 0.3, -2.0, 0.0 }; });
    EXPECT_LT(
      RelativeError(Heat(plate.Vertices, plate.Faces, constant, settings).Result, constant), 1e-11);
    // Around and along: parallel on the prism that the points make, too.
    const Values around = Field(cylinder,
      [](const Row& p) -> Row
      { return Row(-p.y(), p.x(), 0.0).normalized() + Row(0.0, 0.0, 0.5); });
    EXPECT_LT(
      RelativeError(Heat(cylinder.Vertices, cylinder.Faces, around, settings).Result, around),
      1e-11);
  }
}

TEST(TangentDiffusion, OnAPlaneIsDiffusionOfTheComponents)
{
  const Testing::Surface s = Testing::Strip(15, 15);
  const Values f = Field(s,
    [](const Row& p) -> Row {
      return { std::sin(9.0 * p.x()), p.y() * p.y(), 0.0 };
    });
  for (const bool steady : { false, true })
  {
    HeatSettings settings = Tangent(VectorLaplacian::Connection, 0.01);
    settings.MassMatrix = MassMatrix::Mixed;
    if (steady)
    {
      settings.Mode = HeatMode::SteadyState;
      settings.FidelityWeight = 30.0;
    }
    const Values tangent = Heat(s.Vertices, s.Faces, f, settings).Result;
    settings.Vectors.Type = VectorType::Components;
    EXPECT_LT(RelativeError(tangent, Heat(s.Vertices, s.Faces, f, settings).Result), 1e-9);
  }
}

// One vector at a pole, carried along meridians: the connection is the surface's own.
TEST(TangentDiffusion, CarriesAVectorByParallelTransport)
{
  const Testing::Surface s = Testing::Icosphere(4);
  Values f = Values::Zero(s.Vertices.rows(), 3);
  Eigen::Index pole = 0;
  s.Vertices.col(2).maxCoeff(&pole);
  const Row start = Row(1.0, 0.0, 0.0) - s.Vertices(pole, 0) * Row(s.Vertices.row(pole));
  f.row(pole) = start.normalized();
  HeatSettings settings = Tangent(VectorLaplacian::Connection, 0.05);
  const Values u = Heat(s.Vertices, s.Faces, f, settings).Result;
  for (Eigen::Index i = 0; i < u.rows(); ++i)
  {
    const Row p = s.Vertices.row(i);
    const Row axis = Row(s.Vertices.row(pole)).cross(p);
    if (axis.norm() < 0.05 || axis.norm() > 0.6 || p.dot(s.Vertices.row(pole)) < 0.0)
    {
      continue;
    }
    const double angle = std::asin(axis.norm());
    const Eigen::Vector3d carried =
      Eigen::AngleAxisd(angle, axis.transpose().normalized()) * f.row(pole).transpose();
    const double cosine = u.row(i).normalized().dot(carried.transpose());
    EXPECT_GT(cosine, std::cos(0.035)) << i; // 2 degrees
  }
}

TEST(TangentDiffusion, DependsNeitherOnOrientationNorOnPlaceUnitsAndNumbering)
{
  const Testing::Surface s = Testing::Icosphere(3);
  const auto rough = [](const Row& p) -> Row
  { return Row(std::sin(7.0 * p.y()), std::cos(5.0 * p.z()), p.x()); };
  const HeatSettings settings = Tangent(VectorLaplacian::Viscous, 0.02);
  const Values f = Field(s, rough);
  const Values u = Heat(s.Vertices, s.Faces, f, settings).Result;

  Testing::Surface mixed = s;
  for (Eigen::Index t = 0; t < mixed.Faces.rows(); t += 3)
  {
    std::swap(mixed.Faces(t, 0), mixed.Faces(t, 1));
  }
  EXPECT_LT(RelativeError(Heat(mixed.Vertices, mixed.Faces, f, settings).Result, u), 1e-11);

  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, -0.5).normalized()).toRotationMatrix();
  constexpr double size = 1000.0;
  const Points moved = size * s.Vertices * turn.transpose();
  HeatSettings scaled = settings;
  scaled.TimeStep *= size * size;
  const Values turned = Heat(moved, s.Faces, Values(f * turn.transpose()), scaled).Result;
  EXPECT_LT(RelativeError(turned, u * turn.transpose()), 1e-11);

  const Testing::Surface other =
    Testing::Renumbered(s, Testing::Permutation(static_cast<Index>(s.Vertices.rows()), 5));
  const Values renumbered = Heat(other.Vertices, other.Faces, Field(other, rough), settings).Result;
  EXPECT_NEAR(renumbered.norm(), u.norm(), 1e-11 * u.norm());
}

// The part along the normal, of which Diffuse makes what the filter makes of a scalar.
TEST(TangentDiffusion, DropsKeepsOrDiffusesTheNormalPart)
{
  const Testing::Surface s = Testing::Icosphere(3);
  const auto height = [](const Row& p) { return 1.0 + p.z(); };
  const Values f = Field(s, [&](const Row& p) -> Row { return RotationAboutZ(p) + height(p) * p; });
  Vector heights(s.Vertices.rows());
  for (Eigen::Index i = 0; i < heights.size(); ++i)
  {
    heights[i] = height(s.Vertices.row(i));
  }
  HeatSettings settings = Tangent(VectorLaplacian::Connection, 0.1);
  settings.Vectors.Type = VectorType::Components;
  const Vector diffused = Heat(s.Vertices, s.Faces, heights, settings).Result;
  settings.Vectors.Type = VectorType::Tangent;
  const auto normalPart = [&](NormalPart part) -> Vector
  {
    settings.Vectors.NormalPart = part;
    const Values u = Heat(s.Vertices, s.Faces, f, settings).Result;
    return s.Vertices.cwiseProduct(u).rowwise().sum();
  };
  EXPECT_LT(normalPart(NormalPart::Drop).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((normalPart(NormalPart::Keep) - heights).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((normalPart(NormalPart::Diffuse) - diffused).cwiseAbs().maxCoeff(), 1e-9);
}

namespace
{

/// The warnings of VectorType Automatic, and whether the result is that of tangent vectors.
struct Decision
{
  std::size_t NumberOfWarnings;
  bool IsTangent;
};

Decision Decide(const Testing::Surface& s, const Values& f)
{
  HeatSettings settings = Tangent(VectorLaplacian::Connection, 0.01);
  settings.Vectors.Type = VectorType::Automatic;
  const Solution found = Heat(s.Vertices, s.Faces, f, settings);
  settings.Vectors.Type = VectorType::Tangent;
  const Values tangent = Heat(s.Vertices, s.Faces, f, settings).Result;
  return { found.Warnings.size(), found.Result == tangent };
}

} // namespace

TEST(TangentDiffusion, IsChosenForTangentVectorsAndForNothingElse)
{
  const Testing::Surface s = Testing::Icosphere(3);
  Values f = Field(s, RotationAboutZ);
  const Decision ofVectors = Decide(s, f);
  EXPECT_TRUE(ofVectors.IsTangent);
  EXPECT_EQ(ofVectors.NumberOfWarnings, 1U);
  f.topRows(f.rows() / 3).setZero(); // zero vectors count neither way
  EXPECT_TRUE(Decide(s, f).IsTangent);

  const Values normals = s.Vertices;
  const Values colours = Field(s,
    [](const Row& p) -> Row
    { return Row(0.5, 0.5, 0.5) + 0.5 * Row(std::sin(3.0 * p.x()), p.y(), p.z()); });
  for (const Values& other : { normals, colours })
  {
    const Decision decision = Decide(s, other);
    EXPECT_FALSE(decision.IsTangent);
    EXPECT_EQ(decision.NumberOfWarnings, 0U);
  }
  // Coordinates of a plane, which lie in it.
  const Testing::Surface plate = Testing::Strip(9, 9);
  const Solution found = Heat(plate.Vertices, plate.Faces, Values(plate.Vertices), {});
  EXPECT_TRUE(found.Warnings.empty());

  // On half of the surface.
  Values half = Field(s, RotationAboutZ);
  for (Eigen::Index i = 0; i < half.rows(); ++i)
  {
    half.row(i) = s.Vertices(i, 2) > 0.3 ? Row(s.Vertices.row(i)) : Row(half.row(i));
  }
  const Decision ofHalf = Decide(s, half);
  EXPECT_FALSE(ofHalf.IsTangent);
  EXPECT_EQ(ofHalf.NumberOfWarnings, 1U);
}

TEST(TangentDiffusion, FillsHolesHoldsFixedVectorsAndFindsItsWeight)
{
  const Testing::Surface s = Testing::Icosphere(4);
  const Values clean = Field(s, RotationAboutZ);
  HeatSettings settings = Tangent(VectorLaplacian::Viscous, 1.0);
  settings.Mode = HeatMode::SteadyState;
  settings.HoldKnownValues = true;
  Fields fields;
  fields.Data.Values = clean;
  for (Eigen::Index i = 0; i < clean.rows(); ++i)
  {
    fields.Mask.Values.push_back(s.Vertices(i, 0) > 0.7);
  }
  const Values filled = Heat(s.Vertices, s.Faces, fields, settings).Result;
  EXPECT_LT(RelativeError(filled, clean), 1e-6); // rigid rotations cost nothing

  Values noisy = clean;
  for (Eigen::Index i = 0; i < noisy.rows(); ++i)
  {
    for (int k = 0; k < 3; ++k)
    {
      noisy(i, k) += 0.2 * Testing::GaussianNumber(i, k);
    }
    noisy.row(i) -= noisy.row(i).dot(s.Vertices.row(i)) * Row(s.Vertices.row(i));
  }
  HeatSettings found = Tangent(VectorLaplacian::Connection, 1.0);
  found.Mode = HeatMode::SteadyState;
  const auto errorAt = [&](double weight)
  {
    found.AutomaticFidelity = weight == 0.0;
    found.FidelityWeight = weight;
    return RelativeError(Heat(s.Vertices, s.Faces, noisy, found).Result, clean);
  };
  double best = 1.0;
  for (double weight = 1.0; weight < 1e4; weight *= 1.5)
  {
    best = std::min(best, errorAt(weight));
  }
  EXPECT_LT(errorAt(0.0), 1.2 * best);
}

} // namespace SurfaceDiffusion
