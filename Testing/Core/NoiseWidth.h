// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Random.h"
#include "Core/Statistics/NoiseWidth.h"
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

/// In the unit of the mesh.
inline double WidthOfNoise(const TriangleMesh& mesh, const Values& u)
{
  NoiseWidth widths(mesh, false);
  widths.Add(u);
  return widths.OfAll();
}

} // namespace SurfaceDiffusion::Testing
