// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/Multigrid.h"

#include "Core/Operators/SparsePattern.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

constexpr Index LargestDirect = 500; // vertices of a level that is solved directly
// The same over several processes, each of which solves the whole level: the messages of one more
// level would take as long.
constexpr Index LargestGathered = 5000;
constexpr double LargestRatio = 0.8; // of the vertices of a level to those of the finer one
constexpr double FinestStrength = 0.08; // of strong entries on the finest level, as in the paper

/// Over all processes, of which this one has n vertices.
double CountVertices(const Reduction& overProcesses, Eigen::Index n)
{
  return overProcesses.SumOverVertices(
    SerialFor(), static_cast<Index>(n), [](Index) { return 1.0; });
}

/// scaled = matrix scaled to unit diagonal, from both sides. scaled: of the pattern of matrix.
void Scale(const SparseMatrix& matrix, const Vector& scaling, SparseMatrix& scaled,
  const ParallelFor& parallel)
{
  const Index* outer = matrix.outerIndexPtr();
  const Index* inner = matrix.innerIndexPtr();
  const double* a = matrix.valuePtr();
  double* s = scaled.valuePtr();
  ForEach(parallel, static_cast<Index>(matrix.rows()),
    [&](Index i)
    {
      for (Index slot = outer[i]; slot < outer[i + 1]; ++slot)
      {
        s[slot] = a[slot] * (scaling[i] * scaling[inner[slot]]);
      }
    });
}

/// In single precision, faster than Eigen's cast of a matrix. A matrix of the same size keeps its
/// pattern.
void Round(const SparseMatrix& matrix, Eigen::SparseMatrix<float, Eigen::ColMajor, Index>& single,
  const ParallelFor& parallel)
{
  const Index* outer = matrix.outerIndexPtr();
  if (single.cols() != matrix.cols() || single.nonZeros() != matrix.nonZeros())
  {
    Eigen::SparseMatrix<float, Eigen::ColMajor, Index> taken(matrix.rows(), matrix.cols());
    taken.resizeNonZeros(matrix.nonZeros());
    std::copy_n(outer, matrix.cols() + 1, taken.outerIndexPtr());
    ForEachBlock(parallel, static_cast<Index>(matrix.cols()),
      [&](Index, Index begin, Index end)
      {
        std::copy(matrix.innerIndexPtr() + outer[begin], matrix.innerIndexPtr() + outer[end],
          taken.innerIndexPtr() + outer[begin]);
      });
    single.swap(taken); // complete: the loop may have been aborted
  }
  ForEachBlock(parallel, static_cast<Index>(matrix.cols()),
    [&](Index, Index begin, Index end)
    {
      std::copy(matrix.valuePtr() + outer[begin], matrix.valuePtr() + outer[end],
        single.valuePtr() + outer[begin]);
    });
}

} // namespace

Multigrid::Multigrid(const ParallelFor& parallel, std::shared_ptr<const Reduction> overProcesses)
  : Parallel(parallel)
  , OverProcesses(std::move(overProcesses))
{
}

void Multigrid::KeepAggregates(const SparseMatrix& model)
{
  this->Coarsenings.clear();
  this->Levels.clear();
  this->Columns = -1;
  Vector kernel = RootsOfDiagonal(model, *this->OverProcesses, this->Parallel);
  TakePattern(model, this->Finest, this->Parallel);
  Scale(model, kernel.cwiseInverse(), this->Finest, this->Parallel);
  double strength = FinestStrength;
  for (const SparseMatrix* current = &this->Finest; current->rows() > LargestDirect;)
  {
    Coarsening& next = this->Coarsenings.emplace_back(*current, strength, this->Parallel);
    if (next.NumberOfAggregates() > LargestRatio * static_cast<double>(current->rows()))
    {
      this->Coarsenings.pop_back();
      break;
    }
    next.SetMatrix(*current, kernel);
    current = &next.Product();
    strength *= 0.5;
  }
  this->Levels.resize(this->Coarsenings.size());
}

void Multigrid::SetMatrix(const SparseMatrix& matrix, const ProgressMonitor& progress)
{
  Vector kernel = RootsOfDiagonal(matrix, *this->OverProcesses, this->Parallel);
  this->Scaling = kernel.cwiseInverse();
  if (!this->Coarsenings.empty())
  {
    Scale(matrix, this->Scaling, this->Finest, this->Parallel);
    this->SetLevels(std::move(kernel), progress);
    return;
  }
  SparseMatrix scaled;
  TakePattern(matrix, scaled, this->Parallel);
  Scale(matrix, this->Scaling, scaled, this->Parallel);
  this->MakeLevels(scaled, std::move(kernel), progress);
}

/// current: the finest matrix on entry. Matrices are swapped: Eigen 3.4 copies those that are
/// moved.
void Multigrid::MakeLevels(SparseMatrix& current, Vector kernel, const ProgressMonitor& progress)
{
  this->Levels.clear();
  this->Columns = -1;
  std::shared_ptr<const Reduction> overProcesses = this->OverProcesses;
  double strength = FinestStrength;
  double fraction = 0.0;
  double size = CountVertices(*overProcesses, current.rows());
  if (this->HasNoLevels && size > LargestReplicated)
  {
    throw std::runtime_error("The matrix is too large to be factorised in every process.");
  }
  const Index ofDistributed = this->HasNoLevels ? LargestReplicated : LargestGathered;
  const Index smallest = overProcesses->IsSerial() ? LargestDirect : ofDistributed;
  while (size > smallest)
  {
    std::shared_ptr<const Reduction> next = overProcesses;
    const SparseMatrix restriction =
      SmoothedAggregation(current, strength, kernel, next, this->Parallel);
    const double left = CountVertices(*next, restriction.rows());
    if (left > LargestRatio * size)
    {
      break;
    }
    const SparseMatrix prolongation = Transposed(restriction, this->Parallel);
    this->Levels.emplace_back();
    this->Levels.back().OverProcesses = overProcesses;
    this->SetLevel(current, restriction, prolongation, this->Levels.back());
    overProcesses = next;
    size = left;
    SparseMatrix coarse = GalerkinProduct(current, restriction, prolongation, this->Parallel);
    current.swap(coarse);
    strength *= 0.5;
    fraction = 0.5 * (fraction + 1.0);
    progress.Report(fraction);
  }
  this->SetCoarsest(current, overProcesses, progress.Part(fraction, 1.0));
}

/// matrix: that of the coarsest level, accumulated. It is taken.
void Multigrid::SetCoarsest(SparseMatrix& matrix, std::shared_ptr<const Reduction> overProcesses,
  const ProgressMonitor& progress)
{
  const auto n = static_cast<Index>(matrix.rows());
  this->CoarsestRows.clear();
  this->CoarsestOverProcesses = std::move(overProcesses);
  if (this->CoarsestOverProcesses->IsSerial())
  {
    this->CoarsestMatrix.swap(matrix);
  }
  else
  {
    const Reduction& reduction = *this->CoarsestOverProcesses;
    double owned = 0.0;
    Vector rows(n);
    for (Index i = 0; i < n; ++i)
    {
      rows[i] = owned;
      owned += reduction.Owns(i) ? 1.0 : 0.0;
    }
    const std::vector<double> counts = reduction.Gather({ owned });
    rows.array() += std::accumulate(counts.begin(), counts.begin() + reduction.Rank(), 0.0);
    reduction.UpdateFromOwners(rows);
    this->CoarsestRows.resize(n);
    std::vector<double> entries; // row, column, value
    for (Index i = 0; i < n; ++i)
    {
      this->CoarsestRows[i] = static_cast<Index>(rows[i]);
      for (SparseMatrix::InnerIterator entry(matrix, i); entry; ++entry)
      {
        entries.insert(entries.end(), { rows[i], rows[entry.index()], entry.value() });
      }
    }
    entries = reduction.Gather(entries);
    std::vector<Eigen::Triplet<double, Index>> triplets;
    for (std::size_t e = 0; e < entries.size(); e += 3)
    {
      triplets.emplace_back(
        static_cast<Index>(entries[e]), static_cast<Index>(entries[e + 1]), entries[e + 2]);
    }
    const double size = std::accumulate(counts.begin(), counts.end(), 0.0);
    this->CoarsestMatrix.resize(static_cast<Index>(size), static_cast<Index>(size));
    this->CoarsestMatrix.setFromTriplets(triplets.begin(), triplets.end());
  }
  this->Coarsest = MakeCholeskySolver();
  this->Coarsest->SetMatrix(this->CoarsestMatrix, progress);
}

/// The levels of Finest.
void Multigrid::SetLevels(Vector kernel, const ProgressMonitor& progress)
{
  const SparseMatrix* current = &this->Finest;
  double fraction = 0.0;
  for (std::size_t l = 0; l < this->Levels.size(); ++l)
  {
    Coarsening& next = this->Coarsenings[l];
    next.SetMatrix(*current, kernel);
    this->Levels[l].OverProcesses = this->OverProcesses;
    this->SetLevel(*current, next.Restriction(), next.Prolongation(), this->Levels[l]);
    current = &next.Product();
    fraction = 0.5 * (fraction + 1.0);
    progress.Report(fraction);
  }
  SparseMatrix coarsest = *current;
  this->SetCoarsest(coarsest, this->OverProcesses, progress.Part(fraction, 1.0));
}

void Multigrid::SetLevel(const SparseMatrix& matrix, const SparseMatrix& restriction,
  const SparseMatrix& prolongation, Level& level)
{
  this->HasSlices = false;
  Round(matrix, level.A, this->Parallel);
  Round(restriction, level.Prolongation, this->Parallel);
  Round(prolongation, level.Restriction, this->Parallel);
  const auto n = static_cast<Index>(matrix.rows());
  const Index* outer = matrix.outerIndexPtr();
  const double* a = matrix.valuePtr();
  Vector sums(n);
  ForEach(this->Parallel, n,
    [&](Index i)
    {
      sums[i] = 0.0;
      for (Index slot = outer[i]; slot < outer[i + 1]; ++slot)
      {
        sums[i] += std::abs(a[slot]);
      }
    });
  level.OverProcesses->Accumulate(sums);
  level.InverseD.resize(n);
  ForEach(
    this->Parallel, n, [&](Index i) { level.InverseD[i] = static_cast<float>(1.0 / sums[i]); });
  level.IsOnInterface = level.OverProcesses->MarkInterfaces(n);
}

} // namespace SurfaceDiffusion
