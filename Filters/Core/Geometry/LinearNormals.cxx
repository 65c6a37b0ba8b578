// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/LinearNormals.h"

#include <Eigen/Geometry>

#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// Normals with less support are outliers. The flat side of a corner of a cube has about 0.3.
constexpr double LeastSupport = 0.15;
/// e of FitLinearNormals(): gradients across one row of triangles are not determined by the fit.
constexpr double Ridge = 0.05;

double RangeFactor(const NormalFilterSettings& settings)
{
  return 0.5 / (settings.Range * settings.Range);
}

/// The share of the area of the ring that agrees with each normal.
Vector MeasureSupport(const FaceGraph& graph, const FaceGeometry& geometry,
  const NormalFilterSettings& settings, const ParallelFor& parallel)
{
  const double range = RangeFactor(settings);
  Vector support(graph.NumberOfFaces());
  ForEach(parallel, graph.NumberOfFaces(),
    [&](Index f)
    {
      double like = 0.0;
      double all = 0.0;
      for (Offset k = graph.Ring.Begin[f]; k < graph.Ring.Begin[f + 1]; ++k)
      {
        const Index g = graph.Ring.Entries[k];
        const double difference = (geometry.Normals.row(g) - geometry.Normals.row(f)).squaredNorm();
        like += geometry.Areas[g] * FallOff(range * difference);
        all += geometry.Areas[g];
      }
      support[f] = all > 0.0 ? like / all : 1.0;
    });
  return support;
}

/// The normal equations of one fit.
class LinearFit
{
public:
  explicit LinearFit(const Eigen::RowVector3d& normal)
    : First(normal.unitOrthogonal())
    , Second(normal.cross(this->First))
  {
  }

  void Add(const Eigen::RowVector3d& offset, const Eigen::RowVector3d& value, double weight)
  {
    const double x = this->First.dot(offset);
    const double y = this->Second.dot(offset);
    const Eigen::RowVector3d weighted = weight * value;
    this->W += weight;
    this->X += weight * x;
    this->Y += weight * y;
    this->XX += weight * x * x;
    this->XY += weight * x * y;
    this->YY += weight * y * y;
    this->V += weighted;
    this->VX += x * weighted;
    this->VY += y * weighted;
  }

  /// The direction of the value at the offset 0, not normalised: by Cramer's rule without the
  /// determinant, which is not negative.
  Eigen::RowVector3d Solve() const
  {
    const double ridge = Ridge * (this->XX + this->YY);
    if (!(ridge > 0.0))
    {
      return this->V;
    }
    // in the unit of length in which the mean square of the offsets is 1 / Ridge
    const double unit = std::sqrt(ridge / this->W);
    const double x = this->X / unit / this->W;
    const double y = this->Y / unit / this->W;
    const double xx = this->XX / ridge + 1.0;
    const double xy = this->XY / ridge;
    const double yy = this->YY / ridge + 1.0;
    return (xx * yy - xy * xy) * this->V + (y * xy - x * yy) / unit * this->VX +
      (x * xy - y * xx) / unit * this->VY;
  }

private:
  Eigen::RowVector3d First, Second;
  double W = 0.0, X = 0.0, Y = 0.0, XX = 0.0, XY = 0.0, YY = 0.0; ///< sums of the weighted terms
  Eigen::RowVector3d V = Eigen::RowVector3d::Zero();
  Eigen::RowVector3d VX = V, VY = V;
};

} // namespace

Points ReplaceUnsupportedNormals(const FaceGraph& graph, const FaceGeometry& geometry,
  const NormalFilterSettings& settings, const ParallelFor& parallel)
{
  const Vector support = MeasureSupport(graph, geometry, settings, parallel);
  Points guide = geometry.Normals;
  ForEach(parallel, graph.NumberOfFaces(),
    [&](Index f)
    {
      Index best = f;
      for (Offset k = graph.Across.Begin[f]; k < graph.Across.Begin[f + 1]; ++k)
      {
        const Index g = graph.Across.Entries[k];
        best = support[g] > support[best] ? g : best;
      }
      if (support[f] < LeastSupport)
      {
        guide.row(f) = geometry.Normals.row(best);
      }
    });
  return guide;
}

Points FitLinearNormals(const FaceGraph& graph, const FaceGeometry& geometry, const Points& guide,
  const NormalFilterSettings& settings, const ParallelFor& parallel)
{
  const NeighbourWeights neighbours(graph, geometry, guide, settings);
  const double range = RangeFactor(settings);
  Points normals(graph.NumberOfFaces(), 3);
  ForEachBlock(parallel, graph.NumberOfFaces(),
    [&](Index, Index begin, Index end)
    {
      std::vector<double> weights;
      for (Index f = begin; f < end; ++f)
      {
        const Eigen::RowVector3d own = guide.row(f);
        if (own.isZero(0.0))
        {
          normals.row(f) = own;
          continue;
        }
        neighbours.Find(f, weights);
        LinearFit fit(own);
        const auto add = [&](Index g, double weight)
        {
          fit.Add(geometry.Centroids.row(g) - geometry.Centroids.row(f), geometry.Normals.row(g),
            weight * geometry.Areas[g]);
        };
        add(f, FallOff(range * (geometry.Normals.row(f) - own).squaredNorm()));
        const Index* const ring = graph.Ring.Entries.data() + graph.Ring.Begin[f];
        for (std::size_t k = 0; k < weights.size(); ++k)
        {
          if (weights[k] > 0.0)
          {
            add(ring[k], weights[k]);
          }
        }
        const Eigen::RowVector3d normal = fit.Solve();
        const double length = normal.norm();
        normals.row(f) = length > 0.0 ? Eigen::RowVector3d(normal / length) : own;
      }
    });
  return normals;
}

} // namespace SurfaceDiffusion
