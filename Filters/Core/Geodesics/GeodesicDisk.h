// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Geodesics/EdgeFrames.h"
#include "Core/Geodesics/SourcePiece.h"

#include <vector>

namespace SurfaceDiffusion
{

/// The part of a surface of flat triangles whose exact distance from a place, see ExactDistance, is at
/// most a radius.
///
/// Triangles that the boundary may cross are bisected until their edges are at most a sixteenth of the
/// radius, and no longer where they are farther from it than they are long. The distance at their corners
/// is exact, and linear between these: on a plane the area is 0.1 % too small, and on any surface of
/// triangles its error is of this order.
class GeodesicDisk
{
public:
  /// radius: above 0, in units of the mesh. Throws Aborted.
  GeodesicDisk(const TriangleMesh& mesh, const EdgeFrames& frames, const MeshPlace& center,
    double radius, const ProgressMonitor& progress = ProgressMonitor());

  double Area() const { return this->TotalArea; }
  /// Curves along the boundary, whose places are in their triangles. Closed ones end with the place
  /// that they begin with, and others at boundaries of the surface or edges of several triangles,
  /// which are no part of them.
  const std::vector<std::vector<MeshPlace>>& Boundary() const { return this->Curves; }

private:
  double TotalArea = 0.0;
  std::vector<std::vector<MeshPlace>> Curves;
};

} // namespace SurfaceDiffusion
