// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Fields/ResolventPower.h"

#include "Core/Foundation/ColumnPanels.h"
#include "Core/Foundation/Random.h"
#include "Core/Solvers/SolverChoice.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

int IntegerPower(double beta)
{
  return static_cast<int>(std::ceil(beta)) - 1;
}

/// Where e is the largest, all eigenvalues x are above it, and the variance is as (1 + e)^-nu, nu = 2 beta - 1:
/// up to there relative errors count.
double RelativeToVariance(double x, double beta, double extra)
{
  return std::pow(1.0 + std::min(x, extra), 2.0 * beta - 1.0);
}

/// Eigenvalues x count as the variance of the field has them, x^-nu for log x: of rough fields poles reach
/// the largest ones.
double LastPole(double beta, double smallest, double largest, double extra)
{
  const double last = std::max(smallest, std::min(2.5 / (2.0 * beta - 1.0), largest));
  return std::min(1e6, std::pow(10.0, last) * (1.0 + extra));
}

} // namespace

PoleSum PolesOfPower(double beta, double extra)
{
  const double rest = beta - IntegerPower(beta);
  if (rest == 1.0)
  {
    return { Vector::Ones(1), Vector::Ones(1) };
  }
  const auto g = [rest](double x) { return std::pow(1.0 + x, -rest); };
  // Between the relative error and that of the variance.
  const auto weight = [&](double x)
  {
    return std::sqrt(WeightOfEigenvalue(x) * RelativeToVariance(x, beta, extra)) *
      std::pow(1.0 + x, -beta) / g(x);
  };
  const int count = beta < 0.9 || extra > 0.0 ? 14 : 10;
  return FitPoles(g, 1.0, LastPole(beta, 2.0, 6.0, extra), count, weight, true);
}

PoleSum PolesOfSquaredPower(double beta, double extra)
{
  const int count = extra > 0.0 ? 28 : beta < 0.9 ? 16 : 12;
  return FitPoles([beta](double x) { return std::pow(1.0 + x, -2.0 * beta); }, 0.9,
    LastPole(beta, 0.5, 5.0, extra), count,
    [&](double x) { return WeightOfEigenvalue(x) * RelativeToVariance(x, beta, extra); });
}

ResolventPower::ResolventPower(std::shared_ptr<const Assembler> assembler,
  const CornerWeights& coefficients, double step, const Vector& extra, double beta,
  const ParallelFor& parallel)
  : Assembly(std::move(assembler))
  , Power(IntegerPower(beta))
  , Sum(PolesOfPower(beta, extra.size() > 0 ? extra.maxCoeff() : 0.0))
  , ArePrepared(static_cast<std::size_t>(this->Sum.Poles.size()), false)
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  const double h = mesh.MeanEdgeLength();
  this->Systems.reserve(this->ArePrepared.size());
  for (const double pole : this->Sum.Poles)
  {
    SolverTask task;
    task.NumberOfVertices = mesh.NumberOfVertices();
    task.DiffusionNumber = step / (pole * h * h);
    task.NumberOfColumns = ColumnPanel;
    this->Systems.emplace_back(
      this->Assembly, MakeSolver(SolverMethod::Automatic, task, parallel), parallel);
    Vector diagonal = pole * mesh.ControlAreas();
    if (extra.size() > 0)
    {
      diagonal += extra.cwiseProduct(mesh.ControlAreas());
    }
    this->Systems.back().Assemble(diagonal, step, coefficients);
  }
}

void ResolventPower::Apply(Values& u, const ProgressMonitor& progress)
{
  ForEachPanel(u, progress,
    [this](Values& panel, const ProgressMonitor& part) { this->ApplyToPanel(panel, part); });
}

void ResolventPower::ApplyToPanel(Values& u, const ProgressMonitor& progress)
{
  const auto poles = this->Systems.size();
  const auto all = static_cast<double>(poles) + this->Power;
  double done = 0.0;
  Values x;
  const auto solve = [&](std::size_t pole)
  {
    this->Solve(pole, u, x, progress.Part(done / all, (done + 1.0) / all));
    done += 1.0;
  };
  for (int k = 0; k < this->Power; ++k)
  {
    solve(0);
    u.swap(x);
  }
  Values sum = this->Sum.Constant * u;
  for (std::size_t pole = 0; pole < poles; ++pole)
  {
    solve(pole);
    sum += this->Sum.Residues[static_cast<Eigen::Index>(pole)] * x;
  }
  u.swap(sum);
}

void ResolventPower::Prepare(std::size_t pole, const ProgressMonitor& progress)
{
  if (this->ArePrepared[pole])
  {
    return;
  }
  ImplicitSystem& system = this->Systems[pole];
  system.SetUpSolver(progress.Part(0.0, 0.5));
  const Vector& areas = this->Assembly->Mesh().ControlAreas();
  Values noise(areas.size(), 1);
  for (Eigen::Index i = 0; i < noise.rows(); ++i)
  {
    noise(i, 0) = areas[i] * (UniformRandom(0, 0, i) - 0.5);
  }
  Values found = Values::Zero(noise.rows(), 1);
  StepReport report;
  system.Solve(noise, found, report, progress.Part(0.5, 1.0));
  this->ArePrepared[pole] = true;
}

void ResolventPower::Solve(
  std::size_t pole, const Values& b, Values& x, const ProgressMonitor& progress)
{
  ImplicitSystem& system = this->Systems[pole];
  this->Prepare(pole, progress.Part(0.0, 0.5));
  Values right = this->Assembly->Mesh().ControlAreas().asDiagonal() * b;
  x = b / this->Sum.Poles[static_cast<Eigen::Index>(pole)];
  system.Solve(right, x, this->Report, progress.Part(0.5, 1.0));
}

} // namespace SurfaceDiffusion
