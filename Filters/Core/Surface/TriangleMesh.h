// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Buffer.h"
#include "Core/Foundation/Parallel.h"
#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Foundation/Reduction.h"
#include "Core/Foundation/Types.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

/// Counts of defects and other features of a surface that may be unintended.
struct MeshDiagnostics
{
  Index DegenerateTriangles = 0; ///< of zero area (height/longest edge < 1e-15): left out
  Index IsolatedVertices = 0; ///< in no triangle, or in degenerate ones only: left out
  Index NonManifoldEdges = 0; ///< shared by three or more triangles: kept
  Index BoundaryEdges = 0; ///< of one triangle
};

/// A triangulated surface, any angles and any topology, with the barycentric control cells of its
/// vertices, on which the finite volume method integrates (Wu, Deng, Chen 2008, sections 2 and 4.1,
/// 4.2).
///
/// - Triangles of zero area are left out, and so are vertices that no triangle uses.
/// - Vertices are renumbered: by connected component, and within a component along a Hilbert curve,
///   so that neighbours on the surface are neighbours in memory. InputVertex() gives their input
///   numbers.
/// - Lengths are in units of LengthUnit(), a power of two near the size of the surface, so that
///   coordinates from 1e-150 to 1e150 work alike. Areas are in LengthUnit()^2.
/// - A triangle keeps only its shape, laid out in the plane: corner 0 at the origin, corner 1 at
///   (l, 0), corner 2 at (x, y) with l, y > 0. Operators that depend on lengths alone, such as the
///   Laplace-Beltrami operator and all isotropic models, need nothing else. TriangleAxes() in
///   TangentVectors.h gives these axes in space.
class TriangleMesh
{
public:
  /// Corner 1 = (Length, 0) and corner 2 = (X, Y) in the triangle's own axes.
  struct Shape
  {
    double Length, X, Y;
    double Weight = 1.0; ///< see ShapeList
    double Area() const { return 0.5 * Length * Y * Weight; }
    /// Length of the edge opposite corner a.
    double EdgeLength(int a) const
    {
      const double x = a == 0 ? X - Length : X;
      return a == 2 ? Length : std::sqrt(x * x + Y * Y);
    }
  };

  /// The shapes of all triangles: their numbers, and one weight.
  class ShapeList
  {
  public:
    ShapeList() = default;
    /// weight: the fraction of the areas that counts, 1/2 if two sheets cover the surface (see
    /// IntrinsicTriangulation.h).
    explicit ShapeList(Index count, double weight = 1.0)
      : Numbers(static_cast<std::size_t>(count))
      , Weight(weight)
    {
    }

    Index Size() const { return static_cast<Index>(this->Numbers.size()); }
    Shape operator[](std::size_t t) const
    {
      const auto [length, x, y] = this->Numbers[t];
      return { length, x, y, this->Weight };
    }
    void Set(std::size_t t, double length, double x, double y)
    {
      this->Numbers[t] = { length, x, y };
    }
    double GetWeight() const { return this->Weight; }

  private:
    Buffer<std::array<double, 3>> Numbers;
    double Weight = 1.0;
  };

  /// All that a mesh is given; the rest follows from it. See the accessors of the same names.
  struct Contents
  {
    std::vector<Index> InputVertex;
    std::vector<Index> InputTriangle;
    Triangles TriangleVertices;
    Triangles TriangleEdges; ///< no row: an edge is known by its two vertices
    ShapeList Shapes;
    std::vector<Index> ComponentsBegin;
    std::vector<Index> BoundaryVertices;
    Vector ControlAreas; ///< no entries: a third of the triangles around each vertex
    double LengthUnit = 1.0;
    double TotalEdgeLength = 0.0;
    Index NumberOfEdges = 0;
    MeshDiagnostics Diagnostics;
  };

  /// points: finite coordinates; triangles: rows of points; lengthUnit: LengthUnit(), or 0 to
  /// choose it by the size of the surface. Throws Aborted.
  TriangleMesh(const Eigen::Ref<const Points>& points, const Eigen::Ref<const Triangles>& triangles,
    const ParallelFor& parallel = SerialFor(), const ProgressMonitor& progress = ProgressMonitor(),
    double lengthUnit = 0.0);

  /// A mesh of given shapes, which need not lie in space. Triangles may have a vertex twice.
  explicit TriangleMesh(Contents contents, const ParallelFor& parallel = SerialFor());

  Index NumberOfVertices() const { return static_cast<Index>(this->Given.InputVertex.size()); }
  Index NumberOfTriangles() const
  {
    return static_cast<Index>(this->Given.TriangleVertices.rows());
  }

  /// The row of the constructor's points that is vertex i.
  const std::vector<Index>& InputVertex() const { return this->Given.InputVertex; }
  /// The row of the constructor's triangles that is triangle t. Empty if the triangles are not
  /// those of the input.
  const std::vector<Index>& InputTriangle() const { return this->Given.InputTriangle; }

  /// m x 3 vertex numbers.
  const Triangles& TriangleVertices() const { return this->Given.TriangleVertices; }
  /// m x 3 numbers of the edges opposite the corners, below 3 m, if two edges of an intrinsic
  /// triangulation can have the same two vertices. Otherwise no row.
  const Triangles& TriangleEdges() const { return this->Given.TriangleEdges; }
  const ShapeList& Shapes() const { return this->Given.Shapes; }

  /// The triangles around vertex i are entries VertexCornersBegin()[i] .. [i + 1] of
  /// VertexCorners(): 3 t + a for corner a of triangle t, ascending.
  const std::vector<Index>& VertexCornersBegin() const { return this->CornersBegin; }
  const Buffer<Index>& VertexCorners() const { return this->CornerList; }
  /// The vertex `step` = 1 or 2 corners after an entry of VertexCorners(), in its triangle.
  Index OtherCorner(Index corner, int step) const
  {
    constexpr int shift[2][3] = { { 1, 1, -2 }, { 2, -1, -1 } };
    return this->Given.TriangleVertices.data()[corner + shift[step - 1][corner % 3]];
  }

  /// A_i, the area of the control cell of v_i, a third of the triangles around it: the diagonal of
  /// the lumped mass matrix. An intrinsic Delaunay triangulation has those of the surface's own
  /// triangles, so that the sum of A_i u_i is the integral over the drawn surface.
  const Vector& ControlAreas() const { return this->Given.ControlAreas; }
  /// A third of the triangles of this mesh around vertex i.
  double ThirdOfTriangles(Index i) const;
  /// Multiply A_i by a positive factor per input point. The stiffness matrix does not change under
  /// a conformal change of the metric in two dimensions, so this is such a change: lengths near v_i
  /// grow by the square root of the factor, and functions of lengths of edges do not notice.
  void ScaleControlAreas(const std::vector<double>& factors);

  /// Connected component c has the vertices ComponentsBegin()[c] .. [c + 1].
  const std::vector<Index>& ComponentsBegin() const { return this->Given.ComponentsBegin; }
  Index NumberOfComponents() const
  {
    return static_cast<Index>(this->Given.ComponentsBegin.size()) - 1;
  }

  /// The length 1 of this mesh in units of the coordinates.
  double LengthUnit() const { return this->Given.LengthUnit; }
  /// Sum of the lengths of the distinct edges and their number, in LengthUnit(). Their quotient is
  /// the mean edge length h of natural units; they are separate so that several meshes can share
  /// one h.
  double TotalEdgeLength() const { return this->Given.TotalEdgeLength; }
  Index NumberOfEdges() const { return this->Given.NumberOfEdges; }
  /// h, in LengthUnit(); 1 without edges.
  double MeanEdgeLength() const
  {
    return this->NumberOfEdges() > 0 ? this->TotalEdgeLength() / this->NumberOfEdges() : 1.0;
  }

  /// Vertices of edges that only one triangle uses, ascending.
  const std::vector<Index>& BoundaryVertices() const { return this->Given.BoundaryVertices; }

  /// Over the processes that the surface is decomposed over; serial if this mesh is the whole.
  const Reduction& GetReduction() const
  {
    return this->OverProcesses ? *this->OverProcesses : Reduction::Serial();
  }
  void SetReduction(std::shared_ptr<const Reduction> reduction)
  {
    this->OverProcesses = std::move(reduction);
  }

  const MeshDiagnostics& Diagnostics() const { return this->Given.Diagnostics; }

private:
  void ListCorners(const ParallelFor& parallel);
  void SumAreas(const ParallelFor& parallel);
  void MeasureEdges(const ParallelFor& parallel);

  Contents Given;
  std::vector<Index> CornersBegin;
  Buffer<Index> CornerList;
  std::shared_ptr<const Reduction> OverProcesses;
};

/// The rows of `input`, one per input point, of the mesh vertices.
Values GatherVertices(const TriangleMesh& mesh, const Eigen::Ref<const Values>& input);

} // namespace SurfaceDiffusion
