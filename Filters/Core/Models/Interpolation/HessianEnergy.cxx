// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Interpolation/HessianEnergy.h"

#include "Core/Models/Interpolation/NeedleShare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

using Entry = Eigen::Triplet<double, Index>;

/// The edges of a mesh with axes of their own: the first triangle of an edge gives its direction,
/// and the axis across it points into that triangle.
struct EdgeAxes
{
  explicit EdgeAxes(const TriangleMesh& mesh)
    : OfCorner(mesh.NumberOfTriangles(), 3)
    , Along(mesh.NumberOfTriangles(), 3)
    , Across(mesh.NumberOfTriangles(), 3)
  {
    struct Side
    {
      std::array<Index, 2> Key;
      Index Corner; ///< 3 t + a, opposite
    };
    const Triangles& vertices = mesh.TriangleVertices();
    const Triangles& given = mesh.TriangleEdges();
    std::vector<Side> sides;
    sides.reserve(3 * static_cast<std::size_t>(mesh.NumberOfTriangles()));
    for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
    {
      for (int a = 0; a < 3; ++a)
      {
        const auto ends = std::minmax(vertices(t, (a + 1) % 3), vertices(t, (a + 2) % 3));
        const std::array<Index, 2> key = given.rows() > 0
          ? std::array<Index, 2>{ given(t, a), 0 }
          : std::array<Index, 2>{ ends.first, ends.second };
        sides.push_back({ key, 3 * t + a });
      }
    }
    std::sort(sides.begin(), sides.end(),
      [](const Side& a, const Side& b)
      { return a.Key != b.Key ? a.Key < b.Key : a.Corner < b.Corner; });
    Index start = -1;
    for (std::size_t i = 0; i < sides.size(); ++i)
    {
      const Index t = sides[i].Corner / 3;
      const int a = sides[i].Corner % 3;
      const Index from = vertices(t, (a + 1) % 3);
      const bool isFirst = i == 0 || sides[i].Key != sides[i - 1].Key;
      if (isFirst)
      {
        ++this->Count;
        start = from;
      }
      const bool isLoop = from == vertices(t, (a + 2) % 3);
      this->OfCorner(t, a) = this->Count - 1;
      this->Along(t, a) = isFirst || (from == start && !isLoop) ? 1.0 : -1.0;
      this->Across(t, a) = isFirst ? 1.0 : -1.0;
    }
  }

  Index Count = 0;
  Triangles OfCorner; ///< the edge opposite a corner
  CornerWeights Along, Across; ///< the signs of its axes in the triangle
};

/// A triangle in its own axes. Row a is of corner a, or of the edge opposite to it.
struct PlaneTriangle
{
  explicit PlaneTriangle(const TriangleMesh::Shape& s)
    : Area(s.Area())
    , GradientShare(std::sqrt(NeedleShare(s)))
  {
    Corners << 0.0, 0.0, s.Length, 0.0, s.X, s.Y;
    for (int a = 0; a < 3; ++a)
    {
      const Eigen::RowVector2d edge = Corners.row((a + 2) % 3) - Corners.row((a + 1) % 3);
      const double height = s.Length * s.Y / edge.norm();
      this->Along.row(a) = edge.normalized();
      this->Inward.row(a) << -this->Along(a, 1), this->Along(a, 0);
      this->Basis.row(a) =
        this->GradientShare / height * this->Inward.row(a); // of the linear function of corner a
    }
    for (int a = 0; a < 3; ++a)
    {
      const double cosine = -this->Along.row((a + 1) % 3).dot(this->Along.row((a + 2) % 3));
      this->Angles[a] = std::acos(std::min(1.0, std::max(-1.0, cosine)));
    }
  }

  double Area;
  double GradientShare; ///< of needles, beside that in Basis
  Eigen::Matrix<double, 3, 2> Corners, Along, Inward, Basis;
  std::array<double, 3> Angles;
};

/// An unknown of an edge, in one of its triangles: part of the gradient along an axis.
struct Unknown
{
  int Corner; ///< opposite the edge
  Index Number;
  Eigen::RowVector2d Axis;
  double Share; ///< of the gradient of the triangle in the unknown
  double Weight = 1.0; ///< of the unknown in the triangle
};

/// Edges of three or more triangles, whose slopes s_i across them, each into its triangle, become
/// s_i - c_i S with S their sum and c_i = (1/A_i)/(sum of 1/A). S and s_i are the unknowns.
struct Junctions
{
  Junctions(const TriangleMesh& mesh, const EdgeAxes& edges)
    : Uses(Vector::Zero(edges.Count))
    , Smallest(Vector::Constant(edges.Count, std::numeric_limits<double>::max()))
    , Sums(Vector::Zero(edges.Count))
  {
    for (const bool isLast : { false, true })
    {
      for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
      {
        const double area = mesh.Shapes()[t].Area();
        for (const Index e : edges.OfCorner.row(t))
        {
          this->Uses[e] += isLast ? 0.0 : 1.0;
          this->Smallest[e] = std::min(this->Smallest[e], area);
          this->Sums[e] += isLast ? this->Smallest[e] / area : 0.0;
        }
      }
    }
  }

  bool Has(Index e) const { return this->Uses[e] > 2.0; }
  double ShareOfSum(Index e, double area) const { return this->Smallest[e] / area / this->Sums[e]; }

  Vector Uses, Smallest, Sums; ///< per edge: triangles, the least area, the sum of it over areas
};

} // namespace

Index HessianEnergy::TooManyTriangles(const TriangleMesh& mesh, double more)
{
  double entries = 0.0;
  Index largest = 0;
  std::vector<Index> uses(static_cast<std::size_t>(mesh.NumberOfVertices()), 0);
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    Index count = 0;
    for (const Index change : { 1, -1 })
    {
      for (Index c = mesh.VertexCornersBegin()[i]; c < mesh.VertexCornersBegin()[i + 1]; ++c)
      {
        for (const int other : { 1, 2 })
        {
          const Index j = mesh.OtherCorner(mesh.VertexCorners()[c], other);
          uses[j] += change;
          count = std::max(count, uses[j]);
        }
      }
    }
    entries += (count + 1.0) * (count + 1.0);
    largest = std::max(largest, count);
  }
  return entries > 400.0 * mesh.NumberOfVertices() + more ? largest : 0;
}

HessianEnergy::HessianEnergy(const TriangleMesh& mesh, bool withNegativeCurvature)
{
  constexpr double third = 1.0 / 3.0;
  const double fullAngle = 2.0 * std::acos(-1.0);
  const EdgeAxes edges(mesh);
  const Triangles& vertices = mesh.TriangleVertices();
  const Index n = mesh.NumberOfVertices();
  Vector masses = Vector::Zero(edges.Count);
  Vector angles = Vector::Zero(n);
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const PlaneTriangle triangle(mesh.Shapes()[t]);
    for (int a = 0; a < 3; ++a)
    {
      masses[edges.OfCorner(t, a)] += third * triangle.Area;
      angles[vertices(t, a)] += triangle.Angles[a];
    }
  }
  Vector defects = (fullAngle - angles.array()).matrix();
  for (const Index i : mesh.BoundaryVertices())
  {
    defects[i] = 0.0;
  }

  if (!withNegativeCurvature)
  {
    defects = defects.cwiseMax(0.0).eval();
  }

  const Junctions junctions(mesh, edges);
  Index count = 2 * edges.Count;
  std::vector<Unknown> unknowns;
  std::vector<Entry> gradient, energy;
  gradient.reserve(18 * static_cast<std::size_t>(mesh.NumberOfTriangles()));
  energy.reserve(36 * static_cast<std::size_t>(mesh.NumberOfTriangles()));
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const PlaneTriangle triangle(mesh.Shapes()[t]);
    unknowns.clear();
    for (int a = 0; a < 3; ++a)
    {
      const Index e = edges.OfCorner(t, a);
      const double share = third * triangle.Area / masses[e];
      unknowns.push_back({ a, 2 * e, edges.Along(t, a) * triangle.Along.row(a), share });
      if (!junctions.Has(e))
      {
        unknowns.push_back({ a, 2 * e + 1, edges.Across(t, a) * triangle.Inward.row(a), share });
        continue;
      }
      const double ofSum = junctions.ShareOfSum(e, triangle.Area);
      unknowns.push_back({ a, 2 * e + 1, triangle.Inward.row(a), 1.0, -ofSum });
      unknowns.push_back({ a, count++, triangle.Inward.row(a), 1.0 });
    }
    for (const Unknown& e : unknowns)
    {
      for (int b = 0; b < 3; ++b)
      {
        gradient.emplace_back(e.Number, vertices(t, b),
          e.Share * triangle.GradientShare * e.Axis.dot(triangle.Basis.row(b)));
      }
    }
    for (const Unknown& e : unknowns)
    {
      for (const Unknown& f : unknowns)
      {
        // The function of an edge is 1 - 2 phi with phi of the opposite corner.
        double density =
          4.0 * triangle.Area * triangle.Basis.row(e.Corner).dot(triangle.Basis.row(f.Corner));
        for (int corner = 0; corner < 3; ++corner)
        {
          const double sign = (corner == e.Corner) == (corner == f.Corner) ? 1.0 : -1.0;
          const Index i = vertices(t, corner);
          density += sign * defects[i] * triangle.Angles[corner] / angles[i];
        }
        energy.emplace_back(
          e.Number, f.Number, density * (e.Weight * e.Axis).dot(f.Weight * f.Axis));
      }
    }
  }
  this->Gradient.resize(count, n);
  this->Gradient.setFromTriplets(gradient.begin(), gradient.end());
  this->Energy.resize(count, count);
  this->Energy.setFromTriplets(energy.begin(), energy.end());
}

} // namespace SurfaceDiffusion
