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

/// Domain decomposition without overlap of a surface of which each process has one piece. Vertices
/// and edges on interfaces are owned by the process of lowest rank that has them.
class DomainDecomposition : public Reduction
{
public:
  /// surface: that of this process's piece, identity: that of the piece's points. Collective.
  DomainDecomposition(
    const Processes& processes, const Surface& surface, const PointIdentity& identity);

  using Reduction::Sum;
  void Sum(double* numbers, Index count) const override;
  void Max(double* numbers, Index count) const override;
  void UpdateFromOwners(Values& values) const override;
  void UpdateFromOwners(std::vector<vtkIdType>& numbers) const; ///< one per vertex
  using Reduction::Accumulate;
  void Accumulate(double* rows, Index columns) const override;
  void AccumulateInterfaceVertices(double* rows, Index columns) const override;
  void AccumulateInterfaceEdges(double* ofEdges) const override;

  /// asked: whether this process is to stop. Sum() then throws Aborted in all processes.
  void ObeyAbort(std::shared_ptr<const bool> asked) { this->AbortAsked = std::move(asked); }
  /// Whether one of the processes is to stop.
  bool IsAborted() const { return this->Any(this->AbortAsked && *this->AbortAsked); }

  /// Copies the values of an array to points that no triangle of the process uses from the points
  /// of other processes that they are copies of.
  void FillCopies(vtkDataArray* array) const;
  vtkIdType NumberOfCopies() const { return this->CopyCount; }

  const Processes& GetProcesses() const { return this->Group; }

  /// Number and total length of the interface edges that another process owns.
  Index SharedEdges() const { return this->ForeignEdges; }
  double SharedEdgeLength() const { return this->ForeignEdgeLength; }

private:
  /// Numbers of vertices or edges on interfaces, by the other process: those that this process owns
  /// and the other has too, and those that the other owns. Both processes list them in the same
  /// order.
  struct Interface
  {
    std::map<int, std::vector<Index>> Owned, Foreign;
  };
  /// An edge between vertices on interfaces.
  struct Edge
  {
    std::array<Index, 2> Vertices;
    double Length;
  };
  using EdgeMap = std::map<std::pair<vtkIdType, vtkIdType>, Edge>; ///< by the labels of its ends

  void FindInterfaceVertices(const TriangleMesh& mesh, const PointIdentity& identity);
  void MergeComponents(const TriangleMesh& mesh, const PointIdentity& identity);
  EdgeMap FindCandidateEdges(const TriangleMesh& mesh, const PointIdentity& identity) const;
  void FindInterfaceEdges(const TriangleMesh& mesh, const PointIdentity& identity);
  void FindCopies(const Surface& surface, const PointIdentity& identity);
  std::map<int, std::vector<vtkIdType>> ShareWithNeighbours(
    const std::vector<vtkIdType>& here) const;
  bool IsOnInterface(vtkIdType label) const;
  bool AddToInterface(Interface& to, Index item, const std::vector<int>& holders) const;

  template <typename T>
  void UpdateVertices(T* rows, Index columns) const;
  template <typename T>
  void UpdateItems(const Interface& items, T* rows, Index columns) const;
  void AccumulateItems(const Interface& items, double* rows, Index columns) const;
  template <typename T, typename Items, typename Read, typename Write>
  void ExchangeItems(const Items& sent, const Items& received, std::size_t columns,
    const Read& read, const Write& write) const;
  template <typename T>
  void Exchange(int other, const std::vector<T>& sent, std::vector<T>& received) const;

  const Processes Group;
  const std::vector<int> Neighbours; ///< ranks, ascending
  /// Of labels that several pieces have: the ranks among the neighbours and this process.
  std::map<vtkIdType, std::vector<int>> Holders;
  Interface Vertices, Edges;
  std::map<int, std::vector<vtkIdType>> Originals, Copies; ///< points, by the other process
  vtkIdType CopyCount = 0;
  Index ForeignEdges = 0;
  double ForeignEdgeLength = 0.0;
  std::shared_ptr<const bool> AbortAsked;
};

} // namespace SurfaceDiffusion
