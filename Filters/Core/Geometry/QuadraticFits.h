// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geometry/OrientedNormals.h"

#include <Eigen/QR>
#include <Eigen/SVD>

#include <vector>

namespace SurfaceDiffusion
{

/// Least-squares fits of polynomials
///
///     p x + q y + a x^2/2 + b x y + c y^2/2
///
/// over the tangent plane of a vertex, the origin, to values at the vertices of at most two edges
/// from it, less its own. x and y are in units of Radius(), the largest distance in the plane.
/// Vertices that a function over the plane cannot reach, with normals at 60 degrees or more, do not
/// count, unless the others do not determine the polynomial, as at sharp edges and corners: then all
/// neighbours count. Of several polynomials that fit equally well the one with the smallest
/// p^2 + q^2 + a^2 + 2 b^2 + c^2 is taken, which does not depend on the axes.
class QuadraticFits
{
public:
  using Coefficients = Eigen::Matrix<double, 5, 1>; ///< p, q, a, b, c

  /// All must outlive this object. positions: per vertex, in LengthUnit().
  QuadraticFits(const TriangleMesh& mesh, const Points& positions, const OrientedNormals& normals)
    : Mesh(mesh)
    , Positions(positions)
    , Normals(normals)
  {
  }

  /// Go to a vertex. Returns whether there are other vertices in its plane.
  bool MoveTo(Index vertex);
  /// Whether the vertices determine the polynomials.
  bool IsDetermined() const { return this->Determined; }
  /// The vertices that count, ascending.
  const std::vector<Index>& Vertices() const { return this->Chosen; }
  Coefficients Fit(const Vector& differences) const;
  /// The root mean square of (a^2 + 2 b^2 + c^2)^1/2 for independent errors of variance 1 of the values
  /// at the vertices and at the vertex itself.
  double ErrorOfSecondOrder() const;
  /// Of a polynomial at the vertex, on the surface that is the polynomial of its depths.
  double LaplacianOf(const Coefficients& u) const;

  const Eigen::Matrix<double, 3, 2>& Axes() const { return this->Plane; } ///< of x and y
  double Radius() const { return this->Unit; }
  /// How far vertex j lies below the tangent plane: above 0 where the surface bends away from the
  /// normal.
  double DepthOf(Index j) const;
  Vector Depths() const; ///< of Vertices()
  /// Whether the normals of some neighbours are at 60 degrees or more.
  bool IsSharp() const { return this->Sharp; }
  /// The curvature of the paraboloid of revolution that fits the depths of the neighbours if they
  /// all lie on one side of the tangent plane; otherwise 0.
  double CurvatureOfNeighbours() const;

private:
  void FindDisk();
  std::vector<double> CosinesOfNormals() const;
  bool Decompose();

  const TriangleMesh& Mesh;
  const Points& Positions;
  const OrientedNormals& Normals;
  Index Centre = 0;
  std::vector<Index> Ring; ///< vertices one edge from it, ascending, and itself
  std::vector<Index> Disk; ///< at most two edges from it, ascending
  std::vector<Index> Chosen;
  bool Determined = false;
  bool Sharp = false;
  Eigen::Matrix<double, 3, 2> Plane;
  double Unit = 0.0;
  Eigen::CompleteOrthogonalDecomposition<Eigen::Matrix<double, Eigen::Dynamic, 5>> Regular;
  Eigen::JacobiSVD<Eigen::MatrixXd> Least; ///< where Regular may not be
};

} // namespace SurfaceDiffusion
