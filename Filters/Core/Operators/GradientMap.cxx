// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Operators/GradientMap.h"

#include "Core/Operators/CotanWeights.h"

#include <utility>

namespace SurfaceDiffusion
{

GradientMaps::GradientMaps(
  std::shared_ptr<const TriangleMesh> mesh, TangentVectors frames, double along, double across)
  : Mesh(std::move(mesh))
  , Frames(std::move(frames))
  , Along(along)
  , Across(across)
{
}

GradientMap GradientMaps::operator[](Index t) const
{
  const TriangleMesh::Shape& s = this->Mesh->Shapes()[t];
  const GradientMap plain = { Gradient(s, 0.0, 1.0, 0.0), Gradient(s, 0.0, 0.0, 1.0) };
  if (this->Frames.rows() == 0)
  {
    return plain;
  }
  if (!HasDirection(this->Frames, t))
  {
    const double mean = IsotropicMean(this->Along, this->Across);
    return { mean * plain.First, mean * plain.Second };
  }
  const Eigen::Vector2d e1 = this->Frames.row(t);
  const auto stretch = [&](const Eigen::Vector2d& v) -> Eigen::Vector2d
  { return this->Across * v + ((this->Along - this->Across) * e1.dot(v)) * e1; };
  return { stretch(plain.First), stretch(plain.Second) };
}

} // namespace SurfaceDiffusion
