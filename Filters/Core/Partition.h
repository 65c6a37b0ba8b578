// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Types.h"

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

  /// Each number becomes its sum, or the largest, over the processes.
  virtual void Sum(double* numbers, Index count) const = 0;
  virtual void Max(double* numbers, Index count) const = 0;

  /// Vertices on seams get the values of the process that owns them.
  virtual void TakeFromOwners(Values& values) const = 0;

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

/// The same for sums over connected components: row r belongs to component[r] of this mesh.
void SumComponents(const Partition* partition, const std::vector<Index>& component, Values& sums);

} // namespace SurfaceDiffusion
