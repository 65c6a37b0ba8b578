// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// GeodesicDistance: the march of fronts over the vertices.

#include "Core/Geodesics/GeodesicDistance.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <queue>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// What a time has to fall by, relatively, so that the front starts again: more than round-off. Where the
/// lengths of an edge differ much between its two triangles, times may fall by less and less without an
/// end; after UsualFalls, what counts doubles with each.
double SmallestFall(int falls)
{
  constexpr double resolved = 1e-14;
  constexpr int UsualFalls = 16;
  return std::ldexp(resolved, std::max(0, falls - UsualFalls));
}

} // namespace

GeodesicDistance::Memory::Memory(Index vertices)
  : Found{ std::vector<double>(static_cast<std::size_t>(vertices), Never),
    std::vector<Index>(static_cast<std::size_t>(vertices), -1) }
  , Starts(this->Found.Times.size(), 0.0)
  , Media(this->Found.Times.size(), -1)
  , Falls(static_cast<std::size_t>(vertices), 0)
{
}

void GeodesicDistance::Memory::Clear(const std::vector<Index>& vertices)
{
  for (const Index vertex : vertices)
  {
    const auto v = static_cast<std::size_t>(vertex);
    this->Found.Times[v] = Never;
    this->Found.Sources[v] = -1;
    this->Falls[v] = 0;
  }
}

GeodesicDistance::Arrival GeodesicDistance::Find(
  const std::vector<FrontSource>& sources, double cutoff, const ProgressMonitor& progress) const
{
  Memory memory(this->Mesh->NumberOfVertices());
  this->FindNear(sources, cutoff, {}, memory, progress);
  return std::move(memory.Found);
}

/// The least at each vertex.
std::vector<double> GeodesicDistance::TimesOfSources(const std::vector<FrontSource>& sources) const
{
  std::vector<double> times(static_cast<std::size_t>(this->Mesh->NumberOfVertices()), Never);
  for (const FrontSource& source : sources)
  {
    double& time = times[static_cast<std::size_t>(source.Vertex)];
    time = std::min(time, source.Time);
  }
  return times;
}

/// Whether no way from a vertex is the first one, since fronts start all around it as early.
bool GeodesicDistance::IsAmongSources(
  const FrontSource& source, const std::vector<double>& times) const
{
  const auto v = static_cast<std::size_t>(source.Vertex);
  const TriangleMesh& mesh = *this->Mesh;
  for (Index k = mesh.VertexCornersBegin()[v]; k < mesh.VertexCornersBegin()[v + 1]; ++k)
  {
    for (const int step : { 1, 2 })
    {
      const Index other = mesh.OtherCorner(mesh.VertexCorners()[static_cast<std::size_t>(k)], step);
      if (!(times[static_cast<std::size_t>(other)] <= source.Time))
      {
        return false;
      }
    }
  }
  return true;
}

GeodesicDistance::Arrival GeodesicDistance::FindNearest(
  const std::vector<FrontSource>& sources, const ProgressMonitor& progress) const
{
  Arrival nearest = this->Find(sources, Never, progress.Part(0.0, 0.5));
  std::map<Index, std::vector<Index>> labels;
  for (std::size_t k = 0; k < sources.size(); ++k)
  {
    labels[sources[k].Label].push_back(static_cast<Index>(k));
  }
  if (labels.size() < 2)
  {
    return nearest;
  }
  std::vector<double> latest = this->LongestEdges();
  constexpr double edges = 3.0;
  for (std::size_t i = 0; i < latest.size(); ++i)
  {
    latest[i] = nearest.Times[i] + edges * latest[i];
  }
  const std::vector<double> starts = this->TimesOfSources(sources);
  Memory alone(this->Mesh->NumberOfVertices());
  nearest = alone.Found;
  double done = 0.0;
  for (const auto& [label, rows] : labels)
  {
    std::vector<FrontSource> ofLabel;
    for (const Index k : rows)
    {
      ofLabel.push_back(sources[static_cast<std::size_t>(k)]);
    }
    const bool isInside = ofLabel.size() == 1 && this->IsAmongSources(ofLabel[0], starts);
    const std::vector<Index> touched =
      this->FindNear(ofLabel, isInside ? ofLabel[0].Time : Never, latest, alone);
    for (const Index vertex : touched)
    {
      const auto v = static_cast<std::size_t>(vertex);
      const Index row = rows[static_cast<std::size_t>(alone.Found.Sources[v])];
      if (alone.Found.Times[v] < nearest.Times[v] ||
        (alone.Found.Times[v] == nearest.Times[v] && row < nearest.Sources[v]))
      {
        nearest.Times[v] = alone.Found.Times[v];
        nearest.Sources[v] = row;
      }
    }
    alone.Clear(touched);
    progress.Report(0.5 + 0.5 * ++done / static_cast<double>(labels.size()));
  }
  return nearest;
}

/// Per vertex, the longest time along an edge of a triangle around it that is no barrier.
std::vector<double> GeodesicDistance::LongestEdges() const
{
  const TriangleMesh& mesh = *this->Mesh;
  std::vector<double> longest(static_cast<std::size_t>(mesh.NumberOfVertices()), 0.0);
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    if (IsBarrier(this->Shapes, t))
    {
      continue;
    }
    const TriangleMesh::Shape shape = this->ShapeOf(t);
    const double edge = std::max({ shape.EdgeLength(0), shape.EdgeLength(1), shape.EdgeLength(2) });
    for (int a = 0; a < 3; ++a)
    {
      double& known = longest[static_cast<std::size_t>(mesh.TriangleVertices()(t, a))];
      known = std::max(known, edge);
    }
  }
  return longest;
}

std::vector<Index> GeodesicDistance::FindNear(const std::vector<FrontSource>& sources,
  double cutoff, const std::vector<double>& latest, Memory& memory,
  const ProgressMonitor& progress) const
{
  Arrival& arrival = memory.Found;
  const TriangleMesh& mesh = *this->Mesh;
  const auto n = static_cast<std::size_t>(mesh.NumberOfVertices());
  std::vector<Index> reached;
  const auto limitAt = [&](std::size_t v)
  { return latest.empty() ? cutoff : std::min(cutoff, latest[v]); };
  // The sources, and the corners that ways go around with the numbers of their sources
  std::vector<FrontSource> fronts = sources;
  std::vector<Index> sourceOf(sources.size());
  using Event = std::pair<double, Index>; // time, vertex
  std::priority_queue<Event, std::vector<Event>, std::greater<>> queue;
  for (std::size_t k = 0; k < sources.size(); ++k)
  {
    const FrontSource& source = sources[k];
    const auto v = static_cast<std::size_t>(source.Vertex);
    sourceOf[k] = static_cast<Index>(k);
    if (source.Time < arrival.Times[v] && source.Time <= limitAt(v))
    {
      reached.push_back(source.Vertex);
      arrival.Times[v] = source.Time;
      arrival.Sources[v] = static_cast<Index>(k);
      memory.Starts[v] = source.Start;
      memory.Media[v] = -1;
      queue.emplace(source.Time, source.Vertex);
    }
  }
  const std::size_t reportEvery = std::clamp<std::size_t>(n / 32, 1, 16384);
  for (std::size_t visited = 0; !queue.empty();)
  {
    const auto [time, vertex] = queue.top();
    queue.pop();
    if (time > arrival.Times[static_cast<std::size_t>(vertex)])
    {
      continue; // it has been reached earlier since
    }
    if (++visited % reportEvery == 0)
    {
      progress.Report(std::min(1.0, static_cast<double>(visited) / static_cast<double>(n)));
    }
    Index around = -1; // the front from this corner
    for (Index k = mesh.VertexCornersBegin()[vertex]; k < mesh.VertexCornersBegin()[vertex + 1];
         ++k)
    {
      const Index corner = mesh.VertexCorners()[static_cast<std::size_t>(k)];
      for (const int step : { 1, 2 })
      {
        const Index neighbour = mesh.OtherCorner(corner, step);
        const Index at = corner - corner % 3 + (corner % 3 + step) % 3;
        Way way = this->WayThrough(at, fronts, memory);
        double& known = arrival.Times[static_cast<std::size_t>(neighbour)];
        const double limit = limitAt(static_cast<std::size_t>(neighbour));
        int& fallsHere = memory.Falls[static_cast<std::size_t>(neighbour)];
        if (!(way.Time < Never && way.Time <= limit) ||
          !(known == Never || way.Time < known - SmallestFall(fallsHere) * std::abs(known)))
        {
          continue;
        }
        ++fallsHere;
        if (way.Along == vertex && this->IsCorner[static_cast<std::size_t>(vertex)] != 0)
        {
          if (around < 0)
          {
            const FrontSource& before = fronts[static_cast<std::size_t>(way.Front)];
            around = static_cast<Index>(fronts.size());
            const Index point = -1 - vertex; // of no source
            fronts.push_back({ vertex, time, before.Label, point, time });
            sourceOf.push_back(sourceOf[static_cast<std::size_t>(way.Front)]);
          }
          way.Front = around;
          way.Start = time;
        }
        if (known == Never)
        {
          reached.push_back(neighbour);
        }
        known = way.Time;
        arrival.Sources[static_cast<std::size_t>(neighbour)] = way.Front;
        memory.Starts[static_cast<std::size_t>(neighbour)] = way.Start;
        memory.Media[static_cast<std::size_t>(neighbour)] = way.Medium;
        queue.emplace(way.Time, neighbour);
      }
    }
  }
  std::sort(reached.begin(), reached.end());
  reached.erase(std::unique(reached.begin(), reached.end()), reached.end());
  for (const Index vertex : reached)
  {
    Index& source = arrival.Sources[static_cast<std::size_t>(vertex)];
    source = sourceOf[static_cast<std::size_t>(source)];
  }
  return reached;
}

} // namespace SurfaceDiffusion
