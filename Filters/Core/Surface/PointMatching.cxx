// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/PointMatching.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

using Group = std::vector<std::size_t>; // of points

/// Calls use(group) for the points of each surface with one id and the same coordinates, each group
/// ordered by label and so by piece.
template <typename Use>
void ForEachGroup(const std::vector<InterfacePoint>& points, Group among, const Use& use)
{
  const auto key = [&](std::size_t p)
  { return std::tie(points[p].Surface, points[p].GlobalId, points[p].Coordinates); };
  std::sort(among.begin(), among.end(),
    [&](std::size_t a, std::size_t b)
    { return key(a) != key(b) ? key(a) < key(b) : points[a].Label < points[b].Label; });
  for (std::size_t begin = 0, end = 0; begin < among.size(); begin = end)
  {
    while (end < among.size() && key(among[end]) == key(among[begin]))
    {
      ++end;
    }
    use(Group(among.begin() + begin, among.begin() + end));
  }
}

/// Matches the points of a group: the k-th of each piece with the k-th of the others.
class PointMatcher
{
public:
  /// needsOpen: whether one of the points must lie on the edge of its piece.
  PointMatcher(const std::vector<InterfacePoint>& points, bool needsOpen)
    : Points(points)
    , NeedsOpen(needsOpen)
    , Owners(points.size())
  {
    std::iota(this->Owners.begin(), this->Owners.end(), std::size_t(0));
  }

  /// Appends the points that match no other to `unmatched`.
  void MatchGroup(const Group& group, Group& unmatched)
  {
    std::map<std::pair<int, bool>, std::size_t> seen; // piece, copy: how many so far
    std::map<std::size_t, Group> ordinals;
    for (const std::size_t p : group)
    {
      ordinals[seen[{ this->Points[p].Piece, this->Points[p].IsCopy }]++].push_back(p);
    }
    for (const auto& ordinal : ordinals)
    {
      const Group& members = ordinal.second;
      const bool haveSeveralPieces = this->AnyOf(members,
        [&](const InterfacePoint& point)
        { return point.Piece != this->Points[members.front()].Piece; });
      const bool isOpen =
        this->AnyOf(members, [](const InterfacePoint& point) { return point.IsOpen; });
      if (!haveSeveralPieces || (this->NeedsOpen && !isOpen))
      {
        unmatched.insert(unmatched.end(), members.begin(), members.end());
        continue;
      }
      // The first point that is no copy owns the others.
      const auto original = std::find_if(
        members.begin(), members.end(), [&](std::size_t p) { return !this->Points[p].IsCopy; });
      const std::size_t owner = original == members.end() ? members.front() : *original;
      for (const std::size_t p : members)
      {
        this->Owners[p] = owner;
      }
    }
  }

  std::vector<std::size_t> TakeOwners() { return std::move(this->Owners); }

private:
  template <typename Predicate>
  bool AnyOf(const Group& group, const Predicate& predicate) const
  {
    return std::any_of(
      group.begin(), group.end(), [&](std::size_t p) { return predicate(this->Points[p]); });
  }

  const std::vector<InterfacePoint>& Points;
  const bool NeedsOpen;
  std::vector<std::size_t> Owners;
};

/// Moves each point to the first one of its surface within the tolerance, which may be itself.
/// Cubes of the tolerance's width hold the points, so that 27 of them are searched.
void SnapNearPoints(std::vector<InterfacePoint>& points, const Group& among, double tolerance)
{
  using Cube = std::array<double, 4>; // surface, and the position in a grid
  const auto cubeOf = [&](const InterfacePoint& point)
  {
    Cube cube{ static_cast<double>(point.Surface), 0.0, 0.0, 0.0 };
    for (int k = 0; k < 3; ++k)
    {
      cube[k + 1] = std::floor(point.Coordinates[k] / tolerance);
    }
    return cube;
  };
  std::map<Cube, Group> cubes;
  for (const std::size_t p : among)
  {
    cubes[cubeOf(points[p])].push_back(p);
  }
  const auto isNear = [&](std::size_t p, std::size_t q)
  {
    double square = 0.0;
    for (int k = 0; k < 3; ++k)
    {
      const double difference = points[p].Coordinates[k] - points[q].Coordinates[k];
      square += difference * difference;
    }
    return square <= tolerance * tolerance;
  };
  std::vector<std::size_t> firsts;
  for (const std::size_t p : among)
  {
    const Cube centre = cubeOf(points[p]);
    std::size_t first = p;
    for (int n = 0; n < 27; ++n)
    {
      const int shift[3] = { n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1 };
      const auto found =
        cubes.find({ centre[0], centre[1] + shift[0], centre[2] + shift[1], centre[3] + shift[2] });
      if (found != cubes.end())
      {
        const auto near = std::find_if(found->second.begin(), found->second.end(),
          [&](std::size_t q) { return q >= first || isNear(p, q); });
        first = near == found->second.end() ? first : std::min(first, *near);
      }
    }
    firsts.push_back(first);
  }
  const std::vector<InterfacePoint> before = points;
  for (std::size_t i = 0; i < among.size(); ++i)
  {
    points[among[i]].Coordinates = before[firsts[i]].Coordinates;
  }
}

} // namespace

std::vector<std::size_t> MatchPoints(
  std::vector<InterfacePoint> points, bool byId, double tolerance)
{
  PointMatcher matcher(points, !byId);
  Group all(points.size()), unmatched, isolated;
  std::iota(all.begin(), all.end(), std::size_t(0));
  ForEachGroup(points, all, [&](const Group& group) { matcher.MatchGroup(group, unmatched); });
  if (!byId && tolerance > 0.0)
  {
    std::sort(unmatched.begin(), unmatched.end());
    SnapNearPoints(points, unmatched, tolerance);
    ForEachGroup(
      points, unmatched, [&](const Group& group) { matcher.MatchGroup(group, isolated); });
  }
  return matcher.TakeOwners();
}

} // namespace SurfaceDiffusion
