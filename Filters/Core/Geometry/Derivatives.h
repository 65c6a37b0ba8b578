// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geometry/OrientedNormals.h"
#include "Core/Surface/TriangleMesh.h"

#include <cstdint>
#include <vector>

namespace SurfaceDiffusion
{

/// Derivatives of functions and vector fields on a triangulated surface. A field of k columns of
/// vectors has 3 k columns: x, y, z of the first one, and so on. With the linear basis functions
/// phi_i, the areas a_t of the triangles and A_i of the control cells, and the outward conormal nu
/// of boundary edges:
///
///     gradient on a triangle      g_t = sum over its corners of u_i grad phi_i
///     gradient at a vertex        g_i = P_i (sum over t at i of a_t g_t) / sum of a_t
///     divergence at a vertex      A_i d_i = - sum over t of a_t v_t . grad phi_i
///                                           + integral over the boundary of phi_i v . nu
///     curl at a vertex            the divergence of v x n
///     Laplacian                   inside, the divergence of g_t; at boundary vertices that of the
///                                 quadratic polynomial that fits u near it, see QuadraticFits
///
/// P_i is the projection to the tangent plane of the vertex, n the unit normal of the triangle. Of
/// vectors at vertices, v_t is the mean of the projections of those of its corners to its plane, and
/// v on a boundary edge their linear interpolation. For the divergence they are projected to the
/// tangent planes of the vertices first, with SphericalNormals(): the divergence of a normal part,
/// which the triangles see at random, would not converge on irregular meshes.
///
/// The sum of A_i d_i is the flux across the boundary, that of A_i times the curl the circulation
/// along it, up to round-off; and the curl of g_t is 0. On planes all are exact for linear
/// functions and fields, at boundaries too, where the Laplacian is for quadratic ones. Inside, A times
/// the Laplacian is -K u with the stiffness matrix K of cotan weights. An edge of three or more
/// triangles is no boundary: what leaves one of them enters the others. On surfaces with one side,
/// such as a Moebius strip, the curl has no sign: it is positive there.
class Derivatives
{
public:
  /// positions: per vertex of the mesh, in LengthUnit(). Both must outlive this object.
  Derivatives(
    const TriangleMesh& mesh, const Points& positions, const ParallelFor& parallel = SerialFor());

  /// g_t, m x 3k, of u, n x k, in 1/LengthUnit().
  Values Gradients(const Values& u) const;
  /// The means g_i of vectors on triangles, n x 3k.
  Values ToVertices(const Values& ofTriangles) const;
  /// The Laplacian, n x k, of u. NaN at boundary vertices whose neighbours do not determine it.
  Values Laplacian(const Values& u) const;
  /// The divergence, n x k, of vectors on triangles, whose parts in their planes count.
  Values Divergence(const Values& ofTriangles) const;
  /// That of vectors at vertices.
  Values DivergenceOfVertices(const Values& ofVertices) const;
  Values Curl(const Values& ofTriangles) const;
  Values CurlOfVertices(const Values& ofVertices) const;

  const OrientedNormals& Normals() const { return this->Oriented; }

  /// grad phi_a of corner a of triangle t.
  Eigen::RowVector3d BasisGradient(Index t, int a) const;
  /// v_t, m x 3k, of vectors at vertices.
  Values ToTriangles(const Values& ofVertices) const;

private:
  /// The sum over corners 3 t + a and boundary edges. onTriangle(corner, c): v_t. onEdge(corner, i, j,
  /// c): the mean of phi_i v over the edge from i to j. Both of column c.
  template <typename OnTriangle, typename OnEdge>
  Values SumFluxes(Eigen::Index columns, const OnTriangle& onTriangle, const OnEdge& onEdge) const;
  /// turn(v, corner): v, or v x n.
  template <typename Turn>
  Values SumOfTriangles(const Values& ofTriangles, const Turn& turn) const;
  template <typename Turn>
  Values SumOfVertices(const Values& ofVertices, const Turn& turn) const;
  Eigen::RowVector3d Turned(const Eigen::RowVector3d& v, Index corner) const; ///< v x n
  Values WithoutSign(Values curl) const;
  void FindBoundary();

  const TriangleMesh& Mesh;
  const Points& Positions;
  const ParallelFor& Parallel;
  OrientedNormals Oriented;
  std::vector<std::uint8_t> BoundarySides; ///< per triangle: bit a if no other has the edge
};

} // namespace SurfaceDiffusion
