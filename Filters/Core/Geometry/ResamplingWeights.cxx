// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/ResamplingWeights.h"

#include "Core/Geometry/NearestPoints.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

/// A source vertex and its weight.
using Entry = std::pair<Index, double>;

const Index* BeginOf(const RowMatrix& matrix, Index row)
{
  return matrix.innerIndexPtr() + matrix.outerIndexPtr()[row];
}

const Index* EndOf(const RowMatrix& matrix, Index row)
{
  return matrix.innerIndexPtr() + matrix.outerIndexPtr()[row + 1];
}

void DivideByRowSums(RowMatrix& matrix)
{
  for (Index row = 0; row < matrix.rows(); ++row)
  {
    const double sum = matrix.row(row).sum();
    for (RowMatrix::InnerIterator entry(matrix, row); entry; ++entry)
    {
      entry.valueRef() /= sum;
    }
  }
}

} // namespace

RowMatrix BarycentricWeights(const Points& target, const Points& source, const Triangles& faces,
  const ParallelFor& parallel, const ProgressMonitor& progress)
{
  const auto count = static_cast<Index>(target.rows());
  const NearestPoints nearest(source, faces);
  std::vector<std::array<Entry, 3>> rows(static_cast<std::size_t>(count));
  constexpr Index part = 32 * BlockSize; // between two reports
  for (Index first = 0; first < count; first += part)
  {
    progress.Report(static_cast<double>(first) / count);
    ForEach(parallel, std::min(part, count - first),
      [&](Index i)
      {
        const NearestPoint found = nearest.Find(target.row(first + i));
        std::array<Entry, 3>& row =
          rows[static_cast<std::size_t>(first) + static_cast<std::size_t>(i)];
        for (std::size_t a = 0; a < 3 && found.Triangle >= 0; ++a)
        {
          row[a] = { faces(found.Triangle, static_cast<Eigen::Index>(a)), found.Coordinates[a] };
        }
        std::sort(row.begin(), row.end());
      });
  }
  RowMatrix weights(count, source.rows());
  weights.reserve(3 * static_cast<Eigen::Index>(count));
  for (Index i = 0; i < count; ++i)
  {
    weights.startVec(i);
    for (const auto& [vertex, weight] : rows[static_cast<std::size_t>(i)])
    {
      if (weight != 0.0)
      {
        weights.insertBack(i, vertex) = weight;
      }
    }
  }
  weights.finalize();
  return weights;
}

RowMatrix AdaptiveAreaWeights(const RowMatrix& forward, const RowMatrix& reverse,
  const Vector& sourceAreas, const Vector& targetAreas)
{
  RowMatrix gathered = reverse.transpose();
  gathered.prune(
    [&](Eigen::Index, Eigen::Index vertex, double) { return sourceAreas[vertex] > 0.0; });
  RowMatrix weights(forward.rows(), forward.cols());
  weights.reserve(forward.nonZeros() + gathered.nonZeros());
  Vector sums = Vector::Zero(forward.cols());
  for (Index t = 0; t < forward.rows(); ++t)
  {
    const bool takesForward = std::includes(
      BeginOf(forward, t), EndOf(forward, t), BeginOf(gathered, t), EndOf(gathered, t));
    weights.startVec(t);
    for (RowMatrix::InnerIterator entry(takesForward ? forward : gathered, t); entry; ++entry)
    {
      const double weight = entry.value() * targetAreas[t];
      weights.insertBack(t, entry.col()) = weight;
      sums[entry.col()] += weight;
    }
  }
  weights.finalize();
  for (Index t = 0; t < weights.rows(); ++t)
  {
    for (RowMatrix::InnerIterator entry(weights, t); entry; ++entry)
    {
      const double sum = sums[entry.col()];
      entry.valueRef() *= sum > 0.0 ? sourceAreas[entry.col()] / sum : 0.0;
    }
  }
  weights.prune([](Eigen::Index, Eigen::Index, double weight) { return weight != 0.0; });
  return weights;
}

RowMatrix ResamplingWeights(ResamplingMethod method, AreaSphere source, AreaSphere target,
  const Flags& isLeftOut, const ParallelFor& parallel, const ProgressMonitor& progress)
{
  source.Vertices.rowwise().normalize();
  target.Vertices.rowwise().normalize();
  const bool isAdaptive = method == ResamplingMethod::AdaptiveBarycentricArea;
  RowMatrix weights = BarycentricWeights(target.Vertices, source.Vertices, source.Faces, parallel,
    progress.Part(0.0, isAdaptive ? 0.5 : 1.0));
  if (isAdaptive)
  {
    const RowMatrix reverse = BarycentricWeights(
      source.Vertices, target.Vertices, target.Faces, parallel, progress.Part(0.5, 0.9));
    weights = AdaptiveAreaWeights(weights, reverse, source.Areas, target.Areas);
  }
  if (isLeftOut.size() > 0)
  {
    weights.prune([&](Eigen::Index, Eigen::Index vertex, double) { return !isLeftOut[vertex]; });
  }
  DivideByRowSums(weights);
  progress.Report(1.0);
  return weights;
}

} // namespace SurfaceDiffusion
