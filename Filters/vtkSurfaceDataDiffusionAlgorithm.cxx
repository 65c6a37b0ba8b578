// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceDataDiffusionAlgorithm.h"

#include "Conversion/FieldReader.h"
#include "Conversion/InputArrays.h"
#include "Run/OwnedSettings.h"

#include <utility>

VTK_ABI_NAMESPACE_BEGIN
vtkSurfaceDataDiffusionAlgorithm::vtkSurfaceDataDiffusionAlgorithm(
  SurfaceDiffusion::OwnedSettings settings)
  : Superclass(std::move(settings))
{
}

void vtkSurfaceDataDiffusionAlgorithm::UsePaperScheme()
{
  this->Superclass::UsePaperScheme();
  this->SetHoldKnownValues(false);
  this->SetInitialFillToInput();
}

bool vtkSurfaceDataDiffusionAlgorithm::FindFields(
  vtkPolyData* block, SurfaceDiffusion::InputFields& fields, Problems& problems)
{
  const bool hasData = this->Superclass::FindFields(block, fields, problems);
  const SurfaceDiffusion::InputArrays inputs(this, block, fields, problems);
  fields.Fidelity = inputs.Find(5, "FidelityArray", 1);
  return hasData;
}
VTK_ABI_NAMESPACE_END
