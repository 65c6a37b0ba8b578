// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Operators/CotanWeights.h"
#include "Core/Surface/TriangleMesh.h"

#include <memory>

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

/// That of S = 1.
inline GradientMap PlainGradientMap(const TriangleMesh::Shape& s)
{
  return { Gradient(s, 0.0, 1.0, 0.0), Gradient(s, 0.0, 0.0, 1.0) };
}

/// The map of each triangle of a mesh, computed when it is asked for.
class GradientMaps
{
public:
  /// S = 1.
  explicit GradientMaps(std::shared_ptr<const TriangleMesh> mesh)
    : GradientMaps(std::move(mesh), TangentVectors(), 1.0, 1.0)
  {
  }
  /// S = along e1 e1^T + across e2 e2^T; see IsotropicMean() for triangles without a direction.
  /// frames: e1 per triangle; no row: S = 1.
  GradientMaps(
    std::shared_ptr<const TriangleMesh> mesh, TangentVectors frames, double along, double across);

  GradientMap operator[](Index t) const
  {
    const GradientMap plain = PlainGradientMap(this->Mesh->Shapes()[t]);
    return this->Frames.rows() == 0 ? plain : this->Stretch(t, plain);
  }

private:
  GradientMap Stretch(Index t, const GradientMap& plain) const;

  std::shared_ptr<const TriangleMesh> Mesh;
  TangentVectors Frames;
  double Along, Across;
};

} // namespace SurfaceDiffusion
