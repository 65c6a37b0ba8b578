// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geodesics/ExactDistance.h"
#include "Core/Geodesics/GeodesicPath.h"
#include "ExactDistances.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

namespace SurfaceDiffusion::Testing
{

/// Shortest paths on a surface, in its unit, with what makes them shortest measured in space.
class PathsOn
{
public:
  using Place = MeshPlace;

  struct Found
  {
    double Length = 0.0; ///< that the path has by its own account
    bool IsFollowed = false; ///< the segments lead from begin to end
    std::vector<Eigen::RowVector3d> Points;
    std::vector<Index> Faces;
    double Drawn = 0.0; ///< the length of the segments in space
    double Gap = 0.0; ///< between the end of a segment and the begin of the next
    double Bend =
      0.0; ///< the largest angle by which the path turns at an edge, laid out in a plane
    double Lack = 0.0; ///< the largest angle that a side of the path at a vertex has less than pi
    Index Vertices = 0; ///< that it goes through
  };

  explicit PathsOn(const Surface& s)
    : Given(s)
    , Mesh(std::make_shared<TriangleMesh>(s.Vertices, s.Faces))
    , Exact(Mesh)
    , Paths(*Mesh, Exact.GetFrames())
  {
    const std::vector<Index>& points = this->Mesh->InputVertex();
    for (std::size_t v = 0; v < points.size(); ++v)
    {
      this->VertexOf[points[v]] = static_cast<Index>(v);
    }
    for (Index t = 0; t < this->Mesh->NumberOfTriangles(); ++t)
    {
      for (int a = 0; a < 3; ++a)
      {
        for (const int step : { 1, 2 })
        {
          this->FacesAt[{ this->VertexAt(3 * t + a), this->VertexAt(3 * t + (a + step) % 3) }]
            .push_back(t);
        }
      }
    }
  }

  bool Has(Index point) const { return this->VertexOf.count(point) > 0; }
  Place At(Index point) const
  {
    const auto v = static_cast<std::size_t>(this->VertexOf.at(point));
    const Index corner =
      this->Mesh->VertexCorners()[static_cast<std::size_t>(this->Mesh->VertexCornersBegin()[v])];
    Place place{ corner / 3, { 0.0, 0.0, 0.0 } };
    place.At[static_cast<std::size_t>(corner % 3)] = 1.0;
    return place;
  }
  Index NumberOfTriangles() const { return this->Mesh->NumberOfTriangles(); }

  /// The distance by ExactDistance from a point of the surface to another one.
  double Distance(Index from, Index to)
  {
    if (this->DistancesFrom != from)
    {
      const Place place = this->At(from);
      this->Distances = this->Exact.Find({ { place.Triangle, place.At, place.At } }, Never).Times;
      this->DistancesFrom = from;
    }
    return this->Distances[static_cast<std::size_t>(this->VertexOf.at(to))] *
      this->Mesh->LengthUnit();
  }

  Found Find(const Place& from, const Place& to)
  {
    Found found = this->Draw(from, this->Paths.Find(from, to));
    found.Gap =
      std::max(found.Gap, (this->InSpace(to.Triangle, to.At) - found.Points.back()).norm());
    return found;
  }

  /// From points of the surface to the nearest of pieces, with the distances by ExactDistance.
  std::vector<Found> FindAll(const std::vector<Index>& points,
    const std::vector<SourcePiece>& pieces, std::vector<double>& distances)
  {
    std::vector<Place> from;
    for (const Index point : points)
    {
      from.push_back(this->At(point));
    }
    const std::vector<double> times = this->Exact.Find(pieces, Never).Times;
    std::vector<Found> all;
    for (const GeodesicPath::Path& path : this->Paths.FindAll(from, pieces))
    {
      const auto k = all.size();
      all.push_back(this->Draw(from[k], path));
      distances.push_back(
        times[static_cast<std::size_t>(this->VertexOf.at(points[k]))] * this->Mesh->LengthUnit());
      if (path.Piece >= 0)
      {
        // Its distance from the straight piece in space
        const SourcePiece& piece = pieces[static_cast<std::size_t>(path.Piece)];
        const Eigen::RowVector3d begin = this->InSpace(piece.Triangle, piece.From);
        const Eigen::RowVector3d along = this->InSpace(piece.Triangle, piece.To) - begin;
        const Eigen::RowVector3d at = all.back().Points.back() - begin;
        const double share =
          along.norm() > 0.0 ? std::clamp(at.dot(along) / along.squaredNorm(), 0.0, 1.0) : 0.0;
        all.back().Gap = std::max(all.back().Gap, (at - share * along).norm());
      }
    }
    return all;
  }

private:
  Found Draw(const Place& from, const GeodesicPath::Path& path) const
  {
    Found found;
    found.IsFollowed = path.IsFollowed;
    found.Length = path.Length * this->Mesh->LengthUnit();
    found.Points.push_back(this->InSpace(from.Triangle, from.At));
    for (std::size_t k = 0; k < path.Segments.size(); ++k)
    {
      const PathSegment& segment = path.Segments[k];
      const auto begin = this->InSpace(segment.Triangle, segment.From);
      const auto end = this->InSpace(segment.Triangle, segment.To);
      found.Gap = std::max(found.Gap, (begin - found.Points.back()).norm());
      found.Drawn += (end - begin).norm();
      found.Points.push_back(end);
      found.Faces.push_back(
        this->Mesh->InputTriangle()[static_cast<std::size_t>(segment.Triangle)]);
      if (k > 0)
      {
        this->Measure(path.Segments[k - 1], segment, found);
      }
    }
    return found;
  }
  Index VertexAt(Index corner) const { return this->Mesh->TriangleVertices().data()[corner]; }
  Eigen::RowVector3d At3(Index vertex) const
  {
    return this->Given.Vertices.row(this->Mesh->InputVertex()[static_cast<std::size_t>(vertex)]);
  }
  Eigen::RowVector3d InSpace(Index triangle, const std::array<double, 3>& at) const
  {
    Eigen::RowVector3d sum(0.0, 0.0, 0.0);
    for (int a = 0; a < 3; ++a)
    {
      sum += at[static_cast<std::size_t>(a)] * this->At3(this->VertexAt(3 * triangle + a));
    }
    return sum;
  }
  static double Angle(const Eigen::RowVector3d& a, const Eigen::RowVector3d& b)
  {
    return std::atan2(a.cross(b).norm(), a.dot(b));
  }

  void Measure(const PathSegment& in, const PathSegment& out, Found& found) const
  {
    const Eigen::RowVector3d here = this->InSpace(out.Triangle, out.From);
    const Eigen::RowVector3d back = this->InSpace(in.Triangle, in.From) - here;
    const Eigen::RowVector3d on = this->InSpace(out.Triangle, out.To) - here;
    const auto corner = std::max_element(out.From.begin(), out.From.end());
    if (*corner == 1.0)
    {
      ++found.Vertices;
      const Index vertex =
        this->VertexAt(3 * out.Triangle + static_cast<Index>(corner - out.From.begin()));
      const double side = this->LesserSide(vertex, in.Triangle, back, out.Triangle, on);
      found.Lack = std::max(found.Lack, Pi - side);
      return;
    }
    // Along the edge that both triangles share
    for (int a = 0; a < 3; ++a)
    {
      const Index p = this->VertexAt(3 * out.Triangle + a);
      const Index q = this->VertexAt(3 * out.Triangle + (a + 1) % 3);
      if (out.From[static_cast<std::size_t>((a + 2) % 3)] == 0.0)
      {
        const Eigen::RowVector3d edge = this->At3(q) - this->At3(p);
        found.Bend = std::max(found.Bend, std::abs(Angle(edge, back) + Angle(edge, on) - Pi));
      }
    }
  }

  /// Of the angles on both sides of a path at a vertex, the lesser one; infinite if there are none
  /// within the triangles.
  double LesserSide(Index vertex, Index from, const Eigen::RowVector3d& back, Index to,
    const Eigen::RowVector3d& on) const
  {
    const auto has = [&](Index t)
    {
      return this->VertexAt(3 * t) == vertex || this->VertexAt(3 * t + 1) == vertex ||
        this->VertexAt(3 * t + 2) == vertex;
    };
    double lesser = Never;
    if (!has(from) || !has(to))
    {
      return lesser; // a segment beside it is too short to be kept
    }
    for (const int side : { 0, 1 })
    {
      // Triangles are left over the edge to `next`
      std::vector<Index> others;
      for (int a = 0; a < 3; ++a)
      {
        const Index other = this->VertexAt(3 * from + a);
        if (other != vertex)
        {
          others.push_back(other);
        }
      }
      Index next = others[static_cast<std::size_t>(side)];
      Index last = others[static_cast<std::size_t>(1 - side)];
      const auto direction = [&](Index v) -> Eigen::RowVector3d
      { return this->At3(v) - this->At3(vertex); };
      if (from == to && Angle(on, direction(next)) <= Angle(back, direction(next)))
      {
        lesser = std::min(lesser, Angle(back, on));
        continue;
      }
      double sum = Angle(back, direction(next));
      for (Index t = from;;)
      {
        const std::vector<Index>& faces = this->FacesAt.at({ vertex, next });
        if (faces.size() != 2)
        {
          sum = Never; // a boundary, or several triangles
          break;
        }
        t = faces[0] == t ? faces[1] : faces[0];
        last = next;
        for (int a = 0; a < 3; ++a)
        {
          const Index other = this->VertexAt(3 * t + a);
          next = other != vertex && other != last ? other : next;
        }
        if (t == to)
        {
          sum += Angle(direction(last), on);
          break;
        }
        sum += Angle(direction(last), direction(next));
        if (t == from)
        {
          break;
        }
      }
      lesser = std::min(lesser, sum);
    }
    return lesser;
  }

  const Surface Given;
  std::shared_ptr<const TriangleMesh> Mesh;
  ExactDistance Exact;
  GeodesicPath Paths;
  std::map<Index, Index> VertexOf;
  std::map<std::pair<Index, Index>, std::vector<Index>>
    FacesAt; ///< along edges, in both directions
  Index DistancesFrom = -1;
  std::vector<double> Distances;
};

} // namespace SurfaceDiffusion::Testing
