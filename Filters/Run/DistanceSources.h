// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geodesics/SourcePiece.h"
#include "Core/Geometry/NearestPoints.h"
#include "Run/Surface.h"

#include <functional>
#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// Points and lines anywhere in space, whose nearest places on a surface are sources, or places on it.
struct SourceShapes
{
  Points Places; ///< m x 3, coordinates; finite
  /// In place of coordinates, one per source: points of the surface, whose Places do not count, or
  /// triangles of the input, in which Places are barycentric coordinates. Both empty: coordinates.
  std::vector<Index> OfPoints, OfTriangles;
  std::vector<double> StartTimes; ///< per row of Places; empty: 0
  /// Pairs of rows of Places: the straight parts of lines. Rows in no pair are points.
  std::vector<std::array<Index, 2>> Segments;
  std::vector<char> Hidden; ///< per row, nonzero: takes no part, and is in no pair; empty: none
  const char* Name = "the sources"; ///< for messages

  /// The label of each row: its own number, and of lines that share points the smallest of theirs.
  std::vector<Index> FindLabels() const;
};

/// What SourceProjection has found.
struct ProjectedSources
{
  std::vector<SourcePiece> Pieces; ///< on triangles of surface.InputMesh()
  Index Count = 0; ///< points, and segments, with a piece
  Index TooFar = 0; ///< without one: farther than the largest distance
  Index Outside = 0; ///< without one: nearest to triangles that take no part
  std::vector<double> Distances; ///< of the points that are not hidden, from the surface
  Points Places; ///< of the same
};

/// Finds the places of a surface that are nearest to points and lines. Those nearest to triangles
/// that the mask excludes do not count, rather than to move to others.
class SourceProjection
{
public:
  /// arrays: of the surface, which must outlive this object. Throws std::runtime_error on
  /// coordinates that are not finite.
  SourceProjection(SurfaceArrays arrays, const SurfaceDiffusion::Surface& surface);

  /// maximumDistance: in coordinate units; 0: none. triangles: of the mesh; barriers take no part.
  /// Throws InputError on coordinates that are not finite; Aborted.
  ProjectedSources Project(const SourceShapes& shapes, double maximumDistance,
    const FrontShapes& triangles, const ProgressMonitor& progress) const;

private:
  struct Place
  {
    Index Triangle = -1; ///< of the mesh; -1: it does not count
    std::array<double, 3> Coordinates = { 0.0, 0.0, 0.0 };
    bool IsFar = false;
    double Distance = 0.0; ///< coordinate units
  };

  /// Finds the place that is nearest to a point.
  using Finder = std::function<Place(const Eigen::RowVector3d&)>;
  void ProjectSegment(const SourceShapes& shapes, std::array<Index, 2> ends, Index label,
    const Finder& find, ProjectedSources& found) const;

  SurfaceArrays Arrays; ///< whose triangles are those of MeshTriangles
  std::vector<Index> MeshTriangles; ///< per triangle, that of the mesh; -1: excluded
  double EdgeLength; ///< coordinate units
  std::unique_ptr<const NearestPoints> Nearest;
};

} // namespace SurfaceDiffusion
