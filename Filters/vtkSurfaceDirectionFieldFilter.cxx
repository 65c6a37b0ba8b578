// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceDirectionFieldFilter.h"

#include "Conversion/FieldReader.h"
#include "Conversion/InputArrays.h"
#include "Conversion/SurfaceRuns.h"
#include "Run/DirectionFieldRun.h"
#include "Run/OwnedSettings.h"

#include "vtkObjectFactory.h"

using namespace SurfaceDiffusion;

VTK_ABI_NAMESPACE_BEGIN
vtkObjectFactoryNewMacro(vtkSurfaceDirectionFieldFilter);

vtkSurfaceDirectionFieldFilter::vtkSurfaceDirectionFieldFilter()
  : Superclass(OwnedSettings::Make<DirectionFieldSettings>(),
      SurfaceRuns::Of<DirectionFieldRun>(&InputFields::Direction), "Direction")
{
}

vtkSurfaceDirectionFieldFilter::~vtkSurfaceDirectionFieldFilter() = default;

bool vtkSurfaceDirectionFieldFilter::FindFields(
  vtkPolyData* block, InputFields& fields, Problems& problems)
{
  if (this->GetMethod() == METHOD_HINTS)
  {
    fields.Direction = InputArrays(this, block, fields, problems).Find(2, "DirectionArray", 3);
  }
  return true; // without hints, which is an error if they are needed
}
VTK_ABI_NAMESPACE_END
