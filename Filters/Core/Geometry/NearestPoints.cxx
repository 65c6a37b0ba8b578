// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/NearestPoints.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

constexpr Index LeafSize = 8;

/// Coordinates below it are those of a point on an edge or at a corner.
constexpr double Resolved = 1e-9;

std::array<double, 3> Snapped(std::array<double, 3> coordinates)
{
  double sum = 0.0;
  for (double& c : coordinates)
  {
    c = c < Resolved ? 0.0 : c;
    sum += c;
  }
  for (double& c : coordinates)
  {
    c = c == sum ? (c > 0.0 ? 1.0 : 0.0) : c / sum;
  }
  return coordinates;
}

/// The share of b in the point of the edge from a to b that is nearest to x.
double AlongEdge(
  const Eigen::RowVector3d& a, const Eigen::RowVector3d& b, const Eigen::RowVector3d& x)
{
  const double square = (b - a).squaredNorm();
  return square > 0.0 ? std::clamp((x - a).dot(b - a) / square, 0.0, 1.0) : 0.0;
}

double SquaredDistanceToBox(
  const Eigen::Array3d& low, const Eigen::Array3d& high, const Eigen::RowVector3d& x)
{
  const Eigen::Array3d p = x.transpose().array();
  return (low - p).max(p - high).max(0.0).square().sum();
}

} // namespace

NearestPoints::NearestPoints(const Points& points, const Triangles& triangles)
  : Vertices(points)
  , Faces(triangles)
  , Order(static_cast<std::size_t>(triangles.rows()))
{
  std::iota(this->Order.begin(), this->Order.end(), 0);
  Points centers(triangles.rows(), 3);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
  {
    centers.row(t) =
      points.row(triangles(t, 0)) + points.row(triangles(t, 1)) + points.row(triangles(t, 2));
  }
  if (triangles.rows() > 0)
  {
    this->Nodes.reserve(this->Order.size() / 2 + 2);
    this->Split(0, static_cast<Index>(triangles.rows()), centers);
  }
}

/// Append the node of these triangles, then those of its halves.
void NearestPoints::Split(Index begin, Index end, const Points& centers)
{
  const std::size_t own = this->Nodes.size();
  Node node;
  node.Begin = begin;
  node.End = end;
  node.Low.setConstant(std::numeric_limits<double>::infinity());
  node.High = -node.Low;
  Eigen::Array3d low = node.Low;
  Eigen::Array3d high = node.High;
  for (Index i = begin; i < end; ++i)
  {
    const Index t = this->Order[static_cast<std::size_t>(i)];
    for (int a = 0; a < 3; ++a)
    {
      const Eigen::Array3d x = this->Vertices.row(this->Faces(t, a)).transpose().array();
      node.Low = node.Low.min(x);
      node.High = node.High.max(x);
    }
    const Eigen::Array3d center = centers.row(t).transpose().array();
    low = low.min(center);
    high = high.max(center);
  }
  this->Nodes.push_back(node);
  if (end - begin <= LeafSize)
  {
    return;
  }
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  const Index middle = begin + (end - begin) / 2;
  const auto first = this->Order.begin();
  std::nth_element(first + begin, first + middle, first + end,
    [&](Index s, Index t) {
      return std::pair{ centers(s, axis), s } < std::pair{ centers(t, axis), t };
    });
  this->Split(begin, middle, centers);
  this->Nodes[own].Right = static_cast<Index>(this->Nodes.size());
  this->Split(middle, end, centers);
}

NearestPoint NearestPoints::InTriangle(Index t, const Eigen::RowVector3d& x) const
{
  const std::array<Eigen::RowVector3d, 3> corners = { this->Vertices.row(this->Faces(t, 0)),
    this->Vertices.row(this->Faces(t, 1)), this->Vertices.row(this->Faces(t, 2)) };
  NearestPoint found;
  found.Triangle = t;
  found.SquaredDistance = std::numeric_limits<double>::infinity();
  const auto take = [&](const std::array<double, 3>& shares)
  {
    const std::array<double, 3> c = Snapped(shares);
    const double square =
      (c[0] * corners[0] + c[1] * corners[1] + c[2] * corners[2] - x).squaredNorm();
    if (square < found.SquaredDistance)
    {
      found.Coordinates = c;
      found.SquaredDistance = square;
    }
  };
  const Eigen::RowVector3d e = corners[1] - corners[0];
  const Eigen::RowVector3d f = corners[2] - corners[0];
  const Eigen::RowVector3d normal = e.cross(f);
  const double square = normal.squaredNorm();
  if (square > 0.0)
  {
    const Eigen::RowVector3d d = x - corners[0];
    const double second = d.cross(f).dot(normal) / square;
    const double third = e.cross(d).dot(normal) / square;
    if (second >= 0.0 && third >= 0.0 && second + third <= 1.0)
    {
      take({ 1.0 - second - third, second, third });
      return found;
    }
  }
  for (std::size_t a = 0; a < 3; ++a)
  {
    const std::size_t b = (a + 1) % 3;
    std::array<double, 3> shares = { 0.0, 0.0, 0.0 };
    shares[b] = AlongEdge(corners[a], corners[b], x);
    shares[a] = 1.0 - shares[b];
    take(shares);
  }
  return found;
}

NearestPoint NearestPoints::Find(const Eigen::RowVector3d& x) const
{
  NearestPoint best;
  best.SquaredDistance = std::numeric_limits<double>::infinity();
  std::vector<std::pair<Index, double>> open;
  const auto visit = [&](Index n)
  {
    const Node& node = this->Nodes[static_cast<std::size_t>(n)];
    open.emplace_back(n, SquaredDistanceToBox(node.Low, node.High, x));
  };
  if (!this->Nodes.empty())
  {
    visit(0);
  }
  while (!open.empty())
  {
    const auto [n, distance] = open.back();
    open.pop_back();
    if (distance > best.SquaredDistance)
    {
      continue;
    }
    const Node& node = this->Nodes[static_cast<std::size_t>(n)];
    if (node.Right < 0)
    {
      for (Index i = node.Begin; i < node.End; ++i)
      {
        const NearestPoint found = this->InTriangle(this->Order[static_cast<std::size_t>(i)], x);
        if (std::pair{ found.SquaredDistance, found.Triangle } <
          std::pair{ best.SquaredDistance, best.Triangle })
        {
          best = found;
        }
      }
      continue;
    }
    visit(node.Right);
    visit(n + 1);
    if (open[open.size() - 1].second > open[open.size() - 2].second)
    {
      std::swap(open[open.size() - 1], open[open.size() - 2]); // the nearer one first
    }
  }
  return best;
}

} // namespace SurfaceDiffusion
