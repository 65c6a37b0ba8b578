// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceCurvatureFilter.h"

#include "Conversion/FieldReader.h"
#include "Conversion/InputArrays.h"
#include "Conversion/SurfaceRuns.h"
#include "Run/CurvatureRun.h"
#include "Run/OwnedSettings.h"

#include "vtkObjectFactory.h"

using namespace SurfaceDiffusion;

VTK_ABI_NAMESPACE_BEGIN
vtkObjectFactoryNewMacro(vtkSurfaceCurvatureFilter);

vtkSurfaceCurvatureFilter::vtkSurfaceCurvatureFilter()
  : Superclass(OwnedSettings::Make<CurvatureSettings>(), SurfaceRuns::Of<CurvatureRun>())
{
}

vtkSurfaceCurvatureFilter::~vtkSurfaceCurvatureFilter() = default;

bool vtkSurfaceCurvatureFilter::FindFields(
  vtkPolyData* block, InputFields& fields, Problems& problems)
{
  const InputArrays inputs(this, block, fields, problems);
  fields.Mask = inputs.Find(1, "MaskArray", 1);
  return true;
}
VTK_ABI_NAMESPACE_END
