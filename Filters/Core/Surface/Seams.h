// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"
#include "Core/Surface/TriangleMesh.h"

namespace SurfaceDiffusion
{

/// Vertices of the boundary that coincide with others of it up to round-off.
struct Seams
{
  Index NumberOfVertices = 0;
  double Distance = 0.0; ///< between two of them at most, in coordinates, rounded up to one digit
};

/// Two vertices of the boundary coincide if their distance is at most 1/1000 of the shortest edge at
/// either: more than the round-off of single precision leaves, and far less than what two sides of
/// an open slit are apart. points: the rows that mesh.InputVertex() refers to.
Seams FindSeams(const TriangleMesh& mesh, const Points& points);

} // namespace SurfaceDiffusion
