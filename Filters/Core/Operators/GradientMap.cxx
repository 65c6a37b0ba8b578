// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Operators/GradientMap.h"

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

GradientMap GradientMaps::Stretch(Index t, const GradientMap& plain) const
{
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
