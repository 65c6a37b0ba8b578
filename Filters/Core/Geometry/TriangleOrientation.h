// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"

namespace SurfaceDiffusion
{

/// Turn triangles so that the two of each manifold edge have the same orientation. Of a set of
/// triangles that such edges connect, the larger part of the area keeps the orientation that it
/// has. On surfaces with one side only, such as a Moebius strip, edges with opposite orientations
/// remain. A triangle is turned by an exchange of its second and third corner.
///
/// points: rows that the triangles refer to.
void OrientTriangles(const Points& points, Triangles& triangles);

} // namespace SurfaceDiffusion
