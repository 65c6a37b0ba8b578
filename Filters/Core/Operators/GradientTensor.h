// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Operators/CotanWeights.h"

namespace SurfaceDiffusion
{

/// T = sum over the columns k of u of grad u_k grad u_k^T on a triangle, and the root of its
/// determinant, which has no cancellation: it is 0 for one column, and up to round-off for others
/// whose gradients are parallel.
struct GradientTensor
{
  PlaneTensor T{ 0.0, 0.0, 0.0 };
  double RootDeterminant = 0.0;
  double ValueScale = 1.0, Scale = 1.0; ///< by whose product the gradients were multiplied
};
/// Gradients whose squares might overflow, as of data on triangles of 1e-150 of the surface's size,
/// are shortened to 1e75.
GradientTensor SumGradients(const TriangleMesh& mesh, const Values& u, Index t);

/// S = sqrt(along) e1 e1^T + sqrt(across) e2 e2^T per triangle, for constant factors of the
/// diffusivity along and across given directions: a model of S grad u has the diffusion tensor
/// S D S. See IsotropicMean() for triangles without a direction.
class GivenFactors
{
public:
  /// frames: e1 per triangle, without rows if both factors are the same.
  GivenFactors(TangentVectors frames, double along, double across);

  PlaneTensor operator()(Index t) const;
  bool IsOne() const { return this->AreOne; }

private:
  TangentVectors Frames;
  double Along, Across; ///< the square roots
  bool AreOne;
};

/// The unit vector along the largest eigenvalue of a diffusion tensor, or zero if it is isotropic.
Eigen::RowVector2d StrongestAxis(const PlaneTensor& d);

} // namespace SurfaceDiffusion
