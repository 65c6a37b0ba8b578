// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Reduction.h"
#include "Core/Foundation/Types.h"
#include "Core/Surface/TriangleMesh.h"

namespace SurfaceDiffusion
{

/// The largest max - min over the columns of u on the surface; 1 without values, and for constants
/// up to round-off.
double ValueRange(const Eigen::Ref<const Values>& u, const Reduction& reduction);

/// The range of u without the outliers: that between the quantiles of 5 and 95 %, the largest over
/// the columns. Rarer values count for less.
double TypicalRange(const Eigen::Ref<const Values>& u, const Reduction& reduction);

/// u with outliers moved to within a typical range of the quantiles of 0.5 and 99.5 % of each
/// column.
Values WithoutOutliers(const Values& u, const Reduction& reduction);

/// The largest max - min over the columns of u at the corners of a triangle.
double RangeOnTriangle(const TriangleMesh& mesh, const Eigen::Ref<const Values>& u, Index triangle);

} // namespace SurfaceDiffusion
