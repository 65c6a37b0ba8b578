// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The boundaries of regions, and the closed curves, of signed distances.
#include "Run/DistanceRun.h"

#include "Core/Geodesics/CurveSides.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <string>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// The rows of places along each closed line, from the pairs of its straight parts.
std::vector<std::vector<Index>> OrderClosedLines(const SourceShapes& shapes)
{
  std::map<Index, std::vector<Index>> neighbours;
  for (const auto& [first, second] : shapes.Segments)
  {
    neighbours[first].push_back(second);
    neighbours[second].push_back(first);
  }
  std::vector<std::vector<Index>> lines;
  for (Index row = 0; row < static_cast<Index>(shapes.Places.rows()); ++row)
  {
    const bool isHidden = IsSet(shapes.Hidden, static_cast<std::size_t>(row));
    const auto found = neighbours.find(row);
    if (!isHidden && (found == neighbours.end() || found->second.size() != 2))
    {
      throw InputError(Sentence("point ")
        << row << " of the sources is on no closed line; allowed together with "
        << Word::Setting("Signed") << ": closed lines of three or more points");
    }
  }
  while (!neighbours.empty())
  {
    std::vector<Index> line;
    for (Index row = neighbours.begin()->first; row >= 0;)
    {
      line.push_back(row);
      const std::vector<Index> next = neighbours.at(row);
      neighbours.erase(row);
      row = neighbours.count(next[0]) > 0 ? next[0] : neighbours.count(next[1]) > 0 ? next[1] : -1;
    }
    lines.push_back(std::move(line));
  }
  return lines;
}

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

/// The smoothest function that is not above 0 within a region nor below it outside, near its boundary, where it
/// is 0: the minimum of
///   |L u|^2 + 0.02 |u - d|^2
/// with the difference L u from the mean of the neighbours and the distance d in edges, 1/2 at the ends of those
/// that leave the region and at most 6, by accelerated projected gradients (A. Beck, M. Teboulle, SIAM J.
/// Imaging Sci. 2, 2009). The middle of each edge that leaves the region is 2 % of the largest distance off on a
/// sphere of 642 vertices, and this boundary 0.7 %.
std::vector<double> SmoothRegion(const TriangleMesh& mesh, const std::vector<char>& inside)
{
  constexpr double farthest = 6.0;
  constexpr double nearness = 0.02;
  constexpr int iterations = 60;
  std::vector<double> distances(inside.size(), farthest);
  std::vector<Index> band;
  const auto add = [&](Index v, double distance)
  {
    distances[static_cast<std::size_t>(v)] = std::min(distance, farthest - 1e-9);
    band.push_back(v);
  };
  for (Index v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    bool isEnd = false;
    ForEachNeighbour(mesh, v,
      [&](std::size_t w) { isEnd = isEnd || inside[w] != inside[static_cast<std::size_t>(v)]; });
    if (isEnd)
    {
      add(v, 0.5);
    }
  }
  for (std::size_t k = 0; k < band.size(); ++k)
  {
    const double next = distances[static_cast<std::size_t>(band[k])] + 1.0;
    ForEachNeighbour(mesh, band[k],
      [&](std::size_t w)
      {
        if (next < farthest + 1.0 && distances[w] == farthest)
        {
          add(static_cast<Index>(w), next);
        }
      });
  }
  for (std::size_t v = 0; v < inside.size(); ++v)
  {
    distances[v] *= inside[v] ? -1.0 : 1.0;
  }
  const auto differences = [&](const std::vector<double>& u)
  {
    std::vector<double> found(u.size(), 0.0);
    for (const Index v : band)
    {
      double sum = 0.0;
      double count = 0.0;
      ForEachNeighbour(mesh, v,
        [&](std::size_t w)
        {
          sum += u[w];
          ++count;
        });
      found[static_cast<std::size_t>(v)] = u[static_cast<std::size_t>(v)] - sum / count;
    }
    return found;
  };
  // At open ends u may have any slope: a neighbour that comes once is there.
  std::vector<Index> ends;
  std::copy_if(band.begin(), band.end(), std::back_inserter(ends),
    [&](Index v)
    {
      std::size_t odd = 0; // all that come twice leave no bit
      ForEachNeighbour(mesh, v, [&](std::size_t w) { odd ^= w + 1; });
      return odd != 0;
    });
  std::vector<double> u = distances;
  std::vector<double> ahead = u;
  double momentum = 1.0;
  for (int iteration = 0; iteration < iterations; ++iteration)
  {
    std::vector<double> bend = differences(ahead);
    for (const Index v : ends)
    {
      bend[static_cast<std::size_t>(v)] = 0.0;
    }
    const std::vector<double> slope = differences(bend);
    const double next = 0.5 * (1.0 + std::sqrt(1.0 + 4.0 * momentum * momentum));
    for (const Index vertex : band)
    {
      const auto v = static_cast<std::size_t>(vertex);
      const double step = (slope[v] + nearness * (ahead[v] - distances[v])) / (4.0 + nearness);
      const double moved =
        inside[v] ? std::min(ahead[v] - step, 0.0) : std::max(ahead[v] - step, 0.0);
      ahead[v] = moved + (momentum - 1.0) / next * (moved - u[v]);
      u[v] = moved;
    }
    momentum = next;
  }
  return u;
}

} // namespace

DistanceRun::SourceSet DistanceRun::FindSigned(
  const BlockInput& drawn, const Fields& fields, const ProgressMonitor& progress)
{
  const SourceShapes* const shapes = fields.Sources.get();
  if (shapes && !shapes->OfTriangles.empty())
  {
    throw InputError(Sentence("the sources are places in triangles; allowed together with ")
      << Word::Setting("Signed") << ": the points of a region, or a closed line");
  }
  const bool isCurve = shapes && shapes->OfPoints.empty();
  SourceSet set = isCurve ? this->FindClosedLines(drawn, *shapes, progress)
    : shapes              ? this->FindPlaced(*shapes)
                          : this->FindMarked(fields);
  if (!isCurve)
  {
    this->MoveToBoundary(set);
  }
  set.IsSigned = true;
  return set;
}

/// The marked points become the boundary of their region, between them and their neighbours.
void DistanceRun::MoveToBoundary(SourceSet& set) const
{
  const TriangleMesh& mesh = *this->MeshOfSolvers;
  std::vector<double> names(static_cast<std::size_t>(mesh.NumberOfVertices()), 0.0);
  set.Inside.assign(names.size(), 0);
  for (std::size_t k = 0; k < set.Pieces.size(); ++k)
  {
    const SourcePiece& piece = set.Pieces[k];
    const auto corner = std::max_element(piece.From.begin(), piece.From.end());
    const Index vertex = mesh.TriangleVertices()(
      piece.Triangle, static_cast<Eigen::Index>(corner - piece.From.begin()));
    set.Inside[static_cast<std::size_t>(vertex)] = 1;
    names[static_cast<std::size_t>(vertex)] = set.Names[k];
  }
  set.Pieces.clear();
  set.Names.clear();
  const std::vector<double> smooth = SmoothRegion(mesh, set.Inside);
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const auto vertexAt = [&](std::size_t a)
    { return static_cast<std::size_t>(mesh.TriangleVertices()(t, static_cast<Eigen::Index>(a))); };
    const auto isInside = [&](std::size_t a) { return set.Inside[vertexAt(a)] != 0; };
    const int count = int(isInside(0)) + int(isInside(1)) + int(isInside(2));
    if (count == 0 || count == 3)
    {
      continue;
    }
    // The boundary cuts off the corner that is alone on its side.
    const bool within = count == 1;
    const std::size_t alone = isInside(0) == within ? 0 : isInside(1) == within ? 1 : 2;
    const std::size_t next = (alone + 1) % 3, last = (alone + 2) % 3;
    const auto cut = [&](std::size_t a, std::size_t b)
    {
      constexpr double nearest = 0.05; // of an edge: both of its ends stay on their sides
      const double at = std::abs(smooth[vertexAt(a)]), other = std::abs(smooth[vertexAt(b)]);
      const double share =
        std::clamp(at + other > 0.0 ? at / (at + other) : 0.5, nearest, 1.0 - nearest);
      std::array<double, 3> place = { 0.0, 0.0, 0.0 };
      place[a] = 1.0 - share;
      place[b] = share;
      return place;
    };
    // From the lower corner to the higher one, so that triangles on both sides of an edge agree
    const auto cutEdge = [&](std::size_t a, std::size_t b)
    { return vertexAt(a) < vertexAt(b) ? cut(a, b) : cut(b, a); };
    const SourcePiece piece{ t, cutEdge(alone, next), cutEdge(alone, last), -1, -1, 0 };
    set.Pieces.push_back(piece);
    set.Names.push_back(names[vertexAt(within ? alone : next)]);
  }
  set.Count = set.Pieces.empty() ? 0 : set.Count;
}

/// The shortest paths from each point of closed lines to the next, and their smaller side.
DistanceRun::SourceSet DistanceRun::FindClosedLines(
  const BlockInput& drawn, const SourceShapes& shapes, const ProgressMonitor& progress)
{
  const TriangleMesh& mesh = *this->MeshOfSolvers;
  std::vector<std::vector<PathSegment>> curves;
  SourceSet set;
  set.AreShapes = true;
  const auto count = static_cast<double>(shapes.Segments.size());
  GeodesicPath finder(mesh, this->TakeExact().GetFrames());
  for (const std::vector<Index>& line : OrderClosedLines(shapes))
  {
    std::vector<SurfacePlace> places;
    places.reserve(line.size());
    for (const Index row : line)
    {
      places.push_back(
        { "point " + std::to_string(row) + " of the sources", -1, -1, shapes.Places.row(row) });
    }
    const std::vector<MeshPlace> stops = this->FindPlaces(drawn, places, progress);
    curves.emplace_back();
    for (std::size_t k = 0; k < stops.size(); ++k)
    {
      const std::size_t next = (k + 1) % stops.size();
      const GeodesicPath::Path leg = this->FindLeg(
        finder, places, stops, k, next, progress.Part(set.Count / count, (set.Count + 1) / count));
      for (const PathSegment& segment : leg.Segments)
      {
        set.Pieces.push_back({ segment.Triangle, segment.From, segment.To, -1, -1, line.front() });
        set.Names.push_back(line.front());
      }
      curves.back().insert(curves.back().end(), leg.Segments.begin(), leg.Segments.end());
      ++set.Count;
    }
  }
  set.Given = set.Count;
  set.Farness = this->Found.Farness;
  set.Inside = FindSmallerSide(mesh, curves);
  if (set.Inside.empty())
  {
    throw InputError(
      Sentence("the closed lines of the sources do not divide the surface into two sides; "
               "allowed together with ")
      << Word::Setting("Signed") << ": lines that do, or the points of a region");
  }
  return set;
}

} // namespace SurfaceDiffusion
