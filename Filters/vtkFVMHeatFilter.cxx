// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkFVMHeatFilter.h"

#include "Conversion/RunState.h"
#include "Run/HeatSettings.h"

#include "vtkObjectFactory.h"

using namespace SurfaceDiffusion;

vtkStandardNewMacro(vtkFVMHeatFilter);

vtkFVMHeatFilter::vtkFVMHeatFilter()
  : Superclass(OwnedSettings::Make<HeatSettings>())
{
}

void vtkFVMHeatFilter::UsePaperScheme()
{
  this->Superclass::UsePaperScheme();
  this->SetModeToTimeSteps();
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
