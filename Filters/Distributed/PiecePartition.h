// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Reduction.h"
#include "Distributed/PointIdentity.h"
#include "Distributed/Processes.h"
#include "Run/Surface.h"

#include <map>
#include <memory>
#include <utility>
#include <vector>

class vtkDataArray;

namespace SurfaceDiffusion
{

/// A surface each process has one piece of.
class PiecePartition : public Reduction
{
public:
  /// surface: of this process's piece, whose points have this identity. Collective.
  PiecePartition(const Processes& processes, const Surface& surface, const PointIdentity& identity);

  using Reduction::Sum;
  void Sum(double* numbers, Index count) const override;
  void Max(double* numbers, Index count) const override;
  void UpdateFromOwners(Values& values) const override;
  using Reduction::Accumulate;
  void Accumulate(double* rows, Index columns) const override;
  void AccumulateInterfaceEdges(double* ofEdges) const override;

  /// asked: whether this process is to stop. Sum() obeys it in all processes together.
  void ObeyAbort(std::shared_ptr<const bool> asked) { this->AbortAsked = std::move(asked); }
  /// Whether one of the processes is to stop.
  bool IsAborted() const { return this->Any(this->AbortAsked && *this->AbortAsked); }

  /// Give the points of no cell of the piece's own the values at the points that they are copies
  /// of.
  void FillCopies(vtkDataArray* array) const;

  const Processes& GetProcesses() const { return this->Group; }

  vtkIdType NumberOfCopies() const { return this->CopyCount; }

  /// Edges that an earlier process has too: their number and total length.
  Index SharedEdges() const { return this->Edges; }
  double SharedEdgeLength() const { return this->EdgeLength; }

private:
  /// Vertices, or edges, on seams by the other process: those that it gets the values of from here,
  /// and those that it gives to this one.
  struct Seams
  {
    std::map<int, std::vector<Index>> Given, Taken;
  };

  void FindSharedVertices(const Surface& surface, const PointIdentity& identity);
  void FindComponents(const Surface& surface, const PointIdentity& identity);
  void FindSharedEdges(const Surface& surface, const PointIdentity& identity);
  void FindCopies(const Surface& surface, const PointIdentity& identity);
  bool Join(Seams& seams, Index item, const std::vector<int>& sharers) const;
  template <typename Items, typename Read, typename Write>
  void Pass(const Items& given, const Items& taken, std::size_t columns, const Read& read,
    const Write& write) const;
  void Take(const Seams& seams, double* rows, Index columns) const;
  void Add(const Seams& seams, double* rows, Index columns) const;
  void Exchange(int other, const std::vector<double>& sent, std::vector<double>& received) const;

  const Processes Group;
  std::map<vtkIdType, std::vector<int>> Sharers; ///< of each shared point: its processes
  Seams OfVertices, OfEdges;
  std::map<int, std::vector<vtkIdType>> Originals, Copies; ///< points by the other process
  vtkIdType CopyCount = 0;
  Index Edges = 0;
  double EdgeLength = 0.0;
  std::shared_ptr<const bool> AbortAsked;
};

} // namespace SurfaceDiffusion
