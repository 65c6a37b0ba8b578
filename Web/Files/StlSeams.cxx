// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Files/Stl.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <utility>

namespace SurfaceDiffusion::Files
{

namespace
{

using Pair = std::pair<std::int64_t, std::int64_t>; ///< of points, the lower number first

constexpr double Rounding = 1e-5; ///< of the diagonal
constexpr double RoundingOfEdges = 0.01; ///< of the median open edge
constexpr std::size_t Neighbours =
  200; ///< of a point along a line, on average, which bounds the search

Pair MakePair(std::int64_t a, std::int64_t b)
{
  return { std::min(a, b), std::max(a, b) };
}

std::vector<Pair> EdgesOf(const std::vector<std::int64_t>& corners)
{
  std::vector<Pair> edges;
  edges.reserve(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i)
  {
    edges.push_back(MakePair(corners[i], corners[i % 3 == 2 ? i - 2 : i + 1]));
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

std::vector<Pair> OpenEdges(const std::vector<Pair>& edges)
{
  std::vector<Pair> open;
  for (std::size_t i = 0; i < edges.size(); ++i)
  {
    if ((i == 0 || edges[i - 1] != edges[i]) && (i + 1 == edges.size() || edges[i + 1] != edges[i]))
    {
      open.push_back(edges[i]);
    }
  }
  return open;
}

class Seams
{
public:
  explicit Seams(SurfaceFile& file)
    : File(file)
  {
  }

  void Join()
  {
    const std::vector<Pair> edges = EdgesOf(this->File.Corners);
    const std::vector<Pair> open = OpenEdges(edges);
    if (open.empty())
    {
      return;
    }
    std::vector<Pair> pairs;
    for (const Pair& pair : this->NearPairs(open, this->LargestDistance(open)))
    {
      if (!std::binary_search(edges.begin(), edges.end(), pair)) // which would take an edge away
      {
        pairs.push_back(pair);
      }
    }
    while (!pairs.empty() && !this->Unite(pairs))
    {
    }
    if (!pairs.empty())
    {
      this->Rename(pairs);
    }
  }

private:
  double Distance(const Pair& pair) const
  {
    const double* const a = &this->File.Points[3 * static_cast<std::size_t>(pair.first)];
    const double* const b = &this->File.Points[3 * static_cast<std::size_t>(pair.second)];
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  }

  /// A facet far away makes the diagonal long, but not the edges.
  double LargestDistance(const std::vector<Pair>& open) const
  {
    std::array<double, 3> size{};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      double low = this->File.Points[axis];
      double high = low;
      for (std::size_t i = axis; i < this->File.Points.size(); i += 3)
      {
        low = std::min(low, this->File.Points[i]);
        high = std::max(high, this->File.Points[i]);
      }
      size[axis] = high - low;
    }
    std::vector<double> lengths;
    for (const Pair& edge : open)
    {
      lengths.push_back(this->Distance(edge));
    }
    const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
    std::nth_element(lengths.begin(), middle, lengths.end());
    return std::min(Rounding * std::hypot(size[0], size[1], size[2]), RoundingOfEdges * *middle);
  }

  /// Ends of open edges that are no more apart, sorted along a direction that no part is made along. None
  /// if points are so dense that they are no rounded ones.
  std::vector<Pair> NearPairs(const std::vector<Pair>& open, double distance) const
  {
    std::vector<std::int64_t> ends;
    for (const Pair& edge : open)
    {
      ends.insert(ends.end(), { edge.first, edge.second });
    }
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    std::vector<std::pair<double, std::int64_t>> line;
    for (const std::int64_t end : ends)
    {
      const double* const point = &this->File.Points[3 * static_cast<std::size_t>(end)];
      line.emplace_back(0.5773 * point[0] + 0.2113 * point[1] + 0.7887 * point[2], end);
    }
    std::sort(line.begin(), line.end());
    std::size_t room = std::min<std::size_t>(Neighbours * line.size(), 10000000);
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < line.size(); ++i)
    {
      for (std::size_t j = i + 1; j < line.size() && line[j].first - line[i].first <= distance; ++j)
      {
        if (room-- == 0)
        {
          return {};
        }
        const Pair pair = MakePair(line[i].second, line[j].second);
        if (this->Distance(pair) <= distance)
        {
          pairs.push_back(pair);
        }
      }
    }
    return pairs;
  }

  std::int64_t Find(std::int64_t point)
  {
    const auto parent = [this](std::int64_t child) -> std::int64_t&
    { return this->Parent[static_cast<std::size_t>(child)]; };
    while (parent(point) != point)
    {
      point = parent(point) = parent(parent(point));
    }
    return point;
  }

  /// The least number of those that are joined. False, with fewer pairs, if triangles have lost a corner.
  bool Unite(std::vector<Pair>& pairs)
  {
    this->Parent.resize(this->File.NumberOfPoints());
    std::iota(this->Parent.begin(), this->Parent.end(), std::int64_t{ 0 });
    for (const Pair& pair : pairs)
    {
      const Pair roots = MakePair(this->Find(pair.first), this->Find(pair.second));
      this->Parent[static_cast<std::size_t>(roots.second)] = roots.first;
    }
    std::vector<std::int64_t> lost;
    const std::vector<std::int64_t>& corners = this->File.Corners;
    for (std::size_t i = 0; i < corners.size(); i += 3)
    {
      const std::int64_t ids[] = { corners[i], corners[i + 1], corners[i + 2] };
      const std::int64_t roots[] = { this->Find(ids[0]), this->Find(ids[1]), this->Find(ids[2]) };
      const auto coincide = [](const std::int64_t(&n)[3])
      { return n[0] == n[1] || n[1] == n[2] || n[2] == n[0]; };
      if (coincide(roots) && !coincide(ids))
      {
        lost.insert(lost.end(), std::begin(roots), std::end(roots));
      }
    }
    std::sort(lost.begin(), lost.end());
    pairs.erase(std::remove_if(pairs.begin(), pairs.end(),
                  [&](const Pair& pair)
                  { return std::binary_search(lost.begin(), lost.end(), this->Find(pair.first)); }),
      pairs.end());
    return lost.empty();
  }

  void Rename(const std::vector<Pair>& pairs)
  {
    double apart = 0.0;
    for (const Pair& pair : pairs)
    {
      apart = std::max(apart, this->Distance(pair));
    }
    char number[32];
    std::snprintf(number, sizeof(number), "%.2g", apart);
    this->File.Warnings.push_back(
      std::string("corners of facets up to ") + number + " apart, at open edges, are joined");
    std::vector<std::int64_t> fresh(this->Parent.size(), -1);
    std::vector<double> points;
    for (std::size_t i = 0; i < fresh.size(); ++i)
    {
      if (this->Find(static_cast<std::int64_t>(i)) == static_cast<std::int64_t>(i))
      {
        fresh[i] = static_cast<std::int64_t>(points.size() / 3);
        const auto from = this->File.Points.begin() + static_cast<std::ptrdiff_t>(3 * i);
        points.insert(points.end(), from, from + 3);
      }
    }
    for (std::int64_t& corner : this->File.Corners)
    {
      corner = fresh[static_cast<std::size_t>(this->Find(corner))];
    }
    this->File.Points = std::move(points);
  }

  SurfaceFile& File;
  std::vector<std::int64_t> Parent; ///< of each point one that it is joined with, or itself
};

} // namespace

void JoinSeams(SurfaceFile& file)
{
  Seams(file).Join();
}

} // namespace SurfaceDiffusion::Files
