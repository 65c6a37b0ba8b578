// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Operators/Assembler.h"
#include "Core/Surface/IntrinsicDelaunay.h"
#include "Run/Sentence.h"

#include <array>
#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// A triangulated surface as arrays: n x 3 coordinates, m x 3 point numbers.
struct SurfaceArrays
{
  SurfaceDiffusion::Points Points;
  SurfaceDiffusion::Triangles Triangles;
  std::vector<char> Excluded; ///< per point: triangles with a nonzero corner are ignored
  /// Per point, above 0: multiplies the area of its control cell, for surfaces whose true areas are
  /// known, such as averages of many. Empty: 1. Not together with IntrinsicDelaunay.
  std::vector<double> AreaFactors = {};
  std::vector<char> ExcludedTriangles = {}; ///< per triangle: nonzero ones are ignored, too
  /// Per point, empty or nonzero where nothing determines a value: excluded, too. See Undetermined.
  std::vector<char> Undetermined = {};
};

/// Throws std::runtime_error if a coordinate is not finite.
void RequireFiniteCoordinates(const Points& points, const ParallelFor& parallel = SerialFor());

struct SurfaceOptions
{
  bool MergeCoincidentPoints = false;
  double MergeTolerance = 0.0;
  /// The ends of edges without a length are one point: see JoinShortEdges(). Off in pieces of a
  /// surface, whose other pieces may know the points but not the edge.
  bool JoinShortEdges = true;
  bool IntrinsicDelaunay = false;
  BoundaryEdges Boundaries = BoundaryEdges::Flip; ///< of the intrinsic Delaunay triangulation
  double LengthUnit = 0.0; ///< of the meshes; 0: chosen by the extent of the surface
};

/// Counts of the parts of a surface that are ignored or look unintended.
struct SurfaceDiagnostics
{
  /// Left out, so that the surface may be cut there. Those of short edges, which are points, count
  /// only if no other triangle is left.
  Index DegenerateTriangles = 0;
  Index UnusedPoints = 0; ///< not in any participating triangle; excluded points do not count
  Index NonManifoldEdges = 0;
  Index CoincidentBoundaryPoints = 0; ///< Seams::NumberOfVertices, of points that are not merged
  double CoincidenceDistance = 0.0; ///< Seams::Distance
  bool MergesPoints = false; ///< SurfaceOptions::MergeCoincidentPoints
  Index EdgesLeft = 0; ///< IntrinsicDelaunay::NumberOfEdgesLeft()
};

/// What follows the number of CoincidentBoundaryPoints: the consequence, and what joins them.
Sentence SentenceOfCoincidence(const SurfaceDiagnostics& found, const char* consequence);

/// The surface that the numerics work on, and the way back to its points.
class Surface
{
public:
  /// Throws std::runtime_error on coordinates that are not finite, on triangles that refer to no
  /// point, and on more points or triangles than 32-bit numbers count; Aborted.
  Surface(SurfaceArrays arrays, const SurfaceOptions& options, const ParallelFor& parallel,
    const ProgressMonitor& progress);

  /// Declare this surface one process's part of a larger one. Only without IntrinsicDelaunay.
  void SetReduction(std::shared_ptr<const Reduction> reduction)
  {
    this->Input->SetReduction(std::move(reduction));
  }

  /// Per input point.
  const SurfaceDiffusion::Points& Points() const { return this->Arrays.Points; }
  /// The triangles of the mesh as rows of Points(), computed at each call. Merged points are
  /// replaced by the point that represents them, and excluded triangles are left out.
  SurfaceDiffusion::Triangles MakeTriangles() const;
  Index NumberOfTriangles() const { return this->TriangleCount; }
  /// The row of the input's triangles that row t of MakeTriangles() is.
  Index InputTriangle(Index t) const
  {
    return this->TriangleRows.empty() ? t : this->TriangleRows[static_cast<std::size_t>(t)];
  }
  /// The mesh of MakeTriangles().
  const TriangleMesh& InputMesh() const { return *this->Input; }

  std::shared_ptr<const TriangleMesh> SharedInputMesh() const { return this->Input; }

  /// The mesh that models work on: InputMesh() or its intrinsic Delaunay triangulation, which has
  /// the same vertices.
  const TriangleMesh& Mesh() const { return *this->Working; }
  std::shared_ptr<const TriangleMesh> SharedMesh() const { return this->Working; }
  /// Null if models work on InputMesh().
  const IntrinsicDelaunay* Delaunay() const { return this->Flipped.get(); }
  std::shared_ptr<const Assembler> SharedAssembler() const { return this->Operators; }

  /// The vertex of an input point; -1 if no participating triangle uses the point.
  Index VertexOf(Index point) const { return this->Vertices[static_cast<std::size_t>(point)]; }

  /// Whether the point is of a component without a known value, which is excluded.
  bool IsUndetermined(Index point) const
  {
    return !this->Arrays.Undetermined.empty() &&
      this->Arrays.Undetermined[static_cast<std::size_t>(point)] != 0;
  }
  const std::vector<char>& Undetermined() const { return this->Arrays.Undetermined; }

  const SurfaceDiagnostics& Diagnostics() const { return this->Found; }

private:
  void SelectTriangles(const SurfaceOptions& options);
  Index JoinPoints(const ParallelFor& parallel);
  void Build(
    const SurfaceOptions& options, const ParallelFor& parallel, const ProgressMonitor& progress);
  void ReleaseTriangles();
  void FindVertices();

  SurfaceArrays Arrays;
  std::vector<Index> Representative; ///< per point; empty if every point represents itself
  Index TriangleCount = 0;
  std::vector<std::array<Index, 4>> TrianglesWithoutArea; ///< row and points of those not in Input
  std::vector<Index> TriangleRows; ///< empty: those of the input
  std::shared_ptr<TriangleMesh> Input;
  std::shared_ptr<const IntrinsicDelaunay> Flipped;
  std::shared_ptr<const TriangleMesh> Working;
  std::shared_ptr<const Assembler> Operators;
  std::vector<Index> Vertices;
  SurfaceDiagnostics Found;
};

/// Positions of the vertices, in LengthUnit().
Points VertexPositions(const Surface& surface);

/// e1 per triangle of Mesh(), from tangent vectors of InputMesh().
TangentVectors TransportToMesh(const Surface& surface, const TangentVectors& vectors);

/// The diagonal of the bounding box of all pieces, in coordinate units.
double DiagonalOf(const Points& points, const Reduction& processes);

} // namespace SurfaceDiffusion
