// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/TriangleStars.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

constexpr Index LargestStar = 128;

/// An edge, or twice a vertex.
using Centre = std::pair<Index, Index>;

/// Per triangle, the edge of many triangles that it is at, otherwise the vertex of many, otherwise
/// two numbers below 0.
std::vector<Centre> FindCentres(const Triangles& triangles, const Points& points)
{
  std::vector<Index> valence(static_cast<std::size_t>(points.rows()), 0);
  for (Eigen::Index k = 0; k < triangles.size(); ++k)
  {
    ++valence[static_cast<std::size_t>(triangles.data()[k])];
  }
  const auto isLarge = [&](Index v) { return valence[static_cast<std::size_t>(v)] > LargestStar; };
  std::map<std::array<double, 3>, Index> firstAt; // the first of them at a place
  for (Index v = 0; v < static_cast<Index>(points.rows()); ++v)
  {
    if (isLarge(v))
    {
      firstAt.emplace(std::array<double, 3>{ points(v, 0), points(v, 1), points(v, 2) }, v);
    }
  }
  const auto count = static_cast<Index>(triangles.rows());
  std::vector<Centre> centres(static_cast<std::size_t>(count), Centre(-1, -1));
  std::vector<std::pair<Centre, Index>> edges; // with their triangles
  for (Index t = 0; t < count; ++t)
  {
    for (int a = 0; a < 3; ++a)
    {
      const Index p = triangles(t, a);
      const Index q = triangles(t, (a + 1) % 3);
      if (isLarge(p))
      {
        const Index first = firstAt.at({ points(p, 0), points(p, 1), points(p, 2) });
        centres[static_cast<std::size_t>(t)] = { first, first };
        if (isLarge(q))
        {
          edges.emplace_back(std::minmax(p, q), t);
        }
      }
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end)
  {
    while (end < edges.size() && edges[end].first == edges[begin].first)
    {
      ++end;
    }
    for (std::size_t k = begin; k < end && end - begin > static_cast<std::size_t>(LargestStar); ++k)
    {
      centres[static_cast<std::size_t>(edges[k].second)] = edges[k].first;
    }
  }
  return centres;
}

/// See TriangleStars::Star::Arcs.
Points ArcsAround(Index centre, const Points& points, const Triangles& triangles)
{
  Points arcs(3 * triangles.rows(), 3);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
  {
    int row = 0;
    for (int a = 0; a < 3; ++a)
    {
      if (points.row(triangles(t, a)) != points.row(centre) && row < 2)
      {
        arcs.row(3 * t + row++) =
          (points.row(triangles(t, a)) - points.row(centre)).stableNormalized();
      }
    }
    for (; row < 2; ++row) // a corner occurs twice
    {
      arcs.row(3 * t + row).setZero();
    }
    // where the tangents at both ends meet
    constexpr double least = 1e-9;
    const double cosine = arcs.row(3 * t).dot(arcs.row(3 * t + 1));
    arcs.row(3 * t + 2) = (arcs.row(3 * t) + arcs.row(3 * t + 1)) / std::max(1.0 + cosine, least);
  }
  return arcs;
}

} // namespace

TriangleStars::TriangleStars(const Points& points, const Triangles& triangles)
  : StarOf(static_cast<std::size_t>(triangles.rows()), 0)
  , PlaceOf(static_cast<std::size_t>(triangles.rows()), 0)
{
  const std::vector<Centre> centres = FindCentres(triangles, points);
  std::map<Centre, Index> numbers{ { Centre(-1, -1), 0 } };
  std::vector<std::vector<Index>> members(1);
  for (std::size_t t = 0; t < centres.size(); ++t)
  {
    const auto [found, isNew] = numbers.emplace(centres[t], static_cast<Index>(members.size()));
    if (isNew)
    {
      members.emplace_back();
    }
    std::vector<Index>& list = members[static_cast<std::size_t>(found->second)];
    this->StarOf[t] = found->second;
    this->PlaceOf[t] = static_cast<Index>(list.size());
    list.push_back(static_cast<Index>(t));
  }
  std::vector<Centre> centreOf(members.size());
  for (const auto& [centre, number] : numbers)
  {
    centreOf[static_cast<std::size_t>(number)] = centre;
  }
  this->Stars.reserve(members.size());
  for (std::size_t s = 0; s < members.size(); ++s)
  {
    const auto size = static_cast<Index>(members[s].size());
    Triangles part(size, 3);
    Triangles corners(size, 3);
    for (Index k = 0; k < size; ++k)
    {
      part.row(k) = triangles.row(members[s][static_cast<std::size_t>(k)]);
      corners.row(k) << 3 * k, 3 * k + 1, 3 * k + 2;
    }
    const bool hasArcs = s > 0 && centreOf[s].first == centreOf[s].second;
    Points arcs = hasArcs ? ArcsAround(centreOf[s].first, points, part) : Points(0, 3);
    const TriangleTree arcBoxes(arcs, hasArcs ? corners : Triangles(0, 3));
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    if (hasArcs)
    {
      centre = points.row(centreOf[s].first).transpose();
    }
    this->Stars.push_back(
      { std::move(members[s]), TriangleTree(points, part), centre, std::move(arcs), arcBoxes });
  }
  std::vector<Box> bounds;
  for (const Star& star : this->Stars)
  {
    bounds.push_back((star.Members.empty() ? this->Stars.back() : star).Boxes.Bounds());
  }
  this->Bounds = TriangleTree(bounds);
}

} // namespace SurfaceDiffusion
