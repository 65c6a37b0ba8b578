// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/DisplacementStatistics.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// Of averaging over neighbours. Each spreads a value by about 0.65 edges along an axis, and the
/// spread grows with their square root: R of fewer values would be too uncertain.
constexpr int WhitenessSweeps = 64;
constexpr int MeanSweeps = 8;

} // namespace

DisplacementStatistics::DisplacementStatistics(
  const TriangleMesh& mesh, const std::vector<char>& fixed, const ParallelFor& parallel)
  : Fixed(fixed)
  , Parallel(parallel)
{
  this->Around = MakeLists(mesh.NumberOfVertices(), parallel,
    [&](Index i, std::vector<Index>& entries)
    {
      const std::size_t first = entries.size();
      for (Index k = mesh.VertexCornersBegin()[i]; k < mesh.VertexCornersBegin()[i + 1]; ++k)
      {
        entries.push_back(mesh.OtherCorner(mesh.VertexCorners()[k], 1));
        entries.push_back(mesh.OtherCorner(mesh.VertexCorners()[k], 2));
      }
      SortUnique(entries, first);
    });
}

double DisplacementStatistics::Whiteness(const Vector& displacements) const
{
  double squaresOfSums = 0.0;
  double squares = 0.0;
  for (Index i = 0; i < static_cast<Index>(displacements.size()); ++i)
  {
    if (!this->IsFixed(i))
    {
      double sum = displacements[i];
      for (Offset k = this->Around.Begin[i]; k < this->Around.Begin[i + 1]; ++k)
      {
        sum += displacements[this->Around.Entries[k]];
      }
      squaresOfSums += sum * sum / this->FreeCount(i);
      squares += displacements[i] * displacements[i];
    }
  }
  return squares > 0.0 ? squaresOfSums / squares : 0.0;
}

double DisplacementStatistics::WhitenessDeviation() const
{
  double free = 0.0;
  double terms = 0.0;
  for (Index i = 0; i + 1 < static_cast<Index>(this->Around.Begin.size()); ++i)
  {
    free += this->IsFixed(i) ? 0.0 : 1.0;
    terms += this->IsFixed(i) ? 0.0 : this->FreeCount(i);
  }
  return std::sqrt(2.0 * terms) / std::max(1.0, free);
}

double DisplacementStatistics::FreeCount(Index i) const
{
  double count = 1.0;
  for (Offset k = this->Around.Begin[i]; k < this->Around.Begin[i + 1]; ++k)
  {
    count += this->IsFixed(this->Around.Entries[k]) ? 0.0 : 1.0;
  }
  return count;
}

Vector DisplacementStatistics::LocalWhiteness(const Vector& displacements) const
{
  Squares squares = this->FindSquares(displacements);
  this->Average(squares, WhitenessSweeps);
  Vector whiteness(squares.rows());
  ForEach(this->Parallel, static_cast<Index>(squares.rows()),
    [&](Index i) { whiteness[i] = squares(i, 1) > 0.0F ? squares(i, 0) / squares(i, 1) : 0.0; });
  return whiteness;
}

Vector DisplacementStatistics::LocalMeans(const Vector& values) const
{
  Vector means = values;
  this->Average(means, MeanSweeps);
  return means;
}

DisplacementStatistics::Squares DisplacementStatistics::FindSquares(
  const Vector& displacements) const
{
  Vector means = displacements;
  this->Average(means, 1);
  Squares squares = Squares::Zero(means.size(), 2);
  ForEach(this->Parallel, static_cast<Index>(means.size()),
    [&](Index i)
    {
      if (!this->IsFixed(i))
      {
        squares(i, 0) = static_cast<float>(this->Count(i) * means[i] * means[i]);
        squares(i, 1) = static_cast<float>(displacements[i] * displacements[i]);
      }
    });
  return squares;
}

template <typename Matrix>
void DisplacementStatistics::Average(Matrix& values, int sweeps) const
{
  Matrix next(values.rows(), values.cols());
  for (int sweep = 0; sweep < sweeps; ++sweep)
  {
    ForEach(this->Parallel, static_cast<Index>(values.rows()),
      [&](Index i)
      {
        using Number = typename Matrix::Scalar;
        Eigen::Array<Number, 1, Matrix::ColsAtCompileTime> sum = values.row(i).array();
        for (Offset k = this->Around.Begin[i]; k < this->Around.Begin[i + 1]; ++k)
        {
          sum += values.row(this->Around.Entries[k]).array();
        }
        next.row(i) = sum / static_cast<Number>(this->Count(i));
      });
    values.swap(next);
  }
}

} // namespace SurfaceDiffusion
