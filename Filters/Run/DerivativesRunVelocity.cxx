// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The velocities of waves from their arrival times.
#include "Run/DerivativesRun.h"

#include "Core/Geometry/Derivatives.h"

#include <cmath>
#include <limits>
#include <utility>

namespace SurfaceDiffusion
{

void DerivativesRun::AddVelocity(Values gradients, const Values& turns, bool onTriangles)
{
  // Where fronts meet head on the turn is -2 to -3, and -1 to -1.5 at right angles; at a distance r from a
  // focus it is the length of an edge over r.
  constexpr double largestTurn = 0.7;
  constexpr double roundOff = 1e-12; // of the largest gradient: times that do not change
  Values speeds = Values::Zero(gradients.rows(), gradients.cols() / 3);
  for (Eigen::Index c = 0; c < speeds.cols(); ++c)
  {
    auto slowness = gradients.middleCols(3 * c, 3);
    const Vector lengths = slowness.rowwise().stableNorm();
    const double smallest = lengths.size() > 0 ? roundOff * lengths.maxCoeff() : 0.0;
    for (Eigen::Index i = 0; i < speeds.rows(); ++i)
    {
      const bool isUndetermined = std::abs(turns(i, c)) > largestTurn;
      const double speed = lengths[i] > smallest && !isUndetermined ? 1.0 / lengths[i] : 0.0;
      speeds(i, c) = std::isfinite(speed) ? speed : 0.0;
      slowness.row(i) *= speeds(i, c) * speeds(i, c);
      speeds(i, c) = isUndetermined ? std::numeric_limits<double>::quiet_NaN() : speeds(i, c);
    }
  }
  this->Add("ConductionVelocity", std::move(gradients), onTriangles);
  this->Results.back().Active = Role::Vectors;
  const auto add = [&](const char* name, Values rows)
  {
    this->Add(name, std::move(rows), onTriangles);
    this->Results.back().IsBesideResult = true;
  };
  constexpr double many = 0.1;
  const auto undetermined = static_cast<double>((turns.array().abs() > largestTurn).count());
  if (undetermined > many * static_cast<double>(turns.size()))
  {
    this->OfTurns << "fronts turn within an edge at "
                  << std::round(100.0 * undetermined / static_cast<double>(turns.size()))
                  << " % of the " << (onTriangles ? "triangles" : "points")
                  << ", where the speed is not determined; use a finer surface or, of times with "
                     "noise, set "
                  << Word::Setting("SmoothingFWHM");
  }
  add("Speed", std::move(speeds));
  add("Collision", (turns.array() < -largestTurn).cast<double>());
  add("Focus", (turns.array() > largestTurn).cast<double>());
}

void DerivativesRun::AddBand(const Values& speeds, const Values& slopeErrors)
{
  constexpr double quantile = 1.6448536269514722; // of the normal distribution: 5 % lie above it
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Values lower = speeds, upper = speeds;
  for (Eigen::Index i = 0; i < speeds.rows(); ++i)
  {
    for (Eigen::Index c = 0; c < speeds.cols(); ++c)
    {
      const double error = slopeErrors(i, c);
      if (error < 0.0)
      {
        throw ErrorAt(Word::Array("SlopeErrorArray"), "is negative", false, i,
          "allowed: 0 or more, and NaN where the error is not known");
      }
      if (std::isnan(speeds(i, c)) || std::isnan(error))
      {
        lower(i, c) = upper(i, c) = std::numeric_limits<double>::quiet_NaN();
        continue;
      }
      const double slowness = speeds(i, c) > 0.0 ? 1.0 / speeds(i, c) : 0.0;
      lower(i, c) = 1.0 / (slowness + quantile * error);
      const double smallest = slowness - quantile * error;
      upper(i, c) = smallest > 0.0 ? 1.0 / smallest : infinity;
    }
  }
  const auto add = [this](const char* name, Values& bound)
  {
    this->Results.push_back({ name, Place::PerPoint, OutputType::Double, std::move(bound) });
    this->Results.back().IsBesideResult = true;
    this->Results.back().MayBeInfinite = true;
  };
  add("SpeedLower", lower);
  add("SpeedUpper", upper);
}

Values DerivativesRun::FindTurns(
  const Derivatives& operators, const Values& gradients, bool onTriangles) const
{
  const TriangleMesh& mesh = this->Domain->InputMesh();
  Values directions = gradients;
  for (Eigen::Index t = 0; t < directions.rows(); ++t)
  {
    for (Eigen::Index c = 0; c < directions.cols(); c += 3)
    {
      directions.row(t).segment<3>(c).stableNormalize();
    }
  }
  const Values turns =
    mesh.ControlAreas().cwiseSqrt().asDiagonal() * operators.Divergence(directions);
  if (!onTriangles)
  {
    return turns;
  }
  Values largest(mesh.NumberOfTriangles(), turns.cols());
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    for (Eigen::Index c = 0; c < turns.cols(); ++c)
    {
      largest(t, c) = 0.0;
      for (int a = 0; a < 3; ++a)
      {
        const double turn = turns(mesh.TriangleVertices()(t, a), c);
        largest(t, c) = std::abs(turn) > std::abs(largest(t, c)) ? turn : largest(t, c);
      }
    }
  }
  return largest;
}

} // namespace SurfaceDiffusion
