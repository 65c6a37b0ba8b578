// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geometry/FaceGraph.h"

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <vector>

namespace SurfaceDiffusion
{

/// A row of three numbers and a 0: four in single precision are a vector of every processor.
using VariationRow = Eigen::Array4f;

/// The normal and the slope of a triangle, or their differences at an edge: of the normal, and of
/// the slope along the edge and across it.
struct VariationBlock
{
  VariationRow Rows[3] = { VariationRow::Zero(), VariationRow::Zero(), VariationRow::Zero() };
};

/// An edge between two triangles, with lengths in the unit of the energy.
struct VariationEdge
{
  std::array<Index, 2> Faces{};
  float Length = 0.0F;
  float Weight = 1.0F;
  /// Per triangle, in its axes: the midpoint from the centroid, and the direction of the edge.
  float Middle[2][2] = {};
  float Along[2][2] = {};
  /// Per triangle: 1 if the direction, turned to the left, leaves it, otherwise -1.
  std::array<float, 2> Side{};
};

/// v += what the differences at the edge have from one of its triangles, x.
inline void AddDifferences(
  const VariationEdge& edge, int side, const VariationBlock& x, VariationBlock& v)
{
  const float sign = side == 0 ? 1.0F : -1.0F;
  const float* const middle = edge.Middle[side];
  const float* const along = edge.Along[side];
  const float out = edge.Side[side];
  v.Rows[0] += sign * (x.Rows[0] + middle[0] * x.Rows[1] + middle[1] * x.Rows[2]);
  v.Rows[1] += sign * (along[0] * x.Rows[1] + along[1] * x.Rows[2]);
  v.Rows[2] += out * (along[0] * x.Rows[2] - along[1] * x.Rows[1]);
}

/// y += the transpose of AddDifferences(), times the length.
inline void AddForces(
  const VariationEdge& edge, int side, const VariationBlock& v, VariationBlock& y)
{
  const float sign = side == 0 ? edge.Length : -edge.Length;
  const float* const middle = edge.Middle[side];
  const float* const along = edge.Along[side];
  const VariationRow out = edge.Length * edge.Side[side] * v.Rows[2];
  const VariationRow first = sign * v.Rows[0];
  const VariationRow second = sign * v.Rows[1];
  y.Rows[0] += first;
  y.Rows[1] += middle[0] * first + along[0] * second - along[1] * out;
  y.Rows[2] += middle[1] * first + along[1] * second + along[0] * out;
}

/// The factor that shrinks a vector to a ball.
inline float ShrinkingFactor(float square, float radius)
{
  return square > radius * radius ? radius / std::sqrt(square) : 1.0F;
}

/// Shrink the rows of v to balls of the radii w a1 and w a0, a1 and a0 the weights of the orders.
inline void Shrink(
  const VariationEdge& edge, float weightOfFirst, float weightOfSecond, VariationBlock& v)
{
  const float square = v.Rows[0].square().sum();
  const float squares = (v.Rows[1].square() + v.Rows[2].square()).sum();
  const float slope = ShrinkingFactor(squares, edge.Weight * weightOfSecond);
  v.Rows[0] *= ShrinkingFactor(square, edge.Weight * weightOfFirst);
  v.Rows[1] *= slope;
  v.Rows[2] *= slope;
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
