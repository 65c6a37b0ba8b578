// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/Types.h"

#include <array>
#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// Reductions over the processes that work together on a run: sums, maxima and the exchange at the
/// interfaces of a domain decomposition. This class is that of one process, which has the whole
/// surface: its arguments are the results already. A distributed one overrides it.
///
/// In a decomposition each triangle belongs to one process. A vertex on an interface is in all
/// processes whose triangles use it, and one of them owns it. A vector over the vertices is
/// - consistent: it has the same value in every process that has the vertex (states, solutions);
/// - or accumulated over the triangles of the process only: the sum over the processes is the value
///   on the surface (lumped mass matrix, stiffness matrix, right-hand sides).
///   Accumulate() makes it consistent.
/// So matrices and right-hand sides are assembled from the triangles of the process, without
/// communication, and no caller needs to know if there are other processes.
///
/// All calls but Owns() and OwnsInterfaceEdge() are collective: all processes make the same ones.
class Reduction
{
public:
  Reduction() = default;
  virtual ~Reduction() = default;

  static const Reduction& Serial();
  static std::shared_ptr<const Reduction> SharedSerial(); ///< the same one

  /// True if this process has the whole surface. No formula depends on it.
  bool IsSerial() const { return !this->IsDistributed; }

  /// Each number becomes its sum, or its maximum, over the processes. Sum() throws Aborted in all
  /// of them if one of them was asked to stop.
  virtual void Sum(double* /*numbers*/, Index /*count*/) const {}
  virtual void Max(double* /*numbers*/, Index /*count*/) const {}
  double Sum(double here) const
  {
    this->Sum(&here, 1);
    return here;
  }
  bool Any(bool here) const
  {
    double any = here ? 1.0 : 0.0;
    this->Max(&any, 1);
    return any > 0.0;
  }

  /// Sum of f(i) over the vertices of the surface, each counted once. f is called for all `count`
  /// vertices of the process.
  template <typename F>
  double SumOverVertices(const ParallelFor& parallel, Index count, const F& f) const
  {
    if (this->IsSerial())
    {
      return SurfaceDiffusion::Sum(parallel, count, f);
    }
    const auto ofOwned = [&](Index i)
    {
      const double value = f(i);
      return this->Owns(i) ? value : 0.0;
    };
    return this->Sum(SurfaceDiffusion::Sum(parallel, count, ofOwned));
  }

  /// The quantile of the values at the vertices of the surface: of count values, in ascending
  /// order, that with the number fraction (count - 1), rounded. 0 without values.
  double Quantile(const Eigen::Ref<const Vector>& values, double fraction) const;
  /// The same without a copy: the order of the values is lost.
  double QuantileInPlace(Vector& values, double fraction) const;

  /// The processes are numbered from 0.
  virtual int Rank() const { return 0; }
  /// The numbers of all processes, ordered by rank.
  virtual std::vector<double> Gather(const std::vector<double>& here) const { return here; }

  /// Vertices on interfaces get the values of the process that owns them.
  void UpdateFromOwners(double* rows, Index columns) const;
  void UpdateFromOwners(Values& values) const
  {
    this->UpdateFromOwners(values.data(), static_cast<Index>(values.cols()));
  }
  void UpdateFromOwners(Vector& values) const { this->UpdateFromOwners(values.data(), 1); }

  /// An accumulated vector becomes consistent: vertices on interfaces get the sum of what the
  /// processes have there, to the same bits everywhere. rows: per vertex.
  void Accumulate(double* rows, Index columns) const;
  void Accumulate(Values& values) const
  {
    this->Accumulate(values.data(), static_cast<Index>(values.cols()));
  }
  void Accumulate(Vector& values) const { this->Accumulate(values.data(), 1); }

  /// The same into `storage`, which the serial reduction does not need: it returns `values`.
  template <typename T>
  const T& Accumulated(const T& values, T& storage) const
  {
    if (this->IsSerial())
    {
      return values;
    }
    storage = values;
    this->Accumulate(storage);
    return storage;
  }

  /// Values at vertices that this process owns, 0 at the others: with them a sum over the vertices
  /// of the process counts each vertex once. The serial reduction returns `values`.
  const Vector& OwnedPart(const Vector& values, Vector& storage) const;

  /// gather(i) writes row i of the accumulated `values`, use(i) reads that of the consistent ones.
  /// The serial reduction does both in one pass.
  template <typename Gather, typename Use>
  void AccumulateEach(
    const ParallelFor& parallel, Values& values, const Gather& gather, const Use& use) const
  {
    const auto rows = static_cast<Index>(values.rows());
    if (this->IsSerial())
    {
      const auto both = [&](Index i)
      {
        gather(i);
        use(i);
      };
      ForEach(parallel, rows, both);
      return;
    }
    ForEach(parallel, rows, gather);
    this->Accumulate(values);
    ForEach(parallel, rows, use);
  }

  /// Vertices that other processes have too; Accumulate() and UpdateFromOwners() for one row of
  /// numbers per such vertex.
  const std::vector<Index>& InterfaceVertices() const { return this->VerticesOnInterface; }
  virtual void AccumulateInterface(double* /*rows*/, Index /*columns*/) const {}
  virtual void UpdateInterface(double* /*rows*/, Index /*columns*/) const {}
  /// Per vertex of the process, of which there are `count`, whether it is one of them. Empty on one
  /// process.
  std::vector<char> MarkInterfaces(Index count) const;
  /// Per such vertex a number of the set of processes that have it. The number is the process's
  /// own.
  const std::vector<Index>& InterfaceHolders() const { return this->HolderSets; }

  /// The reduction of `count` vertices of which each stands for a part of the vertices of this one:
  /// vertex i is in part coarse[i], or in none if that is negative. Those of a part that has
  /// vertices on interfaces all are, of the same processes, and all these have the same ones in the
  /// part. This reduction's finest one must outlive it.
  virtual std::shared_ptr<const Reduction> Coarsened(
    const std::vector<Index>& coarse, Index count) const;

  /// Edges that other processes have too, as pairs of vertices of this one; Accumulate() for one
  /// number per such edge.
  const std::vector<std::array<Index, 2>>& InterfaceEdges() const { return this->EdgesOnInterface; }
  virtual void AccumulateInterfaceEdges(double* /*ofEdges*/) const {}

  bool Owns(Index vertex) const { return this->IsSerial() || this->OwnedVertices[vertex] != 0; }
  bool OwnsInterfaceEdge(Index edge) const { return this->OwnedEdges[edge] != 0; }

  /// sums: row r belongs to connected component `components[r]` of the process's mesh. It becomes
  /// the sum over all parts of the component of the surface that this is a part of.
  void SumComponents(const std::vector<Index>& components, Values& sums) const;

protected:
  enum class Kind
  {
    Serial,
    Distributed
  };
  explicit Reduction(Kind kind)
    : IsDistributed(kind == Kind::Distributed)
  {
  }

  Index NumberOfComponents = 0; ///< of the surface
  std::vector<Index> SurfaceComponent; ///< per component of the process's mesh
  std::vector<Index> VerticesOnInterface, HolderSets;
  std::vector<std::array<Index, 2>> EdgesOnInterface;
  std::vector<char> OwnedVertices, OwnedEdges;

private:
  const bool IsDistributed = false;
};

} // namespace SurfaceDiffusion
