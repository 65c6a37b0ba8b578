// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMumfordShahFilter.h"

#include "Run/MumfordShahSettings.h"
#include "Run/OwnedSettings.h"

#include "vtkObjectFactory.h"

using namespace SurfaceDiffusion;

VTK_ABI_NAMESPACE_BEGIN
vtkObjectFactoryNewMacro(vtkMumfordShahFilter);

vtkMumfordShahFilter::vtkMumfordShahFilter()
  : Superclass(OwnedSettings::Make<MumfordShahSettings>())
{
  this->DeclareNumber("EffectiveEdgeThreshold");
  this->DeclareNumber("EffectiveSmoothingLength");
  this->DeclareNumber("EstimatedNoiseLevel");
  this->DeclareNumber("EdgeLength");
  this->SetNumberOfOutputPorts(3);
}

vtkMumfordShahFilter::~vtkMumfordShahFilter() = default;
VTK_ABI_NAMESPACE_END
