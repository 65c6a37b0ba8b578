// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkFVMHeatFilter.h"

#include "Conversion/EnumText.h"
#include "Conversion/SurfaceRun.h"
#include "Core/Models/LinearDiffusion.h"
#include "Core/Models/NoiseLevel.h"
#include "Core/Operators/CotanWeights.h"

#include "vtkObjectFactory.h"

#include <algorithm>
#include <cmath>
#include <ostream>

using SurfaceDiffusion::LinearDiffusion;

using namespace SurfaceDiffusion;

vtkStandardNewMacro(vtkFVMHeatFilter);

vtkFVMHeatFilter::vtkFVMHeatFilter()
{
  this->TimeIntegrator = TIME_INTEGRATOR_SECOND_ORDER;
}

const char* vtkFVMHeatFilter::GetModeAsString()
{
  return EnumText(this->Mode, { "TimeSteps", "SteadyState" });
}

void vtkFVMHeatFilter::UsePaperScheme()
{
  this->Superclass::UsePaperScheme();
  this->SetModeToTimeSteps();
}

void vtkFVMHeatFilter::CheckProperties(Problems& problems)
{
  this->Superclass::CheckProperties(problems);
  Require(this->TimeIntegrator == TIME_INTEGRATOR_FIRST_ORDER ||
      this->TimeIntegrator == TIME_INTEGRATOR_SECOND_ORDER,
    "TimeIntegrator", this->TimeIntegrator, "0 FirstOrder, 1 SecondOrder", problems);
  Require(this->Mode == MODE_TIME_STEPS || this->Mode == MODE_STEADY_STATE, "Mode", this->Mode,
    "0 TimeSteps, 1 SteadyState", problems);
  Require(std::isfinite(this->NoiseLevel) && this->NoiseLevel >= 0.0, "NoiseLevel",
    this->NoiseLevel, "finite numbers, 0 or more", problems);
  Require(std::isfinite(this->FWHM) && this->FWHM >= 0.0, "FWHM", this->FWHM,
    "finite numbers, 0 or more", problems);
  if (this->FWHM > 0.0)
  {
    const char* const off = "0 together with FWHM, whose width it would change";
    Require(this->FidelityWeight == 0.0, "FidelityWeight", this->FidelityWeight, off, problems);
    Require(!this->AutomaticFidelity, "AutomaticFidelity", 1.0, off, problems);
    const char* const one = "1 together with FWHM, whose width it would change";
    Require(
      this->AlongDiffusivity == 1.0, "AlongDiffusivity", this->AlongDiffusivity, one, problems);
    Require(
      this->AcrossDiffusivity == 1.0, "AcrossDiffusivity", this->AcrossDiffusivity, one, problems);
    Require(this->Mode != MODE_STEADY_STATE, "Mode", this->Mode,
      "0 TimeSteps together with FWHM: a steady state has no width", problems);
  }
}

void vtkFVMHeatFilter::WriteRunKey(std::ostream& key)
{
  this->Superclass::WriteRunKey(key);
  key << this->Mode << ' ' << this->GetTimeIsAbsolute() << ' ' << this->AutomaticFidelity << ' '
      << this->NoiseLevel << ' ';
}

int vtkFVMHeatFilter::GetEffectiveNumberOfTimeSteps()
{
  return this->Mode == MODE_STEADY_STATE ? 1 : this->NumberOfTimeSteps;
}

double vtkFVMHeatFilter::GetEffectiveTimeStep()
{
  if (this->FWHM > 0.0)
  {
    return this->FWHM * this->FWHM / (16.0 * std::log(2.0)) / std::max(1, this->NumberOfTimeSteps);
  }
  return this->TimeStep;
}

bool vtkFVMHeatFilter::UsesFidelity()
{
  return this->AutomaticFidelity || this->Superclass::UsesFidelity();
}

bool vtkFVMHeatFilter::GetTimeIsAbsolute()
{
  return this->FWHM > 0.0 || this->Superclass::GetTimeIsAbsolute();
}

std::unique_ptr<SurfaceDiffusion::Model> vtkFVMHeatFilter::MakeModel(ModelInput& input, int steps)
{
  const TriangleMesh& mesh = *input.Surface.Mesh;
  const CornerWeights isotropic = CotanWeights(mesh, input.Parallel);
  const bool directed = this->AlongDiffusivity != this->AcrossDiffusivity;
  const CornerWeights coefficients = directed
    ? AnisotropicWeights(mesh, isotropic, input.Frames, this->AlongDiffusivity,
        this->AcrossDiffusivity, input.Parallel)
    : CornerWeights(this->AlongDiffusivity * isotropic);

  UnitSystem timeUnits = input.Units;
  timeUnits.Natural = !this->GetTimeIsAbsolute();
  LinearDiffusion::Settings settings;
  settings.TimeStep = timeUnits.ToCore(this->GetEffectiveTimeStep(), 2.0, 0.0);
  settings.Fidelity = timeUnits.ToCore(this->FidelityWeight, -2.0, 0.0);
  settings.TimeScheme = this->TimeIntegrator == TIME_INTEGRATOR_SECOND_ORDER
    ? LinearDiffusion::Scheme::SDIRK2
    : LinearDiffusion::Scheme::BackwardEuler;

  const double h = input.Units.MeanEdgeLength / input.Units.LengthUnit;
  const double fastest = std::max(this->AlongDiffusivity, this->AcrossDiffusivity);
  SolverTask task;
  task.NumberOfVertices = mesh.NumberOfVertices();
  task.DiffusionNumber = fastest * settings.ImplicitStep() / (h * h);
  task.NumberOfSolves = this->TimeIntegrator == TIME_INTEGRATOR_SECOND_ORDER ? 2.0 * steps : steps;
  if (this->Mode == MODE_STEADY_STATE)
  {
    settings.TimeScheme = LinearDiffusion::Scheme::SteadyState;
    task.DiffusionNumber.reset();
  }

  this->EffectiveFidelityWeight = this->FidelityWeight;
  if (this->AutomaticFidelity)
  {
    const double noise = this->NoiseLevel > 0.0
      ? this->NoiseLevel / input.Units.ValueUnit
      : EstimateNoiseLevel(*input.Surface.Operators, input.Data);
    const auto solver = input.Solver("discrepancy", task);
    const auto discrepancy = [&](double fidelity)
    {
      LinearDiffusion::Settings steady;
      steady.Fidelity = fidelity;
      steady.TimeScheme = LinearDiffusion::Scheme::SteadyState;
      LinearDiffusion model(
        input.Surface.Operators, coefficients, input.Data, steady, solver, input.Parallel);
      model.Advance(input.Monitor.Part(0.5, 0.5));
      return Discrepancy(mesh, input.Data, model.State());
    };
    settings.Fidelity = FindFidelityByDiscrepancy(discrepancy, noise, 1.0 / (h * h));
    this->EffectiveFidelityWeight = settings.Fidelity / timeUnits.ToCore(1.0, -2.0, 0.0);
  }
  return std::make_unique<LinearDiffusion>(input.Surface.Operators, coefficients,
    std::move(input.Data), settings, input.Solver("diffusion", task), input.Parallel);
}

void vtkFVMHeatFilter::VisitReported(const std::function<void(double&)>& visit)
{
  this->Superclass::VisitReported(visit);
  visit(this->EffectiveFidelityWeight);
}

void vtkFVMHeatFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Mode: " << this->GetModeAsString() << "\n";
  os << indent << "FWHM: " << this->FWHM << "\n";
  os << indent << "AutomaticFidelity: " << (this->AutomaticFidelity ? "On" : "Off") << "\n";
  os << indent << "NoiseLevel: " << this->NoiseLevel << "\n";
  os << indent << "EffectiveFidelityWeight: " << this->EffectiveFidelityWeight << "\n";
}
