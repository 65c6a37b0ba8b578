// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/VertexNoise.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

constexpr std::size_t SmallestNeighbourhood = 9;
constexpr double LargestLeverage = 2.0;
constexpr double MedianOfNormalDistribution = 0.6745; ///< of |x| for the standard deviation 1
/// The fraction of vertices that must be away from edges and without outliers, and the quantile of
/// |x| for the standard deviation 1.
constexpr double NoiseFraction = 0.3;
constexpr double NoiseQuantile = 0.3853;
/// Of larger surfaces, every second, third, ... vertex is used: that many have a quantile within about
/// 1 %.
constexpr Index EnoughVertices = 20000;
/// (3/2)^3: the variance of details from three rings of neighbours over that from two.
constexpr double GrowthOfDetails = 3.375;

using Quadric = Eigen::Matrix<double, 6, 1>;

void AppendNeighbours(const TriangleMesh& mesh, Index vertex, std::vector<Index>& list)
{
  for (Index k = mesh.VertexCornersBegin()[vertex]; k < mesh.VertexCornersBegin()[vertex + 1]; ++k)
  {
    const Index corner = mesh.VertexCorners()[k];
    list.push_back(mesh.OtherCorner(corner, 1));
    list.push_back(mesh.OtherCorner(corner, 2));
  }
}

void MakeUnique(std::vector<Index>& list)
{
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

/// The vertices up to this number of edges away from the vertex, without the vertex.
void FindRings(const TriangleMesh& mesh, Index vertex, int rings, std::vector<Index>& list)
{
  list.assign(1, vertex);
  for (int ring = 0; ring < rings; ++ring)
  {
    const std::size_t count = list.size();
    for (std::size_t k = 0; k < count; ++k)
    {
      AppendNeighbours(mesh, list[k], list);
    }
    MakeUnique(list);
  }
  list.erase(std::lower_bound(list.begin(), list.end(), vertex));
}

/// The rows: two main axes of the points, and the normal.
Eigen::Matrix3d MainAxes(const Points& points, const std::vector<Index>& list)
{
  Eigen::RowVector3d centre = Eigen::RowVector3d::Zero();
  for (const Index i : list)
  {
    centre += points.row(i);
  }
  centre /= static_cast<double>(list.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Index i : list)
  {
    const Eigen::RowVector3d d = points.row(i) - centre;
    covariance += d.transpose() * d;
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  Eigen::Matrix3d axes;
  axes.row(0) = solver.eigenvectors().col(2).transpose();
  axes.row(1) = solver.eigenvectors().col(1).transpose();
  axes.row(2) = axes.row(0).cross(axes.row(1));
  return axes;
}

/// The standardised distance of the vertex from the quadric through `list`; negative if the fit is
/// not well determined. h: a length of the size of the neighbourhood.
double StandardizedDistance(
  const Points& points, Index vertex, const std::vector<Index>& list, double h)
{
  const Eigen::Matrix3d axes = MainAxes(points, list);
  Eigen::Matrix<double, 6, 6> normalMatrix = Eigen::Matrix<double, 6, 6>::Zero();
  Quadric right = Quadric::Zero();
  for (const Index i : list)
  {
    const Eigen::Vector3d d = axes * (points.row(i) - points.row(vertex)).transpose() / h;
    Quadric terms;
    terms << 1.0, d[0], d[1], d[0] * d[0], d[0] * d[1], d[1] * d[1];
    normalMatrix += terms * terms.transpose();
    right += terms * d[2];
  }
  const auto factor = normalMatrix.ldlt();
  const double leverage = factor.solve(Quadric::Unit(0))[0];
  const double distance = std::abs(factor.solve(right)[0]) * h;
  const bool determined = leverage >= 0.0 && leverage < LargestLeverage && std::isfinite(distance);
  return determined ? distance / std::sqrt(1.0 + leverage) : -1.0;
}

/// The estimate of EstimateVertexNoise() from the vertices up to this number of edges away.
double EstimateOverRings(
  const TriangleMesh& mesh, const Points& points, int rings, const ParallelFor& parallel)
{
  const Index stride = std::max<Index>(1, mesh.NumberOfVertices() / EnoughVertices);
  const Index count = mesh.NumberOfVertices() / stride;
  const double h = mesh.TotalEdgeLength() / std::max<Index>(1, mesh.NumberOfEdges());
  std::vector<double> distances(static_cast<std::size_t>(count));
  ForEachBlock(parallel, count,
    [&](Index, Index begin, Index end)
    {
      std::vector<Index> list;
      for (Index i = begin; i < end; ++i)
      {
        FindRings(mesh, i * stride, rings, list);
        distances[i] = list.size() < SmallestNeighbourhood
          ? -1.0
          : StandardizedDistance(points, i * stride, list, h);
      }
    });
  distances.erase(std::remove_if(distances.begin(), distances.end(),
                    [](double distance) { return distance < 0.0; }),
    distances.end());
  return QuantileOf(distances, NoiseFraction) / NoiseQuantile;
}

} // namespace

double QuantileOf(std::vector<double>& values, double fraction)
{
  if (values.empty())
  {
    return 0.0;
  }
  const double place = fraction * static_cast<double>(values.size());
  const auto quantile = values.begin() + static_cast<std::ptrdiff_t>(place);
  std::nth_element(values.begin(), quantile, values.end());
  return *quantile;
}

double MedianDeviation(std::vector<double>& absoluteValues)
{
  return QuantileOf(absoluteValues, 0.5) / MedianOfNormalDistribution;
}

double EstimateVertexNoise(
  const TriangleMesh& mesh, const Points& points, const ParallelFor& parallel)
{
  const double two = EstimateOverRings(mesh, points, 2, parallel);
  const double three = std::max(two, EstimateOverRings(mesh, points, 3, parallel));
  return std::sqrt(
    std::max(0.0, two * two - (three * three - two * two) / (GrowthOfDetails - 1.0)));
}

} // namespace SurfaceDiffusion
