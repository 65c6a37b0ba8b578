// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace SurfaceDiffusion
{

/// Values and where they are: at the points of a surface or on its cells.
template <typename T>
struct Located
{
  T Values{};
  bool OnCells = false;
};

/// Whether a row is flagged; `flags` may be empty for none.
template <typename Row>
bool IsSet(const std::vector<char>& flags, Row row)
{
  return !flags.empty() && flags[static_cast<std::size_t>(row)] != 0;
}

} // namespace SurfaceDiffusion
