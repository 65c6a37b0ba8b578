// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geodesics/ExactDistance.h"

#include "Core/Geodesics/WindowFront.h"

#include <algorithm>
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

std::vector<std::pair<Index, double>> ExactDistance::FindNear(const SourcePiece& source,
  double cutoff, Memories& memories, const ProgressMonitor& progress) const
{
  std::shared_ptr<WindowFront> front;
  {
    const std::lock_guard<std::mutex> lock(memories.Mutex);
    if (!memories.Free.empty())
    {
      front = std::move(memories.Free.back());
      memories.Free.pop_back();
    }
  }
  if (!front)
  {
    front = std::make_shared<WindowFront>(*this->Mesh, this->Frames, cutoff);
  }
  front->AddSource(source, 0);
  front->Run(progress);
  std::vector<std::pair<Index, double>> near;
  for (const Index v : front->Reached)
  {
    near.emplace_back(v, front->Times[static_cast<std::size_t>(v)]);
  }
  std::sort(near.begin(), near.end());
  front->Clear();
  const std::lock_guard<std::mutex> lock(memories.Mutex);
  memories.Free.push_back(std::move(front));
  return near;
}

bool ExactDistance::TakesAtMostASecond(const TriangleMesh& mesh, double times)
{
  // Of 80,000 triangles, the windows of spheres with and without bumps, long ellipsoids, bowls and
  // saddles took .5 to 1.2 s on a loaded processor of 2 GHz, planes and noisy surfaces less.
  constexpr double triangles = 1e5, perFan = 0.2;
  const auto power = [](double count) { return count * std::sqrt(count); };
  double cost = power(static_cast<double>(mesh.NumberOfTriangles()));
  for (std::size_t v = 0; v + 1 < mesh.VertexCornersBegin().size(); ++v)
  {
    const double fan = mesh.VertexCornersBegin()[v + 1] - mesh.VertexCornersBegin()[v];
    cost += perFan * fan * fan; // windows of one edge of a fan may cross all others
  }
  return times * cost <= power(triangles);
}

} // namespace SurfaceDiffusion
