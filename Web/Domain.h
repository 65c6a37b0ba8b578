// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Foundation/Types.h"
#include "Files/SurfaceFile.h"

#include <array>
#include <string>
#include <vector>

namespace SurfaceDiffusion
{

/// What a run works on: the triangles of a file's surface, or those that its long edges were bisected
/// to.
struct Domain
{
  SurfaceDiffusion::Points Points;
  SurfaceDiffusion::Triangles Triangles;
  std::vector<Index> Cells; ///< of the file, that each triangle lies in
  Index NumberOfCells = 0; ///< that arrays of the domain have
  /// Of a refined surface: point n + k, with n given points, is the middle of two points.
  std::vector<std::array<Index, 2>> Parents;
  bool IsRefined = false; ///< the cells of the domain are its triangles

  /// Cut the polygons of a file. Throws std::runtime_error.
  static Domain Of(const Files::SurfaceFile& file);
  /// Bisect edges above a length; `warnings` gets a sentence if they were too many. Throws Aborted.
  Domain Refined(double length, Index maximumTriangles, const ProgressMonitor& progress,
    std::vector<std::string>& warnings) const;

  double MeanEdgeLength() const; ///< 0 without an edge
  /// The cell of the domain that each triangle is of.
  std::vector<Index> OwnCells() const;
  /// An array of the file's surface on this one. input: of numpy that it is for, by which a point
  /// between two is masked, marked, or has a mean; empty: data.
  Files::FileArray Carry(Files::FileArray array, const std::string& input) const;
};

} // namespace SurfaceDiffusion
