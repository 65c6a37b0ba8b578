// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Geodesics/EdgeFrames.h"
#include "Core/Geodesics/GeodesicWindow.h"
#include "Core/Geodesics/SourcePiece.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <functional>
#include <queue>
#include <unordered_map>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

/// The windows from one set of sources, see ExactDistance.
class WindowFront
{
public:
  WindowFront(const TriangleMesh& mesh, const EdgeFrames& frames, double cutoff);

  /// The straight last part of the way to a place: from a vertex, or from a source in the triangle of
  /// the place, or over an edge of this triangle.
  struct LastPart
  {
    Index From = -1; ///< the vertex that it comes from; -1: none
    Index Corner = -1; ///< of the triangle; the edge opposite, if the way comes over it
    bool IsOverEdge = false;
    Eigen::Vector2d Place = { 0.0, 0.0 }; ///< in the frame of this edge, where the part begins
    double Start = 0.0; ///< the distance there
  };
  /// By a window over an edge to a place in its frame.
  static LastPart LastPartOver(
    Index edge, const GeodesicWindow& window, const Eigen::Vector2d& place);

  void AddSource(const SourcePiece& piece, Index source);
  /// watch: has windows that go over marked triangles. isDone: whether the run may end before windows
  /// that are no nearer than this. Throws Aborted.
  using Watch = std::function<void(Index edge, const std::vector<GeodesicWindow>&)>;
  void Run(const ProgressMonitor& progress, const Watch& watch = {},
    const std::function<bool(double)>& isDone = {});
  /// As after construction, once Run() has ended, in the time that Run() took.
  void Clear();

  std::vector<double> Times;
  std::vector<Index> Sources;
  std::vector<Index> Reached; ///< vertices
  std::vector<char> Watched; ///< per triangle, nonzero: marked for Run(); empty: none
  /// A straight piece of a source within a triangle, or a point: From and To.
  struct PieceWithin
  {
    std::array<double, 3> From, To;
    Index Source;
  };
  /// The pieces by their triangles; points on an edge are in all triangles around it, those at vertices
  /// in none.
  std::unordered_multimap<Index, PieceWithin> Pieces;
  /// The piece of a triangle that is nearest to a place, and how far; Never: there is none there.
  struct NearestPiece
  {
    double Distance = Never;
    std::array<double, 3> At = { 0.0, 0.0, 0.0 };
    Index Source = -1;
  };
  NearestPiece FindNearestPiece(const MeshPlace& place) const
  {
    const Index edge = 3 * place.Triangle;
    return this->FindNearestPiece(edge, this->Frames.PlaceOn(edge, place.At));
  }
  /// To a place in the frame of an edge of the triangle.
  NearestPiece FindNearestPiece(Index edge, const Eigen::Vector2d& place) const;

  /// Of the way to a vertex that has been reached.
  const LastPart& LastPartTo(Index vertex) const
  {
    return this->Ways[static_cast<std::size_t>(vertex)].Last;
  }

private:
  /// Windows that have come to an edge and not yet gone over its triangle.
  struct Waiting
  {
    std::vector<GeodesicWindow> Windows;
    double Least = 0.0;
    double Queued = 0.0; ///< the least distance when the edge was put into the queue
    bool IsChanged = false; ///< since then
  };
  /// From where a way comes to a vertex.
  struct Incoming
  {
    Index Corner = -1; ///< the triangle that it comes through; -1: ways go on everywhere
    double Angle = 0.0; ///< between the way and the edge to the next corner
    LastPart Last;
  };

  void AddPoint(Index triangle, const std::array<double, 3>& at, Index source);
  /// Ways from a point of a triangle over its edges; behind: but this one, where they come from.
  void LeavePoint(Index triangle, const std::array<double, 3>& at, Index source, Index behind);
  bool IsOnEdge(Index edge, const std::array<double, 3>& at) const;
  /// The ways that leave a straight piece at right angles.
  void AddStrips(const SourcePiece& piece, Index source);
  /// A way to a corner of a triangle from a place in the frame of the edge that begins there.
  void ReachFrom(Index corner, const Eigen::Vector2d& place, Index source);
  /// A way to a vertex, if it is shorter than those known.
  void Reach(Index vertex, double time, Index source, const Incoming& incoming);
  /// Ways from a vertex in all directions, independent of the way that leads there.
  void LeaveEverywhere(Index vertex);
  void LeaveVertex(Index vertex);
  /// Ways from a corner of a triangle over the edge opposite, between angles from the edge to the
  /// next corner.
  void LeaveCorner(Index corner, double from, double to, double start, Index source);
  /// Windows that have gone over the triangle; null: they are not kept here.
  std::vector<GeodesicWindow>* PastAt(Index edge, double& roundOff);
  void CrossTriangle(Index edge, std::vector<GeodesicWindow>& windows);
  void CrossCorner(
    Index edge, bool left, const GeodesicWindow& window, bool seesApex, double atApex);
  /// Puts a window, in the direction of `edge` or reversed, behind it.
  void GoOver(Index edge, bool reversed, std::uint32_t behind, const GeodesicWindow& window);
  /// Forgets what waits.
  void DropWaiting();
  /// Puts edges that windows have come to into the queue.
  void QueueChanged();
  Index VertexAt(Index corner) const { return this->Mesh.TriangleVertices().data()[corner]; }
  double TimeAt(Index corner) const
  {
    return this->Times[static_cast<std::size_t>(this->VertexAt(corner))];
  }

  const TriangleMesh& Mesh;
  const EdgeFrames& Frames;
  double Cutoff;
  std::vector<Incoming> Ways; ///< per vertex
  std::vector<Index> WaitingAt; ///< per edge; -1: none
  /// Per edge; windows past are kept at the few that many come to again and again: beside needles,
  /// and where ways branch at edges of many triangles. Otherwise these would multiply.
  std::vector<unsigned char> TimesCrossed;
  std::unordered_map<Index, std::vector<GeodesicWindow>> Past;
  std::vector<Waiting> Pool;
  std::vector<Index> Free;
  using Event = std::pair<double, Index>; ///< an edge, or -1 - vertex
  std::priority_queue<Event, std::vector<Event>, std::greater<>> Queue;
  std::vector<Index> Changed; ///< edges whose windows have changed
  WindowBuffers Buffers;
  std::vector<Index> Crossed; ///< edges
};

} // namespace SurfaceDiffusion
