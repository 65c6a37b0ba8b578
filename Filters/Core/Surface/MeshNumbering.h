// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

namespace SurfaceDiffusion
{

/// The triangles that are not degenerate and the vertices that they use, numbered by connected
/// component and along a Hilbert curve (see TriangleMesh). Edges are not measured.
TriangleMesh::Contents NumberMesh(const Eigen::Ref<const Points>& points,
  const Eigen::Ref<const Triangles>& triangles, double lengthUnit, const ParallelFor& parallel,
  const ProgressMonitor& progress);

} // namespace SurfaceDiffusion
