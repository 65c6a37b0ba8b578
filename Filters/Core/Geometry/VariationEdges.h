// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geometry/FaceGraph.h"

#include <array>
#include <vector>

namespace SurfaceDiffusion
{

/// The normal and the slope of a triangle, or their differences at an edge: of the normal, and of
/// the slope along the edge and across it. The last column is 0: rows of four are vectors of the
/// processor.
struct VariationBlock
{
  double Rows[3][4] = {};
};

/// Block i of a list without the zeros, nine numbers each.
template <typename Number>
VariationBlock LoadBlock(const Number* list, Index i)
{
  const Number* const p = list + 9 * static_cast<std::ptrdiff_t>(i);
  VariationBlock block;
  for (int c = 0; c < 3; ++c)
  {
    block.Rows[0][c] = p[c];
    block.Rows[1][c] = p[3 + c];
    block.Rows[2][c] = p[6 + c];
  }
  return block;
}

template <typename Number>
void StoreBlock(Number* list, Index i, const VariationBlock& block)
{
  Number* const p = list + 9 * static_cast<std::ptrdiff_t>(i);
  for (int c = 0; c < 3; ++c)
  {
    p[c] = static_cast<Number>(block.Rows[0][c]);
    p[3 + c] = static_cast<Number>(block.Rows[1][c]);
    p[6 + c] = static_cast<Number>(block.Rows[2][c]);
  }
}

/// An edge between two triangles, with lengths in the unit of the energy.
struct VariationEdge
{
  std::array<Index, 2> Faces{};
  double Length = 0.0;
  double Weight = 1.0;
  /// Per triangle, in its axes: the midpoint from the centroid, and the direction of the edge.
  double Middle[2][2] = {};
  double Along[2][2] = {};
  /// Per triangle: 1 if the direction, turned to the left, leaves it, otherwise -1.
  std::array<float, 2> Side{};
};

/// v += what the differences at the edge have from one of its triangles, x.
inline void AddDifferences(
  const VariationEdge& edge, int side, const VariationBlock& x, VariationBlock& v)
{
  const double sign = side == 0 ? 1.0 : -1.0;
  const double mx = sign * edge.Middle[side][0], my = sign * edge.Middle[side][1];
  const double ax = sign * edge.Along[side][0], ay = sign * edge.Along[side][1];
  const double ox = -edge.Side[side] * edge.Along[side][1];
  const double oy = edge.Side[side] * edge.Along[side][0];
  for (int c = 0; c < 4; ++c)
  {
    v.Rows[0][c] += sign * x.Rows[0][c] + mx * x.Rows[1][c] + my * x.Rows[2][c];
    v.Rows[1][c] += ax * x.Rows[1][c] + ay * x.Rows[2][c];
    v.Rows[2][c] += ox * x.Rows[1][c] + oy * x.Rows[2][c];
  }
}

/// y += the transpose of AddDifferences(), times the length.
inline void AddForces(
  const VariationEdge& edge, int side, const VariationBlock& v, VariationBlock& y)
{
  const double sign = side == 0 ? edge.Length : -edge.Length;
  const double mx = sign * edge.Middle[side][0], my = sign * edge.Middle[side][1];
  const double ax = sign * edge.Along[side][0], ay = sign * edge.Along[side][1];
  const double ox = -edge.Length * edge.Side[side] * edge.Along[side][1];
  const double oy = edge.Length * edge.Side[side] * edge.Along[side][0];
  for (int c = 0; c < 4; ++c)
  {
    y.Rows[0][c] += sign * v.Rows[0][c];
    y.Rows[1][c] += mx * v.Rows[0][c] + ax * v.Rows[1][c] + ox * v.Rows[2][c];
    y.Rows[2][c] += my * v.Rows[0][c] + ay * v.Rows[1][c] + oy * v.Rows[2][c];
  }
}

inline double SquareOf(const double* row)
{
  return row[0] * row[0] + row[1] * row[1] + row[2] * row[2];
}

/// Shrink the rows of v to balls of the radii w a1 and w a0, a1 and a0 the weights of the orders.
inline void Shrink(
  const VariationEdge& edge, double weightOfFirst, double weightOfSecond, VariationBlock& v)
{
  const double square = SquareOf(v.Rows[0]);
  const double squares = SquareOf(v.Rows[1]) + SquareOf(v.Rows[2]);
  const double first = edge.Weight * weightOfFirst;
  const double second = edge.Weight * weightOfSecond;
  const double f = square > first * first ? first / std::sqrt(square) : 1.0;
  const double s = squares > second * second ? second / std::sqrt(squares) : 1.0;
  for (int c = 0; c < 4; ++c)
  {
    v.Rows[0][c] *= f;
    v.Rows[1][c] *= s;
    v.Rows[2][c] *= s;
  }
}

inline double Product(const VariationBlock& a, const VariationBlock& b)
{
  double sums[4] = {};
  for (int c = 0; c < 4; ++c)
  {
    sums[c] =
      a.Rows[0][c] * b.Rows[0][c] + a.Rows[1][c] * b.Rows[1][c] + a.Rows[2][c] * b.Rows[2][c];
  }
  return sums[0] + sums[1] + sums[2];
}

/// The edges of a surface over which the variation of normals is summed: those between two
/// triangles.
class VariationEdges
{
public:
  /// unit: of the lengths.
  VariationEdges(const FaceGraph& graph, double unit);

  /// Take the lengths and directions at these points. The axes of a triangle follow the edge that
  /// was its longest at the first call: slopes keep their components while points move.
  void SetPlaces(const Points& points, const FaceGeometry& geometry, const ParallelFor& parallel);
  /// w_e = 1/(1 + (|n_f - n_g|/range)^2).
  void SetWeights(const Points& normals, double range, const ParallelFor& parallel);

  Index Size() const { return static_cast<Index>(this->Edges.size()); }
  const VariationEdge* Data() const { return this->Edges.data(); }
  const VariationEdge& operator[](Index e) const { return this->Edges[e]; }

  using OfFace = std::array<Index, 3>; ///< -1: none
  const std::vector<OfFace>& OfFaces() const { return this->EdgesOf; }

private:
  const FaceGraph& Graph;
  const double Unit;
  std::vector<VariationEdge> Edges;
  std::vector<OfFace> EdgesOf;
  std::vector<char> FirstCorners; ///< before the edges that the axes follow
};

} // namespace SurfaceDiffusion
