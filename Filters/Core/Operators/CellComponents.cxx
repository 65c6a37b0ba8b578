// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Operators/CellComponents.h"

#include "Core/Surface/AllComponents.h"

#include <algorithm>

namespace SurfaceDiffusion
{

CellComponents::CellComponents(
  const TriangleMesh& mesh, const CellTransfer& cells, const ParallelFor& parallel)
  : Mesh(mesh)
  , Parallel(parallel)
{
  // Cells that take no part have a number of their own.
  std::vector<Index> components(
    static_cast<std::size_t>(cells.NumberOfCells()), mesh.NumberOfComponents());
  for (Index c = 0; c < mesh.NumberOfComponents(); ++c)
  {
    for (Index i = mesh.ComponentsBegin()[c]; i < mesh.ComponentsBegin()[c + 1]; ++i)
    {
      cells.ForEachCellAround(
        i, [&](Index cell) { components[static_cast<std::size_t>(cell)] = c; });
    }
  }
  this->ByComponent = GroupByKey(cells.NumberOfCells(), mesh.NumberOfComponents() + 1, parallel,
    [&](Index cell) { return components[static_cast<std::size_t>(cell)]; });
}

void CellComponents::SumOverProcesses()
{
  if (this->Mesh.GetReduction().IsSerial())
  {
    return;
  }
  Values sums = Eigen::Map<const Values>(this->Sums.data(), this->Count(), this->Columns);
  this->Mesh.GetReduction().SumComponents(AllComponents(this->Mesh), sums);
  std::copy(sums.data(), sums.data() + sums.size(), this->Sums.begin());
}

} // namespace SurfaceDiffusion
