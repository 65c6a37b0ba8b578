// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace SurfaceDiffusion
{

/// Values and where they are: at the points of a surface or on its cells.
template <typename T>
struct Located
{
  T Values{};
  bool OnCells = false;
};

} // namespace SurfaceDiffusion
