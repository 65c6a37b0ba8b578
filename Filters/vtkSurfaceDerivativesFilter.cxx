// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceDerivativesFilter.h"

#include "Conversion/FieldReader.h"
#include "Conversion/InputArrays.h"
#include "Conversion/SurfaceRuns.h"
#include "Run/DerivativesRun.h"
#include "Run/InputSentences.h"
#include "Run/OwnedSettings.h"

#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkObjectFactory.h"

using namespace SurfaceDiffusion;

VTK_ABI_NAMESPACE_BEGIN
vtkObjectFactoryNewMacro(vtkSurfaceDerivativesFilter);

vtkSurfaceDerivativesFilter::vtkSurfaceDerivativesFilter()
  : Superclass(OwnedSettings::Make<DerivativesSettings>(),
      SurfaceRuns::Of<DerivativesRun>(&InputFields::Data))
{
  this->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS_THEN_CELLS, vtkDataSetAttributes::SCALARS);
}

vtkSurfaceDerivativesFilter::~vtkSurfaceDerivativesFilter() = default;

bool vtkSurfaceDerivativesFilter::FindFields(
  vtkPolyData* block, InputFields& fields, Problems& problems)
{
  const InputArrays inputs(this, block, fields, problems);
  fields.Data = inputs.Find(0, "InputArray", InputArrays::AnyNumberOfComponents);
  fields.AlphaIsData = true; // there is no result that would have it unchanged
  fields.Mask = inputs.Find(1, "MaskArray", 1);
  fields.SlopeErrors = inputs.Find(10, "SlopeErrorArray", InputArrays::AnyNumberOfComponents);
  if (fields.SlopeErrors.OnCells)
  {
    problems.push_back(Say("CellArray", "SlopeErrorArray"));
  }
  return fields.Data.Values != nullptr;
}
VTK_ABI_NAMESPACE_END
