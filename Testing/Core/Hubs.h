// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Meshes.h"

/// Surfaces with one vertex or edge of all triangles, as cones and disks of CAD have them: what looks at
/// pairs of neighbours takes the square of their number there.
namespace SurfaceDiffusion::Testing
{

/// A regular polygon, cut from its middle.
inline Surface TrianglesAtAVertex(Index count)
{
  Surface s{ Points(count + 1, 3), Triangles(count, 3) };
  s.Vertices.row(0).setZero();
  for (Index k = 0; k < count; ++k)
  {
    const double angle = 2.0 * Pi * k / count;
    s.Vertices.row(k + 1) << std::cos(angle), std::sin(angle), 0.0;
    s.Faces.row(k) << 0, k + 1, (k + 1) % count + 1;
  }
  return s;
}

/// The pages of a book, of height 1 over an edge of length 1.
inline Surface TrianglesAtAnEdge(Index count)
{
  Surface s{ Points(count + 2, 3), Triangles(count, 3) };
  s.Vertices.topRows(2) << 0.0, 0.0, 0.0, 0.0, 0.0, 1.0;
  for (Index k = 0; k < count; ++k)
  {
    const double angle = 2.0 * Pi * k / count;
    s.Vertices.row(k + 2) << std::cos(angle), std::sin(angle), 0.5;
    s.Faces.row(k) << 0, 1, k + 2;
  }
  return s;
}

} // namespace SurfaceDiffusion::Testing
