// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/Partition.h"
#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Foundation/Types.h"

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

/// A triangulated surface, any angles and any topology, with the barycentric control cells of its
/// vertices (Wu, Deng, Chen 2008, sections 2 and 4.1, 4.2).
///
/// - Zero-area triangles are left out, and so are vertices that no triangle uses.
/// - Vertices are renumbered: by connected component, within it along a Hilbert curve, so that
///   neighbours on the surface are neighbours in memory. InputVertex() leads back.
/// - Lengths are in units of LengthUnit(), a power of two near the size of the surface, so that
///   coordinates from 1e-150 to 1e150 work alike; areas are in LengthUnit()^2.
/// - A triangle keeps only its shape, laid out in the plane: corner 0 at the origin, corner 1 at
///   (l, 0), corner 2 at (x, y) with l, y > 0. What depends on lengths alone (all isotropic models)
///   needs nothing else; Axes() leads from space to the plane.
class TriangleMesh
{
public:
  /// Corner 1 = (Length, 0) and corner 2 = (X, Y) in the triangle's own axes.
  struct Shape
  {
    double Length, X, Y;
    /// The share of the surface it stands for: 1/2 where two sheets cover the surface (see
    /// IntrinsicDelaunay.h).
    double Weight = 1.0;
    double Area() const { return 0.5 * Length * Y * Weight; }
    /// Of the edge opposite corner a.
    double EdgeLength(int a) const
    {
      const double x = a == 0 ? X - Length : X;
      return a == 2 ? Length : std::sqrt(x * x + Y * Y);
    }
  };

  /// What was found, to be told to the user.
  struct Findings
  {
    Index DegenerateTriangles = 0; ///< of zero area (height/longest edge < 1e-15): left out
    Index IsolatedVertices = 0; ///< used by no triangle that is left: not in the mesh
    Index NonManifoldEdges = 0; ///< shared by three or more triangles: kept
    Index BoundaryEdges = 0; ///< used by one triangle
  };

  /// The centre of the box around the points that triangles use, and the power of two that scales
  /// the box to one.
  struct Frame
  {
    Eigen::RowVector3d Centre;
    double Unit;
  };

  /// points: finite coordinates; triangles: rows of points; unit: LengthUnit(), 0 to have it
  /// chosen. Throws Aborted.
  TriangleMesh(const Eigen::Ref<const Points>& points, const Eigen::Ref<const Triangles>& triangles,
    const ParallelFor& parallel = SerialFor(),
    const ProgressMonitor& progress = ProgressMonitor(), double unit = 0.0);

  /// The vertices of `mesh` with other triangles, which may have a vertex twice.
  TriangleMesh(const TriangleMesh& mesh, Triangles corners, std::vector<Shape> shapes,
    const ParallelFor& parallel);

  Index NumberOfVertices() const { return static_cast<Index>(this->InputVertices.size()); }
  Index NumberOfTriangles() const { return static_cast<Index>(this->Corners.rows()); }

  /// The row of the constructor's points that vertex i stands for.
  const std::vector<Index>& InputVertex() const { return this->InputVertices; }
  /// The row of the constructor's triangles that triangle t stands for; empty where they are not
  /// triangles of the input.
  const std::vector<Index>& InputTriangle() const { return this->InputTriangles; }

  /// m x 3 vertex numbers.
  const Triangles& TriangleVertices() const { return this->Corners; }
  const std::vector<Shape>& Shapes() const { return this->TriangleShapes; }

  /// The triangles around vertex i are entries VertexCornersBegin()[i] .. [i + 1] of
  /// VertexCorners(): 3 t + a for corner a of triangle t, ascending.
  const std::vector<Index>& VertexCornersBegin() const { return this->CornersBegin; }
  const std::vector<Index>& VertexCorners() const { return this->CornerList; }
  /// The vertex `step` = 1 or 2 corners on from an entry of VertexCorners(), in its triangle.
  Index OtherCorner(Index corner, int step) const
  {
    constexpr int shift[2][3] = { { 1, 1, -2 }, { 2, -1, -1 } };
    return this->Corners.data()[corner + shift[step - 1][corner % 3]];
  }

  /// A_i, the area of the control cell of v_i: a third of the triangles around it.
  const Vector& ControlAreas() const { return this->Areas; }

  /// Connected component c holds the vertices ComponentsBegin()[c] .. [c + 1].
  const std::vector<Index>& ComponentsBegin() const { return this->Components; }
  Index NumberOfComponents() const { return static_cast<Index>(this->Components.size()) - 1; }

  /// One of LengthUnit() in coordinate units.
  double LengthUnit() const { return this->Unit; }
  /// Sum of the lengths of the distinct edges and their number, in LengthUnit(): their quotient is
  /// the h of natural units. Kept apart so that several meshes can share one h.
  double TotalEdgeLength() const { return this->EdgeLength; }
  Index NumberOfEdges() const { return this->Edges; }

  /// Vertices of edges that only one triangle uses, ascending.
  const std::vector<Index>& BoundaryVertices() const { return this->Boundary; }

  /// Where this mesh is a process's part of a surface; null where it is the whole.
  const Partition* GetPartition() const { return this->Processes.get(); }
  void SetPartition(std::shared_ptr<const Partition> partition)
  {
    this->Processes = std::move(partition);
  }

  const Findings& GetFindings() const { return this->Found; }

private:
  friend class MedialMesh; // makes one of its own

  TriangleMesh() = default;
  void SelectTriangles(const Eigen::Ref<const Points>& points,
    const Eigen::Ref<const Triangles>& triangles, const Frame& frame, const ParallelFor& parallel);
  void NumberVertices(const Eigen::Ref<const Points>& points,
    const Eigen::Ref<const Triangles>& triangles, const Frame& frame, const ParallelFor& parallel);
  void ListCorners();
  void MeasureAreas(const ParallelFor& parallel);
  void MeasureEdges(const ParallelFor& parallel);

  std::vector<Index> InputVertices;
  std::vector<Index> InputTriangles;
  Triangles Corners;
  std::vector<Shape> TriangleShapes;
  std::vector<Index> CornersBegin;
  std::vector<Index> CornerList;
  Vector Areas;
  std::vector<Index> Components;
  std::vector<Index> Boundary;
  double Unit = 1.0;
  double EdgeLength = 0.0;
  Index Edges = 0;
  Findings Found;
  std::shared_ptr<const Partition> Processes;
};

/// Values of the distinct vertices per mesh vertex: rows of `input` picked by InputVertex().
Values GatherVertices(const TriangleMesh& mesh, const Eigen::Ref<const Values>& input);

} // namespace SurfaceDiffusion
