// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/Welding.h"

#include "Core/Foundation/DisjointSets.h"
#include "Core/Geometry/OpenEdges.h"
#include "Core/Geometry/TriangleOrientation.h"
#include "Core/Geometry/TriangleTree.h"
#include "Core/Surface/MergePoints.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

using Row3 = Eigen::RowVector3d;

/// Triangles whose rows belong to those of the input.
struct Facets
{
  void Add(const std::array<Index, 3>& corners, Index input)
  {
    this->Corners.push_back(corners);
    this->Input.push_back(input);
  }

  Triangles Rows() const
  {
    Triangles rows(static_cast<Eigen::Index>(this->Corners.size()), 3);
    for (std::size_t t = 0; t < this->Corners.size(); ++t)
    {
      rows.row(static_cast<Eigen::Index>(t)) << this->Corners[t][0], this->Corners[t][1],
        this->Corners[t][2];
    }
    return rows;
  }

  template <typename Keeps>
  Index Keep(const Keeps& keeps)
  {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < this->Corners.size(); ++t)
    {
      if (keeps(static_cast<Index>(t)))
      {
        this->Corners[kept] = this->Corners[t];
        this->Input[kept++] = this->Input[t];
      }
    }
    const auto dropped = static_cast<Index>(this->Corners.size() - kept);
    this->Corners.resize(kept);
    this->Input.resize(kept);
    return dropped;
  }

  std::vector<std::array<Index, 3>> Corners;
  std::vector<Index> Input;
};

/// The corners in ascending order are an even permutation of those of the triangle.
bool IsEven(const std::array<Index, 3>& corners)
{
  const auto [a, b, c] = corners;
  return int{ a < b } + int{ b < c } + int{ c < a } == 2;
}

/// Of triangles with the same corners, which one stays.
struct Twins
{
  explicit Twins(const Facets& facets, const std::vector<Index>& firsts)
    : Stays(firsts.size(), 1)
    , IsSheet(firsts.size(), 0)
  {
    std::map<Index, std::array<std::vector<Index>, 2>> sets; // of the first, by orientation
    const auto add = [&](Index first, Index t)
    { sets[first][IsEven(facets.Corners[t]) ? 1 : 0].push_back(t); };
    for (Index t = 0; t < static_cast<Index>(firsts.size()); ++t)
    {
      if (firsts[t] != t)
      {
        add(firsts[t], t);
        this->Stays[t] = 0;
      }
    }
    for (auto& [first, both] : sets)
    {
      add(first, first);
      const auto& [odd, even] = both;
      const auto& more = even.size() > odd.size() ? even : odd;
      const bool isSheet = odd.size() == even.size();
      const Index kept = isSheet ? first : *std::min_element(more.begin(), more.end());
      this->Stays[first] = 0;
      this->Stays[kept] = 1;
      this->IsSheet[kept] = isSheet;
    }
  }

  std::vector<char> Stays;
  std::vector<char> IsSheet; ///< as often one way as the other
};

/// Leave out triangles with the same corners as others. Their number.
Index DropTwins(Facets& facets)
{
  const Triangles rows = facets.Rows();
  const std::vector<Index> firsts = FindFirsts(rows);
  const Twins twins(facets, firsts);
  if (std::all_of(twins.Stays.begin(), twins.Stays.end(), [](char stays) { return stays != 0; }))
  {
    return 0;
  }
  TriangleSides sides = SortSides(rows);
  sides.erase(std::remove_if(sides.begin(), sides.end(),
                [&](const TriangleSide& side) { return !twins.Stays[side.Triangle]; }),
    sides.end());
  DisjointSets sheets(static_cast<Index>(firsts.size()));
  std::vector<Index> votes(firsts.size(), 0); // for an inner wall
  const auto isSide = [&](const TriangleSide& side) { return twins.IsSheet[side.Triangle] != 0; };
  ForEachEdge(sides,
    [&](auto first, auto last)
    {
      const auto found = std::find_if(first, last, isSide);
      const auto others = (last - first) - std::count_if(first, last, isSide);
      for (auto side = found; side != last; ++side)
      {
        if (isSide(*side))
        {
          sheets.Join(found->Triangle, side->Triangle);
          votes[side->Triangle] += others == 0 ? 0 : others % 2 == 0 ? 1 : -1;
        }
      }
    });
  for (std::size_t t = 0; t < votes.size(); ++t)
  {
    const Index sheet = sheets.Find(static_cast<Index>(t));
    if (sheet != static_cast<Index>(t))
    {
      votes[sheet] += votes[t];
    }
  }
  return facets.Keep(
    [&](Index t) { return twins.Stays[t] && !(twins.IsSheet[t] && votes[sheets.Find(t)] > 0); });
}

/// Where a place is along the line from a to b, from 0 to 1, if it is on that to the tolerance and
/// neither end is so near; negative otherwise.
double PartAlong(const Row3& place, const Row3& a, const Row3& b, double tolerance)
{
  const Row3 way = b - a;
  const double length = way.norm();
  const double along = (place - a).dot(way) / length;
  const bool isOn = (place - a - (along / length) * way).norm() <= tolerance;
  return isOn && along > tolerance && along < length - tolerance ? along / length : -1.0;
}

/// Whether a triangle has no area, its middle corner between the others.
bool IsFlat(const Points& points, const Triangles& rows, Index t, double tolerance)
{
  if (tolerance == 0.0 || HasOrientation(points, rows, t))
  {
    return false;
  }
  for (int a = 0; a < 3; ++a)
  {
    if (PartAlong(points.row(rows(t, a)), points.row(rows(t, (a + 1) % 3)),
          points.row(rows(t, (a + 2) % 3)), tolerance) > 0.0)
    {
      return true;
    }
  }
  return false;
}

/// Splits open edges at the ends of others that are on them.
class EdgeSplitter
{
public:
  EdgeSplitter(const Points& points, Facets& facets, double tolerance)
    : Places(points)
    , Given(facets)
    , Tolerance(tolerance)
  {
  }

  /// The number of splits.
  Index Split()
  {
    this->FindVertices(OpenSides(this->Given.Rows()));
    Facets made;
    for (std::size_t t = 0; t < this->Given.Corners.size(); ++t)
    {
      const auto found = this->OnSides.find(static_cast<Index>(t));
      if (found == this->OnSides.end())
      {
        made.Add(this->Given.Corners[t], this->Given.Input[t]);
      }
      else
      {
        this->Cut(this->Given.Corners[t], found->second, this->Given.Input[t], made);
      }
    }
    this->Given = std::move(made);
    return this->Splits;
  }

private:
  using Chain = std::vector<Index>; ///< vertices on a side, from its first corner on
  using Chains = std::array<Chain, 3>;

  void FindVertices(const TriangleSides& open)
  {
    const std::vector<Index> ends = EndsOf(open);
    std::vector<TriangleTree::Box> boxes;
    for (const Index end : ends)
    {
      boxes.emplace_back(this->Places.row(end).transpose());
    }
    const TriangleTree tree(boxes);
    for (const TriangleSide& side : open)
    {
      const std::array<Index, 3>& corners = this->Given.Corners[side.Triangle];
      const Index from = corners[side.Number];
      const Index to = corners[(side.Number + 1) % 3];
      const Row3 a = this->Places.row(from);
      const Row3 b = this->Places.row(to);
      TriangleTree::Box box(a.cwiseMin(b).transpose(), a.cwiseMax(b).transpose());
      box.min().array() -= this->Tolerance;
      box.max().array() += this->Tolerance;
      std::vector<std::pair<double, Index>> found;
      tree.Visit([&](const TriangleTree::Box& other) { return box.intersects(other); },
        [&](Index k)
        {
          const double part = PartAlong(this->Places.row(ends[k]), a, b, this->Tolerance);
          if (part > 0.0 && std::find(corners.begin(), corners.end(), ends[k]) == corners.end())
          {
            found.emplace_back(part, ends[k]);
          }
        });
      std::sort(found.begin(), found.end());
      for (const auto& [part, vertex] : found)
      {
        this->OnSides[side.Triangle][side.Number].push_back(vertex);
        ++this->Splits;
      }
    }
  }

  /// In two at the middle vertex of the side with most of them, until no side has any.
  static void Cut(
    const std::array<Index, 3>& corners, const Chains& chains, Index input, Facets& made)
  {
    std::size_t side = 0;
    for (std::size_t k = 1; k < 3; ++k)
    {
      side = chains[k].size() > chains[side].size() ? k : side;
    }
    const Chain& chain = chains[side];
    if (chain.empty())
    {
      made.Add(corners, input);
      return;
    }
    const auto middle = chain.begin() + static_cast<std::ptrdiff_t>(chain.size() / 2);
    const std::size_t next = (side + 1) % 3;
    const std::size_t last = (side + 2) % 3;
    Cut({ corners[side], *middle, corners[last] },
      { Chain(chain.begin(), middle), Chain(), chains[last] }, input, made);
    Cut({ *middle, corners[next], corners[last] },
      { Chain(middle + 1, chain.end()), chains[next], Chain() }, input, made);
  }

  const Points& Places;
  Facets& Given;
  double Tolerance;
  std::map<Index, Chains> OnSides; ///< of triangles
  Index Splits = 0;
};

} // namespace

WeldedSurface WeldSurface(const Points& points, const Triangles& triangles, double tolerance)
{
  WeldedSurface welded;
  welded.PointOf = MergePoints(points, 0.0);
  Facets facets;
  for (Index t = 0; t < static_cast<Index>(triangles.rows()); ++t)
  {
    facets.Add({ welded.PointOf[triangles(t, 0)], welded.PointOf[triangles(t, 1)],
                 welded.PointOf[triangles(t, 2)] },
      t);
  }
  const auto dropCollapsed = [&]()
  {
    const Triangles rows = facets.Rows();
    return facets.Keep([&](Index t) { return !IsCollapsed(rows, t); });
  };
  welded.Flat = dropCollapsed();
  const std::vector<Index> joined = JoinOpenEdges(points, facets.Rows(), tolerance);
  for (std::size_t i = 0; i < welded.PointOf.size(); ++i)
  {
    Index& point = welded.PointOf[i];
    const double apart = (points.row(point) - points.row(joined[point])).norm();
    welded.Welded += apart > 0.0;
    welded.Apart = std::max(welded.Apart, apart);
    point = joined[point];
  }
  for (std::array<Index, 3>& corners : facets.Corners)
  {
    corners = { joined[corners[0]], joined[corners[1]], joined[corners[2]] };
  }
  welded.Duplicates = DropTwins(facets);
  const Triangles rows = facets.Rows();
  welded.Flat += facets.Keep([&](Index t) { return !IsFlat(points, rows, t, tolerance); });
  if (tolerance > 0.0)
  {
    welded.Split = EdgeSplitter(points, facets, tolerance).Split();
  }
  welded.Faces = facets.Rows();
  welded.InputTriangle = std::move(facets.Input);
  return welded;
}

} // namespace SurfaceDiffusion
