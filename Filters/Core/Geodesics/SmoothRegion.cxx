// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geodesics/SmoothRegion.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace SurfaceDiffusion
{

namespace
{

constexpr double Farthest = 6.0; ///< of d

/// Call use(w) for each neighbour w of a vertex, twice for those inside.
template <typename Use>
void ForEachNeighbour(const TriangleMesh& mesh, Index v, const Use& use)
{
  const auto row = static_cast<std::size_t>(v);
  for (Index k = mesh.VertexCornersBegin()[row]; k < mesh.VertexCornersBegin()[row + 1]; ++k)
  {
    const Index corner = mesh.VertexCorners()[static_cast<std::size_t>(k)];
    use(static_cast<std::size_t>(mesh.OtherCorner(corner, 1)));
    use(static_cast<std::size_t>(mesh.OtherCorner(corner, 2)));
  }
}

/// The vertices near the boundary, in the order of d.
class Band
{
public:
  Band(const TriangleMesh& mesh, const std::vector<char>& inside)
    : Mesh(mesh)
    , Distances(inside.size(), Farthest)
  {
    for (Index v = 0; v < mesh.NumberOfVertices(); ++v)
    {
      bool isEnd = false;
      ForEachNeighbour(mesh, v,
        [&](std::size_t w) { isEnd = isEnd || inside[w] != inside[static_cast<std::size_t>(v)]; });
      if (isEnd)
      {
        this->Add(v, 0.5);
      }
    }
    for (std::size_t k = 0; k < this->Vertices.size(); ++k)
    {
      const double next = this->Distances[static_cast<std::size_t>(this->Vertices[k])] + 1.0;
      ForEachNeighbour(mesh, this->Vertices[k],
        [&](std::size_t w)
        {
          if (next < Farthest + 1.0 && this->Distances[w] == Farthest)
          {
            this->Add(static_cast<Index>(w), next);
          }
        });
    }
    for (std::size_t v = 0; v < inside.size(); ++v)
    {
      this->Distances[v] *= inside[v] ? -1.0 : 1.0;
    }
  }

  /// L u, 0 beyond the band.
  std::vector<double> Differences(const std::vector<double>& u) const
  {
    std::vector<double> found(u.size(), 0.0);
    for (const Index v : this->Vertices)
    {
      double sum = 0.0;
      double count = 0.0;
      ForEachNeighbour(this->Mesh, v,
        [&](std::size_t w)
        {
          sum += u[w];
          ++count;
        });
      found[static_cast<std::size_t>(v)] = u[static_cast<std::size_t>(v)] - sum / count;
    }
    return found;
  }

  /// Those at open ends: a neighbour that comes once is there.
  std::vector<std::size_t> OpenEnds() const
  {
    std::vector<std::size_t> ends;
    for (const Index v : this->Vertices)
    {
      std::size_t odd = 0; // all that come twice leave no bit
      ForEachNeighbour(this->Mesh, v, [&](std::size_t w) { odd ^= w + 1; });
      if (odd != 0)
      {
        ends.push_back(static_cast<std::size_t>(v));
      }
    }
    return ends;
  }

  const TriangleMesh& Mesh;
  std::vector<double> Distances; ///< d, per vertex of the mesh
  std::vector<Index> Vertices;

private:
  void Add(Index v, double distance)
  {
    this->Distances[static_cast<std::size_t>(v)] = std::min(distance, Farthest - 1e-9);
    this->Vertices.push_back(v);
  }
};

} // namespace

std::vector<double> SmoothRegion(const TriangleMesh& mesh, const std::vector<char>& inside)
{
  constexpr double nearness = 0.02;
  constexpr int iterations = 60;
  const Band band(mesh, inside);
  const std::vector<std::size_t> ends = band.OpenEnds();
  std::vector<double> u = band.Distances;
  std::vector<double> ahead = u;
  double momentum = 1.0;
  for (int iteration = 0; iteration < iterations; ++iteration)
  {
    std::vector<double> bend = band.Differences(ahead);
    for (const std::size_t v : ends)
    {
      bend[v] = 0.0;
    }
    const std::vector<double> slope = band.Differences(bend);
    const double next = 0.5 * (1.0 + std::sqrt(1.0 + 4.0 * momentum * momentum));
    for (const Index vertex : band.Vertices)
    {
      const auto v = static_cast<std::size_t>(vertex);
      const double step = (slope[v] + nearness * (ahead[v] - band.Distances[v])) / (4.0 + nearness);
      const double moved =
        inside[v] ? std::min(ahead[v] - step, 0.0) : std::max(ahead[v] - step, 0.0);
      ahead[v] = moved + (momentum - 1.0) / next * (moved - u[v]);
      u[v] = moved;
    }
    momentum = next;
  }
  return u;
}

} // namespace SurfaceDiffusion
