// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/PointMatching.h"
#include "Distributed/Processes.h"
#include "Distributed/SurfacePieces.h"
#include "vtkSurfaceDiffusionNamespace.h"

#include "vtkBoundingBox.h"
#include "vtkIdTypeArray.h"
#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <vector>

VTK_ABI_NAMESPACE_BEGIN
class vtkDataArray;
VTK_ABI_NAMESPACE_END

namespace SurfaceDiffusion
{

/// A piece in the list that all processes have, ordered by process. Labels number the points of
/// all pieces.
struct PieceEntry
{
  int Process;
  int Surface;
  vtkIdType FirstLabel;
  vtkBoundingBox Box;
};

/// Global ids without rounding: the array itself, or a copy of an array of another type. Null for
/// null.
vtkSmartPointer<vtkIdTypeArray> AsIdTypeArray(vtkDataArray* ids);

/// The global ids of the points, or null if they have none, one each.
vtkDataArray* FindGlobalPointIds(vtkPolyData* data);

/// The pieces of all processes. Collective.
std::vector<PieceEntry> ListPieces(
  const Processes& processes, const std::vector<SurfacePiece>& pieces);

/// The processes with a piece whose bounding box meets that of a piece of the same surface in this
/// process when both are enlarged by `reach`; ascending, without this process.
std::vector<int> FindNeighbours(
  const Processes& processes, const std::vector<PieceEntry>& list, double reach);

/// The points that may be points of several pieces, ordered by label: those of this process's
/// pieces that lie inside the bounding box of another piece of the same surface, enlarged by
/// `reach`, and those of the neighbours' pieces that lie inside such a box of a piece of this
/// process. list[first] is the first piece of this process. Every process calls it.
std::vector<InterfacePoint> FindInterfacePoints(const Processes& processes,
  const std::vector<int>& neighbours, const std::vector<SurfacePiece>& pieces,
  const std::vector<PieceEntry>& list, std::size_t first, double reach, bool byId);

} // namespace SurfaceDiffusion
