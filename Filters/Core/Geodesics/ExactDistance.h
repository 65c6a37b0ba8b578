// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geodesics/EdgeFrames.h"
#include "Core/Geodesics/SourcePiece.h"

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

class WindowFront;

/// Exact distances from sources along a surface of flat triangles: the lengths of the shortest ways
/// on it, to round-off, however coarse the surface and however long its triangles are. A shortest way
/// is straight over the edges of triangles that are laid out side by side, and turns at vertices only
/// where the angle on both sides is at least pi: where the triangles at a vertex have more than 2 pi
/// together, and at corners of the boundary. Ways that start at one place and go over the same
/// edges are a window, an interval of the last of these (J. Mitchell, D. Mount, C. Papadimitriou, SIAM
/// J. Comput. 16, 1987). Windows go over a triangle together, the nearest edge first. They are dropped
/// where another one of the edge is shorter, and where ways by a vertex are (S.-Q. Xin, G.-J. Wang,
/// ACM Trans. Graph. 28, 2009), so that only windows beside the front are in memory.
///
/// Nothing lies behind an edge of one triangle. Over an edge of three or more triangles, ways go into
/// each of the others. Distances have an error of some 1e-14 of the largest, among needles up to some
/// 1e-11; the distance from i to j is that from j to i within that. On a surface of n even triangles
/// there are about n^1.5 / 6 windows.
///
/// The mesh may be an intrinsic triangulation whose triangles have a vertex twice, but an edge must
/// not have the same vertex at both ends.
class ExactDistance
{
public:
  explicit ExactDistance(std::shared_ptr<const TriangleMesh> mesh);

  /// The distance of each vertex in units of the mesh, infinite where no way leads or where it is
  /// above cutoff, and the number of the piece that it comes from, -1 there. Where the distances from
  /// several are equal, it is one of them. Throws Aborted.
  GeodesicDistance::Arrival Find(const std::vector<SourcePiece>& sources, double cutoff,
    const ProgressMonitor& progress = ProgressMonitor()) const;

  /// Fronts of one mesh and cutoff, one for each thread. Empty at first.
  struct Memories
  {
    std::mutex Mutex;
    std::vector<std::shared_ptr<WindowFront>> Free;
  };

  /// The distances up to a cutoff from one source, as (vertex, distance) in ascending order. Takes the
  /// time of the vertices near it alone, but for the first calls with the same memories. Throws
  /// Aborted.
  std::vector<std::pair<Index, double>> FindNear(const SourcePiece& source, double cutoff,
    Memories& memories, const ProgressMonitor& progress = ProgressMonitor()) const;

  /// The triangles of the mesh laid out.
  const EdgeFrames& GetFrames() const { return this->Frames; }

  /// Whether Find() over the whole mesh, or as often as `times` says, takes at most about a second: the
  /// mesh has up to some 100,000 triangles, fewer if very many of them share a vertex and others come
  /// after these: not in a disk that is cut from its middle. Further sources make the work less.
  static bool TakesAtMostASecond(const TriangleMesh& mesh, double times = 1.0);

private:
  std::shared_ptr<const TriangleMesh> Mesh;
  EdgeFrames Frames;
};

} // namespace SurfaceDiffusion
