// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/ImplicitSystem.h"

#include "Core/Operators/SparsePattern.h"

namespace SurfaceDiffusion
{

void ImplicitSystem::Assemble(const Eigen::Ref<const Vector>& diagonal, double scale,
  const CornerWeights& coefficients, const double* weights, const CornerWeights* signs)
{
  if (!this->HasPattern)
  {
    this->Assembly->TakePattern(this->Matrix, this->Parallel);
    this->HasPattern = true; // last: a pattern that was aborted is taken again
  }
  this->Assembly->Fill(this->Matrix, diagonal, scale, coefficients, weights, this->Parallel, signs);
}

void ImplicitSystem::Assemble(
  const Eigen::Ref<const Vector>& diagonal, double scale, const SparseMatrix& stiffness)
{
  this->Matrix = stiffness;
  this->Matrix *= scale;
  this->AddToDiagonal(1.0, diagonal);
}

void ImplicitSystem::AddToDiagonal(double factor, const Vector& x)
{
  ForEach(this->Parallel, static_cast<Index>(x.size()),
    [&](Index i) { this->Matrix.coeffRef(i, i) += factor * x[i]; });
}

void ImplicitSystem::Constrain(const Flags& fixed, const Values& values)
{
  this->Load.resize(values.rows(), values.cols());
  this->Assembly->Constrain(this->Matrix, fixed, values, this->Load, this->Parallel);
  this->FixedRows.clear();
  this->CoupledRows.clear();
  for (Index i = 0; i < static_cast<Index>(fixed.size()); ++i)
  {
    if (fixed[i])
    {
      this->FixedRows.push_back(i);
    }
    else if (!this->Load.row(i).isZero(0.0))
    {
      this->CoupledRows.push_back(i);
    }
  }
  this->FixedValues.resize(static_cast<Eigen::Index>(this->FixedRows.size()), values.cols());
  for (Eigen::Index f = 0; f < this->FixedValues.rows(); ++f)
  {
    this->FixedValues.row(f) = values.row(this->FixedRows[f]);
  }
}

void ImplicitSystem::SetUpSolver(const ProgressMonitor& progress)
{
  this->Solver->SetMatrix(this->Matrix, progress);
}

void ImplicitSystem::Solve(
  Values& b, Values& u, StepReport& report, const ProgressMonitor& progress, Eigen::Index first)
{
  for (const Index i : this->FixedRows)
  {
    b.row(i) = this->Load.row(i).segment(first, b.cols());
  }
  for (const Index i : this->CoupledRows)
  {
    b.row(i) += this->Load.row(i).segment(first, b.cols());
  }
  const SolveReport solve = this->Solver->Solve(b, u, progress);
  RequireAnswer(solve, this->Solver->GetLimits());
  report.Add(solve);
  for (Eigen::Index f = 0; f < this->FixedValues.rows(); ++f)
  {
    // to the last bit
    u.row(this->FixedRows[f]) = this->FixedValues.row(f).segment(first, u.cols());
  }
}

double ImplicitSystem::Product(Index i, const Values& u) const
{
  double sum = this->Load.rows() > 0 ? -this->Load(i, 0) : 0.0;
  for (SparseMatrix::InnerIterator a(this->Matrix, i); a; ++a)
  {
    sum += a.value() * u(a.index(), 0);
  }
  return sum;
}

} // namespace SurfaceDiffusion
