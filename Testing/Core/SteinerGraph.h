// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geodesics/GeodesicDistance.h"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <queue>
#include <utility>
#include <vector>

namespace SurfaceDiffusion::Testing
{

/// The shortest ways from a vertex over `points` places on each edge, straight in the triangles as fronts
/// measure them: later than fronts, by less the more places there are.
inline std::vector<double> TimesOverGraph(
  const TriangleMesh& mesh, const FrontShapes& shapes, Index source, int points)
{
  struct Place
  {
    std::size_t Node;
    Eigen::Vector2d At;
  };
  const auto vertices = static_cast<std::size_t>(mesh.NumberOfVertices());
  std::map<std::pair<Index, Index>, std::size_t> firstOf; // per edge
  std::vector<std::vector<Place>> places(shapes.size());
  std::vector<std::vector<std::pair<std::size_t, std::size_t>>> uses(
    vertices + 3 * shapes.size() * static_cast<std::size_t>(points)); // per node
  for (std::size_t t = 0; t < shapes.size(); ++t)
  {
    const TriangleMesh::Shape& s = shapes[t];
    const std::array<Eigen::Vector2d, 3> corners = { Eigen::Vector2d(0.0, 0.0),
      Eigen::Vector2d(s.Length, 0.0), Eigen::Vector2d(s.X, s.Y) };
    const auto add = [&](std::size_t node, const Eigen::Vector2d& at)
    {
      uses[node].emplace_back(t, places[t].size());
      places[t].push_back({ node, at });
    };
    for (std::size_t a = 0; a < 3; ++a)
    {
      std::size_t from = a, to = (a + 1) % 3;
      const auto vertexAt = [&](std::size_t corner)
      {
        return mesh.TriangleVertices()(
          static_cast<Eigen::Index>(t), static_cast<Eigen::Index>(corner));
      };
      add(static_cast<std::size_t>(vertexAt(a)), corners[a]);
      if (vertexAt(from) > vertexAt(to))
      {
        std::swap(from, to);
      }
      const std::size_t next = vertices + firstOf.size() * static_cast<std::size_t>(points);
      const std::size_t first =
        firstOf.emplace(std::pair(vertexAt(from), vertexAt(to)), next).first->second;
      for (int k = 0; k < points; ++k)
      {
        add(first + static_cast<std::size_t>(k),
          corners[from] + (k + 1.0) / (points + 1.0) * (corners[to] - corners[from]));
      }
    }
  }
  std::vector<double> times(uses.size(), Never);
  using Event = std::pair<double, std::size_t>;
  std::priority_queue<Event, std::vector<Event>, std::greater<>> queue;
  times[static_cast<std::size_t>(source)] = 0.0;
  for (queue.emplace(0.0, source); !queue.empty();)
  {
    const auto [time, node] = queue.top();
    queue.pop();
    if (time > times[node])
    {
      continue;
    }
    for (const auto& [t, row] : uses[node])
    {
      for (const Place& place : places[t])
      {
        const double by = time + (place.At - places[t][row].At).norm();
        if (by < times[place.Node])
        {
          times[place.Node] = by;
          queue.emplace(by, place.Node);
        }
      }
    }
  }
  times.resize(vertices);
  return times;
}

} // namespace SurfaceDiffusion::Testing
