// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Meshes.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace SurfaceDiffusion::Testing
{

/// The shortest straight line from a vertex to the others over any sequence of triangles, laid out in
/// the plane, without any of the rules by which windows are dropped.
class Unfolding
{
public:
  explicit Unfolding(const Surface& s)
    : S(s)
  {
  }

  std::vector<double> From(Index source)
  {
    this->Least.assign(static_cast<std::size_t>(this->S.NumberOfVertices()),
      std::numeric_limits<double>::infinity());
    this->Least[static_cast<std::size_t>(source)] = 0.0;
    for (Index t = 0; t < this->S.NumberOfTriangles(); ++t)
    {
      for (int a = 0; a < 3; ++a)
      {
        if (this->S.Faces(t, a) == source)
        {
          const Index p = this->S.Faces(t, (a + 1) % 3), q = this->S.Faces(t, (a + 2) % 3);
          const Eigen::Vector2d atP(this->Length(source, p), 0.0);
          const Eigen::Vector2d atQ =
            this->Third(p, source, q, atP, Eigen::Vector2d(0.0, 0.0), -1.0);
          this->Reach(p, atP.norm());
          this->Reach(q, atQ.norm());
          this->Passed.assign(static_cast<std::size_t>(this->S.NumberOfTriangles()), false);
          this->Passed[static_cast<std::size_t>(t)] = true;
          this->Cross(p, q, atP, atQ, atP, atQ);
        }
      }
    }
    return this->Least;
  }

private:
  double Length(Index i, Index j) const
  {
    return (this->S.Vertices.row(i) - this->S.Vertices.row(j)).norm();
  }
  static double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b)
  {
    return a[0] * b[1] - a[1] * b[0];
  }
  /// The place of vertex r from those of p and q, on the given side of the line from p to q.
  Eigen::Vector2d Third(Index p, Index q, Index r, const Eigen::Vector2d& atP,
    const Eigen::Vector2d& atQ, double side) const
  {
    const double base = this->Length(p, q), left = this->Length(p, r), right = this->Length(q, r);
    const double x = (base * base + left * left - right * right) / (2.0 * base);
    const double y = side * std::sqrt(std::max(0.0, left * left - x * x));
    const Eigen::Vector2d u = (atQ - atP) / base;
    return atP + x * u + y * Eigen::Vector2d(-u[1], u[0]);
  }
  void Reach(Index i, double distance)
  {
    double& known = this->Least[static_cast<std::size_t>(i)];
    known = std::min(known, distance);
  }
  /// Go on over the edge from p to q, which the source sees from the right to the left, between the
  /// directions `right` and `left`.
  void Cross(Index p, Index q, const Eigen::Vector2d& atP, const Eigen::Vector2d& atQ,
    const Eigen::Vector2d& right, const Eigen::Vector2d& left)
  {
    for (Index t = 0; t < this->S.NumberOfTriangles(); ++t)
    {
      for (int a = 0; a < 3; ++a)
      {
        const Index r = this->S.Faces(t, a);
        if (this->Passed[static_cast<std::size_t>(t)] || this->S.Faces(t, (a + 1) % 3) != q ||
          this->S.Faces(t, (a + 2) % 3) != p)
        {
          continue;
        }
        const Eigen::Vector2d atR = this->Third(p, q, r, atP, atQ, -1.0);
        const double fromRight = Cross(right, atR), toLeft = Cross(atR, left);
        if (fromRight >= 0.0 && toLeft >= 0.0)
        {
          this->Reach(r, atR.norm());
        }
        this->Passed[static_cast<std::size_t>(t)] = true;
        if (fromRight > 0.0)
        {
          this->Cross(p, r, atP, atR, right, toLeft > 0.0 ? atR : left);
        }
        if (toLeft > 0.0)
        {
          this->Cross(r, q, atR, atQ, fromRight > 0.0 ? atR : right, left);
        }
        this->Passed[static_cast<std::size_t>(t)] = false;
      }
    }
  }

  const Surface& S;
  std::vector<double> Least;
  std::vector<bool> Passed;
};

} // namespace SurfaceDiffusion::Testing
