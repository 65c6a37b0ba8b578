// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

namespace SurfaceDiffusion
{

/// Thrown by direct methods.
struct NotPositiveDefinite : std::runtime_error
{
  NotPositiveDefinite()
    : std::runtime_error("the matrix of the linear system is not positive definite")
  {
  }
};

} // namespace SurfaceDiffusion
