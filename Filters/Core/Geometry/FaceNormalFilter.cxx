// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/FaceNormalFilter.h"

namespace SurfaceDiffusion
{

namespace
{

/// The width of the guide, relative to that of the filter.
constexpr double GuideWidth = 0.5;

Eigen::RowVector3d Direction(const Eigen::RowVector3d& vector, const Eigen::RowVector3d& otherwise)
{
  const double length = vector.norm();
  return length > 0.0 ? Eigen::RowVector3d(vector / length) : otherwise;
}

} // namespace

Points MakeGuide(const FaceGraph& graph, const FaceGeometry& geometry,
  const NormalFilterSettings& settings, const ParallelFor& parallel)
{
  Points guide(graph.NumberOfFaces(), 3);
  ForEach(parallel, graph.NumberOfFaces(),
    [&](Index f)
    {
      const double width = GuideWidth * settings.Width * geometry.Widths[f];
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

NeighbourWeights::NeighbourWeights(const FaceGraph& graph, const FaceGeometry& geometry,
  const Points& guide, const NormalFilterSettings& settings)
  : Graph(graph)
  , Geometry(geometry)
  , Guide(guide)
  , DistanceFactor(0.5 / (settings.Width * settings.Width))
  , RangeFactor(0.5 / (settings.Range * settings.Range))
{
}

void NeighbourWeights::Find(Index f, std::vector<double>& weights) const
{
  const Index* const ring = this->Graph.Ring.Entries.data() + this->Graph.Ring.Begin[f];
  weights.resize(
    static_cast<std::size_t>(this->Graph.Ring.Begin[f + 1] - this->Graph.Ring.Begin[f]));
  for (std::size_t k = 0; k < weights.size(); ++k)
  {
    const Index g = ring[k];
    const double distance =
      (this->Geometry.Centroids.row(g) - this->Geometry.Centroids.row(f)).squaredNorm();
    const double widths = this->Geometry.Widths[f] * this->Geometry.Widths[g];
    const double difference = (this->Guide.row(g) - this->Guide.row(f)).squaredNorm();
    weights[k] = FallOff(this->DistanceFactor * distance / widths + this->RangeFactor * difference);
  }
}

Points FilterNormals(const FaceGraph& graph, const FaceGeometry& geometry, const Points& guide,
  const NormalFilterSettings& settings, const ParallelFor& parallel)
{
  const NeighbourWeights neighbours(graph, geometry, guide, settings);
  Points normals(graph.NumberOfFaces(), 3);
  ForEachBlock(parallel, graph.NumberOfFaces(),
    [&](Index, Index begin, Index end)
    {
      std::vector<double> weights;
      for (Index f = begin; f < end; ++f)
      {
        neighbours.Find(f, weights);
        Eigen::RowVector3d sum = geometry.Areas[f] * geometry.Normals.row(f);
        const Index* g = graph.Ring.Entries.data() + graph.Ring.Begin[f];
        for (const double weight : weights)
        {
          sum += weight * geometry.Areas[*g] * geometry.Normals.row(*g);
          ++g;
        }
        normals.row(f) = Direction(sum, geometry.Normals.row(f));
      }
    });
  return normals;
}

} // namespace SurfaceDiffusion
