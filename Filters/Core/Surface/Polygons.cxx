// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/Polygons.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace SurfaceDiffusion
{

namespace
{

using Row2 = Eigen::RowVector2d;
using Row3 = Eigen::RowVector3d;

/// The fourth powers of these lengths are numbers.
constexpr double Smallest = 1e-70;
constexpr double Largest = 1e70;

Row3 Cross(const Row3& u, const Row3& v)
{
  return Row3(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]);
}

/// Twice the signed area of a triangle in the plane.
double Turn(const Row2& a, const Row2& b, const Row2& c)
{
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// Area over the square of the longest edge: 0 for slivers.
double Quality(const Row2& a, const Row2& b, const Row2& c)
{
  const double longest =
    std::max({ (b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm() });
  return longest > 0.0 ? Turn(a, b, c) / longest : 0.0;
}

/// The corners in the plane of the polygon's mean normal (Newell), counterclockwise.
std::vector<Row2> Flatten(const std::vector<Row3>& corners)
{
  const std::size_t count = corners.size();
  Row3 normal = Row3::Zero();
  for (std::size_t i = 0; i < count; ++i)
  {
    normal += Cross(corners[i] - corners[0], corners[(i + 1) % count] - corners[0]);
  }
  const Row3 axis =
    normal.norm() > 0.0 ? Row3(normal.normalized()) : Row3(Row3::UnitZ()); // flat: any plane
  Eigen::Index smallest = 0;
  axis.cwiseAbs().minCoeff(&smallest);
  const Row3 x = Cross(Row3::Unit(smallest), axis).normalized();
  const Row3 y = Cross(axis, x);
  std::vector<Row2> flat;
  flat.reserve(count);
  for (const Row3& corner : corners)
  {
    flat.emplace_back((corner - corners[0]).dot(x), (corner - corners[0]).dot(y));
  }
  return flat;
}

/// The corners of a polygon that are left while ears are cut off.
class EarCutting
{
public:
  explicit EarCutting(const std::vector<Row3>& corners)
    : Flat(Flatten(corners))
    , All(corners.size())
  {
    const auto count = static_cast<int>(corners.size());
    for (int i = 0; i < count; ++i)
    {
      this->All[i].Before = (i + count - 1) % count;
      this->All[i].After = (i + 1) % count;
    }
    for (int i = 0; i < count; ++i)
    {
      this->Measure(i);
    }
  }

  std::vector<Corners> Cut()
  {
    std::vector<Corners> triangles;
    int first = 0; // of those that are left
    for (auto left = this->All.size(); left > 3; --left)
    {
      const int ear = this->FindBestEar(first);
      if (ear < 0)
      {
        break;
      }
      triangles.push_back(this->TriangleAt(ear));
      const auto [before, cut, after] = triangles.back();
      first = ear == first ? after : first;
      this->All[cut].IsLeft = false;
      this->All[before].After = after;
      this->All[after].Before = before;
      this->Measure(before);
      this->Measure(after);
    }
    for (int i = this->All[first].After; this->All[i].After != first; i = this->All[i].After)
    {
      triangles.push_back({ first, i, this->All[i].After });
    }
    return triangles;
  }

private:
  struct Corner
  {
    int Before = 0, After = 0;
    bool IsLeft = true;
    double Quality = 0.0; ///< of the triangle at the corner
    int Blocker = -1; ///< a corner that was found inside the triangle
  };

  Corners TriangleAt(int i) const { return { this->All[i].Before, i, this->All[i].After }; }

  void Measure(int i)
  {
    const Corners ear = this->TriangleAt(i);
    this->All[i].Quality = Quality(this->Flat[ear[0]], this->Flat[ear[1]], this->Flat[ear[2]]);
    this->All[i].Blocker = -1;
  }

  /// A corner inside a triangle; -1 if there is none.
  int FindBlocker(const Corners& ear) const
  {
    const Row2& a = this->Flat[ear[0]];
    const Row2& b = this->Flat[ear[1]];
    const Row2& c = this->Flat[ear[2]];
    for (int i = this->All[ear[2]].After; i != ear[0]; i = this->All[i].After)
    {
      const Row2& p = this->Flat[i];
      if (p != a && p != b && p != c && Turn(a, b, p) >= 0.0 && Turn(b, c, p) >= 0.0 &&
        Turn(c, a, p) >= 0.0)
      {
        return i;
      }
    }
    return -1;
  }

  /// The ear of the best shape; -1 if there is none.
  int FindBestEar(int first)
  {
    for (;;)
    {
      int best = -1;
      double bestQuality = 0.0;
      int i = first;
      do
      {
        const Corner& corner = this->All[i];
        if (corner.Quality > bestQuality &&
          (corner.Blocker < 0 || !this->All[corner.Blocker].IsLeft))
        {
          best = i;
          bestQuality = corner.Quality;
        }
        i = corner.After;
      } while (i != first);
      const int blocker = best < 0 ? -1 : this->FindBlocker(this->TriangleAt(best));
      if (blocker < 0)
      {
        return best;
      }
      this->All[best].Blocker = blocker;
    }
  }

  const std::vector<Row2> Flat;
  std::vector<Corner> All;
};

std::vector<Corners> CutQuad(const std::vector<Row3>& corners)
{
  const auto normal = [&](std::size_t a, std::size_t b, std::size_t c)
  { return Cross(corners[b] - corners[a], corners[c] - corners[a]); };
  const bool firstInside = normal(0, 1, 2).dot(normal(0, 2, 3)) > 0.0;
  const bool secondInside = normal(1, 2, 3).dot(normal(1, 3, 0)) > 0.0;
  const bool firstShorter = (corners[0] - corners[2]).norm() <= (corners[1] - corners[3]).norm();
  if (firstInside == secondInside ? firstShorter : firstInside)
  {
    return { { 0, 1, 2 }, { 0, 2, 3 } };
  }
  return { { 1, 2, 3 }, { 1, 3, 0 } };
}

} // namespace

std::vector<Corners> CutPolygon(const std::vector<Eigen::RowVector3d>& corners)
{
  if (corners.size() < 3)
  {
    return {};
  }
  double extent = 0.0;
  for (const Row3& corner : corners)
  {
    extent = std::max(extent, (corner - corners[0]).cwiseAbs().maxCoeff());
  }
  if (extent > 0.0 && (extent < Smallest || extent > Largest))
  {
    const double unit = std::ldexp(1.0, std::ilogb(extent));
    std::vector<Row3> scaled;
    for (const Row3& corner : corners)
    {
      scaled.push_back((corner - corners[0]) / unit);
    }
    return CutPolygon(scaled);
  }
  return corners.size() == 4 ? CutQuad(corners) : EarCutting(corners).Cut();
}

} // namespace SurfaceDiffusion
