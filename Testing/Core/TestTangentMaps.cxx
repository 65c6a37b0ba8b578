// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "KindsOfNoise.h"
#include "Meshes.h"

#include "Run/HarmonicMapSettings.h"
#include "Run/Solve.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <string>

// Unit vectors that stay in the tangent plane of the surface.

namespace SurfaceDiffusion
{

namespace
{

using Row = Eigen::RowVector3d;

/// Unit vectors along the meridians of the unit sphere.
Row Meridian(const Row& p)
{
  return (Row(0.0, 0.0, 1.0) - p.z() * p).normalized();
}

/// Meridians turned in the tangent plane by random angles of this deviation.
Values NoisyMeridians(const Testing::Surface& s, double deviation)
{
  Values values(s.Vertices.rows(), 3);
  for (Eigen::Index i = 0; i < values.rows(); ++i)
  {
    const Row p = s.Vertices.row(i);
    const Row m = Meridian(p);
    const double angle = deviation * Testing::GaussianNumber(i, 3);
    values.row(i) = std::cos(angle) * m + std::sin(angle) * Row(p.cross(m));
  }
  return values;
}

/// The largest angle out of the tangent plane of the unit sphere, in degrees.
double LargestTilt(const Testing::Surface& s, const Values& u)
{
  const double sine = s.Vertices.cwiseProduct(u).rowwise().sum().cwiseAbs().maxCoeff();
  return std::asin(std::min(sine, 1.0)) * 180.0 / 3.14159265358979323846;
}

HarmonicMapSettings Tangent()
{
  HarmonicMapSettings settings;
  settings.TangentTo = TangentTo::Surface;
  return settings;
}

} // namespace

TEST(TangentMaps, OfFieldsAndLinesStayInThePlaneAndLoseEnergy)
{
  Testing::Surface s = Testing::Rotated(Testing::Icosphere(3), 0.3); // no vertex at a pole
  const Values f = NoisyMeridians(s, 0.3);
  for (const bool lines : { false, true })
  {
    for (const double exponent : { 1.0, 2.0 })
    {
      for (const auto scheme : { HarmonicMap::Scheme::TangentPlane,
             HarmonicMap::Scheme::MinimizingMovement, HarmonicMap::Scheme::ExplicitReaction })
      {
        HarmonicMapSettings settings = Tangent();
        settings.LineField = lines;
        settings.Exponent = exponent;
        settings.Scheme = scheme;
        settings.NumberOfTimeSteps = 20;
        const Solution solution = HarmonicMapFlow(s.Vertices, s.Faces, f, settings);
        SCOPED_TRACE(std::to_string(int(scheme)) + (lines ? " lines" : " vectors"));
        EXPECT_LT(LargestTilt(s, solution.Result), 1e-10);
        EXPECT_LT((solution.Result.rowwise().norm().array() - 1.0).abs().maxCoeff(), 1e-12);
        EXPECT_TRUE(solution.Warnings.empty());
        const std::vector<StepRecord>& steps = solution.Steps.Records;
        for (std::size_t k = 1;
             k < steps.size() && settings.Scheme != HarmonicMap::Scheme::ExplicitReaction; ++k)
        {
          EXPECT_LE(steps[k].Energy, steps[k - 1].Energy);
        }
      }
    }
  }
}

TEST(TangentMaps, LoseTheNoiseOfTheirAngles)
{
  Testing::Surface s = Testing::Rotated(Testing::Icosphere(4), 0.3);
  const Values clean = NoisyMeridians(s, 0.0);
  HarmonicMapSettings settings = Tangent();
  settings.Exponent = 2.0;
  settings.TimeStep = 0.3;
  settings.NumberOfTimeSteps = 5;
  const Values u = HarmonicMapFlow(s.Vertices, s.Faces, NoisyMeridians(s, 0.3), settings).Result;
  double squares = 0.0;
  Index count = 0;
  for (Eigen::Index i = 0; i < u.rows(); ++i)
  {
    if (std::abs(s.Vertices(i, 2)) < 0.8) // away from the poles
    {
      squares += std::pow(std::acos(std::min(1.0, u.row(i).dot(clean.row(i)))), 2);
      ++count;
    }
  }
  EXPECT_LT(std::sqrt(squares / count), 0.1);
}

// In a plane they are the maps into the circle.
TEST(TangentMaps, InAPlaneAreThoseOfTwoComponents)
{
  const Testing::Surface s = Testing::Plate(12, 1.0);
  Values two(s.Vertices.rows(), 2);
  Values three = Values::Zero(two.rows(), 3);
  for (Eigen::Index i = 0; i < two.rows(); ++i)
  {
    const double angle = Testing::GaussianNumber(i, 5);
    two.row(i) << std::cos(angle), std::sin(angle);
    three.row(i) << two.row(i), 0.7; // the part along the normal is dropped
  }
  HarmonicMapSettings settings = Tangent();
  const Values u = HarmonicMapFlow(s.Vertices, s.Faces, three, settings).Result;
  settings.TangentTo = TangentTo::None;
  const Values plane = HarmonicMapFlow(s.Vertices, s.Faces, two, settings).Result;
  EXPECT_LT((u.leftCols(2) - plane).cwiseAbs().maxCoeff(), 1e-5);
}

TEST(TangentMaps, TurnWithTheSurfaceInAnyNumbering)
{
  Testing::Surface s = Testing::Rotated(Testing::Icosphere(3), 0.3);
  const Values f = NoisyMeridians(s, 0.3);
  HarmonicMapSettings settings = Tangent();
  settings.Tolerance = 1e-12;
  settings.LineField = true;
  const Values u = HarmonicMapFlow(s.Vertices, s.Faces, f, settings).Result;
  const std::vector<Index> numbers = Testing::Permutation(s.NumberOfVertices(), 17);
  Testing::Surface other = Testing::Renumbered(s, numbers);
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(2.0, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  other.Vertices = other.Vertices * turn.transpose();
  Values g = f;
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    g.row(numbers[static_cast<std::size_t>(i)]) = f.row(i) * turn.transpose();
  }
  const Values v = HarmonicMapFlow(other.Vertices, other.Faces, g, settings).Result;
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    const Row turned = u.row(i) * turn.transpose();
    EXPECT_GT(std::abs(turned.dot(v.row(numbers[static_cast<std::size_t>(i)]))), 1.0 - 1e-9);
  }
}

TEST(TangentMaps, AreAskedForWhereVectorsWouldLeaveTheSurface)
{
  Testing::Surface s = Testing::Rotated(Testing::Icosphere(3), 0.3);
  HarmonicMapSettings settings;
  settings.LineField = true;
  settings.NumberOfTimeSteps = 100;
  const Solution solution = HarmonicMapFlow(s.Vertices, s.Faces, NoisyMeridians(s, 0.0), settings);
  EXPECT_GT(LargestTilt(s, solution.Result), 10.0);
  ASSERT_EQ(solution.Warnings.size(), 1u);
  EXPECT_NE(solution.Warnings[0].find("set TangentTo to"), std::string::npos)
    << solution.Warnings[0];
  Values normals = s.Vertices;
  EXPECT_TRUE(HarmonicMapFlow(s.Vertices, s.Faces, normals, settings).Warnings.empty());
  settings.TangentTo = TangentTo::Surface;
  const Solution none = HarmonicMapFlow(s.Vertices, s.Faces, normals, settings);
  ASSERT_EQ(none.Warnings.size(), 1u);
  EXPECT_NE(none.Warnings[0].find("has the normals"), std::string::npos) << none.Warnings[0];
}

// Vectors along the normal, and missing ones, become vectors of the plane.
TEST(TangentMaps, FillVectorsThatHaveNoPartInThePlane)
{
  Testing::Surface s = Testing::Rotated(Testing::Icosphere(2), 0.3);
  Values f = NoisyMeridians(s, 0.1);
  for (Eigen::Index i = 0; i < f.rows(); i += 7)
  {
    f.row(i) = s.Vertices.row(i);
    f.row((i + 3) % f.rows()).setConstant(std::nan(""));
  }
  HarmonicMapSettings settings = Tangent();
  for (const auto fill :
    { InitialFill::Mean, InitialFill::Input, InitialFill::Noise, InitialFill::Harmonic })
  {
    settings.InitialFill = fill;
    const Values u = HarmonicMapFlow(s.Vertices, s.Faces, f, settings).Result;
    EXPECT_LT(LargestTilt(s, u), 1e-10);
    EXPECT_LT((u.rowwise().norm().array() - 1.0).abs().maxCoeff(), 1e-12);
  }
}

} // namespace SurfaceDiffusion
