// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkIntrinsicTVFilter.h"

#include "Run/OwnedSettings.h"
#include "Run/TotalVariationSettings.h"

#include "vtkObjectFactory.h"

using namespace SurfaceDiffusion;

VTK_ABI_NAMESPACE_BEGIN
vtkObjectFactoryNewMacro(vtkIntrinsicTVFilter);

vtkIntrinsicTVFilter::vtkIntrinsicTVFilter()
  : Superclass(OwnedSettings::Make<TotalVariationSettings>())
{
  this->DeclareNumber("EffectiveFidelityWeight");
}

void vtkIntrinsicTVFilter::UsePaperScheme()
{
  this->Superclass::UsePaperScheme();
  this->SetTimeIntegratorToFirstOrder();
  this->SetModeToTimeSteps();
  this->SetRegularizerToTV();
  this->SetEdgeFunctionToTotalVariation();
  this->SetAcrossEdgeFunctionToSame();
  this->SetChannelCouplingToPerChannel();
  this->SetFidelityNormToL2();
  this->SetAutomaticFidelity(false);
  this->SetDiscretizationToLinear();
  this->SetColorModelToRGB();
}
VTK_ABI_NAMESPACE_END
