// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nanobind/nanobind.h>

namespace SurfaceDiffusion
{

/// The functions of Python that make another surface: refine() and relief().
void BindShapeFunctions(nanobind::module_& m);

} // namespace SurfaceDiffusion
