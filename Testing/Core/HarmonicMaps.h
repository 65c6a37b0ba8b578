// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Harmonic/HarmonicMap.h"
#include "Core/Operators/CotanWeights.h"
#include "Meshes.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace SurfaceDiffusion::Testing
{

using MapScheme = HarmonicMap::Scheme;

/// h in the mesh's units.
/// Time step and beta in coordinate units, as the exact solutions are.
inline HarmonicMap::Settings MapSettings(const TriangleMesh& mesh, double exponent, double timeStep,
  double beta = 1e-8, MapScheme scheme = MapScheme::TangentPlane)
{
  HarmonicMap::Settings settings;
  settings.Exponent = exponent;
  settings.TimeStep = timeStep / std::pow(mesh.LengthUnit(), exponent);
  settings.Beta = beta * mesh.LengthUnit() * mesh.LengthUnit();
  settings.TimeScheme = scheme;
  return settings;
}

inline std::unique_ptr<HarmonicMap> MakeMap(std::shared_ptr<const Assembler> assembler,
  PointData data, const HarmonicMap::Settings& settings,
  std::shared_ptr<LinearSolver> solver = MakeCholeskySolver(),
  const ParallelFor& parallel = SerialFor())
{
  CornerWeights coefficients = CotanWeights(assembler->Mesh(), parallel);
  return std::make_unique<HarmonicMap>(std::move(assembler), std::move(coefficients),
    std::move(data), settings, std::move(solver), parallel);
}

/// f(x), a row of m numbers of any length, at the vertices, normalised.
template <typename F>
Values SampleUnit(const TriangleMesh& mesh, const Surface& s, Eigen::Index m, const F& f)
{
  Values u(mesh.NumberOfVertices(), m);
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    u.row(i) = f(Eigen::RowVector3d(s.Vertices.row(mesh.InputVertex()[i])));
    u.row(i).normalize();
  }
  return u;
}

/// The great circle: (cos psi, sin psi, 0) with psi(x).
template <typename F>
Values SampleGreatCircle(const TriangleMesh& mesh, const Surface& s, const F& psi)
{
  return SampleUnit(mesh, s, 3,
    [&](const Eigen::RowVector3d& x)
    { return Eigen::RowVector3d(std::cos(psi(x)), std::sin(psi(x)), 0.0); });
}

/// psi of a map into the great circle.
inline Values Angles(const Values& u)
{
  Values psi(u.rows(), 1);
  for (Eigen::Index i = 0; i < u.rows(); ++i)
  {
    psi(i, 0) = std::atan2(u(i, 1), u(i, 0));
  }
  return psi;
}

/// Random unit vectors.
inline Values RandomUnitVectors(const TriangleMesh& mesh, Eigen::Index m, std::int64_t seed = 7)
{
  Values u = Noise(mesh, m, seed);
  u.rowwise().normalize();
  return u;
}

inline double LargestLengthError(const Values& u)
{
  return (u.rowwise().norm().array() - 1.0).abs().maxCoeff();
}

} // namespace SurfaceDiffusion::Testing
