// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/Multigrid.h"

#include "Core/Foundation/Columns.h"
#include "Core/Operators/SparsePattern.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

constexpr Index LargestDirect = 500; // vertices of a level that is solved directly
constexpr double LargestRatio = 0.8; // of the vertices of a level to those of the finer one
constexpr double FinestStrength = 0.08; // of strong entries on the finest level, as in the paper

Vector RootsOfDiagonal(const SparseMatrix& matrix, const ParallelFor& parallel)
{
  Vector roots(matrix.rows());
  ForEach(parallel, static_cast<Index>(matrix.rows()),
    [&](Index i) { roots[i] = std::sqrt(DiagonalEntry(matrix, i)); });
  return roots;
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
  const bool isNew = single.cols() != matrix.cols() || single.nonZeros() != matrix.nonZeros();
  if (isNew)
  {
    single.resize(matrix.rows(), matrix.cols());
    single.resizeNonZeros(matrix.nonZeros());
    std::copy_n(outer, matrix.cols() + 1, single.outerIndexPtr());
  }
  ForEachBlock(parallel, static_cast<Index>(matrix.cols()),
    [&](Index, Index begin, Index end)
    {
      if (isNew)
      {
        std::copy(matrix.innerIndexPtr() + outer[begin], matrix.innerIndexPtr() + outer[end],
          single.innerIndexPtr() + outer[begin]);
      }
      std::copy(matrix.valuePtr() + outer[begin], matrix.valuePtr() + outer[end],
        single.valuePtr() + outer[begin]);
    });
}

/// sums += sign (column i of `matrix`) . x, K columns of x, or any number of them if K is 0.
template <int K, typename Matrix, typename Numbers>
void AddProduct(
  const Matrix& matrix, Index i, const Numbers& x, int columns, float sign, float* sums)
{
  // Eigen's rows of known length are in vector registers where compilers would not put them.
  using Row = Eigen::Array<float, K == 0 ? Eigen::Dynamic : K, 1>;
  const ColumnCount<K> k(columns);
  const Index* inner = matrix.innerIndexPtr();
  const float* a = matrix.valuePtr();
  Eigen::Map<Row> total(sums, k);
  std::conditional_t<K == 0, Eigen::Map<Row>&, Row> row(total);
  for (Index slot = matrix.outerIndexPtr()[i]; slot < matrix.outerIndexPtr()[i + 1]; ++slot)
  {
    row += sign * a[slot] *
      Eigen::Map<const Row>(x.data() + static_cast<std::ptrdiff_t>(inner[slot]) * k, k);
  }
  if constexpr (K > 0)
  {
    total = row;
  }
}

} // namespace

Multigrid::Multigrid(const ParallelFor& parallel)
  : Parallel(parallel)
{
}

void Multigrid::KeepAggregates(const SparseMatrix& model)
{
  this->Coarsenings.clear();
  this->Levels.clear();
  this->Columns = -1;
  Vector kernel = RootsOfDiagonal(model, this->Parallel);
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
  Vector kernel = RootsOfDiagonal(matrix, this->Parallel);
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

/// current: the finest matrix on entry. Matrices are swapped: Eigen 3.4 copies those that are moved.
void Multigrid::MakeLevels(SparseMatrix& current, Vector kernel, const ProgressMonitor& progress)
{
  this->Levels.clear();
  this->Columns = -1;
  double strength = FinestStrength;
  double fraction = 0.0;
  while (current.rows() > LargestDirect)
  {
    const SparseMatrix restriction = SmoothedAggregation(current, strength, kernel, this->Parallel);
    if (restriction.rows() > LargestRatio * static_cast<double>(current.rows()))
    {
      break;
    }
    const SparseMatrix prolongation = Transposed(restriction, this->Parallel);
    this->Levels.emplace_back();
    this->SetLevel(current, restriction, prolongation, this->Levels.back());
    SparseMatrix coarse = GalerkinProduct(current, restriction, prolongation, this->Parallel);
    current.swap(coarse);
    strength *= 0.5;
    fraction = 0.5 * (fraction + 1.0);
    progress.Report(fraction);
  }
  this->CoarsestMatrix.swap(current);
  this->Coarsest = MakeCholeskySolver();
  this->Coarsest->SetMatrix(this->CoarsestMatrix, progress.Part(fraction, 1.0));
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
    this->SetLevel(*current, next.Restriction(), next.Prolongation(), this->Levels[l]);
    current = &next.Product();
    fraction = 0.5 * (fraction + 1.0);
    progress.Report(fraction);
  }
  this->CoarsestMatrix = *current;
  this->Coarsest = MakeCholeskySolver();
  this->Coarsest->SetMatrix(this->CoarsestMatrix, progress.Part(fraction, 1.0));
}

void Multigrid::SetLevel(const SparseMatrix& matrix, const SparseMatrix& restriction,
  const SparseMatrix& prolongation, Level& level)
{
  this->HasSlices = false;
  Round(matrix, level.A, this->Parallel);
  Round(restriction, level.Prolongation, this->Parallel);
  Round(prolongation, level.Restriction, this->Parallel);
  level.InverseD.resize(matrix.rows());
  const Index* outer = matrix.outerIndexPtr();
  const double* a = matrix.valuePtr();
  ForEach(this->Parallel, static_cast<Index>(matrix.rows()),
    [&](Index i)
    {
      double sum = 0.0;
      for (Index slot = outer[i]; slot < outer[i + 1]; ++slot)
      {
        sum += std::abs(a[slot]);
      }
      level.InverseD[i] = static_cast<float>(1.0 / sum);
    });
}

void Multigrid::Resize(int columns)
{
  if (this->Columns == columns)
  {
    return;
  }
  this->Columns = columns;
  for (Level& level : this->Levels)
  {
    for (Numbers* work : { &level.B, &level.X, &level.R, &level.D, &level.E })
    {
      work->resize(level.A.rows(), columns);
    }
  }
  this->CoarsestB.resize(this->CoarsestMatrix.rows(), columns);
  this->CoarsestX.resize(this->CoarsestMatrix.rows(), columns);
  this->CoarsestNumbers.resize(this->CoarsestMatrix.rows(), columns);
}

void Multigrid::SetSlices()
{
  for (Level& level : this->Levels)
  {
    level.RowsOfA.Set(level.A, this->Parallel);
    level.RowsOfProlongation.Set(level.Prolongation, this->Parallel);
    level.RowsOfRestriction.Set(level.Restriction, this->Parallel);
  }
  this->HasSlices = true;
}

void Multigrid::Apply(const Values& r, const std::vector<double>& scale, Values& z)
{
  const int k = static_cast<int>(r.cols());
  const bool isPadded = k == 3; // four columns fill a vector register
  this->Resize(isPadded ? 4 : k);
  if (k == 1 && !this->HasSlices)
  {
    this->SetSlices();
  }
  Numbers& b = this->Levels.empty() ? this->CoarsestNumbers : this->Levels.front().B;
  ForEach(this->Parallel, static_cast<Index>(r.rows()),
    [&](Index i)
    {
      for (int c = 0; c < k; ++c)
      {
        b(i, c) = static_cast<float>(this->Scaling[i] * scale[c] * r(i, c));
      }
      if (isPadded)
      {
        b(i, 3) = 0.0f;
      }
    });
  if (isPadded)
  {
    this->Cycle<4>(0, 4);
  }
  else
  {
    ForColumns(k, [&](auto columns) { this->Cycle<decltype(columns)::value>(0, k); });
  }
  const Numbers& x = this->Levels.empty() ? this->CoarsestNumbers : this->Levels.front().X;
  ForEach(this->Parallel, static_cast<Index>(r.rows()),
    [&](Index i)
    {
      for (int c = 0; c < k; ++c)
      {
        z(i, c) = this->Scaling[i] / scale[c] * x(i, c);
      }
    });
}

/// R = from - A x, and finish(i, first number of row i, R of row i) in the same pass.
template <int K, typename Finish>
void Multigrid::Subtract(
  Level& level, const Numbers& from, const Numbers& x, int columns, const Finish& finish)
{
  if constexpr (K == 1)
  {
    ForEachBlock(this->Parallel, static_cast<Index>(level.A.rows()),
      [&](Index, Index begin, Index end)
      {
        float* const r = level.R.data();
        level.RowsOfA.Subtract(begin, end, from.data(), x.data(), r);
        for (Index i = begin; i < end; ++i)
        {
          finish(i, i, r + i);
        }
      });
    return;
  }
  const ColumnCount<K> k(columns);
  ForEach(this->Parallel, static_cast<Index>(level.A.rows()),
    [&](Index i)
    {
      const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(i) * k;
      float* r = level.R.data() + at;
      ColumnRegisters<float, K> registers;
      float* sums = registers.Or(r);
      for (int c = 0; c < k; ++c)
      {
        sums[c] = from.data()[at + c];
      }
      AddProduct<K>(level.A, i, x, k, -1.0f, sums);
      for (int c = 0; c < k; ++c)
      {
        r[c] = sums[c];
      }
      finish(i, at, sums);
    });
}

/// y = or y += (the columns of `matrix`, or their slices) . x
template <int K>
void Multigrid::Product(
  const Matrix& matrix, const SlicedRows& rows, const Numbers& x, Numbers& y, int columns, bool add)
{
  if constexpr (K == 1)
  {
    ForEachBlock(this->Parallel, rows.Size(),
      [&](Index, Index begin, Index end)
      {
        if (add)
        {
          rows.Add(begin, end, x.data(), y.data());
        }
        else
        {
          rows.Multiply(begin, end, x.data(), y.data());
        }
      });
    return;
  }
  const ColumnCount<K> k(columns);
  ForEach(this->Parallel, static_cast<Index>(matrix.cols()),
    [&](Index i)
    {
      float* yi = y.data() + static_cast<std::ptrdiff_t>(i) * k;
      ColumnRegisters<float, K> registers;
      float* sums = registers.Or(yi);
      for (int c = 0; c < k; ++c)
      {
        sums[c] = add ? yi[c] : 0.0f;
      }
      AddProduct<K>(matrix, i, x, k, 1.0f, sums);
      for (int c = 0; c < k; ++c)
      {
        yi[c] = sums[c];
      }
    });
}

/// X = B_level B, symmetric: the smoother from zero, the coarser levels, the smoother again. With
/// residuals r, the terms of the smoother are d = 4/3 D^-1 r and d' = 1/5 d + 12/5 D^-1 r'.
template <int K>
void Multigrid::Cycle(std::size_t number, int columns)
{
  if (number == this->Levels.size())
  {
    this->CoarsestB = this->CoarsestNumbers.cast<double>();
    this->Coarsest->Precondition(this->CoarsestB, this->CoarsestX); // no refinement
    this->CoarsestNumbers = this->CoarsestX.cast<float>();
    return;
  }
  const ColumnCount<K> k(columns);
  Level& level = this->Levels[number];
  const auto first = [&](Index i, std::ptrdiff_t at, const float* r)
  {
    for (int c = 0; c < k; ++c)
    {
      level.D.data()[at + c] = 4.0f / 3.0f * level.InverseD[i] * r[c];
    }
  };
  const auto second = [&](Index i, std::ptrdiff_t at, const float* r, int c)
  { return 0.2f * level.D.data()[at + c] + 2.4f * level.InverseD[i] * r[c]; };

  ForEach(this->Parallel, static_cast<Index>(level.A.rows()),
    [&](Index i)
    {
      const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(i) * k;
      first(i, at, level.B.data() + at);
    });
  this->Subtract<K>(level, level.B, level.D, columns,
    [&](Index i, std::ptrdiff_t at, const float* r)
    {
      for (int c = 0; c < k; ++c)
      {
        const float e = second(i, at, r, c);
        level.E.data()[at + c] = e;
        level.X.data()[at + c] = level.D.data()[at + c] + e;
      }
    });
  this->Subtract<K>(level, level.R, level.E, columns, [](Index, std::ptrdiff_t, const float*) {});

  const bool last = number + 1 == this->Levels.size();
  this->Product<K>(level.Restriction, level.RowsOfRestriction, level.R,
    last ? this->CoarsestNumbers : this->Levels[number + 1].B, columns, false);
  this->Cycle<K>(number + 1, columns);
  this->Product<K>(level.Prolongation, level.RowsOfProlongation,
    last ? this->CoarsestNumbers : this->Levels[number + 1].X, level.X, columns, true);

  this->Subtract<K>(level, level.B, level.X, columns, first);
  this->Subtract<K>(level, level.R, level.D, columns,
    [&](Index i, std::ptrdiff_t at, const float* r)
    {
      for (int c = 0; c < k; ++c)
      {
        level.X.data()[at + c] += level.D.data()[at + c] + second(i, at, r, c);
      }
    });
}

} // namespace SurfaceDiffusion
