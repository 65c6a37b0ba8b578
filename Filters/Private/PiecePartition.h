// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Partition.h"
#include "PointIdentity.h"
#include "PolyDataSurface.h"
#include "Processes.h"

#include <cstdint>
#include <map>
#include <vector>

class vtkDataArray;

/// A surface each process has one piece of.
class PiecePartition : public SurfaceDiffusion::Partition
{
public:
  using Index = SurfaceDiffusion::Index;

  /// surface: of this process's piece, whose points have this identity. Collective.
  PiecePartition(
    const Processes& processes, const PolyDataSurface& surface, const PointIdentity& identity);

  void Sum(double* numbers, Index count) const override;
  void Max(double* numbers, Index count) const override;
  void TakeFromOwners(SurfaceDiffusion::Values& values) const override;

  /// Give the points of no cell of the piece's own the values at the points that they are copies
  /// of.
  void FillCopies(vtkDataArray* array) const;

  const Processes& GetProcesses() const { return this->Group; }
  bool Owns(Index vertex) const { return this->Owner[vertex] == this->Group.Rank(); }

  vtkIdType NumberOfCopies() const { return this->CopyCount; }

  /// Edges that an earlier process has too: their number and total length.
  Index SharedEdges() const { return this->Edges; }
  double SharedEdgeLength() const { return this->EdgeLength; }

  /// Numbers sent to other processes in one TakeFromOwners() of one column.
  std::int64_t NumbersSent() const;

private:
  void FindSharedVertices(const PolyDataSurface& surface, const PointIdentity& identity);
  void FindComponents(const PolyDataSurface& surface, const PointIdentity& identity);
  void FindSharedEdges(const PolyDataSurface& surface, const PointIdentity& identity);
  void FindCopies(const PolyDataSurface& surface, const PointIdentity& identity);
  void Exchange(int other, const std::vector<double>& sent, std::vector<double>& received) const;

  const Processes Group;
  std::vector<int> Owner; ///< per vertex
  std::map<vtkIdType, std::vector<int>> Sharers; ///< of each shared point: its processes
  std::map<int, std::vector<Index>> Given, Taken; ///< vertices by the other process
  std::map<int, std::vector<vtkIdType>> Originals, Copies; ///< points by the other process
  vtkIdType CopyCount = 0;
  Index Edges = 0;
  double EdgeLength = 0.0;
};
