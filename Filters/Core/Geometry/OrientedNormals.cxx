// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/OrientedNormals.h"

#include "Core/Geometry/TriangleOrientation.h"

#include <Eigen/Geometry>

#include <algorithm>

namespace SurfaceDiffusion
{

namespace
{

/// The directions of the sums of the normals around each vertex, with weights of corners.
template <typename Weight>
Points SumsAtVertices(const TriangleMesh& mesh, const OrientedNormals& normals,
  const ParallelFor& parallel, const Weight& weight)
{
  Points sums(mesh.NumberOfVertices(), 3);
  ForEach(parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
      for (Index c = mesh.VertexCornersBegin()[i]; c < mesh.VertexCornersBegin()[i + 1]; ++c)
      {
        const Index corner = mesh.VertexCorners()[c];
        sum += normals.SideOf(corner) * weight(corner) * normals.OfTriangles.row(corner / 3);
      }
      sums.row(i) = sum.stableNormalized();
    });
  return sums;
}

/// The sides of the corners around vertex i: from triangle to triangle across the edges that two of
/// them share, so that the larger part of the area keeps its orientation. oriented: the triangles.
void FindSidesAround(
  const TriangleMesh& mesh, Index i, const Triangles& oriented, std::vector<signed char>& sides)
{
  const Index begin = mesh.VertexCornersBegin()[i];
  const Index count = mesh.VertexCornersBegin()[i + 1] - begin;
  const auto cornerAt = [&](Index k) { return mesh.VertexCorners()[begin + k]; };
  /// The vertex 1 or 2 corners after this one in the oriented triangle.
  const auto other = [&](Index k, int step)
  {
    const auto corners = oriented.row(cornerAt(k) / 3);
    const int own = corners[0] == i ? 0 : corners[1] == i ? 1 : 2;
    return corners[(own + step) % 3];
  };
  std::vector<signed char> found(static_cast<std::size_t>(count), 0);
  std::vector<Index> fan;
  double area = 0.0; // that keeps its orientation, less that of the others
  for (Index first = 0; first < count; ++first)
  {
    if (found[first] != 0)
    {
      continue;
    }
    found[first] = 1;
    fan.assign(1, first);
    for (std::size_t next = 0; next < fan.size(); ++next)
    {
      const Index k = fan[next];
      area += found[k] * mesh.Shapes()[cornerAt(k) / 3].Area();
      for (const int step : { 1, 2 })
      {
        Index across = -1;
        int acrossStep = 0;
        int sharing = 0;
        for (Index l = 0; l < count; ++l)
        {
          for (const int otherStep : { 1, 2 })
          {
            if (l != k && other(l, otherStep) == other(k, step))
            {
              across = l;
              acrossStep = otherStep;
              ++sharing;
            }
          }
        }
        if (sharing == 1 && found[across] == 0)
        {
          found[across] = acrossStep == step ? static_cast<signed char>(-found[k]) : found[k];
          fan.push_back(across);
        }
      }
    }
  }
  for (Index k = 0; k < count; ++k)
  {
    sides[cornerAt(k)] = area < 0.0 ? static_cast<signed char>(-found[k]) : found[k];
  }
}

} // namespace

OrientedNormals FindOrientedNormals(
  const TriangleMesh& mesh, const Points& positions, const ParallelFor& parallel)
{
  const Triangles& drawn = mesh.TriangleVertices();
  Triangles oriented = drawn;
  std::vector<char> onOneSide;
  OrientTriangles(positions, oriented, &onOneSide);
  OrientedNormals normals;
  normals.OfTriangles.resize(drawn.rows(), 3);
  ForEach(parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      const auto corner = [&](int a) { return Eigen::RowVector3d(positions.row(oriented(t, a))); };
      const Eigen::RowVector3d a = corner(1) - corner(0);
      const Eigen::RowVector3d b = corner(2) - corner(0);
      normals.OfTriangles.row(t) = a.cross(b).stableNormalized();
    });
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    normals.TurnedTriangles +=
      drawn(t, 1) != oriented(t, 1) && HasOrientation(positions, drawn, t) ? 1 : 0;
  }
  if (!onOneSide.empty())
  {
    normals.SidesOfCorners.assign(static_cast<std::size_t>(drawn.size()), 1);
    normals.OnOneSide.assign(static_cast<std::size_t>(mesh.NumberOfVertices()), 0);
    for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
    {
      for (int a = 0; a < 3 && onOneSide[t]; ++a)
      {
        normals.OnOneSide[drawn(t, a)] = 1;
      }
    }
    ForEach(parallel, mesh.NumberOfVertices(),
      [&](Index i)
      {
        if (normals.OnOneSide[i])
        {
          FindSidesAround(mesh, i, oriented, normals.SidesOfCorners);
        }
      });
  }
  normals.OfVertices = SumsAtVertices(
    mesh, normals, parallel, [&](Index corner) { return mesh.Shapes()[corner / 3].Area(); });
  return normals;
}

Points SphericalNormals(
  const TriangleMesh& mesh, const OrientedNormals& normals, const ParallelFor& parallel)
{
  return SumsAtVertices(mesh, normals, parallel,
    [&](Index corner)
    {
      const TriangleMesh::Shape shape = mesh.Shapes()[corner / 3];
      const double e = shape.EdgeLength((corner + 1) % 3);
      const double f = shape.EdgeLength((corner + 2) % 3);
      constexpr double largest = 1e200; // sums stay finite
      return std::min(largest, shape.Area() / (e * e) / (f * f));
    });
}

} // namespace SurfaceDiffusion
