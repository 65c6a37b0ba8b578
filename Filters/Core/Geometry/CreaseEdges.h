// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geometry/FaceGraph.h"
#include "Core/Geometry/SurfaceParts.h"

#include <vector>

namespace SurfaceDiffusion
{

/// The edges of the mesh of a part whose triangles differ by this angle and more, in degrees, if it is
/// above 0, and the given ones, which are pairs of rows of the part.
VertexPairs FindCreases(
  const TriangleMesh& mesh, const Points& points, double angle, const VertexPairs& given);

/// Given edges of the whole surface in each part, as pairs of its rows.
std::vector<VertexPairs> DivideCreases(
  const TriangleMesh& mesh, const std::vector<SurfacePart>& parts, const VertexPairs& creases);

} // namespace SurfaceDiffusion
