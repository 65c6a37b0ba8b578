// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Foundation/Types.h"

#include <vector>

namespace SurfaceDiffusion
{

/// Heights of a relief from the values at vertices, in coordinate units; negative ones are carved.
struct ReliefProfile
{
  double Height = 1.0; ///< of the value 1 above that of 0
  double Base = 0.0; ///< the height of the value 0
  bool TwoLevels = false; ///< Base below the threshold and Base + Height above it
  double Threshold = 0.5; ///< the value in the middle between both levels
  /// The width of the slope between both levels, in coordinate units along the surface; 0: a step.
  double Flank = 0.0;
};

/// The heights of a profile. With two levels the distance from the line of the threshold is that of
/// the linear function with the value and the gradient at the vertex.
Vector ReliefHeights(const Points& points, const Triangles& triangles, const Vector& values,
  const ReliefProfile& profile);

/// Per vertex, whether it is a corner of a triangle that faces down more steeply: whose normal is
/// more than `degrees`, from 0 to 90, below the horizontal. Triangles are oriented as in
/// MakeRelief(). up: the direction of printing, not 0.
std::vector<char> FindOverhangs(
  const Points& points, const Triangles& triangles, const Eigen::Vector3d& up, double degrees);

/// What a relief became.
struct Relief
{
  Points Places; ///< the moved vertices
  Triangles Faces; ///< the triangles, oriented outwards
  Vector Heights; ///< that were used
  Index LoweredVertices = 0; ///< whose height is less than the given one
  Index OpenEdges = 0; ///< of one triangle
  Index NonManifoldEdges = 0; ///< of three or more triangles
  Index OverlappingBodies = 0; ///< pairs, see FindBodies()
  Index RepeatedTriangles = 0; ///< with the same corners as one before, which count once
  Index CrossingTrianglesBefore = 0; ///< see FindSelfIntersections()
  Index CrossingTriangles = 0; ///< after the relief
  double VolumeChange = 0.0; ///< the volume after the relief less that before, if it is closed
  std::vector<double> Walls; ///< per vertex, after the relief, see FindWalls()
  double SmallestWall = 0.0; ///< of these; infinite if there is none
};

/// Move the vertices of a surface by heights along their normals, outwards of closed bodies.
///
/// A vertex moves by h d, where d is the vector with d . n = 1 for the normals n of the triangles
/// around it, in the sense of least squares weighted by angles. So flat faces at a sharp edge are
/// offset by h, and a relief of constant height on a cube is a cube. d has at most length 2.
///
/// Heights are lowered where the surface would come too close to itself: h |d| is at most half of
/// the radius of the largest ball that touches the surface at the vertex, on the side to which it
/// moves, and has no other part of the surface inside. Such balls touch several places of the
/// surface, or one where it is curved as they are, so that smooth surfaces that move by less than
/// the radius do not meet. In the middle of a wall, the limit is a quarter of its thickness. Near
/// inner edges relief fades over twice its height. Where triangles that did not cross others before
/// still do, heights are halved, and at last 0.
///
/// Vertices on edges of one triangle, and of three or more, stay, so that rims fit what they fitted
/// before, and so do those inside another body. Triangles are oriented first, outwards of the solid
/// in cavities, too, see TurnOutwards(); those with the same corners count as one, and get one
/// orientation. The result has the same triangles: it is closed where the input is.
///
/// heights: per vertex, finite. Throws Aborted.
Relief MakeRelief(const Points& points, const Triangles& triangles, const Vector& heights,
  const ParallelFor& parallel = SerialFor(), const ProgressMonitor& progress = ProgressMonitor());

} // namespace SurfaceDiffusion
