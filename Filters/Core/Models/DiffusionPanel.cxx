// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/DiffusionPanel.h"

#include "Core/Foundation/Columns.h"
#include "Core/Foundation/Resize.h"
#include "Core/Operators/ExponentialSeries.h"
#include "Core/Operators/Assembler.h"

#include <cstddef>

namespace SurfaceDiffusion
{

DiffusionPanel::DiffusionPanel(const TriangleMesh& mesh, const PointData& data, const Fidelity& fit,
  const Values& start, const ParallelFor& parallel)
  : Mesh(mesh)
  , Data(data)
  , Fit(fit)
  , Parallel(parallel)
{
  FindMeans(mesh, start, this->Origin, parallel);
}

void DiffusionPanel::StartStage(
  const Values& u, Eigen::Index first, Eigen::Index count, double inertia, double dt)
{
  this->FirstColumn = first;
  this->Solution.resize(u.rows(), count);
  this->RightHandSide.resize(u.rows(), count);
  ForColumns(count, [&](auto number) { this->FillFirst<decltype(number)::value>(u, inertia, dt); });
}

void DiffusionPanel::StartSecondStage(const Values& u, double ratio, double dt)
{
  ForColumns(this->Solution.cols(),
    [&](auto number) { this->FillSecond<decltype(number)::value>(u, ratio, dt); });
}

/// Solution is (1 + ratio) y - ratio u, and M multiplies u + ratio (y - u).
void DiffusionPanel::AddMassOfSecondStage(
  const SparseMatrix& difference, const Values& u, double ratio)
{
  if (difference.rows() == 0)
  {
    return;
  }
  const auto columns = this->Solution.cols();
  const auto before = u.middleCols(this->FirstColumn, columns).rowwise() -
    this->Origin.segment(this->FirstColumn, columns);
  this->AddProduct(difference, (ratio * this->Solution + before) / (1.0 + ratio));
}

void DiffusionPanel::AddProduct(const SparseMatrix& matrix, const Values& x)
{
  if (matrix.rows() == 0)
  {
    return;
  }
  Resize(this->Product, x.rows(), x.cols());
  Multiply(matrix, x, this->Product, this->Parallel);
  ForEach(this->Parallel, static_cast<Index>(x.rows()),
    [&](Index i) { this->RightHandSide.row(i) += this->Product.row(i); });
}

void DiffusionPanel::StartSeries()
{
  this->LastTerm = this->Solution;
  this->TermBefore = this->Solution;
  this->Sum = ExponentialSeries::Coefficients[0] * this->Solution;
}

void DiffusionPanel::AddTerm(int k, double dt)
{
  ForColumns(
    this->Solution.cols(), [&](auto number) { this->FillTerm<decltype(number)::value>(k, dt); });
  this->LastTerm.swap(this->TermBefore);
  if (k == ExponentialSeries::Degree)
  {
    this->Solution.swap(this->Sum);
    this->Shifts.setZero();
  }
}

void DiffusionPanel::Correct(MeanCorrection& correction)
{
  correction.FindShifts(
    this->Mesh, this->RightHandSide, this->Solution, this->Parallel, this->Shifts);
}

void DiffusionPanel::Finish(TotalCorrection& conserved, Values& u)
{
  ForColumns(
    this->Solution.cols(), [&](auto number) { this->AddShifts<decltype(number)::value>(); });
  conserved.FindShifts(this->Mesh, this->Solution, this->Parallel, this->FirstColumn, this->Shifts);
  ForColumns(this->Solution.cols(), [&](auto number) { this->Store<decltype(number)::value>(u); });
}

template <int K>
void DiffusionPanel::FillFirst(const Values& u, double inertia, double dt)
{
  const ColumnCount<K> columns(this->Solution.cols());
  const Eigen::Index first = this->FirstColumn;
  const double* const origin = this->FirstOrigin();
  ForEach(this->Parallel, this->Mesh.NumberOfVertices(),
    [&](Index i)
    {
      const double area = this->Mesh.ControlAreas()[i];
      const double source = dt * this->Fit.Weight(i);
      const double* const value = &u(i, first);
      double* const v = &this->Solution(i, 0);
      double* const b = &this->RightHandSide(i, 0);
      for (int k = 0; k < columns; ++k)
      {
        v[k] = value[k] - origin[k];
        b[k] = area * (inertia * v[k]);
      }
      if (source > 0.0) // f is not read without a weight, which would cost many columns time
      {
        for (int k = 0; k < columns; ++k)
        {
          b[k] = area * (inertia * v[k] + source * (this->Data.Given(i, first + k) - origin[k]));
        }
      }
    });
}

template <typename Body>
void DiffusionPanel::ForEachShifted(const Body& body) const
{
  for (Index c = 0; c < this->Mesh.NumberOfComponents(); ++c)
  {
    const Index begin = this->Mesh.ComponentsBegin()[c];
    const double* const shifts =
      this->Shifts.data() + static_cast<std::ptrdiff_t>(c) * this->Shifts.cols();
    ForEach(this->Parallel, this->Mesh.ComponentsBegin()[c + 1] - begin,
      [&](Index i) { body(begin + i, shifts); });
  }
}

template <int K>
void DiffusionPanel::FillSecond(const Values& u, double ratio, double dt)
{
  const ColumnCount<K> columns(this->Solution.cols());
  const Eigen::Index first = this->FirstColumn;
  const double* const origin = this->FirstOrigin();
  this->ForEachShifted(
    [&](Index i, const double* shifts)
    {
      const double area = this->Mesh.ControlAreas()[i];
      const double source = dt * this->Fit.Weight(i);
      const double* const value = &u(i, first);
      double* const v = &this->Solution(i, 0);
      double* const b = &this->RightHandSide(i, 0);
      for (int k = 0; k < columns; ++k)
      {
        const double previous = value[k] - origin[k];
        const double later = ratio * (v[k] + shifts[k] - previous);
        b[k] = previous + later;
        v[k] += shifts[k] + later;
      }
      if (source > 0.0)
      {
        for (int k = 0; k < columns; ++k)
        {
          b[k] += source * (this->Data.Given(i, first + k) - origin[k]);
        }
      }
      for (int k = 0; k < columns; ++k)
      {
        b[k] *= area;
      }
    });
}

/// Writes T_k over T_(k-2).
template <int K>
void DiffusionPanel::FillTerm(int term, double dt)
{
  const ColumnCount<K> columns(this->Solution.cols());
  const Eigen::Index first = this->FirstColumn;
  const double* const origin = this->FirstOrigin();
  const double coefficient = ExponentialSeries::Coefficients[static_cast<std::size_t>(term)];
  this->ForEachShifted(
    [&](Index i, const double* shifts)
    {
      double* const v = &this->Solution(i, 0);
      const double* const last = &this->LastTerm(i, 0);
      double* const before = &this->TermBefore(i, 0);
      double* const sum = &this->Sum(i, 0);
      for (int k = 0; k < columns; ++k)
      {
        v[k] = ExponentialSeries::NextTerm(term, v[k] + shifts[k], last[k], before[k]);
        before[k] = v[k];
        sum[k] += coefficient * v[k];
      }
      if (term == ExponentialSeries::Degree)
      {
        return;
      }
      const double area = this->Mesh.ControlAreas()[i];
      const double source = dt * this->Fit.Weight(i);
      double* const b = &this->RightHandSide(i, 0);
      for (int k = 0; k < columns; ++k)
      {
        b[k] = area * v[k];
      }
      if (source > 0.0)
      {
        for (int k = 0; k < columns; ++k)
        {
          b[k] += area * source * (this->Data.Given(i, first + k) - origin[k]);
        }
      }
    });
}

template <int K>
void DiffusionPanel::AddShifts()
{
  const ColumnCount<K> columns(this->Solution.cols());
  const double* const origin = this->FirstOrigin();
  this->ForEachShifted(
    [&](Index i, const double* shifts)
    {
      double* const v = &this->Solution(i, 0);
      if (this->Data.Fixed[i])
      {
        CopyColumns<K>(&this->Data.Start(i, this->FirstColumn), v, columns);
        return;
      }
      for (int k = 0; k < columns; ++k)
      {
        v[k] = v[k] + shifts[k] + origin[k];
      }
    });
}

template <int K>
void DiffusionPanel::Store(Values& u)
{
  const ColumnCount<K> columns(this->Solution.cols());
  this->ForEachShifted(
    [&](Index i, const double* shifts)
    {
      const double* const v = &this->Solution(i, 0);
      double* const value = &u(i, this->FirstColumn);
      for (int k = 0; k < columns; ++k)
      {
        value[k] = v[k] + shifts[k];
      }
    });
}

} // namespace SurfaceDiffusion
