// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nanobind/nanobind.h>

namespace SurfaceDiffusion
{

/// The functions of Python for parts: refine(), weld(), bodies().
void BindShapeFunctions(nanobind::module_& m);

/// Those of blocks and pieces: match_points(), number_places(), and what is said about them.
void BindPieceFunctions(nanobind::module_& m);

/// Those that take values from sphere to sphere: resampling_weights() and resample().
void BindResamplingFunctions(nanobind::module_& m);

} // namespace SurfaceDiffusion
