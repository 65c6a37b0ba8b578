// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceRandomFieldFilter.h"

#include "Conversion/FieldReader.h"
#include "Conversion/InputArrays.h"
#include "Conversion/SurfaceRuns.h"
#include "Run/OwnedSettings.h"
#include "Run/RandomFieldRun.h"

#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

using namespace SurfaceDiffusion;

VTK_ABI_NAMESPACE_BEGIN
vtkObjectFactoryNewMacro(vtkSurfaceRandomFieldFilter);

vtkSurfaceRandomFieldFilter::vtkSurfaceRandomFieldFilter()
  : Superclass(OwnedSettings::Make<RandomFieldSettings>(), SurfaceRuns::Of<RandomFieldRun>())
{
}

vtkSurfaceRandomFieldFilter::~vtkSurfaceRandomFieldFilter() = default;

bool vtkSurfaceRandomFieldFilter::FindFields(
  vtkPolyData* block, InputFields& fields, Problems& problems)
{
  const InputArrays inputs(this, block, fields, problems);
  fields.Mask = inputs.Find(1, "MaskArray", 1);
  fields.GlobalIds = block->GetPointData()->GetGlobalIds();
  return true;
}
VTK_ABI_NAMESPACE_END
