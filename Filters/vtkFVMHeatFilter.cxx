// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkFVMHeatFilter.h"

#include "Conversion/MirroredEnum.h"
#include "Conversion/RunState.h"
#include "Run/HeatSettings.h"

#include "vtkObjectFactory.h"

using namespace SurfaceDiffusion;

vtkStandardNewMacro(vtkFVMHeatFilter);

SURFACEDIFFUSION_MIRROR(vtkFVMHeatFilter::MODE_TIME_STEPS, HeatMode::TimeSteps);
SURFACEDIFFUSION_MIRROR(vtkFVMHeatFilter::MODE_STEADY_STATE, HeatMode::SteadyState);

vtkFVMHeatFilter::vtkFVMHeatFilter()
{
  this->TimeIntegrator = TIME_INTEGRATOR_SECOND_ORDER;
  this->InitialFill = INITIAL_FILL_HARMONIC;
}

const char* vtkFVMHeatFilter::GetModeAsString()
{
  return this->FindSettingWord("Mode");
}

void vtkFVMHeatFilter::UsePaperScheme()
{
  this->Superclass::UsePaperScheme();
  this->SetModeToTimeSteps();
}

std::unique_ptr<RunSettings> vtkFVMHeatFilter::MakeSettings() const
{
  auto settings = std::make_unique<HeatSettings>();
  this->CopyProperties(*settings);
  settings->Mode = static_cast<HeatMode>(this->Mode);
  settings->FWHM = this->FWHM;
  settings->AutomaticFidelity = this->AutomaticFidelity;
  settings->NoiseLevel = this->NoiseLevel;
  settings->Blur.FWHM = this->BlurFWHM;
  settings->Blur.Steps = this->BlurSteps;
  return settings;
}

void vtkFVMHeatFilter::TakeResults()
{
  this->Superclass::TakeResults();
  this->EffectiveFidelityWeight = this->State->Run.ReportedBlock().Result.EffectiveFidelityWeight;
}

void vtkFVMHeatFilter::VisitReported(const std::function<void(double&)>& visit)
{
  this->Superclass::VisitReported(visit);
  visit(this->EffectiveFidelityWeight);
}

void vtkFVMHeatFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "EffectiveFidelityWeight: " << this->EffectiveFidelityWeight << "\n";
}
