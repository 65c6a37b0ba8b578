// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkTensorDiffusionFilter.h"

#include "Conversion/ResultWriter.h"
#include "Conversion/RunState.h"
#include "Run/TensorDiffusionSettings.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

using namespace SurfaceDiffusion;

vtkStandardNewMacro(vtkTensorDiffusionFilter);

vtkTensorDiffusionFilter::vtkTensorDiffusionFilter()
  : Superclass(OwnedSettings::Make<TensorDiffusionSettings>())
{
}

const char* vtkTensorDiffusionFilter::GetResultSuffix() const
{
  return this->GetModel() == MODEL_COHERENCE_ENHANCING ? "Coherent"
    : this->GetModel() == MODEL_EDGE_ENHANCING         ? "EdgeEnhanced"
                                                       : "Beltrami";
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
