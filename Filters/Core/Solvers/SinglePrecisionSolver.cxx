// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/SinglePrecisionSolver.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace SurfaceDiffusion
{

namespace
{

/// p.Ap / p.p below which products in single precision have no digit left.
constexpr double SmallestResolved = 1e-6;

} // namespace

void SinglePrecisionSolver::SetMatrix(
  const SparseMatrix& matrix, const Vector& inverseDiagonal, StrongLines& lines)
{
  this->Roots.resize(inverseDiagonal.size());
  ForEach(this->Parallel, static_cast<Index>(inverseDiagonal.size()),
    [&](Index i) { this->Roots[i] = std::sqrt(inverseDiagonal[i]); });
  this->Matrix.Set(matrix, this->Roots);
  this->Lines = lines.IsEmpty() ? nullptr : &lines;
  const std::vector<Index>& vertices = lines.Vertices();
  this->PlacesOnLines.reserve(vertices.capacity());
  this->PlacesOnLines.resize(vertices.size());
  ForEach(this->Parallel, static_cast<Index>(vertices.size()),
    [&](Index k) { this->PlacesOnLines[k] = this->Matrix.PlacesOfRows()[vertices[k]]; });
}

/// act(group, solved) for the groups in which a column is to be solved.
template <typename Act>
void SinglePrecisionSolver::ForGroups(std::vector<Column>& columns, const Act& act)
{
  const auto count = static_cast<int>(columns.size());
  const std::size_t rows = this->Matrix.PaddedRows();
  this->P.resize(rows * count);
  for (std::vector<float>* vector : { &this->R, &this->Q, &this->Y })
  {
    vector->resize(rows * std::min(count, Group::Most));
  }
  for (int first = 0; first < count; first += Group::Most)
  {
    const Group group{ columns.data() + first, first, std::min(Group::Most, count - first) };
    bool solved[Group::Most];
    bool isIdle = true;
    for (int c = 0; c < group.Count; ++c)
    {
      solved[c] = group.Columns[c].Reduction < 1.0;
      isIdle = isIdle && !solved[c];
    }
    if (!isIdle)
    {
      act(group, solved);
    }
  }
}

int SinglePrecisionSolver::Correct(const Values& r, std::vector<Column>& columns,
  int maximumNumberOfIterations, Values& x, const ProgressMonitor& progress,
  ConvergenceForecast* forecast)
{
  const auto count = static_cast<double>(columns.size());
  int iterations = 0;
  const ConvergenceForecast* const before = forecast;
  std::optional<ConvergenceForecast> ofGroup, hardest;
  this->ForGroups(columns,
    [&](const Group& group, bool* solved)
    {
      if (hardest && hardest->IsHopeless())
      {
        return;
      }
      if (before)
      {
        ofGroup = *before;
      }
      this->Take(r, group);
      iterations = std::max(iterations,
        this->Iterate(group, maximumNumberOfIterations, solved,
          progress.Part(group.First / count, (group.First + group.Count) / count),
          ofGroup ? &*ofGroup : nullptr));
      this->Add(group, solved, x, nullptr);
      if (ofGroup && (!hardest || ofGroup->Largest() > hardest->Largest()))
      {
        hardest = ofGroup;
      }
    });
  if (hardest)
  {
    *forecast = *hardest;
  }
  return iterations;
}

bool SinglePrecisionSolver::Descend(Values& r, const std::vector<double>& lengths, double reduction,
  int maximumNumberOfIterations, Values& x)
{
  this->Descents.assign(lengths.size(), Column());
  for (std::size_t c = 0; c < lengths.size(); ++c)
  {
    this->Descents[c].Length = lengths[c];
    this->Descents[c].Reduction = lengths[c] > 0.0 ? reduction : 1.0;
  }
  bool isResolved = true;
  this->ForGroups(this->Descents,
    [&](const Group& group, bool* solved)
    {
      this->Take(r, group);
      this->Iterate(group, maximumNumberOfIterations, solved, ProgressMonitor(), nullptr);
      this->Add(group, solved, x, &r);
      for (int c = 0; c < group.Count; ++c)
      {
        isResolved = isResolved && (solved[c] || group.Columns[c].Reduction == 1.0);
      }
    });
  return isResolved;
}

/// R = D^-1/2 r, P = B R + beta P, Y = 0.
void SinglePrecisionSolver::Take(const Values& r, const Group& group)
{
  double scale[Group::Most];
  bool solved[Group::Most];
  double products[Group::Most] = {};
  for (int c = 0; c < group.Count; ++c)
  {
    Column& column = group.Columns[c];
    scale[c] = 0.0;
    solved[c] = column.Reduction < 1.0;
    if (solved[c])
    {
      column.FirstLength = column.FirstLength > 0.0 ? column.FirstLength : column.Length;
      scale[c] = 1.0 / column.FirstLength;
      column.Square = std::pow(column.Length * scale[c], 2.0);
    }
  }
  const std::vector<Index>& rows = this->Matrix.RowsInOrder();
  ForEach(this->Parallel, static_cast<Index>(rows.size()),
    [&](Index place)
    {
      const Index row = rows[place];
      for (int c = 0; c < group.Count; ++c)
      {
        const std::size_t at = c * rows.size() + place;
        const bool takesPart = row >= 0 && solved[c];
        this->R[at] = takesPart
          ? static_cast<float>(this->Roots[row] * r(row, group.First + c) * scale[c])
          : 0.0F;
        this->Y[at] = 0.0F;
      }
    });
  this->CorrectByLines(group, solved, products);
  this->OverProcesses.Sum(products, group.Count);
  float beta[Group::Most] = {};
  for (int c = 0; c < group.Count; ++c)
  {
    Column& column = group.Columns[c];
    if (solved[c])
    {
      const double last = column.Rho;
      column.Rho = column.Square + products[c];
      const double turn = last > 0.0 ? column.Rho / last : 0.0;
      beta[c] = static_cast<float>(turn);
      column.DirectionSquare = column.Rho + turn * turn * column.DirectionSquare;
    }
  }
  float* const directions = this->P.data() + static_cast<std::size_t>(group.First) * rows.size();
  ForEach(this->Parallel, static_cast<Index>(rows.size()),
    [&](Index place)
    {
      for (int c = 0; c < group.Count; ++c)
      {
        const std::size_t at = c * rows.size() + place;
        if (solved[c])
        {
          directions[at] = beta[c] > 0.0F ? this->R[at] + beta[c] * directions[at] : this->R[at];
        }
      }
    });
  this->AddCorrections(group, solved);
}

/// Reduce the residuals of the columns that are to be solved, or find that they cannot be.
int SinglePrecisionSolver::Iterate(const Group& group, int maximumNumberOfIterations, bool* solved,
  const ProgressMonitor& progress, ConvergenceForecast* forecast)
{
  const int count = group.Count;
  float* const p =
    this->P.data() + static_cast<std::size_t>(group.First) * this->Matrix.PaddedRows();
  bool active[Group::Most];
  double goals[Group::Most] = {};
  double sums[Group::Most] = {};
  double products[Group::Most] = {};
  float alpha[Group::Most] = {};
  float beta[Group::Most] = {};
  for (int c = 0; c < count; ++c)
  {
    const Column& column = group.Columns[c];
    active[c] = solved[c];
    goals[c] = std::pow(column.Reduction, 2.0) * column.Square;
  }
  int iterations = 0;
  for (bool isFinished = false; !isFinished && iterations < maximumNumberOfIterations;)
  {
    ++iterations;
    this->Matrix.Multiply(count, p, this->Q.data(), sums);
    double onLines[Group::Most];
    std::copy_n(this->SquaresOnLines.begin(), count, onLines);
    this->Accumulate(count, p, sums, onLines);
    for (int c = 0; c < count; ++c)
    {
      const Column& column = group.Columns[c];
      const double step = active[c] ? column.Rho / sums[c] : 0.0;
      // Elsewhere B is the identity, so that p.p is at most this.
      const bool isBounded = sums[c] > SmallestResolved * (column.DirectionSquare + onLines[c]);
      solved[c] = solved[c] && (!active[c] || (isBounded && std::isfinite(step)));
      active[c] = active[c] && solved[c];
      alpha[c] = active[c] ? static_cast<float>(step) : 0.0F;
    }
    this->Matrix.Subtract(count, alpha, this->Q.data(), this->R.data(), sums);
    this->CorrectByLines(group, active, products);
    this->CountOnce(count, this->R.data(), sums, products);
    double done = 0.99;
    double residual = 0.0;
    isFinished = true;
    for (int c = 0; c < count; ++c)
    {
      Column& column = group.Columns[c];
      if (active[c])
      {
        // The residual falls by about a constant factor per iteration.
        const double left = std::log(goals[c] / sums[c]) / std::log(column.Reduction);
        done = std::min(done, 1.0 + 0.5 * left);
        active[c] = sums[c] > goals[c];
        const double rho = sums[c] + products[c];
        const double turn = rho / column.Rho;
        beta[c] = static_cast<float>(turn);
        if (active[c])
        {
          column.Square = sums[c];
          column.Rho = rho;
          // B r and the last direction are orthogonal in B^-1.
          column.DirectionSquare = rho + turn * turn * column.DirectionSquare;
        }
        isFinished = isFinished && !active[c];
        column.Reached = std::sqrt(sums[c]) * column.FirstLength;
        residual = std::max(residual, column.Reached / column.ReferenceLength);
      }
    }
    isFinished = (forecast && forecast->Update(iterations, residual)) || isFinished;
    this->Matrix.Turn(count, alpha, beta, active, this->R.data(), this->Y.data(), p);
    this->AddCorrections(group, active);
    if (iterations % 8 == 0)
    {
      progress.Report(std::max(0.0, done));
    }
  }
  progress.Report(1.0);
  return iterations;
}

/// Corrections = B R - R on lines; products[c] = R . (B R - R) of the process.
void SinglePrecisionSolver::CorrectByLines(const Group& group, const bool* solved, double* products)
{
  const std::size_t count = this->PlacesOnLines.size();
  this->Corrections.reserve(this->PlacesOnLines.capacity() * group.Count);
  this->Corrections.resize(count * group.Count);
  for (int c = 0; c < group.Count; ++c)
  {
    products[c] = this->Lines && solved[c]
      ? this->Lines->Correct(this->PlacesOnLines, &this->R[c * this->Matrix.PaddedRows()],
          &this->Corrections[c * count])
      : 0.0;
  }
}

/// P += B R - R, and SquaresOnLines, of the process.
void SinglePrecisionSolver::AddCorrections(const Group& group, const bool* goesOn)
{
  const std::size_t count = this->PlacesOnLines.size();
  float* const p =
    this->P.data() + static_cast<std::size_t>(group.First) * this->Matrix.PaddedRows();
  this->SquaresOnLines.assign(Group::Most, 0.0);
  for (int c = 0; c < group.Count; ++c)
  {
    if (goesOn[c])
    {
      this->SquaresOnLines[c] = Sum(this->Parallel, static_cast<Index>(count),
        [&](Index k)
        {
          float& entry = p[c * this->Matrix.PaddedRows() + this->PlacesOnLines[k]];
          entry += this->Corrections[c * count + k];
          return static_cast<double>(entry) * entry;
        });
    }
  }
}

/// x += D^-1/2 Y, and r = D^1/2 R unless it is null.
void SinglePrecisionSolver::Add(const Group& group, const bool* solved, Values& x, Values* r)
{
  const std::vector<Index>& rows = this->Matrix.RowsInOrder();
  ForEach(this->Parallel, static_cast<Index>(rows.size()),
    [&](Index place)
    {
      const Index row = rows[place];
      for (int c = 0; row >= 0 && c < group.Count; ++c)
      {
        if (solved[c])
        {
          const Column& column = group.Columns[c];
          const double y = this->Y[c * rows.size() + place];
          x(row, group.First + c) += column.Unit * (column.FirstLength * this->Roots[row] * y);
          if (r)
          {
            (*r)(row, group.First + c) =
              column.FirstLength / this->Roots[row] * this->R[c * rows.size() + place];
          }
        }
      }
    });
}

} // namespace SurfaceDiffusion
