// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/FaceNormalFilter.h"

#include "Core/Foundation/Columns.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// The width of the guide of a smooth surface, relative to that of the filter.
constexpr double GuideWidth = 0.5;
/// The mean distance to the triangles of a ring over that to the neighbours across edges.
constexpr double RingDistance = 1.5;
constexpr double TinyDifference = 1e-9;

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

/// The differences of normals, in the order of graph.Across.Entries.
Vector DifferencesAcross(const FaceGraph& graph, const Points& normals, const ParallelFor& parallel)
{
  Vector differences(static_cast<Offset>(graph.Across.Entries.size()));
  ForEach(parallel, graph.NumberOfFaces(),
    [&](Index f)
    {
      for (Offset k = graph.Across.Begin[f]; k < graph.Across.Begin[f + 1]; ++k)
      {
        differences[k] = (normals.row(f) - normals.row(graph.Across.Entries[k])).norm();
      }
    });
  return differences;
}

constexpr std::size_t Lanes = 8;

/// The largest squared difference of two of the vectors, of which there are a multiple of Lanes.
SURFACEDIFFUSION_ANY_VECTORS double LargestSquare(
  const double* x, const double* y, const double* z, std::size_t count)
{
  double squares[Lanes] = {};
  for (std::size_t i = 0; i < count; ++i)
  {
    for (std::size_t first = i / Lanes * Lanes; first < count; first += Lanes)
    {
      for (std::size_t l = 0; l < Lanes; ++l)
      {
        const double dx = x[first + l] - x[i];
        const double dy = y[first + l] - y[i];
        const double dz = z[first + l] - z[i];
        const double square = dx * dx + dy * dy + dz * dz;
        squares[l] = squares[l] > square ? squares[l] : square;
      }
    }
  }
  return *std::max_element(squares, squares + Lanes);
}

/// A triangle and its ring.
class Patch
{
public:
  /// How inconsistent the normals of the patch of triangle f are (equation (8) of the paper): the
  /// largest difference of two of them, times the share of the largest difference across an edge in
  /// the sum of all of them.
  double Inconsistency(const FaceGraph& graph, const Points& normals, const Vector& across, Index f)
  {
    for (std::vector<double>& values : this->Normals)
    {
      values.clear();
    }
    this->Append(normals, f);
    for (Offset k = graph.Ring.Begin[f]; k < graph.Ring.Begin[f + 1]; ++k)
    {
      this->Append(normals, graph.Ring.Entries[k]);
    }
    while (this->Normals[0].size() % Lanes != 0)
    {
      this->Append(normals, f);
    }
    const double largest = LargestSquare(this->Normals[0].data(), this->Normals[1].data(),
      this->Normals[2].data(), this->Normals[0].size());
    double largestAcross = 0.0;
    double sumAcross = 0.0;
    for (Offset k = graph.Inside.Begin[f]; k < graph.Inside.Begin[f + 1]; ++k)
    {
      const double difference = across[graph.Inside.Entries[k]];
      largestAcross = std::max(largestAcross, difference);
      sumAcross += difference;
    }
    return std::sqrt(largest) * (TinyDifference + largestAcross) / (TinyDifference + sumAcross);
  }

private:
  void Append(const Points& normals, Index f)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Normals[axis].push_back(normals(f, axis));
    }
  }

  std::array<std::vector<double>, 3> Normals; ///< per axis
};

Points GuideOfSharpSurface(
  const FaceGraph& graph, const FaceGeometry& geometry, const ParallelFor& parallel)
{
  const Index count = graph.NumberOfFaces();
  const Vector across = DifferencesAcross(graph, geometry.Normals, parallel);
  Vector inconsistency(count);
  Points means(count, 3);
  ForEachBlock(parallel, count,
    [&](Index, Index begin, Index end)
    {
      Patch patch;
      for (Index f = begin; f < end; ++f)
      {
        inconsistency[f] = patch.Inconsistency(graph, geometry.Normals, across, f);
        Eigen::RowVector3d sum = geometry.Areas[f] * geometry.Normals.row(f);
        for (Offset k = graph.Ring.Begin[f]; k < graph.Ring.Begin[f + 1]; ++k)
        {
          const Index g = graph.Ring.Entries[k];
          sum += geometry.Areas[g] * geometry.Normals.row(g);
        }
        means.row(f) = Direction(sum, geometry.Normals.row(f));
      }
    });
  Points guide(count, 3);
  ForEach(parallel, count,
    [&](Index f)
    {
      Index best = f;
      for (Offset k = graph.Ring.Begin[f]; k < graph.Ring.Begin[f + 1]; ++k)
      {
        const Index g = graph.Ring.Entries[k];
        best = inconsistency[g] < inconsistency[best] ? g : best;
      }
      guide.row(f) = means.row(best);
    });
  return guide;
}

Points GuideOfSmoothSurface(const FaceGraph& graph, const FaceGeometry& geometry,
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

/// One sweep from `normals` to `next`.
void Sweep(const FaceGraph& graph, const FaceGeometry& geometry, const Vector& weights,
  const NormalFilterSettings& settings, bool robust, const Points& normals, Points& next,
  const ParallelFor& parallel)
{
  const double range = 0.5 / (settings.Range * settings.Range);
  const double fidelity = robust ? settings.Fidelity : 0.0;
  ForEach(parallel, graph.NumberOfFaces(),
    [&](Index f)
    {
      const Eigen::RowVector3d own = normals.row(f);
      Eigen::RowVector3d sum = geometry.Areas[f] * (own + fidelity * geometry.Normals.row(f));
      for (Offset k = graph.Ring.Begin[f]; k < graph.Ring.Begin[f + 1]; ++k)
      {
        const Index g = graph.Ring.Entries[k];
        if (weights[k] == 0.0)
        {
          continue;
        }
        const Eigen::RowVector3d other = normals.row(g);
        const double weight =
          robust ? weights[k] * FallOff(range * (other - own).squaredNorm()) : weights[k];
        sum += weight * geometry.Areas[g] * other;
      }
      next.row(f) = Direction(sum, own);
    });
}

} // namespace

Points MakeGuide(const FaceGraph& graph, const FaceGeometry& geometry,
  const NormalFilterSettings& settings, const ParallelFor& parallel)
{
  return settings.Kind == SurfaceKind::Sharp
    ? GuideOfSharpSurface(graph, geometry, parallel)
    : GuideOfSmoothSurface(graph, geometry, settings, parallel);
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
  Points normals = geometry.Normals;
  Points next(normals.rows(), 3);
  for (int sweep = 0; sweep < settings.Sweeps; ++sweep)
  {
    // The first sweep starts from the noise, in which the penalty would see edges everywhere.
    Sweep(graph, geometry, weights, settings, sweep > 0, normals, next, parallel);
    normals.swap(next);
  }
  return normals;
}

} // namespace SurfaceDiffusion
