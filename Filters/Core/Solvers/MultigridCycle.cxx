// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/Multigrid.h"

#include "Core/Foundation/Columns.h"
#include "Core/Foundation/Resize.h"

namespace SurfaceDiffusion
{

namespace
{

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
  this->OverProcesses->UpdateFromOwners(z);
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
  if (level.IsOnInterface.empty())
  {
    this->SubtractRows<K>(level, from, x, columns, finish);
    return;
  }
  this->SubtractOwnPart<K>(level, from, x, columns,
    [&](Index i, std::ptrdiff_t at, const float* r)
    {
      if (!level.IsOnInterface[i])
      {
        finish(i, at, r);
      }
    });
  this->AccumulateInterface(*level.OverProcesses, level.R);
  for (const Index vertex : level.OverProcesses->InterfaceVertices())
  {
    finish(vertex, static_cast<std::ptrdiff_t>(vertex) * columns, &level.R(vertex, 0));
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
  this->SubtractOwnPart<K>(
    level, level.R, level.E, columns, [](Index, std::ptrdiff_t, const float*) {});

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
    [&](Index i, std::ptrdiff_t at, const float* r)
    {
      for (int c = 0; c < k; ++c)
      {
        level.X.data()[at + c] += level.D.data()[at + c] + second(i, at, r, c);
      }
    });
}

} // namespace SurfaceDiffusion
