// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"

#include <array>
#include <vector>

namespace SurfaceDiffusion
{

/// A surface whose triangles are spread over processes. Each triangle is in one process, a vertex
/// on a seam in all processes whose triangles use it. Control areas, matrices and right-hand sides
/// are those of a process's own triangles: the sums over the processes are those of the surface.
/// What is a state (values, coefficients) is the same wherever a vertex is.
///
/// All calls are collective: all processes make the same ones.
class Partition
{
public:
  virtual ~Partition() = default;

  /// Each number becomes its sum, or the largest, over the processes. Sum() throws Aborted in all
  /// of them where one of them was asked to stop.
  virtual void Sum(double* numbers, Index count) const = 0;
  virtual void Max(double* numbers, Index count) const = 0;

  /// Vertices on seams get the values of the process that owns them.
  virtual void TakeFromOwners(Values& values) const = 0;

  /// Vertices on seams get the sum of what the processes have there, to the same bits everywhere:
  /// what was summed over the triangles here becomes what it is on the surface. rows: per vertex.
  virtual void AddOverSeams(double* rows, Index columns) const = 0;
  void AddOverSeams(Values& values) const
  {
    this->AddOverSeams(values.data(), static_cast<Index>(values.cols()));
  }
  void AddOverSeams(Vector& values) const { this->AddOverSeams(values.data(), 1); }

  /// Edges, as pairs of vertices here, that other processes have too; the same for them.
  const std::vector<std::array<Index, 2>>& SeamEdges() const { return this->EdgesOnSeams; }
  virtual void AddOverSeamEdges(double* ofEdges) const = 0;

  /// Whether this is the one process that counts it.
  bool Owns(Index vertex) const { return this->OwnedVertices[vertex] != 0; }
  bool OwnsSeamEdge(Index edge) const { return this->OwnedEdges[edge] != 0; }

  bool Any(bool here) const
  {
    double any = here ? 1.0 : 0.0;
    this->Max(&any, 1);
    return any > 0.0;
  }

  /// Connected components of the whole surface: their number, and which one each component of this
  /// process's mesh is part of.
  Index NumberOfComponents() const { return this->Components; }
  const std::vector<Index>& WholeComponent() const { return this->WholeComponents; }

protected:
  Index Components = 0;
  std::vector<Index> WholeComponents;
  std::vector<std::array<Index, 2>> EdgesOnSeams;
  std::vector<char> OwnedVertices, OwnedEdges;
};

/// Sums over the processes; without a partition what is here is the whole.
inline double SumOverProcesses(const Partition* partition, double here)
{
  if (partition)
  {
    partition->Sum(&here, 1);
  }
  return here;
}
inline bool AnyProcess(const Partition* partition, bool here)
{
  return partition ? partition->Any(here) : here;
}

/// Sum of f(i) over the vertices of the surface, each counted once; f is called at all that are
/// here, count of them.
template <typename F>
double SumOverVertices(
  const Partition* partition, const ParallelFor& parallel, Index count, const F& f)
{
  if (!partition)
  {
    return Sum(parallel, count, f);
  }
  const auto ofOwned = [&](Index i)
  {
    const double value = f(i);
    return partition->Owns(i) ? value : 0.0;
  };
  return SumOverProcesses(partition, Sum(parallel, count, ofOwned));
}

/// SumOverProcesses() for sums over connected components: row r belongs to component[r] of this
/// mesh.
void SumComponents(const Partition* partition, const std::vector<Index>& component, Values& sums);

} // namespace SurfaceDiffusion
