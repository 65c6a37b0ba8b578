// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkFVMHeatFilter.h"

#include "Run/HeatSettings.h"
#include "Run/OwnedSettings.h"

#include "vtkObjectFactory.h"

using namespace SurfaceDiffusion;

VTK_ABI_NAMESPACE_BEGIN
vtkObjectFactoryNewMacro(vtkFVMHeatFilter);

vtkFVMHeatFilter::vtkFVMHeatFilter()
  : Superclass(OwnedSettings::Make<HeatSettings>())
{
  this->DeclareNumber("EffectiveFidelityWeight");
}

void vtkFVMHeatFilter::UsePaperScheme()
{
  this->Superclass::UsePaperScheme();
  this->SetTimeIntegratorToFirstOrder();
  this->SetModeToTimeSteps();
  this->SetMassMatrixToLumped();
  this->SetVectorTypeToComponents();
}
VTK_ABI_NAMESPACE_END
