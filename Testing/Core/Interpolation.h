// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Interpolation/SmoothInterpolation.h"
#include "Core/Operators/CotanWeights.h"
#include "Meshes.h"

#include <memory>

namespace SurfaceDiffusion::Testing
{

using Interpolation = SmoothInterpolation;
using Choice = SmoothInterpolation::Choice;

inline Interpolation::Settings InterpolationSettings(Choice smoothing, double mu = 0.0)
{
  Interpolation::Settings settings;
  settings.Smoothing = smoothing;
  settings.Mu = mu;
  return settings;
}

inline Interpolation::Result Interpolate(const std::shared_ptr<const Assembler>& assembler,
  const ScatteredValues& data, const Interpolation::Settings& settings,
  const ParallelFor& parallel = SerialFor())
{
  return Interpolation(assembler, CotanWeights(assembler->Mesh()), settings, parallel).Fit(data);
}

/// The values of the field at those vertices whose input number `isKnown` accepts.
template <typename Known>
ScatteredValues ValuesAt(const TriangleMesh& mesh, const Values& field, const Known& isKnown)
{
  Flags known(mesh.NumberOfVertices());
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    known[i] = isKnown(mesh.InputVertex()[i]);
  }
  return ScatteredValues::AtVertices(field, known);
}

/// `count` points anywhere on the surface, at random, and the values of a field of linear elements
/// there.
inline ScatteredValues ValuesInTriangles(
  const TriangleMesh& mesh, const Values& field, Index count, std::int64_t seed = 3)
{
  ScatteredValues data;
  data.Given = Values::Zero(count, field.cols());
  data.Weights = Vector::Ones(count);
  for (Index i = 0; i < count; ++i)
  {
    const auto t = static_cast<Index>(UniformRandom(seed, 0, i) * mesh.NumberOfTriangles());
    const double r = std::sqrt(UniformRandom(seed, 1, i));
    const double s = UniformRandom(seed, 2, i);
    SurfacePoint place;
    place.Coordinates = { 1.0 - r, r * (1.0 - s), r * s };
    for (int a = 0; a < 3; ++a)
    {
      place.Vertices[a] = mesh.TriangleVertices()(t, a);
      data.Given.row(i) += place.Coordinates[a] * field.row(place.Vertices[a]);
    }
    data.Places.push_back(place);
  }
  return data;
}

/// Standard normal numbers.
inline double Gaussian(std::int64_t seed, std::int64_t component, std::int64_t id)
{
  const double a = UniformRandom(seed, 2 * component, id);
  const double b = UniformRandom(seed, 2 * component + 1, id);
  return std::sqrt(-2.0 * std::log(1.0 - a)) * std::cos(2.0 * Pi * b);
}

/// A smooth field on the unit sphere, like the temperature of the sea by latitude and longitude. Its
/// standard deviation is 9.06.
inline double SeaTemperature(const Eigen::RowVector3d& x)
{
  const double square = x[0] * x[0] + x[1] * x[1];
  return 30.0 * square - 2.0 + 3.0 * x[1] * (3.0 * x[0] * x[0] - x[1] * x[1]);
}

} // namespace SurfaceDiffusion::Testing
