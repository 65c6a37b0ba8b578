// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

namespace SurfaceDiffusion
{

/// The 95 % quantile of Student's distribution over that of the normal one, z = 1.645: by it a
/// standard error has to grow whose deviation was estimated with `freedom` degrees of freedom, so that
/// the band of z of them holds 90 %. By Fisher and Cornish's series (Technometrics 2, 1960), with an
/// error of 5 % at 1, the least that counts, and of 0.3 % from 2 on.
inline double StudentFactor(double freedom)
{
  const double x = 1.0 / std::max(1.0, freedom);
  return 1.0 + x * (0.926386 + x * (0.863422 + x * (0.597622 + x * 0.263778)));
}

} // namespace SurfaceDiffusion
