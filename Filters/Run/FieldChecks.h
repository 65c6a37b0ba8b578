// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/Fields.h"

#include <functional>
#include <vector>

namespace SurfaceDiffusion
{

/// The labels 1, 2, ..., or 0 for none, of numbers. Throws InputError on others.
Located<std::vector<Index>> AsLabels(const Located<std::vector<double>>& numbers, const Word& name);

/// "`name` is `number` at point `row`;" and AllowedFactors().
InputError ErrorOfFactor(const Word& name, double number, bool onCells, Eigen::Index row);

/// Throws InputError on directions that are infinite. NaN is none.
void RequireFiniteDirections(const Points& vectors, bool onCells, const Word& name);

/// Throws InputError on diffusion rates of triangles that are negative or not finite. cellOf: the cell
/// of a triangle.
void RequireRates(const Values& rates, const std::function<Eigen::Index(Index)>& cellOf);

} // namespace SurfaceDiffusion
