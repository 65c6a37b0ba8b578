// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geodesics/SourcePiece.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

using Eigen::Vector2d;

/// Triangles that straight ways are followed over, beyond that of the piece.
constexpr int TrianglesAround = 3;

double Cross(const Vector2d& a, const Vector2d& b)
{
  return a[0] * b[1] - a[1] * b[0];
}

/// The corners of a triangle in its own axes.
std::array<Vector2d, 3> CornersOf(const TriangleMesh::Shape& shape)
{
  return { Vector2d(0.0, 0.0), Vector2d(shape.Length, 0.0), Vector2d(shape.X, shape.Y) };
}

/// A piece in the plane of its triangle.
struct FlatPiece
{
  Vector2d From, Along;

  FlatPiece(const std::array<Vector2d, 3>& corners, const SourcePiece& piece)
    : From(At(corners, piece.From))
    , Along(At(corners, piece.To) - From)
  {
  }

  /// How far along the piece, 0 to 1, the place is that is nearest to x.
  double NearestShare(const Vector2d& x) const
  {
    const double square = this->Along.squaredNorm();
    return square > 0.0 ? std::clamp((x - this->From).dot(this->Along) / square, 0.0, 1.0) : 0.0;
  }
  Vector2d Place(double share) const { return this->From + share * this->Along; }

private:
  static Vector2d At(const std::array<Vector2d, 3>& corners, const std::array<double, 3>& at)
  {
    return at[0] * corners[0] + at[1] * corners[1] + at[2] * corners[2];
  }
};

/// An edge of triangles laid out side by side, that straight ways cross.
struct Gate
{
  Vector2d A, B;

  bool IsCrossed(const Vector2d& from, const Vector2d& to) const
  {
    const Vector2d way = to - from;
    return Cross(this->A - from, way) * Cross(this->B - from, way) <= 0.0;
  }
};

/// Follows straight ways from one piece.
class Spreading
{
public:
  Spreading(const TriangleMesh& mesh, const TriangleMesh::Shape& shape, const SourcePiece& piece,
    Index& nextPoint, std::vector<FrontSource>& fronts)
    : Mesh(mesh)
    , Piece(piece)
    , Corners(CornersOf(shape))
    , Flat(this->Corners, piece)
    , NextPoint(nextPoint)
    , Fronts(fronts)
  {
  }

  void Spread(bool around)
  {
    for (int a = 0; a < 3; ++a)
    {
      this->Reach(
        this->VertexOf(this->Piece.Triangle, a), this->Corners[static_cast<std::size_t>(a)]);
    }
    for (int a = 0; a < 3 && around; ++a)
    {
      const int b = (a + 1) % 3;
      this->Continue(this->Piece.Triangle, this->VertexOf(this->Piece.Triangle, a),
        this->VertexOf(this->Piece.Triangle, b), this->Corners[static_cast<std::size_t>(a)],
        this->Corners[static_cast<std::size_t>(b)], TrianglesAround);
    }
  }

private:
  Index VertexOf(Index t, int corner) const { return this->Mesh.TriangleVertices()(t, corner); }

  /// The straight way to a vertex at x, if it crosses all gates.
  void Reach(Index vertex, const Vector2d& x)
  {
    const double share = this->Flat.NearestShare(x);
    const Vector2d place = this->Flat.Place(share);
    for (const Gate& gate : this->Gates)
    {
      if (!gate.IsCrossed(place, x))
      {
        return;
      }
    }
    Index point = share == 0.0 ? this->Piece.FromPoint : (share == 1.0 ? this->Piece.ToPoint : -1);
    point = point < 0 ? this->NextPoint++ : point;
    this->Fronts.push_back({ vertex, (x - place).norm(), this->Piece.Label, point, 0.0 });
  }

  /// Lay out the triangles beyond the edge from vertex i at a to vertex j at b of triangle t, which
  /// is on the left of it.
  void Continue(Index t, Index i, Index j, const Vector2d& a, const Vector2d& b, int left)
  {
    this->Gates.push_back({ a, b });
    for (Index k = this->Mesh.VertexCornersBegin()[static_cast<std::size_t>(i)];
         k < this->Mesh.VertexCornersBegin()[static_cast<std::size_t>(i) + 1]; ++k)
    {
      const Index corner = this->Mesh.VertexCorners()[static_cast<std::size_t>(k)];
      const Index next = corner / 3;
      const int step = this->Mesh.OtherCorner(corner, 1) == j ? 2 : 1;
      if (next == t || this->Mesh.OtherCorner(corner, 3 - step) != j)
      {
        continue;
      }
      const TriangleMesh::Shape shape = this->Mesh.Shapes()[static_cast<std::size_t>(next)];
      const int third = (corner % 3 + step) % 3;
      const int second = 3 - corner % 3 - third;
      const double fromA = shape.EdgeLength(second); // of the third corner
      const double fromB = shape.EdgeLength(corner % 3);
      const Vector2d edge = b - a;
      const double length = edge.norm();
      const double x = (fromA * fromA - fromB * fromB + length * length) / (2.0 * length);
      const double y = std::sqrt(std::max(0.0, (fromA - x) * (fromA + x)));
      const Vector2d u = edge / length;
      const Vector2d c = a + x * u + y * Vector2d(u[1], -u[0]);
      const Index vertex = this->Mesh.OtherCorner(corner, step);
      this->Reach(vertex, c);
      if (left > 1)
      {
        this->Continue(next, i, vertex, a, c, left - 1);
        this->Continue(next, vertex, j, c, b, left - 1);
      }
    }
    this->Gates.pop_back();
  }

  const TriangleMesh& Mesh;
  const SourcePiece& Piece;
  const std::array<Vector2d, 3> Corners;
  const FlatPiece Flat;
  Index& NextPoint;
  std::vector<FrontSource>& Fronts;
  std::vector<Gate> Gates;
};

} // namespace

void AppendFronts(const TriangleMesh& mesh, const FrontShapes& shapes, const SourcePiece& piece,
  Index& nextPoint, std::vector<FrontSource>& fronts)
{
  for (int a = 0; a < 3; ++a)
  {
    const auto corner = static_cast<std::size_t>(a);
    if (piece.From[corner] == 1.0 && piece.To[corner] == 1.0)
    {
      const Index point = piece.FromPoint < 0 ? nextPoint++ : piece.FromPoint;
      fronts.push_back(
        { mesh.TriangleVertices()(piece.Triangle, a), 0.0, piece.Label, point, 0.0 });
      return;
    }
  }
  const bool around = shapes.empty();
  const auto t = static_cast<std::size_t>(piece.Triangle);
  Spreading(mesh, around ? mesh.Shapes()[t] : shapes[t], piece, nextPoint, fronts).Spread(around);
}

void AppendHeat(
  const TriangleMesh& mesh, const SourcePiece& piece, std::vector<HeatSource>& sources)
{
  const auto corners = CornersOf(mesh.Shapes()[static_cast<std::size_t>(piece.Triangle)]);
  const FlatPiece flat(corners, piece);
  for (std::size_t a = 0; a < 3; ++a)
  {
    const double along = flat.NearestShare(corners[a]);
    const double share = (1.0 - along) * piece.From[a] + along * piece.To[a];
    if (share > 0.0)
    {
      sources.push_back({ mesh.TriangleVertices()(piece.Triangle, static_cast<Eigen::Index>(a)),
        share, (flat.Place(along) - corners[a]).norm() });
    }
  }
}

} // namespace SurfaceDiffusion
