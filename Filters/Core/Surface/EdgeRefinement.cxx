// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/EdgeRefinement.h"

#include "Core/Foundation/Offsets.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

using Point = std::array<double, 3>;

constexpr Index BisectionsPerReport = 4096;

/// A power of two near the largest coordinate, in which squares of lengths do not overflow.
double UnitOf(const Points& points)
{
  const double largest = points.size() > 0 ? points.cwiseAbs().maxCoeff() : 0.0;
  return largest > 0.0 ? std::ldexp(1.0, std::ilogb(largest)) : 1.0;
}

/// A surface that is cut edge by edge.
class Bisection
{
public:
  Bisection(const Points& points, const Triangles& triangles)
    : Unit(UnitOf(points))
    , NumberOfInputs(static_cast<Index>(points.rows()))
  {
    this->Places.reserve(static_cast<std::size_t>(points.rows()));
    for (Index i = 0; i < this->NumberOfInputs; ++i)
    {
      this->Places.push_back({ points(i, 0), points(i, 1), points(i, 2) });
    }
    for (Index t = 0; t < static_cast<Index>(triangles.rows()); ++t)
    {
      const std::array<Index, 3> corners{ triangles(t, 0), triangles(t, 1), triangles(t, 2) };
      if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0])
      {
        this->Corners.push_back(corners);
        this->Origin.push_back(t);
      }
    }
    this->FindEdges();
  }

  /// The edges that are longer are bisected, the longest first.
  void Run(double length, Index maximumTriangles, const ProgressMonitor& progress)
  {
    this->Longest = length / this->Unit;
    const auto isShorter = [this](const Candidate& a, const Candidate& b)
    { return this->IsShorter(a, b); };
    std::vector<Candidate> candidates;
    for (Index e = 0; e < static_cast<Index>(this->Edges.size()); ++e)
    {
      this->AddIfLong(e, [&](const Candidate& found) { candidates.push_back(found); });
    }
    std::priority_queue queue(isShorter, std::move(candidates));
    const auto push = [&](Index edge)
    { this->AddIfLong(edge, [&](const Candidate& found) { queue.push(found); }); };
    for (Index count = 0; !queue.empty(); ++count)
    {
      const Index edge = queue.top().Edge;
      const auto triangles = static_cast<Index>(this->Corners.size());
      if (this->CountTriangles(edge) > std::max(maximumTriangles, triangles) - triangles)
      {
        this->Stopped = true;
        return;
      }
      queue.pop();
      const auto firstNew = static_cast<Index>(this->Edges.size());
      this->Bisect(edge);
      push(edge);
      for (Index e = firstNew; e < static_cast<Index>(this->Edges.size()); ++e)
      {
        push(e);
      }
      if (count % BisectionsPerReport == 0)
      {
        progress.Report(static_cast<double>(this->Corners.size()) /
          static_cast<double>(std::max<std::size_t>(maximumTriangles, this->Corners.size())));
      }
    }
  }

  RefinedSurface Result() const
  {
    RefinedSurface result;
    result.Vertices.resize(static_cast<Eigen::Index>(this->Places.size()), 3);
    for (std::size_t i = 0; i < this->Places.size(); ++i)
    {
      result.Vertices.row(static_cast<Eigen::Index>(i)) << this->Places[i][0], this->Places[i][1],
        this->Places[i][2];
    }
    result.Faces.resize(static_cast<Eigen::Index>(this->Corners.size()), 3);
    for (std::size_t t = 0; t < this->Corners.size(); ++t)
    {
      result.Faces.row(static_cast<Eigen::Index>(t)) << this->Corners[t][0], this->Corners[t][1],
        this->Corners[t][2];
    }
    result.InputTriangle = this->Origin;
    result.Parents = this->Parents;
    double square = 0.0;
    for (const Edge& edge : this->Edges)
    {
      square = std::max(square, this->SquaredLength(edge));
    }
    result.LongestEdge = std::sqrt(square) * this->Unit;
    result.LimitReached = this->Stopped;
    return result;
  }

private:
  struct Edge
  {
    Index Low, High; ///< vertices
    Offset First; ///< of the sides on this edge; 3 t + a is the side opposite corner a
  };

  struct Candidate
  {
    double SquaredLength;
    Index Edge;
  };

  void FindEdges()
  {
    struct Side
    {
      Index Low, High;
      Offset Number;
    };
    std::vector<Side> sides;
    sides.reserve(3 * this->Corners.size());
    for (std::size_t t = 0; t < this->Corners.size(); ++t)
    {
      for (std::size_t a = 0; a < 3; ++a)
      {
        const Index from = this->Corners[t][(a + 1) % 3];
        const Index to = this->Corners[t][(a + 2) % 3];
        sides.push_back({ std::min(from, to), std::max(from, to), static_cast<Offset>(3 * t + a) });
      }
    }
    std::sort(sides.begin(), sides.end(),
      [](const Side& a, const Side& b)
      { return std::tie(a.Low, a.High, a.Number) < std::tie(b.Low, b.High, b.Number); });
    this->Next.resize(sides.size());
    this->Previous.resize(sides.size());
    this->SideEdge.resize(sides.size());
    for (const Side& side : sides)
    {
      if (this->Edges.empty() || this->Edges.back().Low != side.Low ||
        this->Edges.back().High != side.High)
      {
        this->Edges.push_back({ side.Low, side.High, -1 });
      }
      this->Attach(side.Number, static_cast<Index>(this->Edges.size()) - 1);
    }
  }

  void Attach(Offset side, Index edge)
  {
    Offset& first = this->Edges[static_cast<std::size_t>(edge)].First;
    this->SideEdge[static_cast<std::size_t>(side)] = edge;
    this->Link(side, first);
    this->Previous[static_cast<std::size_t>(side)] = -1;
    first = side;
  }

  void Detach(Offset side, Index edge)
  {
    const Offset next = this->Next[static_cast<std::size_t>(side)];
    const Offset previous = this->Previous[static_cast<std::size_t>(side)];
    if (previous >= 0)
    {
      this->Link(previous, next);
      return;
    }
    this->Edges[static_cast<std::size_t>(edge)].First = next;
    if (next >= 0)
    {
      this->Previous[static_cast<std::size_t>(next)] = -1;
    }
  }

  void Link(Offset side, Offset next)
  {
    this->Next[static_cast<std::size_t>(side)] = next;
    if (next >= 0)
    {
      this->Previous[static_cast<std::size_t>(next)] = side;
    }
  }

  double SquaredLength(const Edge& edge) const
  {
    const Point& a = this->Places[static_cast<std::size_t>(edge.Low)];
    const Point& b = this->Places[static_cast<std::size_t>(edge.High)];
    double square = 0.0;
    for (std::size_t k = 0; k < 3; ++k)
    {
      const double difference = a[k] / this->Unit - b[k] / this->Unit;
      square += difference * difference;
    }
    return square;
  }

  template <typename F>
  void AddIfLong(Index edge, const F& add) const
  {
    const double square = this->SquaredLength(this->Edges[static_cast<std::size_t>(edge)]);
    if (std::sqrt(square) > this->Longest)
    {
      add(Candidate{ square, edge });
    }
  }

  Point Middle(Index low, Index high) const
  {
    const Point& a = this->Places[static_cast<std::size_t>(low)];
    const Point& b = this->Places[static_cast<std::size_t>(high)];
    return { 0.5 * a[0] + 0.5 * b[0], 0.5 * a[1] + 0.5 * b[1], 0.5 * a[2] + 0.5 * b[2] };
  }

  /// Whether `b` is bisected before `a`. The order is total unless vertices coincide.
  bool IsShorter(const Candidate& a, const Candidate& b) const
  {
    if (a.SquaredLength != b.SquaredLength)
    {
      return a.SquaredLength < b.SquaredLength;
    }
    const auto ends = [this](Index e)
    {
      const Edge& edge = this->Edges[static_cast<std::size_t>(e)];
      const Point& low = this->Places[static_cast<std::size_t>(edge.Low)];
      const Point& high = this->Places[static_cast<std::size_t>(edge.High)];
      return std::pair(this->Middle(edge.Low, edge.High), std::min(low, high));
    };
    const auto first = ends(a.Edge);
    const auto second = ends(b.Edge);
    return first != second ? first > second : a.Edge > b.Edge;
  }

  Index CountTriangles(Index edge) const
  {
    Index count = 0;
    for (Offset side = this->Edges[static_cast<std::size_t>(edge)].First; side >= 0;
         side = this->Next[static_cast<std::size_t>(side)])
    {
      ++count;
    }
    return count;
  }

  /// Triangle (c, p, q) with the edge pq becomes (c, p, m) and a new one (c, m, q). The edge and a
  /// new one are its halves, and c and m are joined by one edge for all triangles with this c.
  void Bisect(Index edge)
  {
    const Edge whole = this->Edges[static_cast<std::size_t>(edge)];
    const auto middle = static_cast<Index>(this->Places.size());
    this->Places.push_back(this->Middle(whole.Low, whole.High));
    this->Parents.push_back({ whole.Low, whole.High });
    this->Edges[static_cast<std::size_t>(edge)] = { whole.Low, middle, -1 };
    const auto upper = static_cast<Index>(this->Edges.size());
    this->Edges.push_back({ whole.High, middle, -1 });
    this->JoinedTo.resize(this->Places.size(), { -1, -1 });
    for (Offset side = whole.First; side >= 0;)
    {
      const Offset next = this->Next[static_cast<std::size_t>(side)];
      const auto t = static_cast<std::size_t>(side / 3);
      const auto a = static_cast<std::size_t>(side % 3);
      const std::size_t b = (a + 1) % 3;
      const std::size_t c = (a + 2) % 3;
      const Index apex = this->Corners[t][a];
      const bool startsLow = this->Corners[t][b] == whole.Low;
      const auto newTriangle = static_cast<Offset>(this->Corners.size());
      std::array<Index, 3> corners = this->Corners[t];
      corners[b] = middle;
      this->Corners[t][c] = middle;
      this->Corners.push_back(corners);
      this->Origin.push_back(this->Origin[t]);
      this->Next.resize(this->Next.size() + 3);
      this->Previous.resize(this->Previous.size() + 3);
      this->SideEdge.resize(this->SideEdge.size() + 3);

      this->Attach(side, startsLow ? edge : upper);
      this->Attach(3 * newTriangle + static_cast<Offset>(a), startsLow ? upper : edge);
      const Offset outer =
        3 * static_cast<Offset>(t) + static_cast<Offset>(b); // from q to the apex
      const Index outerEdge = this->SideEdge[static_cast<std::size_t>(outer)];
      this->Detach(outer, outerEdge);
      this->Attach(3 * newTriangle + static_cast<Offset>(b), outerEdge);
      const Index inner = this->JoinToApex(middle, apex);
      this->Attach(outer, inner);
      this->Attach(3 * newTriangle + static_cast<Offset>(c), inner);
      side = next;
    }
  }

  /// The edge from a new middle to an apex.
  Index JoinToApex(Index middle, Index apex)
  {
    auto& [joined, edge] = this->JoinedTo[static_cast<std::size_t>(apex)];
    if (joined != middle)
    {
      joined = middle;
      edge = static_cast<Index>(this->Edges.size());
      this->Edges.push_back({ apex, middle, -1 });
    }
    return edge;
  }

  double Unit;
  Index NumberOfInputs;
  double Longest = 0.0; ///< edges up to this length stay, in Unit
  bool Stopped = false;
  std::vector<Point> Places;
  std::vector<std::array<Index, 2>> Parents;
  std::vector<std::array<Index, 3>> Corners;
  std::vector<Index> Origin;
  std::vector<Edge> Edges;
  std::vector<Offset> Next; ///< the next side on the same edge, -1 at the end
  std::vector<Offset> Previous; ///< the one before it, -1 at the begin
  std::vector<Index> SideEdge;
  /// Per vertex, the last middle that it was joined to, and the edge.
  std::vector<std::pair<Index, Index>> JoinedTo;
};

} // namespace

RefinedSurface RefineEdges(const Points& points, const Triangles& triangles, double length,
  Index maximumTriangles, const ProgressMonitor& progress)
{
  Bisection bisection(points, triangles);
  bisection.Run(length, maximumTriangles, progress);
  progress.Report(1.0);
  return bisection.Result();
}

double ValueBetween(PointRole role, bool areIntegers, bool isSingle, double a, double b)
{
  if (role == PointRole::Mask)
  {
    return a == 0.0 ? b : a;
  }
  if (role != PointRole::Data && (a == 0.0 || b == 0.0))
  {
    return 0.0;
  }
  const double mean = 0.5 * a + 0.5 * b;
  if ((role == PointRole::Mark && !std::isnan(mean)) || (areIntegers && isSingle))
  {
    return std::min(a, b);
  }
  return areIntegers ? std::floor(mean + 0.5) : mean;
}

Values InterpolateAtVertices(const RefinedSurface& refined, const Eigen::Ref<const Values>& input)
{
  Values values(refined.Vertices.rows(), input.cols());
  values.topRows(input.rows()) = input;
  Eigen::Index i = input.rows();
  for (const auto& [first, second] : refined.Parents)
  {
    values.row(i++) = 0.5 * values.row(first) + 0.5 * values.row(second);
  }
  return values;
}

} // namespace SurfaceDiffusion
