// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Meshes.h"

#include <cmath>
#include <functional>
#include <vector>

namespace SurfaceDiffusion::Testing
{

/// Data on a sphere: the work of total variation depends on their kind.
struct SphereData
{
  const char* Name;
  Eigen::Index Channels;
  bool IsUneven; ///< the mesh: edges at one pole are ten times as long as at the other
  /// Channel k at the point x of the unit sphere, without noise.
  std::function<double(const Eigen::RowVector3d& x, Eigen::Index k)> Clean;
  double Noise; ///< its standard deviation
  double Outliers; ///< the share of vertices with any value in [-5, 5]
};

inline std::vector<SphereData> AllSphereData()
{
  const auto cells = [](const Eigen::RowVector3d& x, Eigen::Index k) {
    return static_cast<double>((static_cast<int>((4.0 * x.array() + 10.0).floor().sum()) + k) % 2);
  };
  const auto cap = [](const Eigen::RowVector3d& x, Eigen::Index) { return x[2] > 0.3 ? 1.0 : 0.0; };
  const auto caps = [](const Eigen::RowVector3d& x, Eigen::Index k)
  { return x[k] > 0.3 ? 1.0 : 0.0; };
  const auto waves = [](const Eigen::RowVector3d& x, Eigen::Index)
  { return std::sin(8.0 * x[0]) * std::cos(5.0 * x[1]); };
  const auto ramp = [](const Eigen::RowVector3d& x, Eigen::Index) { return x[0]; };
  return {
    { "pattern, noise 0.25", 1, false, cells, 0.25, 0.0 },
    { "cap, noise 0.2", 1, false, cap, 0.2, 0.0 },
    { "cap, noise 0.05", 1, false, cap, 0.05, 0.0 },
    { "waves, noise 0.1", 1, false, waves, 0.1, 0.0 },
    { "ramp, noise 0.1", 1, false, ramp, 0.1, 0.0 },
    { "cap, outliers", 1, false, cap, 0.05, 0.05 },
    { "three caps in colours, noise 0.1", 3, false, caps, 0.1, 0.0 },
    { "cap on an uneven mesh, noise 0.1", 1, true, cap, 0.1, 0.0 },
  };
}

/// An icosphere; an uneven one by a Moebius transformation, which keeps the shapes of triangles.
inline Surface SphereOf(const SphereData& data, int subdivisions)
{
  Surface s = Icosphere(subdivisions);
  constexpr double shift = 0.819; // edges are (1 + shift)/(1 - shift) = 10 times as long
  for (Eigen::Index i = 0; data.IsUneven && i < s.Vertices.rows(); ++i)
  {
    const Eigen::RowVector3d x = s.Vertices.row(i);
    const double denominator = 1.0 + shift * x[2];
    const double narrowed = std::sqrt(1.0 - shift * shift) / denominator;
    s.Vertices.row(i) << narrowed * x[0], narrowed * x[1], (x[2] + shift) / denominator;
  }
  return s;
}

inline Values NoisyValues(const SphereData& data, const TriangleMesh& mesh, const Surface& s)
{
  Values f(mesh.NumberOfVertices(), data.Channels);
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    const Index vertex = mesh.InputVertex()[i];
    for (Eigen::Index k = 0; k < data.Channels; ++k)
    {
      const double a = UniformRandom(1, k, vertex);
      const double b = UniformRandom(2, k, vertex);
      f(i, k) = UniformRandom(3, k, vertex) < data.Outliers
        ? 10.0 * UniformRandom(4, k, vertex) - 5.0
        : data.Clean(s.Vertices.row(vertex), k) +
          data.Noise * std::sqrt(-2.0 * std::log(1.0 - a)) * std::cos(2.0 * Pi * b);
    }
  }
  return f;
}

} // namespace SurfaceDiffusion::Testing
