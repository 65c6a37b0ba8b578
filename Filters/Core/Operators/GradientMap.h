// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

#include <vector>

namespace SurfaceDiffusion
{

/// The linear map from the values at a triangle's corners to S grad u, a vector in the triangle's
/// own axes, with a matrix S that stretches directions:
///   S grad u = First (u_1 - u_0) + Second (u_2 - u_0).
struct GradientMap
{
  Eigen::Vector2d First, Second;

  /// S grad phi_a of the linear basis function of corner a.
  Eigen::Vector2d OfCorner(int a) const
  {
    return a == 1 ? this->First : a == 2 ? this->Second : -this->First - this->Second;
  }
};

/// S = 1, per triangle.
std::vector<GradientMap> PlainGradients(const TriangleMesh& mesh, const ParallelFor& parallel);

/// S = along e1 e1^T + across e2 e2^T; see IsotropicMean() for triangles without a direction.
std::vector<GradientMap> StretchedGradients(const TriangleMesh& mesh,
  const Eigen::Ref<const TangentVectors>& frames, double along, double across,
  const ParallelFor& parallel);

} // namespace SurfaceDiffusion
