// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkTensorDiffusionFilter.h"

#include "Conversion/MirroredEnum.h"
#include "Conversion/ResultWriter.h"
#include "Conversion/RunState.h"
#include "Run/TensorDiffusionSettings.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

using namespace SurfaceDiffusion;

vtkStandardNewMacro(vtkTensorDiffusionFilter);

using Self = vtkTensorDiffusionFilter;
SURFACEDIFFUSION_MIRROR(Self::MODEL_BELTRAMI, TensorModel::Beltrami);
SURFACEDIFFUSION_MIRROR(Self::MODEL_COHERENCE_ENHANCING, TensorModel::CoherenceEnhancing);
SURFACEDIFFUSION_MIRROR(Self::MODEL_EDGE_ENHANCING, TensorModel::EdgeEnhancing);
SURFACEDIFFUSION_MIRROR(Self::METRIC_INDUCED, BeltramiFlow::Metric::Induced);
SURFACEDIFFUSION_MIRROR(Self::METRIC_FIXED, BeltramiFlow::Metric::Fixed);

vtkTensorDiffusionFilter::vtkTensorDiffusionFilter()
{
  this->Tolerance = 1e-3;
  this->InitialFill = INITIAL_FILL_HARMONIC;
}

const char* vtkTensorDiffusionFilter::GetModelAsString()
{
  return this->FindSettingWord("Model");
}

const char* vtkTensorDiffusionFilter::GetMetricAsString()
{
  return this->FindSettingWord("Metric");
}

const char* vtkTensorDiffusionFilter::GetResultSuffix() const
{
  return this->Model == MODEL_COHERENCE_ENHANCING ? "Coherent"
    : this->Model == MODEL_EDGE_ENHANCING         ? "EdgeEnhanced"
                                                  : "Beltrami";
}

std::unique_ptr<RunSettings> vtkTensorDiffusionFilter::MakeSettings() const
{
  auto settings = std::make_unique<TensorDiffusionSettings>();
  this->CopyProperties(*settings);
  settings->Model = static_cast<TensorModel>(this->Model);
  settings->ColorScale = this->ColorScale;
  settings->Metric = static_cast<BeltramiFlow::Metric>(this->Metric);
  settings->NoiseScale = this->NoiseScale;
  settings->IntegrationScale = this->IntegrationScale;
  settings->Contrast = this->Contrast;
  settings->Alpha = this->Alpha;
  settings->DiffusionAxes = this->DiffusionAxes;
  return settings;
}

void vtkTensorDiffusionFilter::WriteResult(
  std::size_t index, const InputFields& fields, vtkPolyData* output)
{
  this->Superclass::WriteResult(index, fields, output);
  const Run::Block& block = this->State->Run.GetBlock(index);
  if (block.Result.DiffusionAxes.rows() > 0)
  {
    this->AddResult(WriteDirections(*block.Surface, this->State->Inputs.CellsOf(index), output,
                      block.Result.DiffusionAxes, this->FindOtherName("DiffusionAxes"),
                      SMPParallelFor::Instance()),
      fields, output->GetCellData());
  }
}

void vtkTensorDiffusionFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}
