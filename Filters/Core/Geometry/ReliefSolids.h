// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"

#include <vector>

namespace SurfaceDiffusion
{

/// A part with relief as two solids, for two colours of material.
struct ReliefSolids
{
  Points Places;
  Triangles Faces; ///< those of the part first
  std::vector<char> IsRaised; ///< per triangle, whether it belongs to the raised solid
};

/// Divide a part with relief: what the relief raises where `levels` is above 0 is one solid, from the
/// surface before to that after, and the rest is the other. Triangles are cut along the line where
/// the linear function `levels` is 0, but for 5 % at the ends of edges. Both solids are closed where the
/// part is, have the walls along that line and the surface before in common, and add up to the part
/// with relief.
///
/// before, after: the vertices; faces: oriented outwards; levels: per vertex, finite.
ReliefSolids DivideRelief(
  const Points& before, const Points& after, const Triangles& faces, const Vector& levels);

} // namespace SurfaceDiffusion
