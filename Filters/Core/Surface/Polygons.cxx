// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/Polygons.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace SurfaceDiffusion
{

namespace
{

using Row2 = Eigen::RowVector2d;
using Row3 = Eigen::RowVector3d;

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
    , Left(corners.size())
  {
    std::iota(this->Left.begin(), this->Left.end(), 0);
  }

  std::vector<Corners> Cut()
  {
    std::vector<Corners> triangles;
    while (this->Left.size() > 3)
    {
      const std::size_t ear = this->FindBestEar();
      if (ear == this->Left.size())
      {
        break;
      }
      triangles.push_back(this->TriangleAt(ear));
      this->Left.erase(this->Left.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    for (std::size_t i = 1; i + 1 < this->Left.size(); ++i)
    {
      triangles.push_back({ this->Left[0], this->Left[i], this->Left[i + 1] });
    }
    return triangles;
  }

private:
  Corners TriangleAt(std::size_t i) const
  {
    const std::size_t count = this->Left.size();
    return { this->Left[(i + count - 1) % count], this->Left[i], this->Left[(i + 1) % count] };
  }

  const Row2& At(int corner) const { return this->Flat[static_cast<std::size_t>(corner)]; }

  bool IsEmpty(const Corners& ear) const
  {
    const Row2& a = this->At(ear[0]);
    const Row2& b = this->At(ear[1]);
    const Row2& c = this->At(ear[2]);
    return std::none_of(this->Left.begin(), this->Left.end(),
      [&](int corner)
      {
        const Row2& p = this->At(corner);
        return std::find(ear.begin(), ear.end(), corner) == ear.end() && p != a && p != b &&
          p != c && Turn(a, b, p) >= 0.0 && Turn(b, c, p) >= 0.0 && Turn(c, a, p) >= 0.0;
      });
  }

  /// The place of the ear of the best shape; that of no corner if there is none.
  std::size_t FindBestEar() const
  {
    std::size_t best = this->Left.size();
    double bestQuality = 0.0;
    for (std::size_t i = 0; i < this->Left.size(); ++i)
    {
      const Corners ear = this->TriangleAt(i);
      const double quality = Quality(this->At(ear[0]), this->At(ear[1]), this->At(ear[2]));
      if (quality > bestQuality && this->IsEmpty(ear))
      {
        best = i;
        bestQuality = quality;
      }
    }
    return best;
  }

  const std::vector<Row2> Flat;
  std::vector<int> Left;
};

} // namespace

std::array<Corners, 2> CutQuad(const std::array<Eigen::RowVector3d, 4>& corners)
{
  const auto normal = [&](std::size_t a, std::size_t b, std::size_t c)
  { return Cross(corners[b] - corners[a], corners[c] - corners[a]); };
  const bool firstInside = normal(0, 1, 2).dot(normal(0, 2, 3)) > 0.0;
  const bool secondInside = normal(1, 2, 3).dot(normal(1, 3, 0)) > 0.0;
  const bool firstShorter = (corners[0] - corners[2]).norm() <= (corners[1] - corners[3]).norm();
  if (firstInside == secondInside ? firstShorter : firstInside)
  {
    return { { { 0, 1, 2 }, { 0, 2, 3 } } };
  }
  return { { { 1, 2, 3 }, { 1, 3, 0 } } };
}

std::vector<Corners> CutPolygon(const std::vector<Eigen::RowVector3d>& corners)
{
  if (corners.size() == 4)
  {
    const auto quad = CutQuad({ corners[0], corners[1], corners[2], corners[3] });
    return { quad.begin(), quad.end() };
  }
  return EarCutting(corners).Cut();
}

} // namespace SurfaceDiffusion
