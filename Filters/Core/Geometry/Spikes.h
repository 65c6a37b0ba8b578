// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

/// Vertices far outside of their neighbours, as a scanner leaves them, with the places that they should
/// have. A vertex of a surface is within its ring: no farther from the mean c of its neighbours than
/// the farthest of them is, r, for edges of any lengths. A spike is more than 5 r from c.
/// So may be the tip of a cone, which differs in this: the ring of a spike is no larger than 1.5 times
/// the upper quartile of the edges around it, and most of its vertices have neighbours beyond them, which
/// a tip without a surface around it has not. The place is c. A spike that has another one for a
/// neighbour is not found.
std::vector<std::pair<Index, Eigen::RowVector3d>> FindSpikes(const TriangleMesh& mesh,
  const Eigen::Ref<const Points>& points, const ParallelFor& parallel = SerialFor());

} // namespace SurfaceDiffusion
