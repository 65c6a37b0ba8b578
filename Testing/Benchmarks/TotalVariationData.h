// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Meshes.h"

#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

/// Data of many kinds on a sphere, for the work of total variation.
namespace SurfaceDiffusion::Testing
{

struct SphereData
{
  const char* Name;
  Eigen::Index Channels;
  bool IsUneven; ///< the mesh: edges at one pole are ten times as long as at the other
  /// The value of channel k at a point of the unit sphere, without noise.
  std::function<double(const Eigen::RowVector3d& x, Eigen::Index k)> Clean;
  double Noise; ///< its standard deviation
  double Outliers; ///< the share of vertices with a value of up to +-5
};

inline const std::vector<SphereData>& AllSphereData()
{
  const auto cap = [](const Eigen::RowVector3d& x, Eigen::Index) { return x[2] > 0.3 ? 1.0 : 0.0; };
  const auto waves = [](const Eigen::RowVector3d& x, Eigen::Index)
  { return std::sin(8.0 * x[0]) * std::cos(5.0 * x[1]); };
  const auto ramp = [](const Eigen::RowVector3d& x, Eigen::Index) { return x[0]; };
  const auto cells = [](const Eigen::RowVector3d& x, Eigen::Index k)
  { return static_cast<double>((static_cast<int>((4.0 * x.array() + 10.0).floor().sum()) + k) % 2); };
  const auto caps = [](const Eigen::RowVector3d& x, Eigen::Index k) { return x[k] > 0.3 ? 1.0 : 0.0; };
  static const std::vector<SphereData> data = {
    { "pattern, noise 0.25", 1, false, cells, 0.25, 0.0 },
    { "cap, noise 0.2", 1, false, cap, 0.2, 0.0 },
    { "cap, noise 0.05", 1, false, cap, 0.05, 0.0 },
    { "waves, noise 0.1", 1, false, waves, 0.1, 0.0 },
    { "ramp, noise 0.1", 1, false, ramp, 0.1, 0.0 },
    { "cap, outliers", 1, false, cap, 0.05, 0.05 },
    { "three caps in colours, noise 0.1", 3, false, caps, 0.1, 0.0 },
    { "cap on an uneven mesh, noise 0.1", 1, true, cap, 0.1, 0.0 },
  };
  return data;
}

/// The icosphere, or with its vertices drawn to one pole.
inline Surface SphereOf(const SphereData& data, int subdivisions)
{
  Surface s = Icosphere(subdivisions);
  if (data.IsUneven)
  {
    // A Moebius transformation of the sphere: conformal, so that triangles keep their shape.
    const double a = 0.52;
    for (Eigen::Index i = 0; i < s.Vertices.rows(); ++i)
    {
      const Eigen::RowVector3d x = s.Vertices.row(i);
      const double z = (x[2] + 2.0 * a / (1.0 + a * a)) / (1.0 + 2.0 * a / (1.0 + a * a) * x[2]);
      const double rho = std::hypot(x[0], x[1]);
      const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
      s.Vertices.row(i) << (rho > 0.0 ? r / rho : 0.0) * x[0], (rho > 0.0 ? r / rho : 0.0) * x[1], z;
    }
  }
  return s;
}

inline Values Sampled(const SphereData& data, const TriangleMesh& mesh, const Surface& s)
{
  Values f(mesh.NumberOfVertices(), data.Channels);
  for (Index i = 0; i < f.rows(); ++i)
  {
    const Index vertex = mesh.InputVertex()[i];
    for (Eigen::Index k = 0; k < data.Channels; ++k)
    {
      const double a = UniformRandom(1, k, vertex);
      const double b = UniformRandom(2, k, vertex);
      f(i, k) = data.Clean(s.Vertices.row(vertex), k) +
        data.Noise * std::sqrt(-2.0 * std::log(1.0 - a)) * std::cos(2.0 * Pi * b);
      if (UniformRandom(3, k, vertex) < data.Outliers)
      {
        f(i, k) = 10.0 * UniformRandom(4, k, vertex) - 5.0;
      }
    }
  }
  return f;
}

} // namespace SurfaceDiffusion::Testing
