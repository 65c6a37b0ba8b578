// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Geodesics/FrontShapes.h"

#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// A vertex that a front reaches first. A source within a triangle has three of these.
struct FrontSource
{
  Index Vertex = 0;
  double Time = 0.0; ///< of the arrival at the vertex
  Index Label = 0;
  Index Point = 0; ///< the number of the point that the front comes from
  double Start = 0.0; ///< the time at that point
};

/// Distances from sources along a surface, or arrival times: grad T . D grad T = 1, T = T_0 at the
/// sources, with the squared speeds D of each triangle (FrontShapes), by fast marching on the
/// triangles (R. Kimmel, J. Sethian, PNAS 95, 1998). The update of a vertex lays the triangle out in
/// the plane. If its other two vertices are reached from one source point, the place of this point
/// in the plane follows from their times, and the third time from the length of the straight line
/// from there (M. Novotni, R. Klein, WSCG 2002): in a plane such distances are exact, and on curved
/// surfaces a front keeps its curvature. If they are reached from different points, as beside a line
/// of sources, the front is plane. In both cases the way has to cross the edge between them; others
/// go along an edge.
///
/// Each time is the length of a path over triangles laid out side by side. A vertex whose time
/// decreases later is visited again, and obtuse triangles, which speeds that differ between
/// directions make of others, need no unfolding. Times do not depend on the order of the vertices,
/// except where ways from several points of a region are equally long, as on even meshes: by up to a
/// quarter of an edge there, half of the error; and where speeds differ by 8 or more between
/// directions that turn, by about 1e-3 of the largest time. On an intrinsic Delaunay triangulation
/// (IntrinsicDelaunay) fewer ways go along edges, and distances have smaller errors; the vertices,
/// and the surface, are the same.
///
/// No way crosses a barrier, but ways along an edge that another triangle shares go by. Ways around
/// a corner of a boundary or a barrier, where the open angle is above pi, go on from there as from a
/// source. Fronts of different labels do not mix.
class GeodesicDistance
{
public:
  explicit GeodesicDistance(std::shared_ptr<const TriangleMesh> mesh, FrontShapes shapes = {});

  /// T per vertex in units of the mesh over those of speed, infinite where no front arrives, and the
  /// number of the source that it comes from, -1 there.
  struct Arrival
  {
    std::vector<double> Times;
    std::vector<Index> Sources;
  };

  /// The first arrivals of all fronts together. Beside the line where fronts of different labels
  /// meet, ways go along edges. cutoff: fronts end at this time: what is later stays infinite.
  /// Throws Aborted.
  Arrival Find(const std::vector<FrontSource>& sources, double cutoff,
    const ProgressMonitor& progress = ProgressMonitor()) const;

  /// The same from a source that reaches few vertices, which are returned in ascending order. arrival:
  /// of all vertices, at first infinite and -1.
  std::vector<Index> FindNear(const FrontSource& source, double cutoff, Arrival& arrival) const;

  /// The same, with the label that arrives first, and its time, exactly as if the fronts of each label
  /// ran alone: each goes three edges beyond the line where it meets others. Of labels that arrive at
  /// the same time, the one of the earliest source counts. Throws Aborted.
  Arrival FindNearest(const std::vector<FrontSource>& sources,
    const ProgressMonitor& progress = ProgressMonitor()) const;

private:
  /// A way to a vertex through one triangle.
  struct Way
  {
    double Time;
    Index Front; ///< that it comes with
    Index Along; ///< the vertex at the other end of the edge that it goes along; -1: along none
  };

  Way WayThrough(
    Index corner, const std::vector<FrontSource>& fronts, const Arrival& arrival) const;
  TriangleMesh::Shape ShapeOf(Index t) const
  {
    return this->Shapes.empty() ? this->Mesh->Shapes()[t]
                                : this->Shapes[static_cast<std::size_t>(t)];
  }
  void FindCorners();
  /// Find() for times that `arrival` has infinite at first. latest: per vertex, the time from which on
  /// fronts end there; empty: cutoff alone. Returns the vertices reached, unless `touched` is null.
  void March(const std::vector<FrontSource>& sources, double cutoff,
    const std::vector<double>& latest, Arrival& arrival, std::vector<Index>* touched,
    const ProgressMonitor& progress) const;
  std::vector<double> LongestEdges() const;

  std::shared_ptr<const TriangleMesh> Mesh;
  FrontShapes Shapes;
  std::vector<char> IsCorner; ///< per vertex
};

} // namespace SurfaceDiffusion
