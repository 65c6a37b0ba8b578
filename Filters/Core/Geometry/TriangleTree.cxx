// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/TriangleTree.h"

#include <algorithm>
#include <numeric>

namespace SurfaceDiffusion
{

namespace
{

constexpr Index LeafSize = 4;

std::vector<TriangleTree::Box> BoxesOf(const Points& points, const Triangles& triangles)
{
  std::vector<TriangleTree::Box> boxes(static_cast<std::size_t>(triangles.rows()));
  for (std::size_t t = 0; t < boxes.size(); ++t)
  {
    for (int a = 0; a < 3; ++a)
    {
      boxes[t].extend(points.row(triangles(static_cast<Eigen::Index>(t), a)).transpose());
    }
  }
  return boxes;
}

} // namespace

TriangleTree::TriangleTree(const Points& points, const Triangles& triangles)
  : TriangleTree(BoxesOf(points, triangles))
{
}

TriangleTree::TriangleTree(const std::vector<Box>& boxes)
  : Order(boxes.size())
{
  std::iota(this->Order.begin(), this->Order.end(), 0);
  if (!boxes.empty())
  {
    this->Nodes.reserve(2 * boxes.size() / LeafSize + 1);
    this->Build(boxes, 0, static_cast<Index>(boxes.size()));
  }
}

void TriangleTree::Build(const std::vector<Box>& boxes, Index begin, Index end)
{
  const std::size_t number = this->Nodes.size();
  this->Nodes.push_back({ Box(), begin, end, -1 });
  Box bounds, centers;
  for (Index k = begin; k < end; ++k)
  {
    const Box& box = boxes[static_cast<std::size_t>(this->Order[static_cast<std::size_t>(k)])];
    bounds.extend(box);
    centers.extend(Eigen::Vector3d(0.5 * box.min() + 0.5 * box.max()));
  }
  this->Nodes[number].Bounds = bounds;
  if (end - begin <= LeafSize)
  {
    return;
  }
  int axis = 0;
  centers.sizes().maxCoeff(&axis);
  const Index middle = begin + (end - begin) / 2;
  const auto at = [&](Index k) { return this->Order.begin() + k; };
  std::nth_element(at(begin), at(middle), at(end),
    [&](Index t, Index u)
    {
      const Box& a = boxes[static_cast<std::size_t>(t)];
      const Box& b = boxes[static_cast<std::size_t>(u)];
      const double first = 0.5 * a.min()[axis] + 0.5 * a.max()[axis];
      const double second = 0.5 * b.min()[axis] + 0.5 * b.max()[axis];
      return first != second ? first < second : t < u;
    });
  this->Build(boxes, begin, middle);
  this->Nodes[number].Second = static_cast<Index>(this->Nodes.size());
  this->Build(boxes, middle, end);
}

Eigen::Vector3d NearestInTriangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
  const Eigen::Vector3d& b, const Eigen::Vector3d& c)
{
  const auto onSegment = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to)
  {
    const Eigen::Vector3d along = to - from;
    const double square = along.squaredNorm();
    const double place = square > 0.0 ? std::clamp((p - from).dot(along) / square, 0.0, 1.0) : 0.0;
    return Eigen::Vector3d(from + place * along);
  };
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const bool inside = (b - a).cross(p - a).dot(normal) >= 0.0 &&
    (c - b).cross(p - b).dot(normal) >= 0.0 && (a - c).cross(p - c).dot(normal) >= 0.0;
  if (inside && normal.squaredNorm() > 0.0)
  {
    return p - normal * ((p - a).dot(normal) / normal.squaredNorm());
  }
  Eigen::Vector3d nearest = onSegment(a, b);
  for (const Eigen::Vector3d& other : { onSegment(b, c), onSegment(c, a) })
  {
    if ((other - p).squaredNorm() < (nearest - p).squaredNorm())
    {
      nearest = other;
    }
  }
  return nearest;
}

} // namespace SurfaceDiffusion
