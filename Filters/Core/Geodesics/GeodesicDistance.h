// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Geodesics/FrontShapes.h"

#include <limits>
#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// The time of an arrival that there is not.
constexpr double Never = std::numeric_limits<double>::infinity();

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
/// surfaces a front keeps its curvature. If they are reached from different points of one source, as
/// beside a line, the front is plane. In both cases the way has to cross the edge between them, and
/// another triangle has to be behind it, unless the source is on it; others go along an edge. At an edge
/// that its two triangles give different lengths, fronts are refracted: the radius of the front becomes
/// another one (V. Cerveny, Seismic Ray Theory, 2001), and a front that goes along the edge, as fast as
/// in the faster triangle, is plane in the other one.
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
/// a corner of a boundary or a barrier, where the open angle is above pi, and around a saddle, a
/// vertex with an angle above 2 pi, go on from there as from a source. Fronts of different labels do
/// not mix.
///
/// Distances are right where triangles are small beside the surface: see EikonalDistance for others.
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

  /// The arrivals of one call after another at all vertices of a mesh: infinite and -1 before each.
  struct Memory
  {
    explicit Memory(Index vertices);
    void Clear(const std::vector<Index>& vertices);

    Arrival Found;
    /// The time at the point that each way seems to come from in a plane with the speeds of its last
    /// triangle; - Never: of plane fronts.
    std::vector<double> Starts;
    std::vector<Index> Media; ///< of the last triangles, see Medium; -1: none
    std::vector<int> Falls; ///< of each time
  };

  /// The same from sources that reach few vertices, which are returned in ascending order. latest: per
  /// vertex, the time from which on fronts end there; empty: cutoff alone.
  std::vector<Index> FindNear(const std::vector<FrontSource>& sources, double cutoff,
    const std::vector<double>& latest, Memory& memory,
    const ProgressMonitor& progress = ProgressMonitor()) const;

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
    double Start; ///< see Memory
    Index Medium;
  };

  Way WayThrough(Index corner, const std::vector<FrontSource>& fronts, const Memory& memory) const;
  bool FitsBehind(Index corner, Index vertex, const Memory& memory) const;
  double Refracted(Index corner, double edge, double one, double other, double start) const;
  TriangleMesh::Shape ShapeOf(Index t) const
  {
    return this->Shapes.empty() ? this->Mesh->Shapes()[t]
                                : this->Shapes[static_cast<std::size_t>(t)];
  }
  void FindCorners();
  void FindGates();
  void FindBehind();
  void FindMedia();
  std::vector<double> LongestEdges() const;
  std::vector<double> TimesOfSources(const std::vector<FrontSource>& sources) const;
  bool IsAmongSources(const FrontSource& source, const std::vector<double>& times) const;

  std::shared_ptr<const TriangleMesh> Mesh;
  FrontShapes Shapes;
  std::vector<char> IsCorner; ///< per vertex
  std::vector<char> IsClosed; ///< per side 3 t + a, opposite corner a: no way comes through it
  /// Of Shapes, or where triangles do not name their edges. Per side, this side of the other triangle
  /// where it is shortest; -1: there is none. Of Shapes, per triangle, a number that is the same in
  /// triangles that give the sides between them about the same length.
  std::vector<Index> Behind, Medium;
};

} // namespace SurfaceDiffusion
