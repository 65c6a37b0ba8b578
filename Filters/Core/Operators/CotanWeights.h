// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

#include <cmath>

namespace SurfaceDiffusion
{

/// The coefficients of the Laplace-Beltrami operator, and of div(D grad u) with a diffusion tensor
/// D, on a triangulated surface: cotan weights and their anisotropic relatives,
///   c_ij = -area grad(phi_i) . D grad(phi_j)
/// for two corners i, j of a triangle, with the linear basis functions phi. They are symmetric.
/// Entry (t, a) of CornerWeights belongs to the edge of triangle t opposite corner a. Assembler
/// sums them to the stiffness matrix K.

/// Gradient of the linear function with these corner values, in the triangle's own axes.
inline Eigen::Vector2d Gradient(const TriangleMesh::Shape& s, double u0, double u1, double u2)
{
  const double x = (u1 - u0) / s.Length;
  return { x, (u2 - u0 - x * s.X) / s.Y };
}

/// The cotan weights (10): c_ij = 1/2 cot(angle at v_k), D = 1. The paper derives them from integrals
/// over the boundaries of control cells: by its Theorem 1 (15) the normal integrates over the part of
/// the boundary of C_i inside a triangle to -area grad(phi_i).
CornerWeights CotanWeights(const TriangleMesh& mesh, const ParallelFor& parallel = SerialFor());

/// Those of one triangle.
inline Eigen::RowVector3d CotanWeights(const TriangleMesh::Shape& s)
{
  // The cotangent of an angle is the cosine over the sine of its two edges.
  const double half = 0.5 * s.Weight;
  return { half * s.X / s.Y, half * (s.Length - s.X) / s.Y,
    half * (s.Y / s.Length - (s.X / s.Y) * ((s.Length - s.X) / s.Length)) };
}

/// A symmetric tensor of second order in a triangle's own axes.
struct PlaneTensor
{
  double XX = 1.0, XY = 0.0, YY = 1.0;

  double Trace() const { return this->XX + this->YY; }
  /// The traceless part as a complex number: half the difference of the eigenvalues times
  /// exp(2 i a), with the angle a of the main axis.
  Eigen::Vector2d Deviator() const { return { 0.5 * (this->XX - this->YY), this->XY }; }
  /// S T S with this tensor T.
  PlaneTensor Between(const PlaneTensor& s) const
  {
    const double a = this->XX * s.XX + this->XY * s.XY; // T S = (a b; c d)
    const double b = this->XX * s.XY + this->XY * s.YY;
    const double c = this->XY * s.XX + this->YY * s.XY;
    const double d = this->XY * s.XY + this->YY * s.YY;
    return { s.XX * a + s.XY * c, s.XX * b + s.XY * d, s.XY * b + s.YY * d };
  }
};

/// The weights of a diffusion tensor D. Those of D = 1 are the cotan weights.
inline Eigen::RowVector3d TensorWeights(const TriangleMesh::Shape& s, const PlaneTensor& d)
{
  const double half = 0.5 * s.Weight;
  const double left = s.X / s.Y;
  const double right = (s.Length - s.X) / s.Y;
  return { half * (d.YY * left - d.XY), half * (d.YY * right + d.XY),
    half * (s.Y * d.XX + (s.Length - 2.0 * s.X) * d.XY - d.YY * left * (s.Length - s.X)) /
      s.Length };
}

/// The weights of the diffusion along a direction (13): D = e e^T. Zero if e is zero.
inline Eigen::RowVector3d DirectionalWeights(const TriangleMesh::Shape& s, double ex, double ey)
{
  const Eigen::Vector2d e(ex, ey);
  const double d1 = e.dot(Gradient(s, 0.0, 1.0, 0.0)); // grad(phi_1) . e
  const double d2 = e.dot(Gradient(s, 0.0, 0.0, 1.0));
  const double d0 = -d1 - d2;
  const double area = s.Area();
  return { -area * d1 * d2, -area * d2 * d0, -area * d0 * d1 };
}

/// The same for e1 of all triangles. The weights across e1 are those along e2, which is
/// perpendicular to it. They add up to the cotan weights, but on needles no digit of theirs may be
/// left in the difference.
CornerWeights DirectionalWeights(const TriangleMesh& mesh,
  const Eigen::Ref<const TangentVectors>& frames, const ParallelFor& parallel = SerialFor());

/// The weights of D = g1 e1 e1^T + g2 e2 e2^T (12) with constant g1, g2 >= 0.
CornerWeights AnisotropicWeights(const TriangleMesh& mesh, const CornerWeights& isotropic,
  const Eigen::Ref<const TangentVectors>& frames, double g1, double g2,
  const ParallelFor& parallel = SerialFor());

/// The same with g1, g2 of each triangle, m values each.
CornerWeights AnisotropicWeights(const TriangleMesh& mesh, const CornerWeights& isotropic,
  const Eigen::Ref<const TangentVectors>& frames, const Eigen::Ref<const Vector>& g1,
  const Eigen::Ref<const Vector>& g2, const ParallelFor& parallel = SerialFor());

/// False for a triangle without a direction: e1 is zero there.
inline bool HasDirection(const Eigen::Ref<const TangentVectors>& frames, Index t)
{
  return !frames.row(t).isZero(0.0);
}

/// The diffusivity of a triangle without a direction, which is isotropic: the geometric mean of g1
/// and g2, as det D = g1 g2 has it. The same for other factors along and across a direction.
inline double IsotropicMean(double g1, double g2)
{
  return std::sqrt(g1) * std::sqrt(g2);
}

/// The weights of D = g1 e1 e1^T + g2 e2 e2^T on one triangle, from its cotan weights and those
/// along e1 and e2.
template <typename Isotropic, typename Along, typename Across>
Eigen::RowVector3d AnisotropicWeights(bool directed, const Isotropic& isotropic, const Along& along,
  const Across& across, double g1, double g2)
{
  if (directed)
  {
    return g1 * along + g2 * across;
  }
  return IsotropicMean(g1, g2) * isotropic;
}

} // namespace SurfaceDiffusion
