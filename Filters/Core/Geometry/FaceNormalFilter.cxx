// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/FaceNormalFilter.h"

namespace SurfaceDiffusion
{

namespace
{

/// The width of the guide, relative to that of the filter.
constexpr double GuideWidth = 0.5;
/// The mean distance to the triangles of a ring over that to the neighbours across edges.
constexpr double RingDistance = 1.5;

Eigen::RowVector3d Direction(const Eigen::RowVector3d& vector, const Eigen::RowVector3d& otherwise)
{
  const double length = vector.norm();
  return length > 0.0 ? Eigen::RowVector3d(vector / length) : otherwise;
}

/// Per triangle, the standard deviation of the spatial weight for Width = 1.
Vector MeasureWidths(
  const FaceGraph& graph, const FaceGeometry& geometry, const ParallelFor& parallel)
{
  Vector widths(graph.NumberOfFaces());
  ForEach(parallel, graph.NumberOfFaces(),
    [&](Index f)
    {
      double sum = 0.0;
      const Offset begin = graph.Ring.Begin[f];
      const Offset end = graph.Ring.Begin[f + 1];
      for (Offset k = begin; k < end; ++k)
      {
        sum += (geometry.Centroids.row(graph.Ring.Entries[k]) - geometry.Centroids.row(f)).norm();
      }
      widths[f] = end > begin ? sum / (RingDistance * static_cast<double>(end - begin)) : 0.0;
    });
  return widths;
}

} // namespace

Points MakeGuide(const FaceGraph& graph, const FaceGeometry& geometry,
  const NormalFilterSettings& settings, const ParallelFor& parallel)
{
  Points guide(graph.NumberOfFaces(), 3);
  const Vector widths = MeasureWidths(graph, geometry, parallel);
  ForEach(parallel, graph.NumberOfFaces(),
    [&](Index f)
    {
      const double width = GuideWidth * settings.Width * widths[f];
      Eigen::RowVector3d sum = geometry.Areas[f] * geometry.Normals.row(f);
      for (Offset k = graph.Ring.Begin[f]; k < graph.Ring.Begin[f + 1]; ++k)
      {
        const Index g = graph.Ring.Entries[k];
        const double distance =
          (geometry.Centroids.row(g) - geometry.Centroids.row(f)).squaredNorm();
        sum +=
          geometry.Areas[g] * FallOff(distance / (2.0 * width * width)) * geometry.Normals.row(g);
      }
      guide.row(f) = Direction(sum, geometry.Normals.row(f));
    });
  return guide;
}

Vector NeighbourWeights(const FaceGraph& graph, const FaceGeometry& geometry, const Points& guide,
  const NormalFilterSettings& settings, const ParallelFor& parallel)
{
  Vector weights(static_cast<Offset>(graph.Ring.Entries.size()));
  const Vector widths = settings.Width * MeasureWidths(graph, geometry, parallel);
  const double range = 0.5 / (settings.Range * settings.Range);
  ForEach(parallel, graph.NumberOfFaces(),
    [&](Index f)
    {
      for (Offset k = graph.Ring.Begin[f]; k < graph.Ring.Begin[f + 1]; ++k)
      {
        const Index g = graph.Ring.Entries[k];
        const double distance =
          (geometry.Centroids.row(g) - geometry.Centroids.row(f)).squaredNorm();
        const double difference = (guide.row(g) - guide.row(f)).squaredNorm();
        weights[k] = FallOff(0.5 * distance / (widths[f] * widths[g]) + range * difference);
      }
    });
  return weights;
}

Points FilterNormals(const FaceGraph& graph, const FaceGeometry& geometry, const Points& guide,
  const NormalFilterSettings& settings, const ParallelFor& parallel)
{
  const Vector weights = NeighbourWeights(graph, geometry, guide, settings, parallel);
  Points normals(graph.NumberOfFaces(), 3);
  ForEach(parallel, graph.NumberOfFaces(),
    [&](Index f)
    {
      Eigen::RowVector3d sum = geometry.Areas[f] * geometry.Normals.row(f);
      for (Offset k = graph.Ring.Begin[f]; k < graph.Ring.Begin[f + 1]; ++k)
      {
        const Index g = graph.Ring.Entries[k];
        sum += weights[k] * geometry.Areas[g] * geometry.Normals.row(g);
      }
      normals.row(f) = Direction(sum, geometry.Normals.row(f));
    });
  return normals;
}

} // namespace SurfaceDiffusion
