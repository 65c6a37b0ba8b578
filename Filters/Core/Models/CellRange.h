// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Operators/CellComponents.h"

#include <array>
#include <vector>

namespace SurfaceDiffusion
{

/// The range of data f on cells, which a result P* u + d keeps that would leave it by some percent:
/// its values outside the range of f, or of P* u where that is larger, are moved to the ends of the
/// range. What this takes from the sum of A d of a connected component, all its cells get back in
/// proportion to their distance to an end.
class CellRange
{
public:
  CellRange() = default;
  /// firstState: u_0; firstDetail: f - P* u_0. The other references must live longer than this
  /// object. Collective.
  CellRange(const TriangleMesh& mesh, const CellTransfer& cells, const Values& firstState,
    const Values& firstDetail, const ParallelFor& parallel);

  /// state: u; detail: d, changed at cells that are not held. Collective.
  void Keep(
    const Values& state, const std::vector<char>& held, CellComponents& components, Values& detail);

private:
  template <typename F>
  std::array<double, 2> FindRange(const F& f);
  void KeepColumn(Eigen::Index column, const Values& state, const std::vector<char>& held,
    CellComponents& components, Values& detail);

  const TriangleMesh* Mesh = nullptr;
  const CellTransfer* Cells = nullptr;
  const ParallelFor* Parallel = nullptr;
  std::vector<std::array<double, 2>> OfData; ///< per column
  std::vector<std::array<double, 2>> OfBlocks;
};

} // namespace SurfaceDiffusion
