// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/TotalVariation/PenaltyRanges.h"

#include "Core/Statistics/ValueRange.h"

#include <algorithm>

namespace SurfaceDiffusion
{

namespace
{

/// The first penalty of an energy with mu > 0, which then grows, is best a sixth of that which
/// stays: measured on steps and steady states of caps and patterns with and without noise.
constexpr double StartOfGrowth = 6.0;

} // namespace

Vector RangesOfTriangles(const TriangleMesh& mesh, const Eigen::Ref<const Values>& u,
  const Values& quadratic, const ParallelFor& parallel)
{
  const Reduction& reduction = mesh.GetReduction();
  const bool grows = reduction.Any((quadratic.array() > 0.0).any());
  const double typical = (grows ? StartOfGrowth : 1.0) * TypicalRange(u, reduction);
  Vector ranges(mesh.NumberOfTriangles());
  ForEach(parallel, mesh.NumberOfTriangles(),
    [&](Index t) { ranges[t] = std::max(typical, RangeOnTriangle(mesh, u, t)); });
  return ranges;
}

Vector RangesOfVertices(
  const TriangleMesh& mesh, const Vector& ofTriangles, const ParallelFor& parallel)
{
  Vector storage;
  const Vector& areas = mesh.GetReduction().Accumulated(mesh.ControlAreas(), storage);
  Vector ranges(mesh.NumberOfVertices());
  ForEach(parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      ranges[i] = 0.0;
      for (Index c = mesh.VertexCornersBegin()[i]; c < mesh.VertexCornersBegin()[i + 1]; ++c)
      {
        const Index t = mesh.VertexCorners()[c] / 3;
        ranges[i] += mesh.Shapes()[t].Area() / 3.0 * ofTriangles[t];
      }
    });
  mesh.GetReduction().Accumulate(ranges);
  return ranges.cwiseQuotient(areas);
}

Vector SquaredWidths(const TriangleMesh& mesh, const ParallelFor& parallel)
{
  // Of the area over the longest edge; an even cell is half as wide as this.
  constexpr double most = 3.0;
  Vector lengths(mesh.NumberOfTriangles());
  ForEach(parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      const TriangleMesh::Shape shape = mesh.Shapes()[t];
      const double length =
        std::max({ shape.EdgeLength(0), shape.EdgeLength(1), shape.EdgeLength(2) });
      lengths[t] = length * length;
    });
  const Vector squares = RangesOfVertices(mesh, lengths, parallel);
  Vector storage;
  const Vector& areas = mesh.GetReduction().Accumulated(mesh.ControlAreas(), storage);
  return areas.array().min(most * most * areas.array().square() / squares.array());
}

} // namespace SurfaceDiffusion
