// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/LinearNormals.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <limits>

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
      for (Index k = graph.Ring.Begin[f]; k < graph.Ring.Begin[f + 1]; ++k)
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
    const Eigen::Vector3d terms(1.0, this->First.dot(offset), this->Second.dot(offset));
    this->Matrix += weight * terms * terms.transpose();
    this->Right += weight * terms * value;
  }

  /// The value at the offset 0.
  Eigen::RowVector3d Solve()
  {
    const double ridge =
      Ridge * (this->Matrix(1, 1) + this->Matrix(2, 2)) + std::numeric_limits<double>::min();
    this->Matrix(1, 1) += ridge;
    this->Matrix(2, 2) += ridge;
    const Eigen::Matrix3d solution = this->Matrix.ldlt().solve(this->Right);
    return solution.row(0);
  }

private:
  Eigen::RowVector3d First, Second;
  Eigen::Matrix3d Matrix = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d Right = Eigen::Matrix3d::Zero();
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
      for (Index k = graph.Across.Begin[f]; k < graph.Across.Begin[f + 1]; ++k)
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
  const Vector weights = NeighbourWeights(graph, geometry, guide, settings, parallel);
  const double range = RangeFactor(settings);
  Points normals(graph.NumberOfFaces(), 3);
  ForEach(parallel, graph.NumberOfFaces(),
    [&](Index f)
    {
      const Eigen::RowVector3d own = guide.row(f);
      if (own.isZero(0.0))
      {
        normals.row(f) = own;
        return;
      }
      LinearFit fit(own);
      const auto add = [&](Index g, double weight)
      {
        fit.Add(geometry.Centroids.row(g) - geometry.Centroids.row(f), geometry.Normals.row(g),
          weight * geometry.Areas[g]);
      };
      add(f, FallOff(range * (geometry.Normals.row(f) - own).squaredNorm()));
      for (Index k = graph.Ring.Begin[f]; k < graph.Ring.Begin[f + 1]; ++k)
      {
        if (weights[k] > 0.0)
        {
          add(graph.Ring.Entries[k], weights[k]);
        }
      }
      const Eigen::RowVector3d normal = fit.Solve();
      const double length = normal.norm();
      normals.row(f) = length > 0.0 ? Eigen::RowVector3d(normal / length) : own;
    });
  return normals;
}

} // namespace SurfaceDiffusion
