// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceDataDiffusionAlgorithm.h"

#include "Conversion/FieldReader.h"
#include "Conversion/InputArrays.h"
#include "Conversion/MirroredEnum.h"
#include "Run/RunSettings.h"

SURFACEDIFFUSION_MIRROR(
  vtkSurfaceDataDiffusionAlgorithm::INITIAL_FILL_INPUT, SurfaceDiffusion::InitialFill::Input);
SURFACEDIFFUSION_MIRROR(
  vtkSurfaceDataDiffusionAlgorithm::INITIAL_FILL_MEAN, SurfaceDiffusion::InitialFill::Mean);
SURFACEDIFFUSION_MIRROR(
  vtkSurfaceDataDiffusionAlgorithm::INITIAL_FILL_NOISE, SurfaceDiffusion::InitialFill::Noise);
SURFACEDIFFUSION_MIRROR(
  vtkSurfaceDataDiffusionAlgorithm::INITIAL_FILL_HARMONIC, SurfaceDiffusion::InitialFill::Harmonic);

void vtkSurfaceDataDiffusionAlgorithm::UsePaperScheme()
{
  this->Superclass::UsePaperScheme();
  this->SetHoldKnownValues(false);
  this->SetInitialFillToInput();
}

const char* vtkSurfaceDataDiffusionAlgorithm::GetInitialFillAsString()
{
  return this->FindSettingWord("InitialFill");
}

bool vtkSurfaceDataDiffusionAlgorithm::FindFields(
  vtkPolyData* block, SurfaceDiffusion::InputFields& fields, Problems& problems)
{
  const bool hasData = this->Superclass::FindFields(block, fields, problems);
  const SurfaceDiffusion::InputArrays inputs(this, block, fields, problems);
  fields.Fidelity = inputs.Find(5, "FidelityArray", 1, fields.FidelityOnCells);
  return hasData;
}

void vtkSurfaceDataDiffusionAlgorithm::CopyProperties(
  SurfaceDiffusion::DataSettings& settings) const
{
  this->Superclass::CopyProperties(settings);
  settings.FidelityWeight = this->FidelityWeight;
  settings.InitialFill = static_cast<SurfaceDiffusion::InitialFill>(this->InitialFill);
  settings.HoldKnownValues = this->HoldKnownValues;
  settings.AlongDiffusivity = this->AlongDiffusivity;
  settings.AcrossDiffusivity = this->AcrossDiffusivity;
  settings.ResultOnCells = this->ResultOnCells;
  settings.KeepCellDetail = this->KeepCellDetail;
}
