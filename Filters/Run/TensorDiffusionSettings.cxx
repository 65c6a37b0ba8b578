// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/TensorDiffusionSettings.h"

#include "Run/DataPreparation.h"
#include "Run/ModelInputs.h"
#include "Run/Rewording.h"

#include <algorithm>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// Of each smoothing of the structure tensor: the time steps of one Gaussian. Measured: with 2 the
/// mean error of the orientation of helical stripes in noise of 30 % is 1.0 degrees.
constexpr int SmoothingSteps = 2;

/// The number of solves with one matrix that the choice of a solver counts on: that of ten time
/// steps. A choice by the number of steps would change all states of a longer run by the tolerance.
constexpr double ExpectedSolves = 10.0 * SmoothingSteps;

/// An error of the smoothed data or tensors changes D by as much.
constexpr double SmoothingTolerance = 1e-4;

} // namespace

void TensorDiffusionSettings::Visit(SettingVisitor& visitor)
{
  Rewording reworded(visitor,
    { { "Tolerance",
      { "",
        "Relative residual at which iterative linear solvers stop, between 0 and 1. The change "
        "of the data in a step is solved for, so that the tolerance is a part of this "
        "change." } } });
  this->DataSettings::Visit(reworded);
  visitor.Choice({ "Model", "",
                   "The diffusion tensor. Beltrami: keeps the edges of colours. "
                   "CoherenceEnhancing: smooths along lines and closes their gaps. "
                   "EdgeEnhancing: smooths along edges, and away from them." },
    this->Model, { "Beltrami", "CoherenceEnhancing", "EdgeEnhancing" });
  visitor.Number({ "ColorScale", "h/R",
                   "b of Beltrami, above 0, in the unit that Units selects (natural units: h/R). "
                   "Gradients above 1/b are edges. Small values give linear diffusion.",
                   "Model=Beltrami" },
    this->ColorScale, SettingRange::Positive());
  visitor.Choice({ "Metric", "",
                   "The area that m of Beltrami measures. Induced: that of the data as a "
                   "surface, so that edges hardly move. Fixed: that of the surface itself, so "
                   "that totals are conserved. The steady states are the same.",
                   "Model=Beltrami" },
    this->Metric, { "Induced", "Fixed" });
  visitor.Number({ "NoiseScale", "h",
                   "sigma, the standard deviation of the Gaussian that smooths the data before "
                   "the structure tensor takes their gradients, in the unit of lengths that "
                   "Units selects (natural units: h). The data themselves are not smoothed by "
                   "it. 0: none.",
                   "Model!=Beltrami" },
    this->NoiseScale, SettingRange::NonNegative());
  visitor.Number({ "IntegrationScale", "h",
                   "rho, the standard deviation of the Gaussian over which CoherenceEnhancing "
                   "averages the direction of lines, in the unit of lengths that Units selects "
                   "(natural units: h). 0: none.",
                   "Model=CoherenceEnhancing" },
    this->IntegrationScale, SettingRange::NonNegative());
  visitor.Number({ "Contrast", "R/h",
                   "The gradient, above 0, in the unit that Units selects (natural units: R/h), "
                   "above which CoherenceEnhancing takes data for lines and EdgeEnhancing for "
                   "edges. To close gaps of noisy lines, take 0.01.",
                   "Model!=Beltrami" },
    this->Contrast, SettingRange::Positive());
  visitor.Number({ "Alpha", "",
                   "The diffusivity of CoherenceEnhancing across lines, and in all directions "
                   "away from lines, relative to that along lines, from 1e-12 to 1.",
                   "Model=CoherenceEnhancing" },
    this->Alpha, SettingRange::Between(1e-12, 1.0, "1e-12 to 1"));
  visitor.Switch({ "DiffusionAxes", "",
                   "Whether the direction of the strongest diffusion is a result, per cell.",
                   SettingScope::Output, "IntrinsicDelaunay=0 or DiffusionAxes=1" },
    this->DiffusionAxes);
}

void TensorDiffusionSettings::CheckTogether(const FieldSummary* fields, Problems& problems) const
{
  this->DataSettings::CheckTogether(fields, problems);
  Require(!(this->DiffusionAxes && this->IntrinsicDelaunay), Word::Setting("DiffusionAxes"),
    Word::SwitchNumber(true),
    Sentence(Word::Switch(false)) << " together with " << Word::Setting("IntrinsicDelaunay")
                                  << ", whose triangles are not those of the " << Word::Cells(),
    problems);
}

ModelTraits TensorDiffusionSettings::DescribeModel() const
{
  const bool beltrami = this->Model == TensorModel::Beltrami;
  ModelTraits traits = this->DescribeSteps();
  traits.Time = { 2.0, 0.0 };
  traits.ResultSuffix = this->Model == TensorModel::CoherenceEnhancing ? "Coherent"
    : this->Model == TensorModel::EdgeEnhancing                        ? "EdgeEnhanced"
                                                                       : "Beltrami";
  traits.Energy = beltrami ? Dimension{ 0.0, 2.0 } : Dimension{ 2.0, 2.0 };
  traits.UsesFidelity = this->FidelityWeight > 0.0;
  traits.SettingsInRange = { beltrami ? "ColorScale" : "Contrast" };
  traits.CanBeDistributed = this->Model != TensorModel::CoherenceEnhancing && !this->DiffusionAxes;
  DescribeData(*this, traits);
  return traits;
}

/// The structure tensor of the settings, whose solvers are kept from run to run.
std::unique_ptr<StructureTensor> TensorDiffusionSettings::MakeStructure(ModelInputs& inputs) const
{
  const double h = inputs.Units.CoreEdgeLength();
  const auto mesh = inputs.Surface.SharedMesh();
  const auto find = [&](SolverPurpose purpose, SolverTask task, double width)
  {
    task.DiffusionNumber = HeatBlur::TimeOfWidth(width, SmoothingSteps) / SmoothingSteps / (h * h);
    task.NumberOfSolves = ExpectedSolves;
    const auto solver = inputs.Solvers.Find(purpose, task);
    IterationLimits limits = solver->GetLimits();
    limits.Tolerance = std::min(limits.Tolerance, SmoothingTolerance);
    solver->SetLimits(limits);
    return solver;
  };
  std::unique_ptr<HeatBlur> noise;
  if (this->NoiseScale > 0.0)
  {
    const double width = WidthOfDeviation * inputs.Units.ToCore(this->NoiseScale, 1.0, 0.0);
    SolverTask task;
    task.NumberOfVertices = mesh->NumberOfVertices();
    task.NumberOfColumns = static_cast<int>(inputs.Data.Start.cols());
    noise = std::make_unique<HeatBlur>(inputs.Surface.SharedAssembler(), width, SmoothingSteps,
      find(SolverPurpose::Blur, task, width), inputs.Parallel);
  }
  std::unique_ptr<TensorSmoothing> integration;
  if (this->Model == TensorModel::CoherenceEnhancing && this->IntegrationScale > 0.0)
  {
    const double width = WidthOfDeviation * inputs.Units.ToCore(this->IntegrationScale, 1.0, 0.0);
    auto laplacian = std::make_shared<LineFieldOperator>(mesh);
    SolverTask task;
    task.NumberOfVertices = static_cast<Index>(laplacian->Mass().size());
    task.AllowMultigrid = false;
    integration = std::make_unique<TensorSmoothing>(std::move(laplacian), width, SmoothingSteps,
      find(SolverPurpose::Structure, task, width), inputs.Parallel);
  }
  return std::make_unique<StructureTensor>(
    mesh, std::move(noise), std::move(integration), inputs.Parallel);
}

std::unique_ptr<Model> TensorDiffusionSettings::Make(ModelInputs& inputs, RunResult& result) const
{
  PrepareData(*this, inputs, result);
  result.AddNumber("EffectiveFidelityWeight", this->FidelityWeight);
  WarnOfUnlikeColumns(inputs, "process each alone", result);
  const double h = inputs.Units.CoreEdgeLength();
  const double timeStep = inputs.Units.ToCore(this->TimeStep, 2.0, 0.0);
  const double fidelity = this->FidelityWeight * inputs.Units.ToCore(1.0, -2.0, 0.0);
  TangentVectors directions = this->IsDirected() ? inputs.Directions : TangentVectors(0, 2);

  SolverTask task;
  task.NumberOfVertices = inputs.Surface.Mesh().NumberOfVertices();
  task.NumberOfColumns = static_cast<int>(inputs.Data.Start.cols());
  task.AllowMultigrid = false;
  task.DiffusionNumber = this->LargestDiffusivity() * timeStep / (h * h);
  auto solver = inputs.Solvers.Find(SolverPurpose::Step, task);
  if (this->Model == TensorModel::Beltrami)
  {
    BeltramiFlow::Settings settings;
    settings.TimeStep = timeStep;
    settings.Fidelity = fidelity;
    settings.ColorScale = inputs.Units.ToCore(this->ColorScale, 1.0, -1.0);
    settings.MassMetric = this->Metric;
    settings.AlongDiffusivity = this->AlongDiffusivity;
    settings.AcrossDiffusivity = this->AcrossDiffusivity;
    return std::make_unique<BeltramiFlow>(inputs.Surface.SharedAssembler(), std::move(directions),
      std::move(inputs.Data), settings, std::move(solver), inputs.Parallel);
  }
  if (this->Model == TensorModel::CoherenceEnhancing && this->IntegrationScale < this->NoiseScale)
  {
    result.Warnings.push_back(Sentence(Word::Setting("IntegrationScale"))
      << " is " << this->IntegrationScale << ", below " << Word::Setting("NoiseScale")
      << ", which is " << this->NoiseScale
      << ": the direction of lines is that of single gradients");
  }
  StructureDiffusion::Settings settings;
  settings.TimeStep = timeStep;
  settings.Fidelity = fidelity;
  settings.Model = this->Model == TensorModel::CoherenceEnhancing
    ? StructureDiffusion::Kind::CoherenceEnhancing
    : StructureDiffusion::Kind::EdgeEnhancing;
  settings.Contrast = inputs.Units.ToCore(this->Contrast, -1.0, 1.0);
  settings.Alpha = this->Alpha;
  settings.AlongDiffusivity = this->AlongDiffusivity;
  settings.AcrossDiffusivity = this->AcrossDiffusivity;
  auto structure = this->MakeStructure(inputs);
  return std::make_unique<StructureDiffusion>(inputs.Surface.SharedAssembler(),
    std::move(directions), std::move(inputs.Data), settings, std::move(structure),
    std::move(solver), inputs.Parallel);
}

std::vector<Output> TensorDiffusionSettings::Finish(const RunState& state, RunResult& result) const
{
  std::vector<Output> outputs = this->DataSettings::Finish(state, result);
  if (this->DiffusionAxes)
  {
    outputs.push_back({ "DiffusionAxes", Place::PerTriangle, OutputType::Double,
      state.Path.CurrentModel().Axes(state.Progress) });
  }
  return outputs;
}

} // namespace SurfaceDiffusion
