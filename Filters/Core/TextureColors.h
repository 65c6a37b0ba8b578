// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Types.h"

#include <array>

namespace SurfaceDiffusion
{

/// n x 3 colours, red, green and blue from 0 to 255.
using Colors = Eigen::Matrix<unsigned char, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// u stretched to [0, 1] between its 1st and 99th percentile, so that no single vertex sets the
/// contrast; 1/2 where these are the same.
Vector StretchContrast(const Eigen::Ref<const Vector>& u);

/// Mixtures of two colours with components in [0, 1]: `low` for 0, `high` for 1.
Colors MixColors(const Eigen::Ref<const Vector>& shares, const std::array<double, 3>& low,
  const std::array<double, 3>& high);

} // namespace SurfaceDiffusion
