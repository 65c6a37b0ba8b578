// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/OrientedNormals.h"

#include "Core/Geometry/TriangleOrientation.h"

#include <Eigen/Geometry>

namespace SurfaceDiffusion
{

OrientedNormals FindOrientedNormals(
  const TriangleMesh& mesh, const Points& positions, const ParallelFor& parallel)
{
  const Triangles& drawn = mesh.TriangleVertices();
  Triangles oriented = drawn;
  OrientTriangles(positions, oriented);
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
  normals.OfVertices.resize(mesh.NumberOfVertices(), 3);
  ForEach(parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
      for (Index c = mesh.VertexCornersBegin()[i]; c < mesh.VertexCornersBegin()[i + 1]; ++c)
      {
        const Index t = mesh.VertexCorners()[c] / 3;
        sum += mesh.Shapes()[t].Area() * normals.OfTriangles.row(t);
      }
      normals.OfVertices.row(i) = sum.stableNormalized();
    });
  return normals;
}

} // namespace SurfaceDiffusion
