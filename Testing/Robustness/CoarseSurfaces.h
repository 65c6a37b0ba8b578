// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BadMeshes.h"
#include "Hubs.h"

#include <fstream>
#include <limits>
#include <string>
#include <vector>

/// Coarse and odd surfaces, as people bring them: what a mean edge, a range or a fit says of fine and
/// even meshes, it does not say of these. Those that are small stand in a file, which the tests in Python
/// read, too; those with many parts are made here.
namespace SurfaceDiffusion::Testing
{

/// The surfaces of Testing/Surfaces/coarse.txt.
inline std::vector<NamedSurface> SmallCoarseSurfaces()
{
  std::vector<NamedSurface> surfaces;
  std::ifstream file(SURFACEDIFFUSION_COARSE_SURFACES);
  std::string name;
  while (file >> name)
  {
    if (name[0] == '#')
    {
      file.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
      continue;
    }
    Index points = 0;
    Index triangles = 0;
    file >> points >> triangles;
    Surface s{ Points(points, 3), Triangles(triangles, 3) };
    for (Index i = 0; i < points; ++i)
    {
      file >> s.Vertices(i, 0) >> s.Vertices(i, 1) >> s.Vertices(i, 2);
    }
    for (Index t = 0; t < triangles; ++t)
    {
      file >> s.Faces(t, 0) >> s.Faces(t, 1) >> s.Faces(t, 2);
    }
    surfaces.push_back({ name, s });
  }
  return surfaces;
}

/// `count` copies side by side, each `growth` times as large as the one before.
inline Surface Row(const Surface& part, Index count, double growth = 1.0)
{
  const Index n = part.NumberOfVertices();
  const Index m = part.NumberOfTriangles();
  Surface row{ Points(n * count, 3), Triangles(m * count, 3) };
  double size = 1.0;
  double place = 0.0;
  for (Index k = 0; k < count; ++k, size *= growth)
  {
    row.Vertices.middleRows(k * n, n) = size * part.Vertices;
    row.Vertices.middleRows(k * n, n).col(0).array() += place;
    row.Faces.middleRows(k * m, m) = (part.Faces.array() + k * n).matrix();
    place += 3.0 * size * (1.0 + growth);
  }
  return row;
}

inline std::vector<NamedSurface> CoarseSurfaces()
{
  std::vector<NamedSurface> surfaces = SmallCoarseSurfaces();
  surfaces.push_back({ "ManyParts", Row(Icosphere(0), 300) });
  surfaces.push_back({ "PartsOfManySizes", Row(Icosphere(1), 4, 10.0) });
  surfaces.push_back({ "Fan", TrianglesAtAVertex(300) });
  surfaces.push_back({ "Book", TrianglesAtAnEdge(300) });
  return surfaces;
}

} // namespace SurfaceDiffusion::Testing
