// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/Multigrid.h"

#include "Core/Foundation/Columns.h"
#include "Core/Foundation/Prefetch.h"
#include "Core/Foundation/Resize.h"

namespace SurfaceDiffusion
{

namespace
{

/// The K columns of a vertex, or any number of them if K is 0. Eigen's rows of known length are in
/// vector registers where compilers would not put them.
template <int K>
using Row = Eigen::Array<float, K == 0 ? Eigen::Dynamic : K, 1>;
template <int K>
using RowMap = Eigen::Map<Row<K>>;
template <int K>
using ConstRowMap = Eigen::Map<const Row<K>>;

/// y = b + sign (columns [begin, end) of `matrix`) . x; b may be y, or null for zero. Pointers are
/// passed by value, so that compilers know that the loop does not change them.
template <int K, typename Matrix>
void AddProducts(const Matrix& matrix, Index begin, Index end, float sign, const float* x,
  const float* b, float* y, ColumnCount<K> k)
{
  const Index* const outer = matrix.outerIndexPtr();
  const Index* const inner = matrix.innerIndexPtr();
  const float* const entries = matrix.valuePtr();
  const Index size = outer[matrix.cols()];
  for (Index i = begin; i < end; ++i)
  {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(i) * k;
    RowMap<K> row(y + at, k);
    // A copy in registers, or the row itself if K is 0
    std::conditional_t<K == 0, RowMap<K>&, Row<K>> sums(row);
    if (b)
    {
      sums = ConstRowMap<K>(b + at, k);
    }
    else
    {
      sums.setZero();
    }
    PrefetchRow(x, inner, outer[i + 1], size, k);
    for (Index slot = outer[i]; slot < outer[i + 1]; ++slot)
    {
      sums +=
        sign * entries[slot] * ConstRowMap<K>(x + static_cast<std::ptrdiff_t>(inner[slot]) * k, k);
    }
    if constexpr (K > 0)
    {
      row = sums;
    }
  }
}

/// A number of columns that fills a vector register, which ForColumns() does not know.
constexpr int SmallPanel = 4;

/// The number of columns over which a cycle for k of them runs: one for which it is compiled.
Eigen::Index PaddedColumns(Eigen::Index k)
{
  if (k < 3 || k > ColumnPanel)
  {
    return k;
  }
  return k <= SmallPanel ? SmallPanel : k <= HalfPanel ? HalfPanel : ColumnPanel;
}

} // namespace

void Multigrid::Resize(int columns)
{
  if (this->Columns == columns)
  {
    return;
  }
  this->Columns = -1; // memory may run out
  for (Level& level : this->Levels)
  {
    for (Numbers* work : { &level.B, &level.X, &level.R, &level.D, &level.E })
    {
      SurfaceDiffusion::Resize(*work, level.A.rows(), columns);
    }
  }
  const Eigen::Index rows = this->CoarsestMatrix.rows();
  SurfaceDiffusion::Resize(this->CoarsestB, rows, columns);
  SurfaceDiffusion::Resize(this->CoarsestX, rows, columns);
  const bool isSerial = this->CoarsestOverProcesses->IsSerial();
  SurfaceDiffusion::Resize(this->CoarsestNumbers,
    isSerial ? rows : static_cast<Eigen::Index>(this->CoarsestRows.size()), columns);
  this->Columns = columns;
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
  const Eigen::Index columns = r.cols();
  const Eigen::Index padded = PaddedColumns(columns);
  this->Resize(static_cast<int>(padded));
  if (columns == 1 && !this->HasSlices)
  {
    this->SetSlices();
  }
  ForColumns(columns, [&](auto k) { this->TakeResiduals<decltype(k)::value>(r, scale); });
  const auto cycle = [&](auto k) { this->Cycle<decltype(k)::value>(0, static_cast<int>(padded)); };
  if (padded == SmallPanel)
  {
    cycle(std::integral_constant<int, SmallPanel>());
  }
  else
  {
    ForColumns(padded, cycle);
  }
  ForColumns(columns, [&](auto k) { this->GiveSolutions<decltype(k)::value>(scale, z); });
  this->OverProcesses->UpdateFromOwners(z);
}

/// The right-hand side of the finest level. Columns beyond those of r are zero.
template <int K>
void Multigrid::TakeResiduals(const Values& r, const std::vector<double>& scale)
{
  const ColumnCount<K> k(r.cols());
  Numbers& b = this->Levels.empty() ? this->CoarsestNumbers : this->Levels.front().B;
  const auto padded = static_cast<int>(b.cols());
  ForEachBlock(this->Parallel, static_cast<Index>(r.rows()),
    [&](Index, Index begin, Index end)
    {
      const double* from = r.data() + static_cast<std::ptrdiff_t>(begin) * k;
      float* to = b.data() + static_cast<std::ptrdiff_t>(begin) * padded;
      for (Index i = begin; i < end; ++i, from += k, to += padded)
      {
        for (int c = 0; c < k; ++c)
        {
          to[c] = static_cast<float>(this->Scaling[i] * scale[c] * from[c]);
        }
        std::fill(to + k, to + padded, 0.0F);
      }
    });
}

/// z from the solution of the finest level.
template <int K>
void Multigrid::GiveSolutions(const std::vector<double>& scale, Values& z) const
{
  const ColumnCount<K> k(z.cols());
  const Numbers& x = this->Levels.empty() ? this->CoarsestNumbers : this->Levels.front().X;
  const auto padded = static_cast<int>(x.cols());
  ForEachBlock(this->Parallel, static_cast<Index>(z.rows()),
    [&](Index, Index begin, Index end)
    {
      const float* from = x.data() + static_cast<std::ptrdiff_t>(begin) * padded;
      double* to = z.data() + static_cast<std::ptrdiff_t>(begin) * k;
      for (Index i = begin; i < end; ++i, from += padded, to += k)
      {
        for (int c = 0; c < k; ++c)
        {
          to[c] = this->Scaling[i] / scale[c] * from[c];
        }
      }
    });
}

/// InterfaceNumbers are those of the vertices on interfaces.
void Multigrid::TakeInterface(const Reduction& overProcesses, const Numbers& numbers)
{
  const Eigen::Index columns = numbers.cols();
  this->InterfaceNumbers.resize(overProcesses.InterfaceVertices().size() * columns);
  double* number = this->InterfaceNumbers.data();
  for (const Index vertex : overProcesses.InterfaceVertices())
  {
    for (Eigen::Index c = 0; c < columns; ++c)
    {
      *number++ = numbers(vertex, c);
    }
  }
}

/// Accumulated numbers become consistent.
void Multigrid::AccumulateInterface(const Reduction& overProcesses, Numbers& numbers)
{
  if (overProcesses.IsSerial())
  {
    return;
  }
  const Eigen::Index columns = numbers.cols();
  this->TakeInterface(overProcesses, numbers);
  overProcesses.AccumulateInterface(this->InterfaceNumbers.data(), static_cast<Index>(columns));
  const double* number = this->InterfaceNumbers.data();
  for (const Index vertex : overProcesses.InterfaceVertices())
  {
    for (Eigen::Index c = 0; c < columns; ++c)
    {
      numbers(vertex, c) = static_cast<float>(*number++);
    }
  }
}

/// R = from - A x, consistent, and finish(i, first number of row i, R of row i). `from` may be R.
template <int K, typename Finish>
void Multigrid::Subtract(
  Level& level, const Numbers& from, const Numbers& x, int columns, const Finish& finish)
{
  if (level.OverProcesses->IsSerial())
  {
    this->SubtractRows<K>(level, from, x, columns, finish);
    return;
  }
  this->SubtractOwnPart<K>(level, from, x, columns,
    [&](Index i, std::ptrdiff_t at, const auto& r)
    {
      if (!level.IsOnInterface[i])
      {
        finish(i, at, r);
      }
    });
  this->AccumulateInterface(*level.OverProcesses, level.R);
  for (const Index vertex : level.OverProcesses->InterfaceVertices())
  {
    finish(vertex, static_cast<std::ptrdiff_t>(vertex) * columns,
      ConstRowMap<K>(&level.R(vertex, 0), columns));
  }
}

/// R accumulated, and finish() for what this process has added up.
template <int K, typename Finish>
void Multigrid::SubtractOwnPart(
  Level& level, const Numbers& from, const Numbers& x, int columns, const Finish& finish)
{
  this->TakeInterface(*level.OverProcesses, from);
  this->SubtractRows<K>(level, from, x, columns, finish);
  const double* number = this->InterfaceNumbers.data();
  for (const Index vertex : level.OverProcesses->InterfaceVertices())
  {
    for (int c = 0; c < columns; ++c, ++number)
    {
      level.R(vertex, c) -= level.OverProcesses->Owns(vertex) ? 0.0F : static_cast<float>(*number);
    }
  }
}

/// R = from - A x, of the process, and finish(i, first number of row i, R of row i) in the same
/// pass.
template <int K, typename Finish>
void Multigrid::SubtractRows(
  Level& level, const Numbers& from, const Numbers& x, int columns, const Finish& finish)
{
  const ColumnCount<K> k(columns);
  ForEachBlock(this->Parallel, static_cast<Index>(level.A.rows()),
    [&](Index, Index begin, Index end)
    {
      float* const r = level.R.data();
      if constexpr (K == 1)
      {
        level.RowsOfA.Subtract(begin, end, from.data(), x.data(), r);
      }
      else
      {
        AddProducts<K>(level.A, begin, end, -1.0F, x.data(), from.data(), r, k);
      }
      for (Index i = begin; i < end; ++i)
      {
        const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(i) * k;
        finish(i, at, ConstRowMap<K>(r + at, k));
      }
    });
}

/// y = or y += (the columns of `matrix`, or their slices) . x
template <int K>
void Multigrid::Product(
  const Matrix& matrix, const SlicedRows& rows, const Numbers& x, Numbers& y, int columns, bool add)
{
  const ColumnCount<K> k(columns);
  ForEachBlock(this->Parallel, static_cast<Index>(matrix.cols()),
    [&](Index, Index begin, Index end)
    {
      if constexpr (K != 1)
      {
        AddProducts<K>(matrix, begin, end, 1.0F, x.data(), add ? y.data() : nullptr, y.data(), k);
      }
      else if (add)
      {
        rows.Add(begin, end, x.data(), y.data());
      }
      else
      {
        rows.Multiply(begin, end, x.data(), y.data());
      }
    });
}

/// CoarsestNumbers, consistent, become the solution for them.
void Multigrid::SolveCoarsest()
{
  const Reduction& reduction = *this->CoarsestOverProcesses;
  if (reduction.IsSerial())
  {
    this->CoarsestB = this->CoarsestNumbers.cast<double>();
    this->Coarsest->Precondition(this->CoarsestB, this->CoarsestX); // no refinement
    this->CoarsestNumbers = this->CoarsestX.cast<float>();
    return;
  }
  const auto n = static_cast<Index>(this->CoarsestRows.size());
  this->CoarsestB.setZero();
  for (Index i = 0; i < n; ++i)
  {
    if (reduction.Owns(i))
    {
      this->CoarsestB.row(this->CoarsestRows[i]) = this->CoarsestNumbers.row(i).cast<double>();
    }
  }
  reduction.Sum(this->CoarsestB.data(), static_cast<Index>(this->CoarsestB.size()));
  this->Coarsest->Precondition(this->CoarsestB, this->CoarsestX);
  for (Index i = 0; i < n; ++i)
  {
    this->CoarsestNumbers.row(i) = this->CoarsestX.row(this->CoarsestRows[i]).cast<float>();
  }
}

/// X = B_level B, symmetric: the smoother from zero, the coarser levels, the smoother again. With
/// residuals r, the terms of the smoother are d = 4/3 D^-1 r and d' = 1/5 d + 12/5 D^-1 r'.
template <int K>
void Multigrid::Cycle(std::size_t number, int columns)
{
  if (number == this->Levels.size())
  {
    this->SolveCoarsest();
    return;
  }
  const ColumnCount<K> k(columns);
  Level& level = this->Levels[number];
  const float* const inverseD = level.InverseD.data();
  float* const rowsOfB = level.B.data();
  float* const rowsOfD = level.D.data();
  float* const rowsOfE = level.E.data();
  float* const rowsOfX = level.X.data();
  const auto first = [=](Index i, std::ptrdiff_t at, const auto& r)
  { RowMap<K>(rowsOfD + at, k) = 4.0F / 3.0F * inverseD[i] * r; };
  const auto second = [=](Index i, std::ptrdiff_t at, const auto& r)
  { return 0.2F * RowMap<K>(rowsOfD + at, k) + 2.4F * inverseD[i] * r; };

  ForEach(this->Parallel, static_cast<Index>(level.A.rows()),
    [=](Index i)
    {
      const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(i) * k;
      first(i, at, ConstRowMap<K>(rowsOfB + at, k));
    });
  this->Subtract<K>(level, level.B, level.D, columns,
    [=](Index i, std::ptrdiff_t at, const auto& r)
    {
      RowMap<K> e(rowsOfE + at, k);
      e = second(i, at, r);
      RowMap<K>(rowsOfX + at, k) = RowMap<K>(rowsOfD + at, k) + e;
    });
  this->SubtractOwnPart<K>(
    level, level.R, level.E, columns, [](Index, std::ptrdiff_t, const auto&) {});

  const bool last = number + 1 == this->Levels.size();
  Numbers& coarse = last ? this->CoarsestNumbers : this->Levels[number + 1].B;
  this->Product<K>(level.Restriction, level.RowsOfRestriction, level.R, coarse, columns, false);
  this->AccumulateInterface(
    last ? *this->CoarsestOverProcesses : *this->Levels[number + 1].OverProcesses, coarse);
  this->Cycle<K>(number + 1, columns);
  this->Product<K>(level.Prolongation, level.RowsOfProlongation,
    last ? this->CoarsestNumbers : this->Levels[number + 1].X, level.X, columns, true);

  this->Subtract<K>(level, level.B, level.X, columns, first);
  this->Subtract<K>(level, level.R, level.D, columns,
    [=](Index i, std::ptrdiff_t at, const auto& r)
    { RowMap<K>(rowsOfX + at, k) += RowMap<K>(rowsOfD + at, k) + second(i, at, r); });
}

} // namespace SurfaceDiffusion
