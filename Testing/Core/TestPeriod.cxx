// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "KindsOfNoise.h"
#include "Meshes.h"

#include "Run/Solve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

// Cyclic data: angles, phases, hours.

namespace SurfaceDiffusion
{

namespace
{

constexpr double Degrees = 57.29577951308232;

/// The longitude of each point in degrees, from 0 to 360, with noise of 0.3 rad.
Vector Longitudes(const Testing::Surface& s, double noise)
{
  Vector f(s.Vertices.rows());
  for (Eigen::Index i = 0; i < f.size(); ++i)
  {
    const double angle =
      std::atan2(s.Vertices(i, 1), s.Vertices(i, 0)) + noise * Testing::GaussianNumber(i, 3);
    f[i] = std::fmod(angle * Degrees + 720.0, 360.0);
  }
  return f;
}

double Distance(double a, double b)
{
  return std::abs(std::remainder(a - b, 360.0));
}

HeatSettings OfDegrees()
{
  HeatSettings settings;
  settings.FWHM = 0.25;
  settings.NumberOfTimeSteps = 1;
  settings.Period = 360.0;
  return settings;
}

} // namespace

// Away from the poles, where all longitudes meet. As scalars, angles near 0 and near 360 have the mean 180.
TEST(Period, SmoothsAnglesAcrossTheirJump)
{
  const Testing::Surface s = Testing::Icosphere(5);
  const Vector clean = Longitudes(s, 0.0);
  const Vector noisy = Longitudes(s, 0.3);
  const auto error = [&](const HeatSettings& settings)
  {
    const Solution found = Heat(s.Vertices, s.Faces, noisy, settings);
    double sum = 0.0;
    double count = 0.0;
    for (Eigen::Index i = 0; i < clean.size(); ++i)
    {
      if (std::abs(s.Vertices(i, 2)) < 0.7)
      {
        EXPECT_GE(found.Result(i, 0), 0.0);
        EXPECT_LE(found.Result(i, 0), 360.0);
        sum += std::pow(Distance(found.Result(i, 0), clean[i]) / Degrees, 2);
        count += 1.0;
      }
    }
    return std::sqrt(sum / count);
  };
  EXPECT_LT(error(OfDegrees()), 0.05);
  HeatSettings scalar = OfDegrees();
  scalar.Period = 0.0;
  EXPECT_GT(error(scalar), 0.3);
}

TEST(Period, OfTheDataChangesNothingButTheInterval)
{
  const Testing::Surface s = Testing::Icosphere(3);
  const Vector f = Longitudes(s, 0.2);
  const Values u = Heat(s.Vertices, s.Faces, f, OfDegrees()).Result;
  const Values later = Heat(s.Vertices, s.Faces, Vector(f.array() + 720.0), OfDegrees()).Result;
  EXPECT_GE(later.minCoeff(), f.minCoeff() + 720.0 - 1e-9);
  Vector centred = f;
  for (double& angle : centred)
  {
    angle -= angle > 180.0 ? 360.0 : 0.0;
  }
  const Values fromMinus = Heat(s.Vertices, s.Faces, centred, OfDegrees()).Result;
  EXPECT_GE(fromMinus.minCoeff(), -180.0 - 1e-9);
  EXPECT_LE(fromMinus.maxCoeff() - 180.0, 1e-9);
  // Half a period more: the result is half a period on.
  const Values half = Heat(s.Vertices, s.Faces, Vector(f.array() + 180.0), OfDegrees()).Result;
  for (Eigen::Index i = 0; i < u.rows(); ++i)
  {
    EXPECT_NEAR(Distance(later(i, 0), u(i, 0)), 0.0, 1e-9);
    EXPECT_NEAR(Distance(fromMinus(i, 0), u(i, 0)), 0.0, 1e-9);
    EXPECT_NEAR(Distance(half(i, 0), u(i, 0) + 180.0), 0.0, 1e-9);
  }
}

TEST(Period, HasACoherenceThatVanishesWhereAnglesCancel)
{
  const Testing::Surface s = Testing::Icosphere(4);
  const Solution found = Heat(s.Vertices, s.Faces, Longitudes(s, 0.0), OfDegrees());
  const Values& coherence = found.Arrays.at("Coherence");
  ASSERT_EQ(coherence.rows(), s.Vertices.rows());
  ASSERT_EQ(coherence.cols(), 1);
  for (Eigen::Index i = 0; i < coherence.rows(); ++i)
  {
    EXPECT_LE(coherence(i, 0), 1.0 + 1e-3);
    if (std::abs(s.Vertices(i, 2)) < 0.7)
    {
      EXPECT_GT(coherence(i, 0), 0.95);
    }
    else if (std::abs(s.Vertices(i, 2)) > 0.999)
    {
      EXPECT_LT(coherence(i, 0), 0.3);
    }
  }
}

TEST(Period, FillsHolesAndServesDataOnCells)
{
  const Testing::Surface s = Testing::Icosphere(4);
  const Vector clean = Longitudes(s, 0.0);
  HeatSettings fill = OfDegrees();
  fill.FWHM = 0.0;
  fill.Mode = HeatMode::SteadyState;
  fill.HoldKnownValues = true;
  Vector holes = clean;
  const auto isHole = [&](Eigen::Index i)
  { return s.Vertices(i, 0) > 0.9 && std::abs(s.Vertices(i, 2)) < 0.4; }; // across the jump
  for (Eigen::Index i = 0; i < holes.size(); ++i)
  {
    holes[i] = isHole(i) ? std::numeric_limits<double>::quiet_NaN() : holes[i];
  }
  const Values filled = Heat(s.Vertices, s.Faces, holes, fill).Result;
  Fields cells;
  cells.Data.OnCells = true;
  cells.Data.Values.resize(s.Faces.rows(), 1);
  for (Eigen::Index t = 0; t < s.Faces.rows(); ++t)
  {
    const Eigen::RowVector3d c =
      s.Vertices.row(s.Faces(t, 0)) + s.Vertices.row(s.Faces(t, 1)) + s.Vertices.row(s.Faces(t, 2));
    cells.Data.Values(t, 0) = std::fmod(std::atan2(c.y(), c.x()) * Degrees + 360.0, 360.0);
  }
  const Values ofCells = Heat(s.Vertices, s.Faces, cells, OfDegrees()).Result;
  for (Eigen::Index i = 0; i < clean.size(); ++i)
  {
    if (isHole(i))
    {
      EXPECT_LT(Distance(filled(i, 0), clean[i]), 3.0) << i;
    }
  }
  ASSERT_EQ(ofCells.rows(), s.Faces.rows());
  for (Eigen::Index t = 0; t < ofCells.rows(); ++t)
  {
    if (std::abs(s.Vertices(s.Faces(t, 0), 2)) < 0.6)
    {
      EXPECT_LT(Distance(ofCells(t, 0), cells.Data.Values(t, 0)), 2.0) << t;
    }
  }
}

} // namespace SurfaceDiffusion
