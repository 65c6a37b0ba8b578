// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/TikhonovDeblurring.h"

#include "Core/Models/InitialState.h"
#include "Core/Operators/DirichletEnergy.h"
#include "Core/Operators/SparsePattern.h"
#include "Core/Operators/SparseProduct.h"
#include "Core/Solvers/ConjugateGradients.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// K + lambda M H w chi H with homogeneous Dirichlet conditions, preconditioned with
/// (K + lambda w' M)^-1.
struct DeblurringSystem : SystemDefaults
{
  const SparseMatrix& Stiffness;
  const Flags& Fixed;
  const Vector& InverseDiagonal;
  LinearSolver& Solver;
  const std::function<void(Values&)>& MakeProduct; ///< v becomes lambda M H w chi H v
  Values& Product; ///< work

  bool HasPreconditioner() const { return true; }
  void Precondition(const Values& r, const std::vector<double>& /*squares*/, Values& z) const
  {
    this->Solver.Precondition(r, z);
  }
  void PrepareProduct(const Values& x) const
  {
    this->Product = x;
    this->MakeProduct(this->Product);
  }
  template <int K>
  void MultiplyRows(const Values& x, Values& y, Index begin, Index end) const
  {
    SurfaceDiffusion::MultiplyRows<K>(this->Stiffness, x, y, begin, end);
    y.middleRows(begin, end - begin) += this->Product.middleRows(begin, end - begin);
  }
  double Scale(Index i, int c, const double* r) const { return this->InverseDiagonal[i] * r[c]; }
  template <int K>
  void Project(Index i, double* row) const
  {
    if (this->Fixed[i])
    {
      std::fill_n(row, ColumnCount<K>(this->Product.cols()), 0.0);
    }
  }
};

} // namespace

TikhonovDeblurring::TikhonovDeblurring(std::shared_ptr<const Assembler> assembler,
  CornerWeights coefficients, PointData data, double fidelity, std::unique_ptr<HeatBlur> blur,
  std::shared_ptr<LinearSolver> solver, const IterationLimits& limits, const ParallelFor& parallel,
  std::shared_ptr<DeblurringSpace> space)
  : StateModel(data.Start)
  , Assembly(std::move(assembler))
  , Coefficients(std::move(coefficients))
  , Data(std::move(data))
  , Fit(this->Data, { fidelity })
  , FidelityWeight(fidelity)
  , Blur(std::move(blur))
  , Solver(std::move(solver))
  , Limits(limits)
  , Parallel(parallel)
  , Conserved(this->Assembly->Mesh(), this->Data, true, parallel)
  , Shared(std::move(space))
{
  FixFreeComponents(this->Assembly->Mesh(), this->Data, fidelity);
}

void TikhonovDeblurring::Prepare(const ProgressMonitor& progress)
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  const Index n = mesh.NumberOfVertices();
  double factors = 0.0;
  for (Index i = 0; i < n; ++i)
  {
    factors += mesh.ControlAreas()[i] * this->Data.FidelityFactor(i);
  }
  const double area = mesh.ControlAreas().sum();
  const double mean = factors > 0.0 ? factors / area : 1.0;
  this->Assembly->TakePattern(this->Stiffness, this->Parallel);
  this->Assembly->TakePattern(this->Preconditioner, this->Parallel);
  this->Assembly->Fill(
    this->Stiffness, Vector::Zero(n), 1.0, this->Coefficients, nullptr, this->Parallel);
  this->Assembly->Fill(this->Preconditioner, (this->FidelityWeight * mean) * mesh.ControlAreas(),
    1.0, this->Coefficients, nullptr, this->Parallel);
  this->InverseDiagonal = this->Preconditioner.diagonal().cwiseInverse();
  this->Blur->Prepare(progress);
  this->Prepared = true; // last: a preparation that was aborted is repeated
}

void TikhonovDeblurring::ApplyAdjoint(Values& v, StepReport& report) const
{
  this->Blur->ApplyToWeighted(this->Fit, v, report);
  ForEach(this->Parallel, static_cast<Index>(v.rows()),
    [&](Index i) { v.row(i) *= this->Assembly->Mesh().ControlAreas()[i]; });
}

bool TikhonovDeblurring::IsFunction() const
{
  // Of steps that move nothing, or all, round-off hides the function.
  constexpr double least = 1e-3, most = 1e3; // in squares of h
  const double h = this->Assembly->Mesh().MeanEdgeLength();
  const double step = this->Blur->StepTime() / (h * h);
  return this->Shared && step >= least && step <= most && this->Data.FidelityFactors.size() == 0 &&
    !this->Data.Missing.any() && !this->Data.Fixed.any();
}

/// x = u for data f, both without a mean.
SolveReport TikhonovDeblurring::ApplyFunction(
  const Values& f, Values& x, StepReport& blurs, const ProgressMonitor& progress)
{
  constexpr int most = 96; // columns of the space: beyond, conjugate gradients take less memory
  DeblurringSpace& shared = *this->Shared;
  // Models of other weights share the solver, and its matrix may be that of one that is gone.
  this->Blur->Prepare(progress.Part(0.0, 0.0));
  if (!shared.Space || shared.Data.cols() != f.cols() || shared.Data != f)
  {
    shared.Space.emplace(this->Assembly->Mesh(), this->Blur->StepTime(), f, this->Parallel);
    shared.Data = f;
  }
  IterationLimits limits = this->Limits;
  limits.MaximumNumberOfIterations = std::min(most, limits.MaximumNumberOfIterations);
  const auto function = [&](double l)
  {
    const double h = std::pow(1.0 + this->Blur->StepTime() * l, -this->Blur->NumberOfSteps());
    return this->FidelityWeight * h / (shared.Diffusivity * l + this->FidelityWeight * h * h);
  };
  return shared.Space->Apply(
    function, [&](Values& y, const ProgressMonitor& part) { this->Blur->Step(y, blurs, part); },
    limits, x, progress);
}

StepReport TikhonovDeblurring::Advance(const ProgressMonitor& progress)
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  // Values are measured from the mean: the errors of a solve are relative to the contrast then.
  Eigen::RowVectorXd origin;
  FindMeans(mesh, this->Data.Start, origin, this->Parallel);
  StepReport report;
  StepReport blurs;
  Values x;
  SolveReport solve;
  solve.Converged = false;
  if (this->IsFunction())
  {
    solve =
      this->ApplyFunction(this->Data.Given.rowwise() - origin, x, blurs, progress.Part(0.0, 1.0));
  }
  if (!solve.Converged)
  {
    solve = this->Iterate(origin, x, blurs, progress);
  }
  report.Add(solve);
  report.MissedResidual = std::max(report.MissedResidual, blurs.MissedResidual);
  this->U = x.rowwise() + origin;
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      if (this->Data.Fixed[i])
      {
        this->U.row(i) = this->Data.Start.row(i);
      }
    });
  this->Conserved.Restore(mesh, this->U, this->Parallel);
  return report;
}

/// By conjugate gradients.
SolveReport TikhonovDeblurring::Iterate(
  const Eigen::RowVectorXd& origin, Values& x, StepReport& blurs, const ProgressMonitor& progress)
{
  if (!this->Prepared)
  {
    this->Prepare(progress.Part(0.0, 0.15));
  }
  this->Solver->SetMatrix(this->Preconditioner, progress.Part(0.15, 0.3)); // others may share it
  x = this->Data.Start.rowwise() - origin;
  SolveReport solve =
    this->Solve(this->Data.Given.rowwise() - origin, x, blurs, progress.Part(0.3, 1.0));
  RequireAnswer(solve, this->Limits);
  return solve;
}

SolveReport TikhonovDeblurring::Solve(
  Values f, Values& x, StepReport& blurs, const ProgressMonitor& progress)
{
  return ForColumns(x.cols(),
    [&](auto k)
    { return this->SolveColumns<decltype(k)::value>(std::move(f), x, blurs, progress); });
}

/// residual: the data on entry. x: u, with the values of Dirichlet conditions in place. Both are
/// measured from the mean of u.
template <int K>
SolveReport TikhonovDeblurring::SolveColumns(
  Values residual, Values& x, StepReport& blurs, const ProgressMonitor& progress)
{
  const Index n = static_cast<Index>(x.rows());
  const std::function<void(Values&)> makeProduct = [&](Values& v)
  {
    this->Blur->Apply(v, blurs);
    this->ApplyAdjoint(v, blurs);
  };
  Values product;
  const DeblurringSystem system{ {}, this->Stiffness, this->Data.Fixed, this->InverseDiagonal,
    *this->Solver, makeProduct, product };
  const auto release = [&](Values& v)
  { ForEach(this->Parallel, n, [&](Index i) { system.template Project<K>(i, &v(i, 0)); }); };

  this->ApplyAdjoint(residual, blurs);
  ConjugateGradientWork work;
  work.Resize(n, static_cast<int>(x.cols()), static_cast<int>(x.cols()));
  for (Eigen::Index c = 0; c < x.cols(); ++c)
  {
    const double square = residual.col(c).cwiseAbs2().dot(this->InverseDiagonal);
    work.Reference[static_cast<std::size_t>(c)] = square > 0.0 ? square : 1.0;
  }
  system.PrepareProduct(x);
  residual -= product;
  Multiply(this->Stiffness, x, product, this->Parallel);
  residual -= product;
  release(residual);
  return ConjugateGradients<K, DeblurringSystem>(system, residual, work, this->Parallel)
    .Solve(x, this->Limits, progress);
}

double TikhonovDeblurring::Energy() const
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  Values blurred = this->U;
  StepReport unused;
  this->Blur->Apply(blurred, unused);
  return DirichletEnergy(mesh, this->Coefficients, this->U, this->Parallel) +
    this->Fit.Energy(mesh, blurred, this->Parallel);
}

DiffusionStep TikhonovDeblurring::Diffusion() const
{
  DiffusionStep step;
  step.TimeStep = InfiniteTime;
  step.Fidelity = this->FidelityWeight;
  return step;
}

} // namespace SurfaceDiffusion
