// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/TotalVariation/PenaltyRanges.h"

#include "Core/Statistics/ValueRange.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// The first penalty of an energy with mu > 0, which then grows, is best a sixth of that which
/// stays: measured on steps and steady states of caps and patterns with and without noise.
constexpr double StartOfGrowth = 6.0;

/// The penalty on S grad u - p, in units of g at the steepest gradient of one range on the
/// triangle: small triangles and slivers then have no larger share in the equations than others. It
/// shifts work between finding edges and settling values and changes no result. Measured with the
/// factor sqrt(triangles per unknown) on meshes and medial meshes: 14 to 28 is best for noise to a
/// gap of 1e-3, 28 to 50 to 1e-5, the more so the more vertices.
constexpr double PenaltyFactor = 28.0;

/// No penalty suits both directions of a needle. That of the steepest gradient, which is across it,
/// is too small along it, where a multiplier then needs thousands of iterations to become 1. On
/// triangles where the square of this gradient is more than this many times that of the geometric
/// mean of both directions, the penalty is that of the mean. Measured on segmentations of fans of
/// 20,000 triangles: with SquaredWidths() of vertices, a tenth of the iterations.
constexpr double LargestRatio = 16.0;

/// That of the penalty. plain: without S, lest strong directions count as needles. It stands for S where
/// this is 0, in triangles without a direction.
double SquaredTypical(const GradientMap& map, const GradientMap& plain)
{
  const double area = std::abs(plain.First[0] * plain.Second[1] - plain.First[1] * plain.Second[0]);
  const double mean = 2.0 / std::sqrt(3.0) * area; // that of equilateral triangles
  const double ofTriangle = SquaredSteepest(plain);
  const double share = ofTriangle > LargestRatio * mean ? mean / ofTriangle : 1.0;
  const double steepest = SquaredSteepest(map);
  return (steepest > 0.0 ? steepest : ofTriangle) * share;
}

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

double SquaredSteepest(const GradientMap& map)
{
  return std::max({ map.OfCorner(0).squaredNorm(), map.OfCorner(1).squaredNorm(),
    map.OfCorner(2).squaredNorm() });
}

Vector PenaltiesOfTriangles(const TriangleMesh& mesh, const GradientMaps& gradients,
  const EdgeFunction& function, const Vector& ranges, double unknowns, const ParallelFor& parallel)
{
  const double triangles = mesh.GetReduction().Sum(mesh.NumberOfTriangles());
  const double perUnknown = std::sqrt(triangles / unknowns);
  Vector penalties(mesh.NumberOfTriangles());
  ForEach(parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      const TriangleMesh::Shape s = mesh.Shapes()[t];
      const double square = SquaredTypical(gradients[t], PlainGradientMap(s));
      const double g = function(ranges[t] * ranges[t] * square);
      penalties[t] = PenaltyFactor * perUnknown * g * s.Area();
    });
  return penalties;
}

} // namespace SurfaceDiffusion
