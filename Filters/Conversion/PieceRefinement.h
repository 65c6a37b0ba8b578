// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Foundation/Types.h"
#include "Distributed/SurfacePieces.h"
#include "Run/Fingerprint.h"
#include "vtkSurfaceDiffusionNamespace.h"

#include "vtkSmartPointer.h"

#include <array>
#include <string>
#include <vector>

VTK_ABI_NAMESPACE_BEGIN
class vtkCellArray;
class vtkPoints;
class vtkPolyData;
VTK_ABI_NAMESPACE_END

namespace SurfaceDiffusion
{

/// The names of arrays of points that have rules of their own between two points; empty if there is
/// none.
struct RefinementRules
{
  std::string Mask; ///< what is between a masked point and another one is masked
  std::string Weights; ///< what is between a point of weight 0 and another one has weight 0
  /// What is between two marked points has the smaller mark, and none beside a point without one.
  std::vector<std::string> Marks;
};

/// Bisects the long edges of the surfaces of an update, see RefineEdges(). Edges that pieces of a
/// surface share are bisected alike in each, because it depends on the length of the edge alone.
/// What follows from the points and cells is kept from update to update.
class PieceRefinement
{
public:
  /// The cell of the input that each cell of a refined surface lies in.
  static constexpr const char* IdsName = "vtkOriginalCellIds";
  /// Of the inputs during an update, not of their outputs: per point, 1 in the middle of an edge
  /// that was bisected; per cell, the cell of the input that it was cut from.
  static constexpr const char* BetweenName = "surface diffusion between";
  static constexpr const char* GivenCellsName = "surface diffusion given cell";

  /// Forget the pieces that the last update has replaced.
  void Begin() { this->Replaced.clear(); }

  /// The distinct edges of the triangles of all pieces.
  struct EdgeSum
  {
    double Length = 0.0;
    double Number = 0.0;
  };
  EdgeSum SumEdges(const std::vector<SurfacePiece>& pieces);

  /// Bisect the edges that are longer, until a piece would have more triangles. Returns the longest
  /// edge that is left in such a piece; 0 if there is none. Throws Aborted.
  double Bisect(const std::vector<SurfacePiece>& pieces, double length, Index maximumTriangles,
    const ProgressMonitor& progress);

  /// Replace the inputs of the pieces that were bisected, and make their outputs copies of them.
  /// Mark what was measured in all inputs. Arrays of points are linear along the edges that are
  /// bisected, except that integers of one component, which are labels and marks, become the
  /// smaller of two, and that masks and weights follow the rules. Triangles have the data of their
  /// cells. Global ids, ghost cells and hidden cells are left out. Returns the number of triangles of
  /// the pieces that were replaced.
  Index Replace(std::vector<SurfacePiece>& pieces, const RefinementRules& rules);

  /// Make the outputs copies of the inputs that were replaced since Begin().
  void Undo();

private:
  struct Piece
  {
    Fingerprint Version;
    double SumOfEdges = -1.0; ///< -1: not known
    double NumberOfEdges = 0.0;
    double Length = 0.0; ///< to which it was refined; 0: not yet
    Index MaximumTriangles = 0;
    vtkSmartPointer<vtkPoints> Points; ///< null: no edge is longer
    vtkSmartPointer<vtkCellArray> Triangles;
    std::vector<vtkIdType> CellOf; ///< per triangle
    std::vector<std::array<Index, 2>> Parents;
    double LongestEdge = 0.0;
    bool LimitReached = false;
  };

  struct Replacement
  {
    vtkSmartPointer<vtkPolyData> Before, After; ///< the latter is the input during the update
    vtkPolyData* Output;
  };

  Piece& Find(std::size_t number, vtkPolyData* input);
  static void Bisect(Piece& piece, vtkPolyData* input, double length, Index maximumTriangles,
    const ProgressMonitor& progress);
  static vtkSmartPointer<vtkPolyData> MakeSurface(
    const Piece& piece, vtkPolyData* input, const RefinementRules& rules);
  static void MarkMeasured(const Piece& piece, vtkIdType points, vtkPolyData* surface);

  std::vector<Piece> Pieces;
  std::vector<Replacement> Replaced;
};

} // namespace SurfaceDiffusion
