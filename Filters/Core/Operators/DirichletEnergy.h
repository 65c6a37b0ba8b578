// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Surface/TriangleMesh.h"

namespace SurfaceDiffusion
{

/// The Dirichlet energy 1/2 int D grad u . grad u = 1/2 u . K u, summed over the columns of u: half
/// the sum over triangles and their edges of c_ij (u_i - u_j)^2, with coefficients c as in
/// CotanWeights.h; no row: D = 1.
double DirichletEnergy(const TriangleMesh& mesh, const CornerWeights& coefficients, const Values& u,
  const ParallelFor& parallel = SerialFor());

/// 1/2 u . K u, summed over the columns of u, with a stiffness matrix K.
double DirichletEnergy(
  const SparseMatrix& stiffness, const Values& u, const ParallelFor& parallel = SerialFor());

} // namespace SurfaceDiffusion
