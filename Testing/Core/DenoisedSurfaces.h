// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geometry/SurfaceDenoising.h"
#include "Meshes.h"
#include "NoisySurfaces.h"

#include <cmath>
#include <vector>

namespace SurfaceDiffusion::Testing
{

/// In units of the surface.
inline double MeanEdgeLength(const TriangleMesh& mesh)
{
  return MeanEdge(mesh) * mesh.LengthUnit();
}
inline double MeanEdgeLength(const Surface& surface)
{
  return MeanEdgeLength(TriangleMesh(surface.Vertices, surface.Faces));
}

inline Surface Denoised(const Surface& s, const DenoisingSettings& settings = DenoisingSettings(),
  const std::vector<char>& fixedPoints = {}, DenoisingReport* report = nullptr,
  const ParallelFor& parallel = SerialFor())
{
  const TriangleMesh mesh(s.Vertices, s.Faces);
  const Points points = GatherVertices(mesh, s.Vertices) / mesh.LengthUnit();
  std::vector<char> fixed;
  for (const Index i : mesh.InputVertex())
  {
    fixed.push_back(fixedPoints.empty() ? 0 : fixedPoints[i]);
  }
  DenoisingSettings scaled = settings;
  scaled.NoiseLevel /= mesh.LengthUnit();
  scaled.DisplacementLimit /= mesh.LengthUnit();
  std::vector<Index> vertexOf(static_cast<std::size_t>(s.NumberOfVertices()), -1);
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    vertexOf[mesh.InputVertex()[i]] = i;
  }
  for (auto& [i, j] : scaled.Creases)
  {
    i = vertexOf[i];
    j = vertexOf[j];
  }
  const Points moved = DenoiseSurface(mesh, points, fixed, scaled, report, parallel);
  Surface result = s;
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    result.Vertices.row(mesh.InputVertex()[i]) = moved.row(i) * mesh.LengthUnit();
  }
  return result;
}

inline double LargestDistance(const Surface& a, const Surface& b)
{
  return (a.Vertices - b.Vertices).rowwise().norm().maxCoeff();
}

/// Gaussian noise along the normals with the covariance exp(-d^2 / (2 L^2)), L in mean edge lengths:
/// white noise after steps of heat flow, each of the variance 1/8 h^2 per axis, to L^2 / 2.
inline Surface WithCorrelatedNoise(Surface s, double amount, double length)
{
  const Surface white = NoisyAlongNormals(s, 1.0);
  const TriangleMesh mesh(s.Vertices, s.Faces);
  const double h = MeanEdgeLength(mesh);
  Points offsets = white.Vertices - s.Vertices;
  for (int step = 0; step < std::lround(4.0 * length * length); ++step)
  {
    // Each neighbour is seen twice. The mean square of its distance along an axis is h^2 / 2.
    Points sums = Points::Zero(offsets.rows(), 3);
    Vector counts = Vector::Zero(offsets.rows());
    for (Index t = 0; t < s.NumberOfTriangles(); ++t)
    {
      for (int a = 0; a < 3; ++a)
      {
        sums.row(s.Faces(t, a)) +=
          offsets.row(s.Faces(t, (a + 1) % 3)) + offsets.row(s.Faces(t, (a + 2) % 3));
        counts[s.Faces(t, a)] += 2.0;
      }
    }
    for (Index i = 0; i < s.NumberOfVertices(); ++i)
    {
      offsets.row(i) = 0.75 * offsets.row(i) + 0.25 / counts[i] * sums.row(i);
    }
  }
  const double level = std::sqrt(offsets.squaredNorm() / static_cast<double>(offsets.rows()));
  s.Vertices += amount * h / level * offsets;
  return s;
}

} // namespace SurfaceDiffusion::Testing
