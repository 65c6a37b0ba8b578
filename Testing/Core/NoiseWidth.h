// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Random.h"
#include "Meshes.h"

#include <cmath>

namespace SurfaceDiffusion::Testing
{

/// A sphere whose vertices are displaced along it by up to `share` of their mean distance.
inline Surface JitteredSphere(int subdivisions, double share)
{
  Surface s = Icosphere(subdivisions);
  const double h =
    MakeAssembler(s)->Mesh().MeanEdgeLength() * MakeAssembler(s)->Mesh().LengthUnit();
  for (Eigen::Index i = 0; i < s.Vertices.rows(); ++i)
  {
    for (int a = 0; a < 3; ++a)
    {
      s.Vertices(i, a) += share * h * (2.0 * UniformRandom(5, a, i) - 1.0);
    }
    s.Vertices.row(i).normalize();
  }
  return s;
}

/// White noise of the variance 1/A_i.
inline Values WhiteNoise(const TriangleMesh& mesh, Index columns)
{
  Values noise(mesh.NumberOfVertices(), columns);
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    for (Index k = 0; k < columns; ++k)
    {
      double sum = -6.0; // of twelve uniform numbers: nearly normal, of the variance 1
      for (int n = 0; n < 12; ++n)
      {
        sum += UniformRandom(k, n, i);
      }
      noise(i, k) = sum / std::sqrt(mesh.ControlAreas()[i]);
    }
  }
  return noise;
}

/// The full width at half maximum, in the unit of the mesh, of the kernel after which white noise has
/// the correlation of neighbours that u has: exp(-2 ln 2 d^2/width^2) at the distance d.
inline double WidthOfNoise(const TriangleMesh& mesh, const Values& u)
{
  double products = 0.0;
  Vector squares(3 * mesh.NumberOfTriangles());
  Vector variances(squares.size());
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    for (int a = 0; a < 3; ++a)
    {
      const auto v = u.row(mesh.TriangleVertices()(t, (a + 1) % 3));
      const auto w = u.row(mesh.TriangleVertices()(t, (a + 2) % 3));
      squares[3 * t + a] = std::pow(mesh.Shapes()[t].EdgeLength(a), 2);
      const double weight = mesh.Shapes()[t].Area() / squares[3 * t + a];
      products += weight * v.dot(w);
      variances[3 * t + a] = 0.5 * weight * (v.squaredNorm() + w.squaredNorm());
    }
  }
  double low = 0.0;
  double high = 1e3 * mesh.MeanEdgeLength();
  while (high - low > 1e-9 * high)
  {
    const double middle = 0.5 * (low + high);
    const double rate = 2.0 * std::log(2.0) / (middle * middle);
    const double expected = (variances.array() * (-rate * squares.array()).exp()).sum();
    (expected > products ? high : low) = middle;
  }
  return high;
}

} // namespace SurfaceDiffusion::Testing
