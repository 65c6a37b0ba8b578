// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Operators/Rings.h"
#include "Core/Surface/PointData.h"
#include "Core/Surface/TriangleMesh.h"

namespace SurfaceDiffusion
{

/// Data and states of the unbiased risk (C. Stein, Annals of Statistics 9, 1981): an estimate of the
/// mean square error of u, without its signal s, from data f = s + noise of the variances s^2/w,
///
///   sum_i A_i w_i (u_i - f_i)^2 + 2 s^2 sum_i A_i du_i/df_i,
///
/// less a constant, over the area and the number of columns. The sum of derivatives is that along
/// one random direction p (M. Hutchinson, Commun. Stat. Simul. 19, 1990): the expectation of
/// sum_i A_i w_i p_i (u(f + s p) - u(f))_i / s for independent p_i of the variances 1/w_i. Exact in
/// that for linear u, and a difference over the size of the noise for others.
///
/// p: one row per vertex, 0 where a value is not known or does not change, and the mean of the
/// neighbours at a vertex whose value was interpolated. The sign of p_i is a hash
/// of the rank of the vertex by its values, and by its place among equal ones, in its range: it
/// depends neither on the numbering and the units, nor on other ranges.
/// mesh: of the data. points: of the input, rows as in TriangleMesh::InputVertex. pattern: of the
/// stiffness matrix.
Values RiskDirection(const TriangleMesh& mesh, const SparsePattern& pattern,
  const Eigen::Ref<const Points>& points, const PointData& data, VertexRange range);

/// The estimate from states u of f and u' of f + noise p. `data`: those that count, see
/// Discrepancy().
double UnbiasedRisk(const TriangleMesh& mesh, const PointData& data, const Values& u,
  const Values& uOfPerturbed, const Values& direction, double noise, VertexRange range);

} // namespace SurfaceDiffusion
