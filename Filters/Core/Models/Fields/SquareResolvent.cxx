// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Fields/SquareResolvent.h"

#include "Core/Foundation/ColumnPanels.h"
#include "Core/Foundation/Resize.h"
#include "Core/Operators/SparseProduct.h"
#include "Core/Solvers/LinearSolver.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace SurfaceDiffusion
{

SquareResolvent::SquareResolvent(std::shared_ptr<const Assembler> assembler,
  const CornerWeights& coefficients, const ParallelFor& parallel)
  : Assembly(std::move(assembler))
  , Parallel(parallel)
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  const Index n = mesh.NumberOfVertices();
  this->Assembly->TakePattern(this->Matrix, parallel);
  this->Assembly->Fill(this->Matrix, Vector::Zero(n), 1.0, coefficients, nullptr, parallel);
  this->Roots = mesh.ControlAreas().cwiseSqrt();
  ForEach(parallel, n,
    [&](Index row)
    {
      for (SparseMatrix::InnerIterator entry(this->Matrix, row); entry; ++entry)
      {
        entry.valueRef() /= this->Roots[row] * this->Roots[entry.index()];
      }
    });
  const double largest = Max(parallel, n,
    [&](Index row)
    {
      double sum = 0.0;
      for (SparseMatrix::InnerIterator entry(this->Matrix, row); entry; ++entry)
      {
        sum += std::abs(entry.value());
      }
      return sum;
    });
  // The error falls by exp(-sqrt(2 / largest)) in each iteration.
  constexpr double tolerance = 1e-10;
  this->Expected = std::ceil(10.0 - std::log(tolerance) * std::sqrt(0.5 * largest));
  this->Balanced = MeanCorrection(mesh, mesh.ControlAreas(), Flags::Constant(n, false), parallel);
}

bool SquareResolvent::Apply(Values& u, const ProgressMonitor& progress)
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  Values filtered = u;
  bool succeeds = true;
  ForEachPanel(filtered, progress,
    [&](Values& panel, const ProgressMonitor& part)
    {
      if (!succeeds)
      {
        return;
      }
      Eigen::RowVectorXd mean;
      FindMeans(mesh, panel, mean, this->Parallel);
      panel.rowwise() -= mean;
      const Values right = mesh.ControlAreas().asDiagonal() * panel;
      succeeds = ForColumns(
        panel.cols(), [&](auto k) { return this->Iterate<decltype(k)::value>(panel, part); });
      this->Balanced.Restore(mesh, right, panel, this->Parallel);
      panel.rowwise() += mean;
    });
  if (succeeds)
  {
    u.swap(filtered);
  }
  return succeeds;
}

template <int K>
bool SquareResolvent::Iterate(Values& u, const ProgressMonitor& progress)
{
  using Complex = std::complex<double>;
  constexpr double tolerance = 1e-10;
  constexpr double patience = 2.0;
  const auto n = static_cast<Index>(u.rows());
  const ColumnCount<K> k(u.cols());
  for (Values* vectors : { &this->W, &this->LastW, &this->Product, &this->P, &this->Q })
  {
    Resize(*vectors, u.rows(), u.cols());
  }
  this->Sums.Resize(n, k);
  this->Columns.assign(static_cast<std::size_t>(k), Column());
  std::vector<Column>& columns = this->Columns;
  std::vector<double> scales(columns.size());
  for (int c = 0; c < k; ++c)
  {
    scales[c] = ScaleOf(u, u, c, this->Parallel);
  }
  this->Sums.Run<K>(this->Parallel, n, k,
    [&](Index i, double* sums)
    {
      for (int c = 0; c < k; ++c)
      {
        this->W(i, c) = this->Roots[i] * (u(i, c) / scales[c]);
        this->LastW(i, c) = this->P(i, c) = this->Q(i, c) = u(i, c) = 0.0;
        sums[c] += this->W(i, c) * this->W(i, c);
      }
    });
  for (int c = 0; c < k; ++c)
  {
    columns[c].Start = std::sqrt(this->Sums[c]);
    columns[c].IsFinished = !(columns[c].Start > 0.0);
    columns[c].Unit = columns[c].IsFinished ? 0.0 : 1.0 / columns[c].Start;
    columns[c].Rest = columns[c].Start;
  }
  const auto isFinished = [](const Column& column) { return column.IsFinished; };
  for (int iteration = 0; !std::all_of(columns.begin(), columns.end(), isFinished); ++iteration)
  {
    if (!(iteration < patience * this->Expected))
    {
      return false;
    }
    progress.Report(std::min(1.0, iteration / this->Expected));
    this->Sums.Run<K>(
      this->Parallel, n, k,
      [&](Index begin, Index end)
      { MultiplyRows<K>(this->Matrix, this->W, this->Product, begin, end); },
      [&](Index i, double* sums)
      {
        for (int c = 0; c < k; ++c)
        {
          sums[c] += this->W(i, c) * this->Product(i, c);
        }
      });
    double unit[K > 0 ? K : ColumnPanel], alpha[K > 0 ? K : ColumnPanel];
    double beta[K > 0 ? K : ColumnPanel], factor[K > 0 ? K : ColumnPanel][2];
    double step[K > 0 ? K : ColumnPanel][2];
    for (int c = 0; c < k; ++c)
    {
      Column& column = columns[c];
      // The factors of the tridiagonal matrix of 1 + i L.
      const double entry = this->Sums[c] * column.Unit * column.Unit;
      const Complex beside(0.0, column.Beta);
      const Complex below = beside / column.Pivot;
      column.Pivot = Complex(1.0, entry) - below * beside;
      column.Rest *= iteration == 0 ? Complex(1.0) : -below;
      column.Step = column.IsFinished ? Complex(0.0) : column.Rest / column.Pivot;
      unit[c] = column.Unit;
      alpha[c] = entry * column.Unit;
      beta[c] = column.Beta * column.LastUnit;
      factor[c][0] = below.real();
      factor[c][1] = below.imag();
      step[c][0] = column.Step.real();
      step[c][1] = column.Step.imag();
    }
    this->Sums.Run<K>(this->Parallel, n, k,
      [&, k](Index i, double* sums)
      {
        for (int c = 0; c < k; ++c)
        {
          const double w = this->W(i, c);
          const double p = this->P(i, c);
          const double q = this->Q(i, c);
          const double newP = unit[c] * w - factor[c][0] * p + factor[c][1] * q;
          const double newQ = -factor[c][0] * q - factor[c][1] * p;
          const double next =
            unit[c] * this->Product(i, c) - alpha[c] * w - beta[c] * this->LastW(i, c);
          this->P(i, c) = newP;
          this->Q(i, c) = newQ;
          u(i, c) += step[c][0] * newP - step[c][1] * newQ;
          this->LastW(i, c) = next;
          sums[c] += next * next;
        }
      });
    std::swap(this->W, this->LastW);
    for (int c = 0; c < k; ++c)
    {
      Column& column = columns[c];
      column.LastUnit = column.Unit;
      column.Beta = std::sqrt(this->Sums[c]);
      column.Unit = column.Beta > 0.0 ? 1.0 / column.Beta : 0.0;
      column.IsFinished =
        column.IsFinished || std::abs(column.Step) * column.Beta <= tolerance * column.Start;
    }
  }
  ForEach(this->Parallel, n,
    [&](Index i)
    {
      for (int c = 0; c < k; ++c)
      {
        u(i, c) *= scales[c] / this->Roots[i];
      }
    });
  progress.Report(1.0);
  return true;
}

} // namespace SurfaceDiffusion
