// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkSurfaceDiffusionNamespace.h"

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <cstddef>
#include <vector>

VTK_ABI_NAMESPACE_BEGIN
class vtkDataArray;
class vtkDataSetAttributes;
class vtkPolyData;
VTK_ABI_NAMESPACE_END

namespace SurfaceDiffusion
{

/// A piece in process 0 and the way from the surface back to its points and cells.
struct GatheredPiece
{
  int Process = 0;
  vtkIdType FirstLabel = 0;
  vtkIdType FirstCell = 0; ///< number of vertices and lines, which come before the polygons
  vtkIdType NumberOfCells = 0; ///< vertices and lines included
  vtkIdType NumberOfPoints = 0;
  vtkSmartPointer<vtkPolyData> Data; ///< of PackPiece(); freed when the surface is made
  std::vector<vtkIdType> SurfacePoints; ///< per point, the surface's point
  std::vector<vtkIdType> SurfaceCells; ///< per polygon and strip, the surface's cell or -1
};

/// A surface made from its pieces. Its points are ordered by id and its cells by their points, so
/// that it is the same for any partition.
///
/// Arrays are merged by vtkDataSetAttributes::FieldList. The filters of VTK that merge pieces do
/// not fit: vtkAggregateDataSetFilter and vtkAppendPolyData neither merge points nor drop ghost
/// cells, vtkStaticCleanPolyData merges the coincident points of one piece and removes degenerate
/// cells, and all three return the points in an order that depends on the partition and keep no
/// map back to the pieces.
class StitchedSurface
{
public:
  std::vector<GatheredPiece> Pieces; ///< ordered by process, then as the process has them
  vtkIdType NumberOfLabels = 0;
  vtkSmartPointer<vtkPolyData> Data; ///< null until StitchPieces()
  vtkSmartPointer<vtkPolyData> Output; ///< a shallow copy for the filter to add its results to

  void StitchPieces();

private:
  /// A point or cell of a piece.
  struct Source
  {
    std::size_t Piece;
    vtkIdType Index;
  };
  struct Cell;

  void StitchPoints(vtkPolyData* surface);
  void StitchCells(vtkPolyData* surface);
  static void TellPiecesApart(const std::vector<Source>& sources, vtkDataArray* numbers);
  std::vector<Source> FindOwnedPoints() const;
  void ReadCells(std::vector<Cell>& cells, std::vector<Cell>& ghosts) const;
  void FindOriginals(const std::vector<Cell>& cells, const std::vector<Cell>& ghosts);
  void MergeArrays(
    const std::vector<Source>& sources, bool fromCells, vtkDataSetAttributes* merged) const;
};

} // namespace SurfaceDiffusion
