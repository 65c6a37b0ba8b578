// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/MumfordShahSettings.h"

#include "Core/Models/MumfordShah.h"
#include "Run/DataPreparation.h"
#include "Run/ModelInputs.h"

#include <algorithm>
#include <sstream>

namespace SurfaceDiffusion
{

namespace
{

/// Curves and side branches shorter than this are left out, in EdgeWidth: the ends and the bumps of
/// an edge are as long.
constexpr double ShortestCurve = 4.0;

/// Noise above the threshold makes edges nearly everywhere, and patterns hardly on so much.
constexpr double LargestShare = 0.8;

/// A part of a hole that edges enclose hangs on kappa alone. With larger tolerances its values drift.
constexpr double ToleranceInHoles = 1e-3;

/// The share of the surface where v is below a half.
double ShareOfEdges(const TriangleMesh& mesh, const Vector& edges, const ParallelFor& parallel)
{
  double areas[2] = { 0.0, mesh.ControlAreas().sum() };
  areas[0] = Sum(parallel, mesh.NumberOfVertices(),
    [&](Index i) { return edges[i] > 0.5 ? mesh.ControlAreas()[i] : 0.0; });
  mesh.GetReduction().Sum(areas, 2);
  return areas[1] > 0.0 ? areas[0] / areas[1] : 0.0;
}

} // namespace

void MumfordShahSettings::Visit(SettingVisitor& visitor)
{
  this->DataSettings::Visit(visitor);
  visitor.Number({ "SmoothingLength", "h",
                   "The length over which data are smoothed between edges; lambda is "
                   "FidelityWeight over its square." },
    this->SmoothingLength, SettingRange::Positive());
  visitor.Number(
    { "EdgeThreshold", "R",
      "The jump from which on an edge costs less than smoothing. Noise with a standard deviation "
      "above a third of it, over all components together, makes edges everywhere." },
    this->EdgeThreshold, SettingRange::Positive());
  visitor.Number({ "EdgeWidth", "h",
                   "eps, the distance over which v rises beside an edge, at least the mean edge "
                   "length." },
    this->EdgeWidth, SettingRange::Positive());
  visitor.Number({ "StopTolerance", "",
                   "The relative decrease of the energy in one step at which the run ends." },
    this->StopTolerance, SettingRange::OpenUnitInterval());
  visitor.Switch(
    { "EdgeCurves", "", "Whether the edges are extracted as curves.", SettingScope::Output },
    this->EdgeCurves);
}

ModelTraits MumfordShahSettings::DescribeModel() const
{
  ModelTraits traits;
  traits.NumberOfSteps = this->NumberOfTimeSteps;
  traits.MayEndEarly = true;
  traits.TimeStep = this->TimeStep;
  traits.AbsoluteTime = this->IsAbsolute();
  traits.Energy = { 0.0, 2.0 };
  traits.UsesFidelity = this->FidelityWeight > 0.0;
  traits.CanBeDistributed = !this->EdgeCurves;
  DescribeData(*this, traits);
  return traits;
}

std::unique_ptr<Model> MumfordShahSettings::Make(ModelInputs& inputs, RunResult& result) const
{
  PrepareData(*this, inputs, result);
  result.EffectiveFidelityWeight = this->FidelityWeight;
  const double h = inputs.Units.CoreEdgeLength();
  const double length = inputs.Units.ToCore(this->SmoothingLength, 1.0, 0.0);
  const double jump = inputs.Units.ToCore(this->EdgeThreshold, 0.0, 1.0);
  MumfordShah::Settings settings;
  settings.Fidelity = this->FidelityWeight / (length * length);
  settings.EdgeWidth = inputs.Units.ToCore(this->EdgeWidth, 1.0, 0.0);
  settings.EdgeCost = jump * jump / (4.0 * length) / (1.0 + h / (4.0 * settings.EdgeWidth));
  settings.StopTolerance = this->StopTolerance;
  if (settings.EdgeWidth < h * (1.0 - 1e-9))
  {
    std::ostringstream text;
    text << "EdgeWidth is below the mean edge length, " << inputs.Units.MeanEdgeLength
         << ": the triangles do not resolve the edges, which then cost more";
    result.WarnOnce(text.str());
  }

  SolverTask task;
  task.NumberOfVertices = inputs.Surface.Mesh().NumberOfVertices();
  task.AllowMultigrid = false;
  task.NumberOfColumns = static_cast<int>(inputs.Data.Start.cols());
  task.DiffusionNumber = this->LargestDiffusivity() * length * length / (h * h);
  const auto smoothing = inputs.Solvers.Find(SolverPurpose::Step, task);
  const bool hasHoles = inputs.Surface.Mesh().GetReduction().Any(inputs.Data.Missing.any());
  if (hasHoles || !(this->FidelityWeight > 0.0))
  {
    IterationLimits limits = smoothing->GetLimits();
    limits.Tolerance = std::min(limits.Tolerance, ToleranceInHoles);
    smoothing->SetLimits(limits);
  }
  task.NumberOfColumns = 1;
  task.DiffusionNumber = 4.0 * settings.EdgeWidth * settings.EdgeWidth / (h * h);
  const auto edges = inputs.Solvers.Find(SolverPurpose::Edges, task);
  return std::make_unique<MumfordShah>(inputs.Surface.SharedAssembler(), MakeWeights(*this, inputs),
    std::move(inputs.Data), settings, smoothing, edges, inputs.Parallel);
}

void MumfordShahSettings::Finish(const RunState& state, RunResult& result) const
{
  const auto& model = dynamic_cast<const MumfordShah&>(state.Path.CurrentModel());
  result.Edges = model.Edges();
  result.EdgeCurves = Polylines();
  if (model.Finished() &&
    ShareOfEdges(state.Surface.Mesh(), result.Edges, state.Parallel) > LargestShare)
  {
    result.WarnOnce(
      "most of the surface is an edge, as if the standard deviation of the noise were above a "
      "third of EdgeThreshold (to keep noise from making edges, raise EdgeThreshold)");
  }
  if (this->EdgeCurves)
  {
    const double width =
      state.Units.ToCore(this->EdgeWidth, 1.0, 0.0) * state.Surface.Mesh().LengthUnit();
    result.EdgeCurves = FindRidges(state.Surface.InputMesh(), state.Surface.Points(), result.Edges,
      ShortestCurve * width, state.Parallel);
  }
}

} // namespace SurfaceDiffusion
