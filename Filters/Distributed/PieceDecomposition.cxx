// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/PieceDecomposition.h"

#include "Distributed/SurfacePieces.h"

#include "vtkBoundingBox.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkPolyData.h"

#include <cmath>
#include <utility>

namespace SurfaceDiffusion
{

PieceDecomposition::PieceDecomposition(
  vtkMultiProcessController* controller, std::shared_ptr<const bool> abortRequested)
  : Members(controller)
  , AbortRequested(std::move(abortRequested))
{
}

void PieceDecomposition::SetPiece(vtkPolyData* piece, double tolerance)
{
  this->Piece = piece;
  this->Tolerance = tolerance;
}

double PieceDecomposition::FindLengthUnit()
{
  const std::vector<SurfacePiece> pieces = { { 0, this->Piece, nullptr } };
  this->Identity = FindIdentity(this->Members, pieces, this->Tolerance).front();
  std::vector<double> bounds(6);
  this->Piece->GetBounds(bounds.data());
  bounds = this->Members.GatherAll(bounds);
  vtkBoundingBox box;
  for (std::size_t b = 0; b < bounds.size(); b += 6)
  {
    box.AddBounds(&bounds[b]);
  }
  const double extent = box.IsValid() ? box.GetMaxLength() : 0.0;
  return extent > 0.0 && std::isfinite(extent) ? std::exp2(std::ilogb(extent)) : 1.0;
}

void PieceDecomposition::Attach(Surface& surface, SolverStore& solvers)
{
  this->Domain = std::make_shared<DomainDecomposition>(this->Members, surface, this->Identity);
  this->Domain->ObeyAbort(this->AbortRequested);
  surface.SetReduction(this->Domain);
  solvers.SetProcesses(this->Domain, surface.InputMesh().NumberOfVertices());
}

void PieceDecomposition::UpdateCopies(
  vtkDataSetAttributes* before, vtkDataSetAttributes* after) const
{
  for (int a = 0; a < after->GetNumberOfArrays(); ++a)
  {
    vtkDataArray* const array = after->GetArray(a);
    if (array && before->GetArray(array->GetName()) != array)
    {
      this->Domain->FillCopies(array);
    }
  }
}

} // namespace SurfaceDiffusion
