// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/TotalVariation/TotalVariationFlow.h"

#include "Core/Models/InitialState.h"
#include "Core/Models/TotalVariation/GeneralizedVariationMinimizer.h"
#include "Core/Models/TotalVariation/TotalVariationMinimizer.h"
#include "Core/Operators/CotanWeights.h"
#include "Core/Statistics/ValueRange.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace SurfaceDiffusion
{

TotalVariationFlow::TotalVariationFlow(std::shared_ptr<const Assembler> assembler,
  const TangentVectors& frames, PointData data, const Settings& settings,
  const ParallelFor& parallel)
  : DataModel(std::move(data))
  , Assembly(std::move(assembler))
  , Frames(frames)
  , Fit(this->Data,
      { settings.Fidelity, settings.Norm, settings.Coupling, 0.0, false, settings.ChannelWeights })
  , Options(settings)
  , Parallel(parallel)
  , Diffusivity(std::max(settings.AlongDiffusivity, settings.AcrossDiffusivity))
  , Target(this->Data.Given)
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  if (this->Fit.CanConserve() && settings.ConservesTotal)
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
  const auto gradients =
    std::make_shared<const GradientMaps>(this->Assembly->SharedMesh(), frames, along, across);

  const Index n = mesh.NumberOfVertices();
  Vector absolute = Vector::Zero(n);
  if (settings.Norm == FidelityNorm::L1)
  {
    ForEach(parallel, n, [&](Index i) { absolute[i] = this->Fit.Weight(i) / this->Diffusivity; });
  }
  this->MeasureWeights();

  if (settings.SteadyState && settings.Norm == FidelityNorm::L1)
  {
    this->SteadyStart = WithoutOutliers(this->Data.Start, mesh.GetReduction());
  }
  const Values& values = this->SteadyStart.size() > 0 ? this->SteadyStart : this->Data.Start;
  const Eigen::Index all = this->U.cols();
  const Eigen::Index columns = settings.Coupling == ChannelCoupling::Joint ? all : 1;
  for (Eigen::Index first = 0; first < all; first += columns)
  {
    const auto start = values.middleCols(first, columns);
    VariationMinimizer::Settings minimizer;
    minimizer.Function = settings.Function;
    minimizer.Coupling = settings.Coupling;
    minimizer.Range = ValueRange(this->Data.Start.middleCols(first, columns), mesh.GetReduction());
    minimizer.StopTolerance = settings.StopTolerance;
    minimizer.MaximumNumberOfIterations = settings.MaximumNumberOfIterations;
    System system{ first, columns, nullptr };
    const Values quadratic = this->QuadraticWeights(first, columns);
    if (settings.GeneralizedLength > 0.0)
    {
      system.Minimizer =
        std::make_unique<GeneralizedVariationMinimizer>(this->Assembly, settings.GeneralizedLength,
          quadratic, absolute, this->Data.Fixed, start, minimizer, parallel);
    }
    else
    {
      system.Minimizer = std::make_unique<TotalVariationMinimizer>(this->Assembly, gradients,
        quadratic, absolute, this->Data.Fixed, start, minimizer, parallel);
    }
    this->Systems.push_back(std::move(system));
  }
  if (this->Systems.size() > 1)
  {
    this->ColumnU.resize(n, columns);
    this->ColumnTarget.resize(n, columns);
    this->ColumnGiven.resize(n, columns);
  }
}

void TotalVariationFlow::SetLimits(double stopTolerance, int maximumNumberOfIterations)
{
  for (const System& system : this->Systems)
  {
    system.Minimizer->SetLimits(stopTolerance, maximumNumberOfIterations);
  }
}

/// The weights mu of the quadratic terms: one column, or one for each of the `columns` from `first`
/// on if their fidelity differs. The minimiser's energy is E over Diffusivity, the step's term with
/// it.
Values TotalVariationFlow::QuadraticWeights(Eigen::Index first, Eigen::Index columns) const
{
  const bool differ = columns > 1 && !this->Options.ChannelWeights.empty();
  const double inertia =
    this->Options.SteadyState ? 0.0 : 1.0 / (this->Options.TimeStep * this->Diffusivity);
  Values quadratic =
    Values::Constant(this->Assembly->Mesh().NumberOfVertices(), differ ? columns : 1, inertia);
  if (this->Options.Norm == FidelityNorm::L2)
  {
    ForEach(this->Parallel, static_cast<Index>(quadratic.rows()),
      [&](Index i)
      {
        for (Eigen::Index k = 0; k < quadratic.cols(); ++k)
        {
          quadratic(i, k) +=
            this->Fit.Weight(i) * this->Fit.ChannelWeight(first + k) / this->Diffusivity;
        }
      });
  }
  return quadratic;
}

void TotalVariationFlow::MeasureWeights()
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  const Vector quadratic = this->QuadraticWeights(0, this->U.cols()).rowwise().minCoeff();
  double largestInverse = 0.0;
  double area = 0.0;
  for (Eigen::Index i = 0; i < quadratic.size(); ++i)
  {
    if (quadratic[i] > 0.0)
    {
      largestInverse = std::max(largestInverse, 1.0 / quadratic[i]);
      area += mesh.ControlAreas()[i];
    }
  }
  mesh.GetReduction().Max(&largestInverse, 1);
  this->LargestInverseWeight = largestInverse;
  this->WeightedArea = mesh.GetReduction().Sum(area);
}

StepReport TotalVariationFlow::Advance(const ProgressMonitor& progress)
{
  this->SetTarget();
  StepReport report;
  double gap = 0.0;
  const auto systems = static_cast<double>(this->Systems.size());
  double done = 0.0;
  for (const System& system : this->Systems)
  {
    const VariationMinimizer::Report result =
      this->Minimize(system, progress.Part(done / systems, (done + 1.0) / systems));
    report.Iterations += result.Iterations;
    report.Residual = std::max(report.Residual, result.Gap);
    gap += result.AbsoluteGap;
    done += 1.0;
  }
  this->KeepsMultipliers = true;
  this->Conserved.Restore(this->Assembly->Mesh(), this->U, this->Parallel);
  report.ErrorBound = this->WeightedArea > 0.0
    ? std::sqrt(2.0 * gap * this->LargestInverseWeight / this->WeightedArea)
    : std::numeric_limits<double>::infinity();
  return report;
}

void TotalVariationFlow::SetTarget()
{
  const Index n = this->Assembly->Mesh().NumberOfVertices();
  if (this->Options.SteadyState)
  {
    if (this->SteadyStart.size() > 0)
    {
      this->U = this->SteadyStart;
    }
    ForEach(this->Parallel, n,
      [&](Index i)
      {
        if (this->Data.Fixed[i])
        {
          this->U.row(i) = this->Data.Start.row(i);
        }
      });
    // The data may have been replaced since the start.
    this->Target = this->Data.Given;
    return;
  }
  // lambda/2 |u - f|^2 + |u - u_old|^2/(2 dt) has its minimum at their weighted mean.
  const bool squared = this->Options.Norm == FidelityNorm::L2;
  ForEach(this->Parallel, n,
    [&](Index i)
    {
      const double weight = squared ? this->Options.TimeStep * this->Fit.Weight(i) : 0.0;
      for (Eigen::Index k = 0; k < this->U.cols(); ++k)
      {
        const double pull = weight * this->Fit.ChannelWeight(k);
        this->Target(i, k) =
          this->U(i, k) + (pull / (1.0 + pull)) * (this->Data.Given(i, k) - this->U(i, k));
      }
    });
}

VariationMinimizer::Report TotalVariationFlow::Minimize(
  const System& system, const ProgressMonitor& progress)
{
  const bool keepMultipliers = !this->Options.SteadyState && this->KeepsMultipliers;
  if (this->Systems.size() == 1)
  {
    return system.Minimizer->Minimize(
      this->Target, this->Data.Given, this->U, progress, keepMultipliers);
  }
  this->ColumnTarget = this->Target.middleCols(system.First, system.Columns);
  this->ColumnGiven = this->Data.Given.middleCols(system.First, system.Columns);
  this->ColumnU = this->U.middleCols(system.First, system.Columns);
  const VariationMinimizer::Report report = system.Minimizer->Minimize(
    this->ColumnTarget, this->ColumnGiven, this->ColumnU, progress, keepMultipliers);
  this->U.middleCols(system.First, system.Columns) = this->ColumnU;
  return report;
}

std::size_t TotalVariationFlow::CheckpointSize() const
{
  std::size_t size = StateModel::CheckpointSize();
  if (this->SavesMultipliers())
  {
    for (const System& system : this->Systems)
    {
      size += system.Minimizer->NumberOfMultipliers(system.Columns);
    }
  }
  return size;
}

void TotalVariationFlow::Save(double* checkpoint) const
{
  StateModel::Save(checkpoint);
  if (!this->SavesMultipliers())
  {
    return;
  }
  checkpoint += this->U.size();
  for (const System& system : this->Systems)
  {
    system.Minimizer->SaveMultipliers(checkpoint, system.Columns);
    checkpoint += system.Minimizer->NumberOfMultipliers(system.Columns);
  }
}

void TotalVariationFlow::Restore(const double* checkpoint)
{
  StateModel::Restore(checkpoint);
  if (!this->SavesMultipliers())
  {
    return;
  }
  checkpoint += this->U.size();
  for (const System& system : this->Systems)
  {
    system.Minimizer->RestoreMultipliers(checkpoint, system.Columns);
    checkpoint += system.Minimizer->NumberOfMultipliers(system.Columns);
  }
}

double TotalVariationFlow::Energy() const
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  double energy = 0.0;
  if (this->Systems.size() == 1)
  {
    energy = this->Systems.front().Minimizer->GradientEnergy(this->U);
  }
  else
  {
    for (const System& system : this->Systems)
    {
      this->ColumnU = this->U.middleCols(system.First, system.Columns);
      energy += system.Minimizer->GradientEnergy(this->ColumnU);
    }
  }
  return this->Diffusivity * energy +
    mesh.GetReduction().Sum(this->Fit.Energy(mesh, this->U, this->Parallel));
}

DiffusionStep TotalVariationFlow::Diffusion() const
{
  DiffusionStep step;
  step.TimeStep = this->Options.SteadyState ? InfiniteTime : this->Options.TimeStep;
  step.Fidelity = this->Options.Fidelity;
  step.IsL1 = this->Options.Norm == FidelityNorm::L1;
  step.SharesTensor = this->Systems.size() == 1;
  return step;
}

const CornerWeights& TotalVariationFlow::DiffusionWeights(Eigen::Index column)
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  const Eigen::Index columns = this->Systems.front().Columns;
  const Eigen::Index first = column / columns * columns;
  this->Weighted.resize(mesh.NumberOfTriangles(), 3);
  ForEach(this->Parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      const TriangleMesh::Shape shape = mesh.Shapes()[t];
      const auto u = [&](int a, Eigen::Index k)
      { return this->U(mesh.TriangleVertices()(t, a), k); };
      double squared = 0.0;
      for (Eigen::Index k = first; k < first + columns; ++k)
      {
        squared += (Gradient(shape, u(0, k), u(1, k), u(2, k)) -
          this->Systems[static_cast<std::size_t>(first / columns)].Minimizer->FreeGradient(
            t, k - first))
                     .squaredNorm();
      }
      const double g = this->Options.Function(squared);
      const double g1 = this->Options.AlongDiffusivity * g;
      if (this->Frames.rows() == 0)
      {
        this->Weighted.row(t) = g1 * CotanWeights(shape);
        return;
      }
      const Eigen::RowVector2d e = this->Frames.row(t);
      this->Weighted.row(t) = AnisotropicWeights(HasDirection(this->Frames, t), CotanWeights(shape),
        DirectionalWeights(shape, e[0], e[1]), DirectionalWeights(shape, -e[1], e[0]), g1,
        this->Options.AcrossDiffusivity * g);
    });
  return this->Weighted;
}

} // namespace SurfaceDiffusion
