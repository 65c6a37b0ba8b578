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
  constexpr double triangles = 1e5, perFan = 0.2, needle = 8.0;
  const auto power = [](double count) { return count * std::sqrt(count); };
  double cost = power(static_cast<double>(mesh.NumberOfTriangles()));
  std::vector<char> isOnRim(static_cast<std::size_t>(mesh.NumberOfVertices()), 0);
  for (const Index v : mesh.BoundaryVertices())
  {
    isOnRim[static_cast<std::size_t>(v)] = 1;
  }
  double largestFan = 0.0;
  for (std::size_t v = 0; v + 1 < mesh.VertexCornersBegin().size(); ++v)
  {
    double fan = 0.0;
    for (Index k = mesh.VertexCornersBegin()[v]; k < mesh.VertexCornersBegin()[v + 1]; ++k)
    {
      const Index corner = mesh.VertexCorners()[static_cast<std::size_t>(k)];
      // Nothing comes over the rim of a disk.
      const bool isOpen = isOnRim[static_cast<std::size_t>(mesh.OtherCorner(corner, 1))] &&
        isOnRim[static_cast<std::size_t>(mesh.OtherCorner(corner, 2))];
      fan += isOpen ? 0.0 : 1.0;
    }
    cost += perFan * fan * fan; // windows of one edge of a fan may cross all others
    largestFan = std::max(largestFan, fan);
  }
  // Needles between the poles of a globe, some 3e-8 s for each and each meridian. Hubs of 1,000 to 8,000
  // triangles in surfaces without other needles took less than half a second.
  double needles = 0.0;
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const TriangleMesh::Shape shape = mesh.Shapes()[static_cast<std::size_t>(t)];
    const double edge = std::max({ shape.EdgeLength(0), shape.EdgeLength(1), shape.EdgeLength(2) });
    needles += edge * edge > needle * 2.0 * shape.Area() ? 1.0 : 0.0;
  }
  cost += largestFan * std::max(0.0, needles - largestFan);
  return times * cost <= power(triangles);
}

} // namespace SurfaceDiffusion
