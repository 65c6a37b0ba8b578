// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace SurfaceDiffusion
{

/// The text of an enum value; checked at update, so a wrong one has a text too.
template <std::size_t N>
const char* EnumText(int value, const char* const (&texts)[N])
{
  return value >= 0 && value < static_cast<int>(N) ? texts[value] : "Unknown";
}

} // namespace SurfaceDiffusion
