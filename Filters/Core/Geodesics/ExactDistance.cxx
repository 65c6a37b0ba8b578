// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geodesics/ExactDistance.h"

#include "Core/Geodesics/WindowFront.h"

#include <cmath>
#include <utility>

namespace SurfaceDiffusion
{

ExactDistance::ExactDistance(std::shared_ptr<const TriangleMesh> mesh)
  : Mesh(std::move(mesh))
  , Frames(*this->Mesh)
{
}

GeodesicDistance::Arrival ExactDistance::Find(
  const std::vector<SourcePiece>& sources, double cutoff, const ProgressMonitor& progress) const
{
  WindowFront front(*this->Mesh, this->Frames, cutoff);
  for (std::size_t k = 0; k < sources.size(); ++k)
  {
    front.AddSource(sources[k], static_cast<Index>(k));
  }
  front.Run(progress);
  return { std::move(front.Times), std::move(front.Sources) };
}

bool ExactDistance::TakesAtMostASecond(const TriangleMesh& mesh, double times)
{
  constexpr double inASecond = 100000.0;
  return times * std::pow(mesh.NumberOfTriangles() / inASecond, 1.5) <= 1.0;
}

} // namespace SurfaceDiffusion
