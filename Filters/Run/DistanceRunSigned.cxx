// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The boundaries of regions, and the closed curves, of signed distances.
#include "Run/DistanceRun.h"

#include "Core/Geodesics/CurveSides.h"
#include "Core/Geodesics/SmoothRegion.h"

#include <algorithm>
#include <cmath>
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
