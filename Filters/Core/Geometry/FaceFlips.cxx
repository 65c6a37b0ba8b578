// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/FaceFlips.h"

#include "Core/Foundation/IndexLists.h"
#include "Core/Foundation/Quantile.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

constexpr int MaximumNumberOfSweeps = 20;
constexpr int NumberOfSteps = 4;
/// t of TurnFlippedFaces().
constexpr double Smoothness = 0.05;
/// The least length of edges at a vertex that moves, as a share of that in the mesh.
constexpr double LeastLength = 1e-3;

/// Twice the area of the triangle with its vertex `vertex` at `place`, as seen along its normal.
double Seen(const TriangleMesh& mesh, const Points& normals, const Points& points, Index corner,
  const Eigen::RowVector3d& place)
{
  const Eigen::RowVector3d a = points.row(mesh.OtherCorner(corner, 1)) - place;
  const Eigen::RowVector3d b = points.row(mesh.OtherCorner(corner, 2)) - place;
  return a.cross(b).dot(normals.row(corner / 3));
}

struct Star
{
  double Least; ///< seen area
  Index Flipped;
};

Star MeasureStar(const TriangleMesh& mesh, const Points& normals, const Points& points,
  Index vertex, const Eigen::RowVector3d& place)
{
  Star star{ 1e300, 0 };
  for (Index k = mesh.VertexCornersBegin()[vertex]; k < mesh.VertexCornersBegin()[vertex + 1]; ++k)
  {
    const double seen = Seen(mesh, normals, points, mesh.VertexCorners()[k], place);
    star.Least = std::min(star.Least, seen);
    star.Flipped += seen < 0.0;
  }
  return star;
}

/// The minimum of the function of TurnFlippedFaces().
Eigen::RowVector3d BestPlace(
  const TriangleMesh& mesh, const Points& normals, const Points& points, Index vertex)
{
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::RowVector3d right = Eigen::RowVector3d::Zero();
  Eigen::RowVector3d middle = Eigen::RowVector3d::Zero();
  const Index begin = mesh.VertexCornersBegin()[vertex];
  const Index end = mesh.VertexCornersBegin()[vertex + 1];
  const Eigen::RowVector3d own = points.row(vertex);
  for (Index k = begin; k < end; ++k)
  {
    const Index corner = mesh.VertexCorners()[k];
    const Eigen::RowVector3d n = normals.row(corner / 3);
    const Eigen::RowVector3d others =
      points.row(mesh.OtherCorner(corner, 1)) + points.row(mesh.OtherCorner(corner, 2)) - 2.0 * own;
    matrix += 2.0 / 3.0 * n.transpose() * n;
    right += n.dot(others) / 3.0 * n;
    middle += others / (2.0 * (end - begin));
  }
  matrix += Smoothness * Eigen::Matrix3d::Identity();
  right += Smoothness * middle;
  return own + matrix.ldlt().solve(right.transpose()).transpose();
}

/// The median length of the edges at a vertex, with the vertex at `place`.
double TypicalEdge(
  const TriangleMesh& mesh, const Points& points, Index vertex, const Eigen::RowVector3d& place)
{
  std::vector<double> lengths;
  for (Index k = mesh.VertexCornersBegin()[vertex]; k < mesh.VertexCornersBegin()[vertex + 1]; ++k)
  {
    for (const int step : { 1, 2 })
    {
      const Index other = mesh.OtherCorner(mesh.VertexCorners()[k], step);
      lengths.push_back((points.row(other) - place).norm());
    }
  }
  return QuantileOf(lengths, 0.5);
}

/// The same in the mesh itself.
double TypicalEdgeOfMesh(const TriangleMesh& mesh, Index vertex)
{
  std::vector<double> lengths;
  for (Index k = mesh.VertexCornersBegin()[vertex]; k < mesh.VertexCornersBegin()[vertex + 1]; ++k)
  {
    const Index corner = mesh.VertexCorners()[k];
    for (const int step : { 1, 2 })
    {
      lengths.push_back(mesh.Shapes()[corner / 3].EdgeLength((corner + step) % 3));
    }
  }
  return QuantileOf(lengths, 0.5);
}

/// Whether a step was found.
bool MoveVertex(const TriangleMesh& mesh, const Points& normals, Points& points, Index vertex)
{
  const Eigen::RowVector3d own = points.row(vertex);
  const Star before = MeasureStar(mesh, normals, points, vertex, own);
  if (before.Flipped == 0)
  {
    return false;
  }
  Eigen::RowVector3d step = BestPlace(mesh, normals, points, vertex) - own;
  step *= std::min(1.0, TypicalEdge(mesh, points, vertex, own) / step.norm());
  const double least = LeastLength * TypicalEdgeOfMesh(mesh, vertex);
  for (int k = 0; k < NumberOfSteps; ++k, step *= 0.5)
  {
    const Star after = MeasureStar(mesh, normals, points, vertex, own + step);
    if (after.Least > before.Least && after.Flipped <= before.Flipped &&
      TypicalEdge(mesh, points, vertex, own + step) >= least)
    {
      points.row(vertex) = own + step;
      return true;
    }
  }
  return false;
}

bool IsFlipped(const TriangleMesh& mesh, const Points& normals, const Points& points, Index t)
{
  return Seen(mesh, normals, points, 3 * t, points.row(mesh.TriangleVertices()(t, 0))) < 0.0;
}

std::vector<Index> VerticesOfFlippedFaces(const TriangleMesh& mesh, const Points& normals,
  const Points& points, const ParallelFor& parallel)
{
  IndexLists lists = MakeLists(mesh.NumberOfTriangles(), parallel,
    [&](Index t, std::vector<Index>& vertices)
    {
      for (int a = 0; a < 3 && IsFlipped(mesh, normals, points, t); ++a)
      {
        vertices.push_back(mesh.TriangleVertices()(t, a));
      }
    });
  SortUnique(lists.Entries, 0);
  return std::move(lists.Entries);
}

} // namespace

Index CountFlippedFaces(const TriangleMesh& mesh, const Points& normals, const Points& points)
{
  Index count = 0;
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    count += IsFlipped(mesh, normals, points, t);
  }
  return count;
}

void TurnFlippedFaces(const TriangleMesh& mesh, const Points& normals,
  const std::vector<char>& fixed, Points& points, const ParallelFor& parallel)
{
  bool changed = true;
  for (int sweep = 0; sweep < MaximumNumberOfSweeps && changed; ++sweep)
  {
    const std::vector<Index> vertices = VerticesOfFlippedFaces(mesh, normals, points, parallel);
    changed = false;
    for (const Index vertex : vertices)
    {
      if (fixed.empty() || !fixed[vertex])
      {
        changed = MoveVertex(mesh, normals, points, vertex) || changed;
      }
    }
  }
}

} // namespace SurfaceDiffusion
