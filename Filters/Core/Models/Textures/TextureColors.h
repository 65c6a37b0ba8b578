// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Reduction.h"

#include <array>

namespace SurfaceDiffusion
{

/// n x 3 colours, red, green and blue from 0 to 255.
using Colors = Eigen::Matrix<unsigned char, Eigen::Dynamic, 3, Eigen::RowMajor>;

// The library has colours of its own because the contrast limits are percentiles of the values on
// the surface, over all processes, which a colour map of ParaView does not know, and because files
// for other programs (printing, rendering) can carry colours only as data, not as a colour map.

/// The 1st and 99th percentile of u over the vertices of the surface, so that no single vertex sets
/// the contrast. reduction: over the processes of the surface.
std::array<double, 2> ContrastLimits(
  const Eigen::Ref<const Vector>& u, const Reduction& reduction = Reduction::Serial());

/// u stretched to [0, 1] between the limits; 1/2 if these are the same.
Vector StretchContrast(const Eigen::Ref<const Vector>& u, const std::array<double, 2>& limits);

/// Mixtures of two colours with components in [0, 1]: `low` for 0, `high` for 1.
Colors MixColors(const Eigen::Ref<const Vector>& shares, const std::array<double, 3>& low,
  const std::array<double, 3>& high);

} // namespace SurfaceDiffusion
