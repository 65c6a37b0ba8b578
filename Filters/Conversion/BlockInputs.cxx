// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Conversion/BlockInputs.h"

#include "Conversion/SMPParallelFor.h"
#include "Distributed/ContentHash.h"

#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

namespace SurfaceDiffusion
{

std::vector<BlockInput> BlockInputs::Describe(
  const std::vector<InputFields>& surfaces, bool excludeMasked)
{
  this->Cells.resize(surfaces.size());
  std::vector<BlockInput> inputs(surfaces.size());
  for (std::size_t b = 0; b < surfaces.size(); ++b)
  {
    const InputFields& arrays = surfaces[b];
    vtkPolyData* const data = arrays.Surface;
    vtkDataArray* const excluded = excludeMasked ? arrays.Mask.Values.Get() : nullptr;
    TriangleCells& cells = this->Cells[b];
    const bool onCells = arrays.Mask.OnCells;
    inputs[b].Name = arrays.Name;
    inputs[b].SurfaceVersion = FingerprintSurface(data, excluded, onCells);
    inputs[b].FieldsVersion = FingerprintFields(arrays);
    inputs[b].ReadSurface = [data, excluded, onCells, &cells]
    { return ReadSurface(data, excluded, onCells, cells); };
  }
  return inputs;
}

std::vector<BlockInput> BlockInputs::Make(
  const std::vector<InputFields>& surfaces, bool excludeMasked)
{
  this->Decomposition.reset();
  std::vector<BlockInput> inputs = this->Describe(surfaces, excludeMasked);
  for (std::size_t b = 0; b < surfaces.size(); ++b)
  {
    inputs[b].ReadFields = [&arrays = surfaces[b], &cells = this->Cells[b]]
    {
      if (arrays.GlobalIds)
      {
        RequireTuples(arrays.GlobalIds, arrays.Surface->GetNumberOfPoints(), "point");
      }
      return ReadFields(arrays, cells);
    };
  }
  return inputs;
}

std::vector<BlockInput> BlockInputs::MakeOfPieces(const std::vector<InputFields>& surfaces,
  bool excludeMasked, double seamTolerance, vtkMultiProcessController* controller,
  const std::shared_ptr<const bool>& abortRequested)
{
  if (!this->Decomposition)
  {
    this->Decomposition = std::make_unique<PieceDecomposition>(controller, abortRequested);
  }
  std::vector<BlockInput> inputs = this->Describe(surfaces, excludeMasked);
  for (std::size_t b = 0; b < surfaces.size(); ++b)
  {
    vtkPointData* const points = surfaces[b].Surface->GetPointData();
    this->Decomposition->SetPiece(surfaces[b].Surface, seamTolerance);
    inputs[b].SurfaceVersion.AddNumber(seamTolerance);
    for (vtkDataArray* array :
      { points->GetGlobalIds(), points->GetArray(vtkDataSetAttributes::GhostArrayName()) })
    {
      AddArray(inputs[b].SurfaceVersion, array, SMPParallelFor::Instance());
    }
    inputs[b].Decomposition = this->Decomposition.get();
    inputs[b].ReadFields =
      [&arrays = surfaces[b], &cells = this->Cells[b], decomposition = this->Decomposition.get()]
    {
      Fields read = ReadFields(arrays, cells);
      read.MakeIds = nullptr; // unless the pieces of all processes have ids
      if (decomposition->HasIds())
      {
        read.MakeIds = [decomposition] { return decomposition->PointIds(); };
      }
      return read;
    };
  }
  return inputs;
}

} // namespace SurfaceDiffusion
