// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Foundation/Types.h"
#include "Distributed/SurfacePieces.h"
#include "Run/Fingerprint.h"
#include "Run/Sentence.h"

#include "vtkSmartPointer.h"

#include <array>
#include <vector>

class vtkCellArray;
class vtkPoints;
class vtkPolyData;

namespace SurfaceDiffusion
{

/// Bisects the long edges of the surfaces of an update, see RefineEdges(). Edges that pieces of a
/// surface share are bisected alike in each, because it depends on the length of the edge alone.
/// What follows from the points and cells is kept from update to update.
class PieceRefinement
{
public:
  /// The triangles that a piece is refined to at most.
  static constexpr Index MaximumTriangles = 4'000'000;
  /// The cell of the input that each cell of a refined surface lies in.
  static constexpr const char* IdsName = "vtkOriginalCellIds";

  /// The mean length of the distinct edges of the triangles of all pieces; 0 if there are none.
  double FindMeanEdgeLength(const std::vector<SurfacePiece>& pieces);

  /// Replace the inputs of the pieces that have longer edges, and make their outputs copies of them.
  /// Arrays of points are linear along the edges that are bisected, except that integers of one
  /// component, which are labels and marks, become the smaller of two. Triangles have the data of
  /// their cells. Global ids, ghost cells and hidden cells are left out. Throws Aborted.
  void Refine(std::vector<SurfacePiece>& pieces, double length, const ProgressMonitor& progress);

  /// Whether a piece was replaced, and the sum of the triangles of these.
  bool HasRefined() const { return !this->Replaced.empty(); }
  Index NumberOfTriangles() const { return this->Triangles; }
  /// About the limit of triangles; empty if it was not reached.
  const Sentence& Limit() const { return this->LimitSentence; }

  /// Make the outputs copies of the inputs that were replaced.
  void Undo();

private:
  struct Piece
  {
    Fingerprint Version;
    double SumOfEdges = -1.0; ///< -1: not known
    double NumberOfEdges = 0.0;
    double Length = 0.0; ///< to which it was refined; 0: not yet
    vtkSmartPointer<vtkPoints> Points; ///< null: no edge is longer
    vtkSmartPointer<vtkCellArray> Triangles;
    std::vector<vtkIdType> CellOf; ///< per triangle
    std::vector<std::array<Index, 2>> Parents;
    double LongestEdge = 0.0;
    bool LimitReached = false;
  };

  struct Replacement
  {
    vtkSmartPointer<vtkPolyData> Before, After;
    vtkPolyData* Output;
  };

  Piece& Find(std::size_t number, vtkPolyData* input);
  static void Bisect(
    Piece& piece, vtkPolyData* input, double length, const ProgressMonitor& progress);
  static vtkSmartPointer<vtkPolyData> MakeSurface(const Piece& piece, vtkPolyData* input);

  std::vector<Piece> Pieces;
  std::vector<Replacement> Replaced;
  Index Triangles = 0;
  Sentence LimitSentence;
};

} // namespace SurfaceDiffusion
