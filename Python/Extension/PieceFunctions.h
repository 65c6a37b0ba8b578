// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nanobind/nanobind.h>

namespace SurfaceDiffusion
{

/// The functions of Python for surfaces in pieces: match_points() and number_places().
void BindPieceFunctions(nanobind::module_& m);

} // namespace SurfaceDiffusion
