// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/TotalVariationFlow.h"

#include "Core/Models/InitialState.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace SurfaceDiffusion
{

namespace
{

/// The largest max - min over the columns; 1 for constants and without values.
double ValueRange(const Values& u, const Reduction& reduction)
{
  constexpr double none = -std::numeric_limits<double>::infinity();
  Eigen::RowVectorXd high = Eigen::RowVectorXd::Constant(u.cols(), none);
  Eigen::RowVectorXd minusLow = high;
  if (u.rows() > 0)
  {
    high = u.colwise().maxCoeff();
    minusLow = -u.colwise().minCoeff();
  }
  reduction.Max(high.data(), static_cast<Index>(u.cols()));
  reduction.Max(minusLow.data(), static_cast<Index>(u.cols()));
  const double range = u.cols() > 0 ? (high + minusLow).maxCoeff() : 0.0;
  return range > 0.0 ? range : 1.0;
}

} // namespace

TotalVariationFlow::TotalVariationFlow(std::shared_ptr<const Assembler> assembler,
  const TangentVectors& frames, PointData data, const Settings& settings,
  const ParallelFor& parallel)
  : StateModel(data.Start)
  , Assembly(std::move(assembler))
  , Data(std::move(data))
  , Fit(this->Data, { settings.Fidelity, settings.Norm, settings.Coupling })
  , Options(settings)
  , Parallel(parallel)
  , Diffusivity(std::max(settings.AlongDiffusivity, settings.AcrossDiffusivity))
  , Target(this->Data.Given)
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  if (this->Fit.CanConserve())
  {
    this->Conserved = TotalCorrection(mesh, this->Data, this->Fit.IsPresent(), parallel);
  }
  if (settings.SteadyState)
  {
    FixFreeComponents(mesh, this->Data, settings.Fidelity);
  }

  double along = settings.AlongDiffusivity / this->Diffusivity;
  double across = settings.AcrossDiffusivity / this->Diffusivity;
  if (GetEdgeFunction(settings.Function.Kind).Dimensionless)
  {
    along = std::sqrt(along);
    across = std::sqrt(across);
  }
  std::vector<GradientMap> gradients = frames.rows() > 0
    ? StretchedGradients(mesh, frames, along, across, parallel)
    : PlainGradients(mesh, parallel);

  // The minimiser's energy is E over Diffusivity, the step's term with it.
  const Index n = mesh.NumberOfVertices();
  const double inertia = settings.SteadyState ? 0.0 : 1.0 / (settings.TimeStep * this->Diffusivity);
  Vector quadratic(n);
  Vector absolute(n);
  ForEach(parallel, n,
    [&](Index i)
    {
      const double fidelity = this->Fit.Weight(i) / this->Diffusivity;
      const bool squared = settings.Norm == FidelityNorm::L2;
      quadratic[i] = inertia + (squared ? fidelity : 0.0);
      absolute[i] = squared ? 0.0 : fidelity;
    });
  TotalVariationMinimizer::Settings minimizer;
  minimizer.Function = settings.Function;
  minimizer.Coupling = settings.Coupling;
  minimizer.Range = ValueRange(this->Data.Start, mesh.GetReduction());
  minimizer.StopTolerance = settings.StopTolerance;
  minimizer.MaximumNumberOfIterations = settings.MaximumNumberOfIterations;
  this->Minimizer = std::make_unique<TotalVariationMinimizer>(this->Assembly, std::move(gradients),
    std::move(quadratic), std::move(absolute), this->Data.Fixed, minimizer, parallel);
}

StepReport TotalVariationFlow::Advance(const ProgressMonitor& progress)
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  if (this->Options.SteadyState)
  {
    ForEach(this->Parallel, mesh.NumberOfVertices(),
      [&](Index i)
      {
        if (this->Data.Fixed[i])
        {
          this->U.row(i) = this->Data.Start.row(i);
        }
      });
  }
  else
  {
    // lambda/2 |u - f|^2 + |u - u_old|^2/(2 dt) has its minimum at their weighted mean.
    const bool squared = this->Options.Norm == FidelityNorm::L2;
    ForEach(this->Parallel, mesh.NumberOfVertices(),
      [&](Index i)
      {
        const double pull = squared ? this->Options.TimeStep * this->Fit.Weight(i) : 0.0;
        this->Target.row(i) =
          this->U.row(i) + (pull / (1.0 + pull)) * (this->Data.Given.row(i) - this->U.row(i));
      });
  }
  const TotalVariationMinimizer::Report result =
    this->Minimizer->Minimize(this->Target, this->Data.Given, this->U, progress);
  this->Conserved.Restore(mesh, this->U, this->Parallel);
  StepReport report;
  report.Iterations = result.Iterations;
  report.Residual = result.Gap;
  return report;
}

double TotalVariationFlow::Energy() const
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  return this->Diffusivity * this->Minimizer->GradientEnergy(this->U) +
    mesh.GetReduction().Sum(this->Fit.Energy(mesh, this->U, this->Parallel));
}

} // namespace SurfaceDiffusion
