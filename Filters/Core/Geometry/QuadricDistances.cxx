// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/QuadricDistances.h"

#include "Core/Foundation/Quantile.h"
#include "Core/Geometry/VertexFans.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace SurfaceDiffusion
{

namespace
{

constexpr std::size_t SmallestNeighbourhood = 9;
constexpr double LargestLeverage = 2.0;
/// The fraction of vertices that must be away from edges and without outliers, and the quantile of
/// |x| for the standard deviation 1.
constexpr double NoiseFraction = 0.3;
constexpr double NoiseQuantile = 0.3853;
/// The same for its largest values.
constexpr double TailFraction = 0.95;
constexpr double TailQuantile = 1.96;

using Quadric = Eigen::Matrix<double, 6, 1>;

struct VertexRange
{
  const Index* First;
  const Index* Last;

  const Index* begin() const { return this->First; }
  const Index* end() const { return this->Last; }
  std::size_t size() const { return static_cast<std::size_t>(this->Last - this->First); }
};

/// A vertex and the vertices up to a number of edges away from it. A vertex with more than
/// LargestFan triangles has neighbours of its own, but does not make them neighbours of each other.
class Neighbourhood
{
public:
  Neighbourhood(const TriangleMesh& mesh, int rings)
    : Mesh(mesh)
    , FoundFrom(static_cast<std::size_t>(mesh.NumberOfVertices()), -1)
    , RingEnds(static_cast<std::size_t>(rings))
  {
  }

  void Find(Index vertex)
  {
    this->Vertices.assign(1, vertex);
    this->FoundFrom[vertex] = vertex;
    std::size_t first = 0;
    for (std::size_t& end : this->RingEnds)
    {
      for (const std::size_t last = this->Vertices.size(); first < last; ++first)
      {
        if (this->Vertices[first] == vertex ||
          NumberOfTrianglesAt(this->Mesh, this->Vertices[first]) <= LargestFan)
        {
          this->AppendNeighbours(this->Vertices[first], vertex);
        }
      }
      end = this->Vertices.size();
    }
  }

  /// The vertices up to this number of edges away, without the vertex itself.
  VertexRange WithinRings(int rings) const
  {
    return { this->Vertices.data() + 1, this->Vertices.data() + this->RingEnds[rings - 1] };
  }

private:
  void AppendNeighbours(Index of, Index vertex)
  {
    const std::vector<Index>& begin = this->Mesh.VertexCornersBegin();
    for (Index k = begin[of]; k < begin[of + 1]; ++k)
    {
      for (const int other : { 1, 2 })
      {
        const Index neighbour = this->Mesh.OtherCorner(this->Mesh.VertexCorners()[k], other);
        if (this->FoundFrom[neighbour] != vertex)
        {
          this->FoundFrom[neighbour] = vertex;
          this->Vertices.push_back(neighbour);
        }
      }
    }
  }

  const TriangleMesh& Mesh;
  std::vector<Index> FoundFrom; ///< per vertex: the last vertex near to which it was found
  std::vector<Index> Vertices; ///< ring after ring
  std::vector<std::size_t> RingEnds;
};

/// The rows: two main axes of the points, and the normal. radius: the deviation along the second one.
Eigen::Matrix3d MainAxes(const Points& points, const VertexRange& list, double& radius)
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
  radius = std::sqrt(std::max(0.0, solver.eigenvalues()[1]) / static_cast<double>(list.size()));
  Eigen::Matrix3d axes;
  axes.row(0) = solver.eigenvectors().col(2).transpose();
  axes.row(1) = solver.eigenvectors().col(1).transpose();
  axes.row(2) = axes.row(0).cross(axes.row(1));
  return axes;
}
/// Of the quadric through `list`. h: a length of the size of the neighbourhood.
QuadricDistance DistanceFromQuadric(
  const Points& points, Index vertex, const VertexRange& list, double h)
{
  QuadricDistance result;
  const Eigen::Matrix3d axes = MainAxes(points, list, result.Radius);
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
  result.Standardized = determined ? distance / std::sqrt(1.0 + leverage) : -1.0;
  return result;
}
} // namespace

double TailOfNormal(std::vector<double>& values)
{
  const double tail = QuantileOf(values, TailFraction) / TailQuantile;
  const double usual = QuantileOf(values, NoiseFraction) / NoiseQuantile;
  return usual > 0.0 ? tail / usual : std::numeric_limits<double>::infinity();
}
Deviation DeviationOf(std::vector<double>& distances)
{
  const double vertices = static_cast<double>(distances.size());
  distances.erase(std::remove_if(distances.begin(), distances.end(),
                    [](double distance) { return distance < 0.0; }),
    distances.end());
  return { QuantileOf(distances, NoiseFraction) / NoiseQuantile,
    QuantileOf(distances, TailFraction) / TailQuantile,
    static_cast<double>(distances.size()) >= NoiseFraction * vertices };
}

Index StrideFor(const TriangleMesh& mesh, Index enough)
{
  return std::max<Index>(1, mesh.NumberOfVertices() / enough);
}

std::vector<std::vector<QuadricDistance>> MeasureDistances(const TriangleMesh& mesh,
  const Points& points, const std::vector<int>& rings, Index stride, const ParallelFor& parallel)
{
  const Index count = mesh.NumberOfVertices() / stride;
  const double h = mesh.MeanEdgeLength();
  std::vector<std::vector<QuadricDistance>> distances(
    rings.size(), std::vector<QuadricDistance>(static_cast<std::size_t>(count)));
  ForEachBlock(parallel, count,
    [&](Index, Index begin, Index end)
    {
      Neighbourhood neighbourhood(mesh, rings.back());
      for (Index i = begin; i < end; ++i)
      {
        neighbourhood.Find(i * stride);
        for (std::size_t k = 0; k < rings.size(); ++k)
        {
          const VertexRange list = neighbourhood.WithinRings(rings[k]);
          if (list.size() >= SmallestNeighbourhood)
          {
            distances[k][i] = DistanceFromQuadric(points, i * stride, list, h);
          }
        }
      }
    });
  return distances;
}

std::vector<double> Standardized(const std::vector<QuadricDistance>& distances)
{
  std::vector<double> values;
  values.reserve(distances.size());
  for (const QuadricDistance& distance : distances)
  {
    values.push_back(distance.Standardized);
  }
  return values;
}

std::vector<Deviation> MeasureDeviations(const TriangleMesh& mesh, const Points& points,
  const std::vector<int>& rings, Index stride, const ParallelFor& parallel)
{
  std::vector<Deviation> deviations;
  for (const auto& distances : MeasureDistances(mesh, points, rings, stride, parallel))
  {
    std::vector<double> values = Standardized(distances);
    deviations.push_back(DeviationOf(values));
  }
  return deviations;
}

} // namespace SurfaceDiffusion
