// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/InterfaceReduction.h"
#include "Distributed/PointIdentity.h"
#include "Distributed/Processes.h"
#include "Run/Surface.h"
#include "vtkSurfaceDiffusionNamespace.h"

#include <map>
#include <memory>
#include <utility>
#include <vector>

VTK_ABI_NAMESPACE_BEGIN
class vtkDataArray;
VTK_ABI_NAMESPACE_END

namespace SurfaceDiffusion
{

/// Domain decomposition without overlap of a surface of which each process has one piece. Vertices
/// and edges on interfaces are owned by the process of lowest rank that has them.
class DomainDecomposition : public InterfaceReduction
{
public:
  /// surface: that of this process's piece, identity: that of the piece's points. Collective.
  DomainDecomposition(
    const Processes& processes, const Surface& surface, const PointIdentity& identity);

  using Reduction::Sum;
  void Sum(double* numbers, Index count) const override;
  void Max(double* numbers, Index count) const override;
  int Rank() const override { return this->Group.Rank(); }
  std::vector<double> Gather(const std::vector<double>& here) const override
  {
    return this->Group.GatherAll(here);
  }
  void AccumulateInterfaceEdges(double* ofEdges) const override
  {
    this->Edges.Accumulate(ofEdges, 1);
  }

  /// asked: whether this process is to stop. Sum() then throws Aborted in all processes.
  void ObeyAbort(std::shared_ptr<const bool> asked) { this->AbortAsked = std::move(asked); }
  /// Whether one of the processes is to stop.
  bool IsAborted() const { return this->Any(this->AbortAsked && *this->AbortAsked); }

  /// Copies the values of an array to points that no triangle of the process uses from the points
  /// of other processes that they are copies of.
  void FillCopies(vtkDataArray* array) const;
  vtkIdType NumberOfCopies() const { return this->CopyCount; }

  const Processes& GetProcesses() const { return this->Group; }

private:
  /// Edges between vertices on interfaces, by the labels of their ends.
  using EdgeMap = std::map<std::pair<vtkIdType, vtkIdType>, std::array<Index, 2>>;

  void FindInterfaceVertices(const TriangleMesh& mesh, const PointIdentity& identity);
  void MergeComponents(const TriangleMesh& mesh, const PointIdentity& identity);
  EdgeMap FindCandidateEdges(const TriangleMesh& mesh, const PointIdentity& identity) const;
  void FindInterfaceEdges(const TriangleMesh& mesh, const PointIdentity& identity);
  void FindCopies(const Surface& surface, const PointIdentity& identity);
  std::map<int, std::vector<vtkIdType>> ShareWithNeighbours(
    const std::vector<vtkIdType>& here) const;
  bool IsOnInterface(vtkIdType label) const;

  const Processes Group;
  const std::vector<int> Neighbours; ///< ranks, ascending
  /// Of labels that several pieces have: the ranks among the neighbours and this process.
  std::map<vtkIdType, std::vector<int>> Holders;
  InterfaceExchange Edges; ///< of InterfaceEdges()
  std::map<int, std::vector<vtkIdType>> Originals, Copies; ///< points, by the other process
  vtkIdType CopyCount = 0;
  std::shared_ptr<const bool> AbortAsked;
};

} // namespace SurfaceDiffusion
