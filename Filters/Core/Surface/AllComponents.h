// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

#include <numeric>
#include <vector>

namespace SurfaceDiffusion
{

/// The numbers of the connected components of a mesh, as sums over the processes take them.
inline std::vector<Index> AllComponents(const TriangleMesh& mesh)
{
  std::vector<Index> all(static_cast<std::size_t>(mesh.NumberOfComponents()));
  std::iota(all.begin(), all.end(), 0);
  return all;
}

} // namespace SurfaceDiffusion
