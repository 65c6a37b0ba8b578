// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

#include <array>
#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// What becomes of boundary edges opposite an obtuse angle. Flipped over the boundary, to the back
/// of their triangle, they leave no negative weight. But the new edge crosses the boundary, so that
/// linear functions are no longer kept exactly beside it, and ways along edges may leave the
/// surface.
enum class BoundaryEdges
{
  Flip,
  Keep
};

/// A triangulation of a surface by edge lengths and neighbours alone, whose edges can be flipped
/// along geodesics: no vertex moves and the surface stays the same.
///
/// It consists of closed, oriented sheets. A closed, oriented manifold is one sheet. Any other
/// surface is covered twice: every triangle has a front and a back, joined at boundary edges and
/// around edges with more than two triangles (N. Sharp, K. Crane, "A Laplacian for Nonmanifold
/// Triangle Meshes", SGP 2020), and each sheet counts with half the area. By symmetry nothing flows
/// over a boundary then (the Neumann condition), and boundary edges flip like others, so that no
/// vertex has to be added, unless they are to be kept.
///
/// The edges of nearly degenerate triangles are first made longer, by about 1e-6 of the longest of
/// their triangle, so that every triangle inequality holds in floating point (mollification, ibid.,
/// but with a length per edge, so that small parts of a surface keep their shape beside large
/// ones). Control areas stay those of the surface.
class IntrinsicTriangulation
{
public:
  explicit IntrinsicTriangulation(const TriangleMesh& mesh,
    BoundaryEdges boundary = BoundaryEdges::Flip, const ParallelFor& parallel = SerialFor());

  /// Side 3 t + a of triangle t is its edge opposite corner a, from corner a + 1 to corner a + 2.
  Index NumberOfSides() const { return 3 * static_cast<Index>(this->Triangles.size()); }
  /// The other side of the same edge; the same side at boundaries that are kept.
  Index Twin(Index side) const { return this->Triangles[side / 3].Twins[side % 3]; }
  /// The vertex at corner a of triangle t.
  Index Vertex(Index t, int a) const { return this->Triangles[t].Vertices[a]; }

  /// Whether the cotangents opposite the edge have a nonnegative sum, up to round-off, or nothing
  /// is to be flipped there.
  bool IsDelaunay(Index side) const;

  /// A flip, with the rotations that carry tangent vectors over it. Angles are in radians from the
  /// first axis of a triangle.
  struct EdgeFlip
  {
    Index Side, Twin; ///< of the edge that is replaced
    double FirstAngle; ///< of the edge in the triangle of Side, before the flip
    double SecondAngle; ///< of the edge in the triangle of Twin, before the flip
    double LeftAngle; ///< from the edge to the first axis of the triangle of Side, after the flip
    double RightAngle; ///< from the edge to the first axis of the triangle of Twin, after the flip
    double LeftShare; ///< the area of the triangle of Side, after the flip, of that of both
  };

  /// Replaces the edge PQ of triangles A P Q and B Q P by the edge AB. The triangle of `side`
  /// becomes A P B, that of its twin B Q A. Returns false, and does nothing, if one of them would
  /// be degenerate.
  bool Flip(Index side, EdgeFlip& flip);

  /// The mesh of these triangles; `mesh` is the one that this was made from.
  std::shared_ptr<TriangleMesh> MakeMesh(
    const TriangleMesh& mesh, const ParallelFor& parallel) const;

private:
  struct Triangle
  {
    std::array<Index, 3> Vertices;
    std::array<double, 3> Lengths; ///< of the sides
    std::array<Index, 3> Twins; ///< of the sides
  };

  /// A use of an edge by a triangle.
  struct EdgeUse
  {
    Index Low, High; ///< the edge's vertices
    Index Side;
    bool Ascending; ///< whether the side runs from the low to the high vertex
    bool SameEdge(const EdgeUse& other) const
    {
      return this->Low == other.Low && this->High == other.High;
    }
  };

  /// All uses, sorted by edge. Those of edges whose low vertex is v are Uses[Begin[v]] ..
  /// Uses[Begin[v + 1] - 1].
  struct EdgeList
  {
    std::vector<Index> Begin;
    Buffer<EdgeUse> Uses;
  };

  static EdgeList ListEdges(const TriangleMesh& mesh, const ParallelFor& parallel);
  static bool IsOneSheet(const Buffer<EdgeUse>& uses, const ParallelFor& parallel);
  void MakeSheets(const TriangleMesh& mesh, const ParallelFor& parallel);
  void JoinSheets(const EdgeList& edges, Index triangleCount, const ParallelFor& parallel);
  void PartSheetsAtBoundaries(Index triangleCount);
  void Join(Index side, Index other);
  void Mollify(const ParallelFor& parallel);
  double LackOfSlack(Index t, int a) const;
  double Cotangent(Index side) const;
  void Relink(Index side, Index twin);

  Buffer<Triangle> Triangles;
  bool TwoSheets = false;
};

} // namespace SurfaceDiffusion
