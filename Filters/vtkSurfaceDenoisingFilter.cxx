// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceDenoisingFilter.h"

#include "Conversion/FieldReader.h"
#include "Conversion/InputArrays.h"
#include "Conversion/SurfaceRuns.h"
#include "Run/DenoisingRun.h"
#include "Run/OwnedSettings.h"

#include "vtkObjectFactory.h"

using namespace SurfaceDiffusion;

VTK_ABI_NAMESPACE_BEGIN
vtkObjectFactoryNewMacro(vtkSurfaceDenoisingFilter);

vtkSurfaceDenoisingFilter::vtkSurfaceDenoisingFilter()
  : Superclass(
      OwnedSettings::Make<DenoisingRunSettings>(), SurfaceRuns::Of<DenoisingRun>(), "Displacement")
{
  this->DeclareNumber("EffectiveNoiseLevel");
  this->DeclareNumber("CorrelationLength");
  this->DeclareNumber("EffectiveSurfaceType");
  this->DeclareNumber("MeanDisplacement");
  this->DeclareNumber("MaximumDisplacement");
  this->DeclareNumber("VolumeBefore");
  this->DeclareNumber("VolumeAfter");
}

vtkSurfaceDenoisingFilter::~vtkSurfaceDenoisingFilter() = default;

bool vtkSurfaceDenoisingFilter::FindFields(
  vtkPolyData* block, InputFields& fields, Problems& problems)
{
  const InputArrays inputs(this, block, fields, problems);
  fields.Fixed = inputs.Find(3, "FixedArray", 1);
  fields.NameOfSeeds = "CreaseArray";
  fields.Seeds = inputs.Find(6, fields.NameOfSeeds, 1);
  return true;
}
VTK_ABI_NAMESPACE_END
