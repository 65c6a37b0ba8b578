// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/RegionBoundaries.h"

#include "Core/Foundation/DisjointSets.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <map>

namespace SurfaceDiffusion
{

namespace
{

/// The largest of the u_k at a point; the first of them.
Index LargestAt(const Eigen::Ref<const Values>& u, Index point)
{
  Eigen::Index best = 0;
  u.row(point).maxCoeff(&best);
  return static_cast<Index>(best);
}

/// A place where the curves cross an edge, or meet in a triangle.
struct Node
{
  Eigen::RowVector3d Point;
  std::vector<Index> Segments;
};

struct Segment
{
  std::array<Index, 2> Nodes;
  std::array<Index, 2> Regions; ///< ascending, from 0
};

std::array<Index, 2> Ascending(Index a, Index b)
{
  return { std::min(a, b), std::max(a, b) };
}

/// The change from one region to another on an edge.
struct Crossing
{
  Index Node;
  std::array<Index, 2> Regions;
};

/// Collects the segments of all triangles.
class SegmentCollector
{
public:
  SegmentCollector(const Eigen::Ref<const Points>& points, const Eigen::Ref<const Values>& u)
    : Places(points)
    , U(u)
  {
  }

  void AddTriangle(const std::array<Index, 3>& corners);

  std::vector<Node> Nodes;
  std::vector<Segment> Segments;

private:
  void AddCrossings(Index from, Index to, std::vector<Crossing>& crossings);
  Index FindNode(Index low, Index high, Index a, Index b, double fraction);
  Index AddJunction(const std::array<Index, 3>& corners, const std::vector<Crossing>& crossings);
  void Connect(Index first, Index second, const std::array<Index, 2>& regions);

  const Eigen::Ref<const Points>& Places;
  const Eigen::Ref<const Values>& U;
  std::map<std::array<Index, 4>, Index> NodeOf; ///< of an edge and two regions
};

Index SegmentCollector::FindNode(Index low, Index high, Index a, Index b, double fraction)
{
  const auto [entry, isNew] =
    this->NodeOf.insert({ { low, high, a, b }, static_cast<Index>(this->Nodes.size()) });
  if (isNew)
  {
    this->Nodes.push_back(
      { (1.0 - fraction) * this->Places.row(low) + fraction * this->Places.row(high), {} });
  }
  return entry->second;
}

/// The changes of the largest u_k along an edge, the upper envelope of K lines. It is followed from
/// the end with the lower number, so that all triangles of the edge find the same.
void SegmentCollector::AddCrossings(Index from, Index to, std::vector<Crossing>& crossings)
{
  const auto [low, high] = Ascending(from, to);
  const Index last = LargestAt(this->U, high);
  Index present = LargestAt(this->U, low);
  double position = 0.0;
  while (present != last)
  {
    double nearest = 2.0;
    Index next = last;
    for (Index k = 0; k < static_cast<Index>(this->U.cols()); ++k)
    {
      const double atLow = this->U(low, k) - this->U(low, present);
      const double atHigh = this->U(high, k) - this->U(high, present);
      const double rise = atHigh - atLow;
      if (k == present || !(rise > 0.0) || !(atHigh >= 0.0))
      {
        continue;
      }
      const double crossing = std::clamp(-atLow / rise, position, 1.0);
      const double slopeOfNext = this->U(high, next) - this->U(low, next);
      const double slope = this->U(high, k) - this->U(low, k);
      if (crossing < nearest || (crossing == nearest && slope > slopeOfNext))
      {
        nearest = crossing;
        next = k;
      }
    }
    position = std::min(nearest, 1.0);
    crossings.push_back(
      { this->FindNode(low, high, present, next, position), Ascending(present, next) });
    present = nearest > 1.0 ? last : next;
  }
}

void SegmentCollector::Connect(Index first, Index second, const std::array<Index, 2>& regions)
{
  const auto number = static_cast<Index>(this->Segments.size());
  this->Segments.push_back({ { first, second }, regions });
  this->Nodes[static_cast<std::size_t>(first)].Segments.push_back(number);
  this->Nodes[static_cast<std::size_t>(second)].Segments.push_back(number);
}

/// The point where three u_k are equal, if that is in the triangle; otherwise the mean of the
/// crossings.
Index SegmentCollector::AddJunction(
  const std::array<Index, 3>& corners, const std::vector<Crossing>& crossings)
{
  Eigen::RowVector3d point = Eigen::RowVector3d::Zero();
  std::vector<Index> regions;
  for (const Crossing& crossing : crossings)
  {
    point += this->Nodes[static_cast<std::size_t>(crossing.Node)].Point /
      static_cast<double>(crossings.size());
    regions.insert(regions.end(), crossing.Regions.begin(), crossing.Regions.end());
  }
  std::sort(regions.begin(), regions.end());
  regions.erase(std::unique(regions.begin(), regions.end()), regions.end());
  if (regions.size() == 3 && crossings.size() == 3)
  {
    Eigen::Matrix3d system = Eigen::Matrix3d::Ones();
    system.row(0) = this->U(corners, regions[0]) - this->U(corners, regions[1]);
    system.row(1) = this->U(corners, regions[0]) - this->U(corners, regions[2]);
    const Eigen::Vector3d share = system.partialPivLu().solve(Eigen::Vector3d(0.0, 0.0, 1.0));
    if (share.allFinite() && share.minCoeff() >= 0.0)
    {
      point = share[0] * this->Places.row(corners[0]) + share[1] * this->Places.row(corners[1]) +
        share[2] * this->Places.row(corners[2]);
    }
  }
  this->Nodes.push_back({ point, {} });
  return static_cast<Index>(this->Nodes.size()) - 1;
}

/// A line on which two u_k are equal is straight: it connects the two crossings of this pair.
/// Crossings of pairs that occur once go to a junction.
void SegmentCollector::AddTriangle(const std::array<Index, 3>& corners)
{
  std::vector<Crossing> crossings;
  for (int c = 0; c < 3; ++c)
  {
    this->AddCrossings(corners[c], corners[(c + 1) % 3], crossings);
  }
  std::vector<Crossing> single;
  while (!crossings.empty())
  {
    const Crossing first = crossings.front();
    crossings.erase(crossings.begin());
    const auto other = std::find_if(crossings.begin(), crossings.end(),
      [&](const Crossing& crossing) { return crossing.Regions == first.Regions; });
    if (other == crossings.end())
    {
      single.push_back(first);
      continue;
    }
    this->Connect(first.Node, other->Node, first.Regions);
    crossings.erase(other);
  }
  if (!single.empty())
  {
    const Index junction = this->AddJunction(corners, single);
    for (const Crossing& crossing : single)
    {
      this->Connect(crossing.Node, junction, crossing.Regions);
    }
  }
}

/// Joins segments to curves.
class CurveTracer
{
public:
  explicit CurveTracer(const SegmentCollector& found)
    : Found(found)
    , IsUsed(found.Segments.size(), false)
  {
  }

  std::vector<RegionBoundary> Trace()
  {
    std::vector<RegionBoundary> curves;
    for (const bool closed : { false, true }) // first those with ends
    {
      for (std::size_t n = 0; n < this->Found.Nodes.size(); ++n)
      {
        for (const Index segment : this->Found.Nodes[n].Segments)
        {
          if (!this->IsUsed[segment] && (closed || this->EndsCurves(static_cast<Index>(n))))
          {
            curves.push_back(this->Follow(static_cast<Index>(n), segment));
          }
        }
      }
    }
    return curves;
  }

private:
  bool EndsCurves(Index node) const
  {
    const std::vector<Index>& segments = this->Found.Nodes[node].Segments;
    return segments.size() != 2 ||
      this->Found.Segments[segments[0]].Regions != this->Found.Segments[segments[1]].Regions;
  }

  RegionBoundary Follow(Index node, Index segment)
  {
    const auto& regions = this->Found.Segments[segment].Regions;
    RegionBoundary curve{ { regions[0] + 1, regions[1] + 1 }, { node } };
    const Index start = node;
    while (true)
    {
      this->IsUsed[segment] = true;
      const auto& ends = this->Found.Segments[segment].Nodes;
      const Index next = ends[0] == node ? ends[1] : ends[0];
      curve.Length += (this->Found.Nodes[next].Point - this->Found.Nodes[node].Point).norm();
      curve.Points.push_back(next);
      node = next;
      if (node == start || this->EndsCurves(node))
      {
        return curve;
      }
      const std::vector<Index>& around = this->Found.Nodes[node].Segments;
      segment = around[0] == segment ? around[1] : around[0];
    }
  }

  const SegmentCollector& Found;
  std::vector<char> IsUsed;
};

/// A convex polygon in a triangle, as shares of its corners. Each half-plane adds one corner.
using Polygon = std::vector<Eigen::Vector3d>;

/// The part of the polygon where the linear function is not negative.
Polygon Clip(const Polygon& polygon, const Eigen::Vector3d& function)
{
  Polygon clipped;
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    const Eigen::Vector3d& a = polygon[i];
    const Eigen::Vector3d& b = polygon[(i + 1) % polygon.size()];
    const double atA = function.dot(a);
    const double atB = function.dot(b);
    if (atA >= 0.0)
    {
      clipped.push_back(a);
    }
    if ((atA < 0.0) != (atB < 0.0))
    {
      clipped.push_back(a + atA / (atA - atB) * (b - a));
    }
  }
  return clipped;
}

/// Its area over that of the triangle times the mean of a linear weight over it.
double WeightedShare(const Polygon& polygon, const Eigen::Vector3d& weight)
{
  double sum = 0.0;
  for (std::size_t i = 2; i < polygon.size(); ++i)
  {
    Eigen::Matrix3d corners;
    corners << polygon[0], polygon[i - 1], polygon[i];
    sum += std::abs(corners.determinant()) * weight.dot(corners.rowwise().mean());
  }
  return sum;
}

} // namespace

RegionBoundaries FindRegionBoundaries(const Eigen::Ref<const Points>& points,
  const Eigen::Ref<const Triangles>& triangles, const Eigen::Ref<const Values>& u)
{
  SegmentCollector collector(points, u);
  for (Index t = 0; t < static_cast<Index>(triangles.rows()); ++t)
  {
    const std::array<Index, 3> corners = { triangles(t, 0), triangles(t, 1), triangles(t, 2) };
    const Index first = LargestAt(u, corners[0]);
    if (first != LargestAt(u, corners[1]) || first != LargestAt(u, corners[2]))
    {
      collector.AddTriangle(corners);
    }
  }
  RegionBoundaries boundaries;
  boundaries.Points.resize(static_cast<Eigen::Index>(collector.Nodes.size()), 3);
  for (std::size_t n = 0; n < collector.Nodes.size(); ++n)
  {
    boundaries.Points.row(static_cast<Eigen::Index>(n)) = collector.Nodes[n].Point;
  }
  boundaries.Curves = CurveTracer(collector).Trace();
  return boundaries;
}

Vector RegionAreas(const Eigen::Ref<const Points>& points,
  const Eigen::Ref<const Triangles>& triangles, const Eigen::Ref<const Values>& u,
  const Eigen::Ref<const Vector>& weights, const ParallelFor& parallel)
{
  const Eigen::Index regions = u.cols();
  Vector areas = Vector::Zero(regions);
  for (Eigen::Index k = 0; k < regions; ++k)
  {
    areas[k] = Sum(parallel, static_cast<Index>(triangles.rows()),
      [&](Index t)
      {
        const std::array<Index, 3> corners = { triangles(t, 0), triangles(t, 1), triangles(t, 2) };
        const Eigen::RowVector3d origin = points.row(corners[0]);
        const Eigen::RowVector3d first = points.row(corners[1]) - origin;
        const Eigen::RowVector3d second = points.row(corners[2]) - origin;
        const double area = 0.5 * first.cross(second).norm();
        Eigen::Vector3d weight = Eigen::Vector3d::Ones();
        if (weights.size() > 0)
        {
          weight = weights(corners);
        }
        const Index label = LargestAt(u, corners[0]);
        if (label == LargestAt(u, corners[1]) && label == LargestAt(u, corners[2]))
        {
          return label == k ? area * weight.mean() : 0.0;
        }
        Polygon polygon = { Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(),
          Eigen::Vector3d::UnitZ() };
        for (Eigen::Index j = 0; j < regions && !polygon.empty(); ++j)
        {
          const Eigen::Vector3d difference = u(corners, k) - u(corners, j);
          if (difference.cwiseAbs().maxCoeff() > 0.0)
          {
            polygon = Clip(polygon, difference);
          }
          else if (j < k) // the first of equal ones counts
          {
            polygon.clear();
          }
        }
        return area * WeightedShare(polygon, weight);
      });
  }
  return areas;
}

std::vector<Index> CountRegionComponents(
  const Eigen::Ref<const Triangles>& triangles, const std::vector<Index>& labels, Index regions)
{
  DisjointSets sets(static_cast<Index>(labels.size()));
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
  {
    for (int c = 0; c < 3; ++c)
    {
      const Index a = triangles(t, c);
      const Index b = triangles(t, (c + 1) % 3);
      if (labels[a] == labels[b])
      {
        sets.Join(a, b);
      }
    }
  }
  std::vector<Index> counts(static_cast<std::size_t>(regions), 0);
  for (Index i = 0; i < static_cast<Index>(labels.size()); ++i)
  {
    if (labels[i] > 0 && sets.Find(i) == i)
    {
      ++counts[labels[i] - 1];
    }
  }
  return counts;
}

} // namespace SurfaceDiffusion
