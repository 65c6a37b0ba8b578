// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkSurfaceDiffusionNamespace.h"

#include "vtkSmartPointer.h"

#include <vector>

VTK_ABI_NAMESPACE_BEGIN
class vtkDataArray;
class vtkMultiProcessController;
class vtkPolyData;
VTK_ABI_NAMESPACE_END

namespace SurfaceDiffusion
{

struct GatheredPiece;

/// An array that a filter added to its output, or the points if it moved them.
struct PieceResult
{
  enum Kind
  {
    PointArray,
    CellArray,
    Coordinates
  };

  Kind Of = PointArray;
  vtkSmartPointer<vtkDataArray> Array;
  int Attribute = -1; ///< the active attribute that the array is; -1: none
};

/// The arrays and points of output that are not those of input.
std::vector<PieceResult> FindResults(vtkPolyData* input, vtkPolyData* output);

/// The tuples of a surface's results that belong to a piece; zero at cells without a result.
std::vector<PieceResult> RestrictResults(
  const std::vector<PieceResult>& results, const GatheredPiece& piece);

void AddResults(const std::vector<PieceResult>& results, vtkPolyData* output);

/// From process 0 to another one, which receives them.
void SendResults(
  vtkMultiProcessController* controller, int process, const std::vector<PieceResult>& results);
std::vector<PieceResult> ReceiveResults(vtkMultiProcessController* controller);

} // namespace SurfaceDiffusion
