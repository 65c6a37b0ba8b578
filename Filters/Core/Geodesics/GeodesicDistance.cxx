// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geodesics/GeodesicDistance.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// The angle above 2 pi from which on a vertex is a saddle, in radians. On fine surfaces, whose angles
/// differ less, ways along edges are mostly those of the triangulation.
constexpr double SmallestSaddle = 0.5;

/// What a time has to fall by, relatively, so that the front starts again: more than round-off. Where the
/// lengths of an edge differ much between its two triangles, times may fall by less and less without an
/// end; after UsualFalls, what counts doubles with each.
double SmallestFall(int falls)
{
  constexpr double resolved = 1e-14;
  constexpr int UsualFalls = 16;
  return std::ldexp(resolved, std::max(0, falls - UsualFalls));
}

/// A triangle ABC in the plane: A at the origin, B at (Edge, 0), C above.
struct LaidOut
{
  double Edge, X, Y;

  LaidOut(double ab, double ca, double cb)
    : Edge(ab)
    , X((ca * ca - cb * cb + ab * ab) / (2.0 * ab))
    , Y(std::sqrt(std::max(0.0, ca * ca - X * X)))
  {
  }

  /// The distance of C from a point below AB at distances da from A and db from B, or infinity if
  /// its straight line does not cross AB, or there is none.
  double FromPoint(double da, double db) const
  {
    const double x = (da * da - db * db + this->Edge * this->Edge) / (2.0 * this->Edge);
    const double square = da * da - x * x;
    constexpr double roundOff = 1e-9;
    if (square < -roundOff * this->Edge * this->Edge)
    {
      return Never; // no point has these distances
    }
    const double y = std::sqrt(std::max(0.0, square));
    const double crossing = x * this->Y + this->X * y; // of AB, times Y + y
    const bool crosses = crossing >= 0.0 && crossing <= this->Edge * (this->Y + y);
    return crosses && this->Y > 0.0 ? std::hypot(this->X - x, this->Y + y) : Never;
  }

  /// The same for a plane front.
  double FromPlane(double da, double db) const
  {
    const double along = (db - da) / this->Edge; // of the gradient
    if (!(std::abs(along) < 1.0))
    {
      return Never;
    }
    const double up = std::sqrt((1.0 - along) * (1.0 + along));
    const double crossing = this->X * up - this->Y * along; // of AB, times `up`
    return crossing >= 0.0 && crossing <= this->Edge * up ? da + along * this->X + up * this->Y
                                                          : Never;
  }
};

} // namespace

GeodesicDistance::GeodesicDistance(std::shared_ptr<const TriangleMesh> mesh, FrontShapes shapes)
  : Mesh(std::move(mesh))
  , Shapes(std::move(shapes))
{
  this->FindCorners();
}

/// The vertices of boundaries and barriers with an open angle above pi, and others with one above 2 pi.
void GeodesicDistance::FindCorners()
{
  const TriangleMesh& mesh = *this->Mesh;
  const auto n = static_cast<std::size_t>(mesh.NumberOfVertices());
  std::vector<double> angles(n, 0.0);
  std::vector<char> isOnRim(n, 0);
  for (const Index vertex : mesh.BoundaryVertices())
  {
    isOnRim[static_cast<std::size_t>(vertex)] = 1;
  }
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const TriangleMesh::Shape shape = this->ShapeOf(t);
    const bool isOpen = !IsBarrier(this->Shapes, t);
    const double first = std::atan2(shape.Y, shape.X);
    const double second = std::atan2(shape.Y, shape.Length - shape.X);
    const double angle[] = { first, second, std::acos(-1.0) - first - second };
    for (int a = 0; a < 3; ++a)
    {
      const auto vertex = static_cast<std::size_t>(mesh.TriangleVertices()(t, a));
      // Both sheets of a surface that is covered twice have each angle.
      angles[vertex] += isOpen ? shape.Weight * angle[a] : 0.0;
      isOnRim[vertex] = isOnRim[vertex] != 0 || !isOpen;
    }
  }
  const double straight = std::acos(-1.0) * (1.0 + 1e-6);
  const double saddle = 2.0 * std::acos(-1.0) + SmallestSaddle;
  this->IsCorner.resize(n);
  for (std::size_t i = 0; i < n; ++i)
  {
    this->IsCorner[i] = angles[i] > (isOnRim[i] != 0 ? straight : saddle);
  }
  this->FindGates(isOnRim);
}

/// Sides without another open triangle, and all sides of triangles that have a vertex twice: times at
/// two places of one vertex say nothing of the way between them.
void GeodesicDistance::FindGates(const std::vector<char>& isOnRim)
{
  const TriangleMesh& mesh = *this->Mesh;
  const Triangles& edges = mesh.TriangleEdges();
  const Index sides = 3 * mesh.NumberOfTriangles();
  std::vector<char> uses(edges.rows() > 0 ? static_cast<std::size_t>(sides) : 0, 0);
  for (Index side = 0; edges.rows() > 0 && side < sides; ++side)
  {
    char& known = uses[static_cast<std::size_t>(edges.data()[side])];
    known = static_cast<char>(std::min(2, known + (IsBarrier(this->Shapes, side / 3) ? 0 : 1)));
  }
  this->IsClosed.assign(static_cast<std::size_t>(sides), 0);
  for (Index side = 0; side < sides; ++side)
  {
    const Index i = mesh.OtherCorner(side, 1);
    const Index j = mesh.OtherCorner(side, 2);
    bool isOpen = edges.rows() == 0 || uses[static_cast<std::size_t>(edges.data()[side])] > 1;
    if (edges.rows() == 0 && isOnRim[static_cast<std::size_t>(i)] != 0 &&
      isOnRim[static_cast<std::size_t>(j)] != 0)
    {
      const auto begin = mesh.VertexCorners().begin();
      isOpen = std::any_of(begin + mesh.VertexCornersBegin()[static_cast<std::size_t>(i)],
        begin + mesh.VertexCornersBegin()[static_cast<std::size_t>(i) + 1],
        [&](Index corner)
        {
          return corner / 3 != side / 3 && !IsBarrier(this->Shapes, corner / 3) &&
            (mesh.OtherCorner(corner, 1) == j || mesh.OtherCorner(corner, 2) == j);
        });
    }
    const Index opposite = mesh.TriangleVertices().data()[side];
    const bool isLoop = i == j || i == opposite || j == opposite;
    this->IsClosed[static_cast<std::size_t>(side)] = isLoop ? 2 : (isOpen ? 0 : 1);
  }
}

/// The first way to a corner of a triangle through the triangle.
GeodesicDistance::Way GeodesicDistance::WayThrough(
  Index corner, const std::vector<FrontSource>& fronts, const Arrival& arrival) const
{
  const Index t = corner / 3;
  if (IsBarrier(this->Shapes, t))
  {
    return { Never, -1, -1 };
  }
  const int a = corner % 3;
  const TriangleMesh::Shape shape = this->ShapeOf(t);
  const Index second = this->Mesh->OtherCorner(corner, 1);
  const Index third = this->Mesh->OtherCorner(corner, 2);
  const double toSecond = shape.EdgeLength((a + 2) % 3);
  const double toThird = shape.EdgeLength((a + 1) % 3);
  const double ofSecond = arrival.Times[static_cast<std::size_t>(second)];
  const double ofThird = arrival.Times[static_cast<std::size_t>(third)];
  const Index bySecond = arrival.Sources[static_cast<std::size_t>(second)];
  const Index byThird = arrival.Sources[static_cast<std::size_t>(third)];
  Way way{ ofSecond + toSecond, bySecond, second };
  if (ofThird + toThird < way.Time)
  {
    way = { ofThird + toThird, byThird, third };
  }
  if (bySecond < 0 || byThird < 0)
  {
    return way;
  }
  const FrontSource& one = fronts[static_cast<std::size_t>(bySecond)];
  const FrontSource& other = fronts[static_cast<std::size_t>(byThird)];
  if (one.Label != other.Label)
  {
    return way;
  }
  // A vertex that a front starts from, a source or a corner, is a point of it.
  const auto startsAt = [](const FrontSource& front, Index vertex)
  { return front.Vertex == vertex && front.Time == front.Start; };
  const bool areTwoPoints = one.Point >= 0 && other.Point >= 0 && one.Point != other.Point;
  const char isClosed = this->IsClosed[static_cast<std::size_t>(corner)];
  const bool isSource = areTwoPoints && startsAt(one, second) && startsAt(other, third);
  if (isClosed == 2 || (isClosed == 1 && !isSource))
  {
    return way;
  }
  const LaidOut triangle(shape.EdgeLength(a), toSecond, toThird);
  const bool isPlane = areTwoPoints && !startsAt(one, third) && !startsAt(other, second);
  // Of a way around a corner and another one, the point where both begin
  const bool isOther =
    startsAt(other, second) || (!startsAt(one, third) && other.Start < one.Start);
  const double start = isPlane ? std::min(ofSecond, ofThird) : (isOther ? other : one).Start;
  const double da = ofSecond - start;
  const double db = ofThird - start;
  const double through =
    start + (isPlane ? triangle.FromPlane(da, db) : triangle.FromPoint(da, db));
  return through < way.Time ? Way{ through, ofSecond < ofThird ? bySecond : byThird, -1 } : way;
}

GeodesicDistance::Memory::Memory(Index vertices)
  : Found{ std::vector<double>(static_cast<std::size_t>(vertices), Never),
    std::vector<Index>(static_cast<std::size_t>(vertices), -1) }
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
        Way way = this->WayThrough(at, fronts, arrival);
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
        }
        if (known == Never)
        {
          reached.push_back(neighbour);
        }
        known = way.Time;
        arrival.Sources[static_cast<std::size_t>(neighbour)] = way.Front;
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
