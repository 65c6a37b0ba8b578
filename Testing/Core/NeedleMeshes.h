// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Meshes.h"

#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

/// Surfaces with long and narrow triangles, as mesh generators and visualisation programs make
/// them.
namespace SurfaceDiffusion::Testing
{

/// The unit sphere with meridians and parallels, as vtkSphereSource makes it: around the poles,
/// triangles are (meridians / 2 pi) times longer than wide.
inline Surface LatitudeLongitudeSphere(Index meridians, Index parallels)
{
  std::vector<Eigen::RowVector3d> vertices = { { 0, 0, 1 }, { 0, 0, -1 } };
  std::vector<std::array<Index, 3>> faces;
  const auto at = [&](Index row, Index i) { return 2 + row * meridians + i % meridians; };
  for (Index row = 0; row < parallels; ++row)
  {
    const double theta = Pi * (row + 1) / (parallels + 1);
    for (Index i = 0; i < meridians; ++i)
    {
      const double phi = 2.0 * Pi * i / meridians;
      vertices.emplace_back(
        std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      if (row > 0)
      {
        faces.push_back({ at(row - 1, i), at(row, i), at(row - 1, i + 1) });
        faces.push_back({ at(row - 1, i + 1), at(row, i), at(row, i + 1) });
      }
    }
  }
  for (Index i = 0; i < meridians; ++i)
  {
    faces.push_back({ 0, at(0, i), at(0, i + 1) });
    faces.push_back({ 1, at(parallels - 1, i + 1), at(parallels - 1, i) });
  }
  return MakeSurface(vertices, faces);
}

/// A torus whose first and last points in both directions differ by round-off only, and are joined
/// by triangles 1e14 times longer than wide: vtkParametricFunctionSource of vtkParametricTorus.
inline Surface TorusWithSeam(Index size, double majorRadius = 1.0, double minorRadius = 0.5)
{
  std::vector<Eigen::RowVector3d> vertices;
  std::vector<Index> number;
  for (Index j = 0; j <= size; ++j)
  {
    for (Index i = 0; i <= size; ++i)
    {
      number.push_back((j % size) * size + i % size);
      if (i < size && j < size)
      {
        const double p = 2.0 * Pi * i / (size - 1), q = 2.0 * Pi * j / (size - 1);
        const double r = majorRadius + minorRadius * std::cos(q);
        vertices.emplace_back(r * std::cos(p), r * std::sin(p), minorRadius * std::sin(q));
      }
    }
  }
  auto faces = GridFaces(size, size);
  Renumber(faces, number);
  return MakeSurface(vertices, faces);
}

/// A closed cylinder of length 2 and radius 1 whose caps are fans around their centres.
inline Surface CylinderWithFans(Index around, Index along)
{
  Surface s = Moved(Cylinder(around, along), { 0.0, 0.0, -1.0 });
  const Index bottom = s.NumberOfVertices(), side = s.NumberOfTriangles();
  s.Vertices.conservativeResize(bottom + 2, 3);
  s.Vertices.bottomRows(2) << 0.0, 0.0, -1.0, 0.0, 0.0, 1.0;
  s.Faces.conservativeResize(side + 2 * around, 3);
  for (Index i = 0; i < around; ++i)
  {
    const Index next = (i + 1) % around;
    s.Faces.row(side + 2 * i) << bottom, next, i;
    s.Faces.row(side + 2 * i + 1) << bottom + 1, along * around + i, along * around + next;
  }
  return s;
}

/// The unit sphere as the contour of its distance function, linear on the tetrahedra of a grid of
/// cells^3 cubes: slivers where it passes close to points of the grid.
inline Surface ContourOfGrid(Index cells)
{
  const double size = 2.5 / cells;
  const auto position = [&](Index p)
  {
    const Index k = p / ((cells + 1) * (cells + 1)), j = p / (cells + 1) % (cells + 1);
    return Eigen::RowVector3d(-1.25 + size * (p % (cells + 1)), -1.25 + size * j, -1.25 + size * k);
  };
  std::vector<Eigen::RowVector3d> vertices;
  std::vector<std::array<Index, 3>> faces;
  std::map<std::pair<Index, Index>, Index> number; // of the vertex on an edge
  const auto cut = [&](Index p, Index q)
  {
    const auto inserted = number.emplace(std::minmax(p, q), static_cast<Index>(vertices.size()));
    if (inserted.second)
    {
      const Eigen::RowVector3d a = position(std::min(p, q)), b = position(std::max(p, q));
      const double fa = a.norm() - 1.0, fb = b.norm() - 1.0;
      vertices.push_back(a + fa / (fa - fb) * (b - a));
    }
    return inserted.first->second;
  };
  const auto add = [&](Index a, Index b, Index c)
  {
    const Eigen::RowVector3d normal = (vertices[b] - vertices[a]).cross(vertices[c] - vertices[a]);
    const bool isOutward = normal.dot(vertices[a]) > 0.0;
    faces.push_back({ a, isOutward ? b : c, isOutward ? c : b });
  };
  // Six tetrahedra around the diagonal of each cube
  constexpr int paths[6][2] = { { 1, 3 }, { 1, 5 }, { 2, 3 }, { 2, 6 }, { 4, 5 }, { 4, 6 } };
  for (Index cube = 0; cube < cells * cells * cells; ++cube)
  {
    const Index x = cube % cells, y = cube / cells % cells, z = cube / (cells * cells);
    const auto corner = [&](int bits) {
      return ((z + (bits >> 2)) * (cells + 1) + y + (bits >> 1) % 2) * (cells + 1) + x + bits % 2;
    };
    for (const auto& path : paths)
    {
      std::vector<Index> inside, outside;
      for (const int bits : { 0, path[0], path[1], 7 })
      {
        const Index p = corner(bits);
        (position(p).norm() < 1.0 ? inside : outside).push_back(p);
      }
      const auto& few = inside.size() == 1 ? inside : outside;
      const auto& many = inside.size() == 1 ? outside : inside;
      if (few.size() == 1)
      {
        add(cut(few[0], many[0]), cut(few[0], many[1]), cut(few[0], many[2]));
      }
      else if (few.size() == 2)
      {
        const Index a = cut(few[0], many[0]), b = cut(few[0], many[1]);
        const Index c = cut(few[1], many[0]), d = cut(few[1], many[1]);
        add(a, b, c);
        add(b, d, c);
      }
    }
  }
  return MakeSurface(vertices, faces);
}

} // namespace SurfaceDiffusion::Testing
