// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/Fields.h"
#include "Run/Surface.h"

#include <vector>

namespace SurfaceDiffusion
{

/// The connected components of a surface without a known value: no model determines values there.
struct Undetermined
{
  std::vector<char> Points; ///< per input point, nonzero: of such a component; empty if none is
  std::vector<char> Cells; ///< the same per cell, if the data are on cells
  double NumberOfComponents = 0.0; ///< over all processes
  bool HasKnown = false; ///< a value is known somewhere on the surface
};

/// Finds them. A point or cell is known if no component of its data is NaN and it is not masked
/// with `inpaint`, or if it is fixed or has a seed; with unitVectors its vector must have a
/// direction, too. Without data nothing is undetermined. Collective.
Undetermined FindUndetermined(const Surface& surface, const Fields& fields, bool inpaint,
  bool unitVectors, const Reduction& processes);

} // namespace SurfaceDiffusion
