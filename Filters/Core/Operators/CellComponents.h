// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/ColumnSums.h"
#include "Core/Foundation/Grouping.h"
#include "Core/Operators/CellTransfer.h"

#include <vector>

namespace SurfaceDiffusion
{

/// The cells that take part, by connected component of the surface, and sums over them.
class CellComponents
{
public:
  /// mesh: that of `cells`; must live longer than this object.
  CellComponents(const TriangleMesh& mesh, const CellTransfer& cells, const ParallelFor& parallel);

  Index Count() const { return this->Mesh.NumberOfComponents(); }
  /// The cells of a component are Cell(Begin(component)) .. Cell(End(component) - 1), ascending.
  Index Begin(Index component) const
  {
    return this->ByComponent.Begin[static_cast<std::size_t>(component)];
  }
  Index End(Index component) const { return this->Begin(component + 1); }
  Index Cell(Index k) const { return this->ByComponent.Items[k]; }

  /// SumOf(component, k) becomes the sum of f(cell, k), k < columns, over the cells of the
  /// component in all processes. Collective.
  template <typename F>
  void Sum(Eigen::Index columns, const F& f)
  {
    this->Columns = columns;
    this->Sums.resize(static_cast<std::size_t>(this->Count() * columns));
    for (Index c = 0; c < this->Count(); ++c)
    {
      const Index begin = this->Begin(c);
      SumColumns(
        this->Parallel, this->End(c) - begin, columns,
        [&](Index i, Eigen::Index k) { return f(this->Cell(begin + i), k); },
        this->Sums.data() + static_cast<std::ptrdiff_t>(c) * columns);
    }
    this->SumOverProcesses();
  }
  double SumOf(Index component, Eigen::Index column) const
  {
    return this->Sums[static_cast<std::size_t>(component * this->Columns + column)];
  }

private:
  void SumOverProcesses();

  const TriangleMesh& Mesh;
  const ParallelFor& Parallel;
  Groups ByComponent;
  std::vector<double> Sums; ///< component x column
  Eigen::Index Columns = 0;
};

} // namespace SurfaceDiffusion
