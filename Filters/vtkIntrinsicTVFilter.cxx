// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkIntrinsicTVFilter.h"

#include "Conversion/RunState.h"
#include "Run/TotalVariationSettings.h"

#include "vtkObjectFactory.h"

using namespace SurfaceDiffusion;

vtkStandardNewMacro(vtkIntrinsicTVFilter);

vtkIntrinsicTVFilter::vtkIntrinsicTVFilter()
  : Superclass(OwnedSettings::Make<TotalVariationSettings>())
{
}

void vtkIntrinsicTVFilter::UsePaperScheme()
{
  this->Superclass::UsePaperScheme();
  this->SetModeToTimeSteps();
  this->SetEdgeFunctionToTotalVariation();
  this->SetAcrossEdgeFunctionToSame();
  this->SetChannelCouplingToPerChannel();
  this->SetFidelityNormToL2();
  this->SetAutomaticFidelity(false);
  this->SetDiscretizationToLinear();
  this->SetColorModelToRGB();
}

void vtkIntrinsicTVFilter::TakeResults()
{
  this->Superclass::TakeResults();
  this->EffectiveFidelityWeight = this->State->Run.ReportedBlock().Result.EffectiveFidelityWeight;
}

void vtkIntrinsicTVFilter::VisitReported(const std::function<void(double&)>& visit)
{
  this->Superclass::VisitReported(visit);
  visit(this->EffectiveFidelityWeight);
}

void vtkIntrinsicTVFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "EffectiveFidelityWeight: " << this->EffectiveFidelityWeight << "\n";
}
