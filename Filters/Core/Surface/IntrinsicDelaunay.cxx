// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/IntrinsicDelaunay.h"

#include "Core/Surface/TangentVectors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

namespace SurfaceDiffusion
{

namespace
{

using Vec2 = Eigen::Vector2d;

/// Side 3 t + a of triangle t is its edge opposite corner a, from corner a + 1 to corner a + 2.
constexpr int Next(int a)
{
  return (a + 1) % 3;
}
constexpr int Last(int a)
{
  return (a + 2) % 3;
}

struct Triangle
{
  std::array<Index, 3> Vertices;
  std::array<double, 3> Lengths; ///< of the sides
  std::array<Index, 3> Twins; ///< the side on the other side of each side
  /// Area times the average of d d^T in axes with corner 0 at the origin and corner 1 on the first
  /// one: xx, xy, yy.
  Eigen::Vector3d Tensor;
};

/// Corner 2 of a triangle with corner 0 at the origin and corner 1 at (c, 0), from its sides.
Vec2 Apex(double a, double b, double c)
{
  const double x = (c * c + (b - a) * (b + a)) / (2.0 * c);
  // Kahan's stable product for needles: 16 area^2 from sorted lengths.
  std::array<double, 3> s{ a, b, c };
  std::sort(s.begin(), s.end());
  const double squared = (s[2] + (s[1] + s[0])) * (s[0] - (s[2] - s[1])) * (s[0] + (s[2] - s[1])) *
    (s[2] + (s[1] - s[0]));
  return { x, 0.5 * std::sqrt(std::max(squared, 0.0)) / c };
}

/// The tensor in axes turned by `angle`: coordinates of fixed directions turn the other way.
Eigen::Vector3d Turn(const Eigen::Vector3d& t, double angle)
{
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return { c * c * t[0] + 2.0 * c * s * t[1] + s * s * t[2],
    -c * s * t[0] + (c * c - s * s) * t[1] + c * s * t[2],
    s * s * t[0] - 2.0 * c * s * t[1] + c * c * t[2] };
}

class Flipper
{
public:
  Flipper(const TriangleMesh& mesh, const TangentVectors* frames)
  {
    const bool twoSheets = !this->GlueOneSheet(mesh);
    this->SheetWeight = twoSheets ? 0.5 : 1.0;
    this->Mollify(mesh);
    if (frames)
    {
      this->AttachFrames(mesh, *frames);
    }
  }

  void Run(const ProgressMonitor& progress)
  {
    std::vector<Index> queue(3 * this->Triangles.size());
    for (std::size_t side = 0; side < queue.size(); ++side)
    {
      queue[side] = static_cast<Index>(side);
    }
    std::vector<char> queued(queue.size(), 1);
    // Flips end: each lowers an energy of finitely many triangulations (Bobenko and Springborn).
    // Round-off in the lengths of needles can still lead around in circles; such edges stay as they
    // are after far more flips than any surface needs.
    const std::size_t most = 50 * queue.size();
    for (std::size_t done = 0; !queue.empty() && done < most; ++done)
    {
      if (done % 65536 == 0)
      {
        progress.Report(0.5);
      }
      const Index side = queue.back();
      queue.pop_back();
      queued[side] = 0;
      if (this->IsDelaunay(side))
      {
        continue;
      }
      const Index twin = this->At(side).Twins[side % 3];
      if (!this->Flip(side))
      {
        continue;
      }
      for (const Index t : { side / 3, twin / 3 })
      {
        for (int a = 0; a < 3; ++a)
        {
          const Index changed = 3 * t + a;
          if (!queued[changed])
          {
            queued[changed] = 1;
            queue.push_back(changed);
          }
        }
      }
    }
  }

  std::shared_ptr<TriangleMesh> Result(
    const TriangleMesh& mesh, TangentVectors* frames, const ParallelFor& parallel) const
  {
    const Index count = static_cast<Index>(this->Triangles.size());
    SurfaceDiffusion::Triangles corners(count, 3);
    std::vector<TriangleMesh::Shape> shapes(count);
    for (Index t = 0; t < count; ++t)
    {
      const Triangle& triangle = this->Triangles[t];
      const Vec2 apex = Apex(triangle.Lengths[0], triangle.Lengths[1], triangle.Lengths[2]);
      shapes[t] = { triangle.Lengths[2], apex[0], apex[1], this->SheetWeight };
      corners.row(t) << triangle.Vertices[0], triangle.Vertices[1], triangle.Vertices[2];
    }
    if (frames)
    {
      frames->resize(count, 2);
      for (Index t = 0; t < count; ++t)
      {
        const Eigen::Vector3d& d = this->Triangles[t].Tensor;
        frames->row(t) = MainAxis(d[0], d[1], d[2]);
      }
    }
    return std::make_shared<TriangleMesh>(mesh, std::move(corners), std::move(shapes), parallel);
  }

private:
  Triangle& At(Index side) { return this->Triangles[side / 3]; }

  /// True, with one triangle per triangle, where every edge joins two triangles that agree on their
  /// orientation; otherwise two triangles for each are made and joined.
  bool GlueOneSheet(const TriangleMesh& mesh)
  {
    const Index count = mesh.NumberOfTriangles();
    using Side = std::tuple<Index, Index, Index, bool>; // low vertex, high vertex, side, ascending
    std::vector<Side> sides;
    sides.reserve(3 * static_cast<std::size_t>(count));
    for (Index t = 0; t < count; ++t)
    {
      for (int a = 0; a < 3; ++a)
      {
        const Index from = mesh.TriangleVertices()(t, Next(a));
        const Index to = mesh.TriangleVertices()(t, Last(a));
        sides.emplace_back(std::min(from, to), std::max(from, to), 3 * t + a, from < to);
      }
    }
    std::sort(sides.begin(), sides.end());
    const auto sameEdge = [&](std::size_t i, std::size_t j)
    {
      return j < sides.size() && std::get<0>(sides[i]) == std::get<0>(sides[j]) &&
        std::get<1>(sides[i]) == std::get<1>(sides[j]);
    };
    bool simple = true;
    for (std::size_t i = 0; i < sides.size() && simple; i += 2)
    {
      simple = sameEdge(i, i + 1) && !sameEdge(i, i + 2) &&
        std::get<3>(sides[i]) != std::get<3>(sides[i + 1]);
    }

    this->Triangles.resize((simple ? 1 : 2) * static_cast<std::size_t>(count));
    for (Index t = 0; t < count; ++t)
    {
      const auto v = mesh.TriangleVertices().row(t);
      const TriangleMesh::Shape& s = mesh.Shapes()[t];
      const double l0 = s.EdgeLength(0);
      const double l1 = s.EdgeLength(1);
      this->Triangles[t] = { { v[0], v[1], v[2] }, { l0, l1, s.Length }, {},
        Eigen::Vector3d::Zero() };
      if (!simple)
      {
        // The back is the triangle seen from behind: corners 1 and 2 exchanged.
        this->Triangles[count + t] = { { v[0], v[2], v[1] }, { l0, s.Length, l1 }, {},
          Eigen::Vector3d::Zero() };
      }
    }
    for (std::size_t i = 0; i < sides.size();)
    {
      std::size_t uses = 1;
      while (sameEdge(i, i + uses))
      {
        ++uses;
      }
      if (simple)
      {
        this->Join(std::get<2>(sides[i]), std::get<2>(sides[i + 1]));
      }
      else
      {
        // Around the edge, the side that runs up of each triangle meets the one that runs down of
        // the next: any cyclic order gives nonnegative weights.
        for (std::size_t k = 0; k < uses; ++k)
        {
          this->Join(this->SheetOf(sides[i + k], count, true),
            this->SheetOf(sides[i + (k + 1) % uses], count, false));
        }
      }
      i += uses;
    }
    return simple;
  }

  /// The side of the front or the back that runs up (from the low to the high vertex) or down.
  template <typename Side>
  static Index SheetOf(const Side& side, Index count, bool up)
  {
    const Index front = std::get<2>(side);
    if (std::get<3>(side) == up)
    {
      return front;
    }
    constexpr int behind[3] = { 0, 2, 1 }; // corners 1 and 2 are exchanged on the back
    return 3 * (count + front / 3) + behind[front % 3];
  }

  void Join(Index side, Index other)
  {
    this->At(side).Twins[side % 3] = other;
    this->At(other).Twins[other % 3] = side;
  }

  /// Add one length to all edges, so that every triangle is proper by a margin.
  void Mollify(const TriangleMesh& mesh)
  {
    const double margin = 1e-6 * mesh.TotalEdgeLength() / std::max<Index>(1, mesh.NumberOfEdges());
    double extra = 0.0;
    for (const Triangle& t : this->Triangles)
    {
      for (int a = 0; a < 3; ++a)
      {
        extra = std::max(extra, margin + t.Lengths[a] - t.Lengths[Next(a)] - t.Lengths[Last(a)]);
      }
    }
    for (Triangle& t : this->Triangles)
    {
      for (double& length : t.Lengths)
      {
        length += extra;
      }
    }
  }

  void AttachFrames(const TriangleMesh& mesh, const TangentVectors& frames)
  {
    const Index count = mesh.NumberOfTriangles();
    for (std::size_t t = 0; t < this->Triangles.size(); ++t)
    {
      const Index original = static_cast<Index>(t) % count;
      const double dx = frames(original, 0);
      double dy = frames(original, 1);
      Triangle& triangle = this->Triangles[t];
      const TriangleMesh::Shape& s = mesh.Shapes()[original];
      triangle.Tensor = s.Area() * Eigen::Vector3d(dx * dx, dx * dy, dy * dy);
      if (static_cast<Index>(t) >= count)
      {
        // From the front's axes to the back's: along the edge to corner 2, and mirrored.
        triangle.Tensor = Turn(triangle.Tensor, std::atan2(s.Y, s.X));
        triangle.Tensor[1] = -triangle.Tensor[1];
      }
    }
  }

  /// Sum of the cotangents opposite the edge: not negative, or too little to matter.
  bool IsDelaunay(Index side) const
  {
    const Index twin = this->Triangles[side / 3].Twins[side % 3];
    if (twin / 3 == side / 3)
    {
      return true; // a cone around one vertex: nothing to flip
    }
    const double here = this->Cotangent(side);
    const double there = this->Cotangent(twin);
    // Written so that what is not a number, of a triangle too flat to measure, stays.
    return !(here + there < -1e-10 * (1.0 + std::abs(here) + std::abs(there)));
  }

  double Cotangent(Index side) const
  {
    const Triangle& t = this->Triangles[side / 3];
    const int a = side % 3;
    const Vec2 apex = Apex(t.Lengths[Next(a)], t.Lengths[Last(a)], t.Lengths[a]);
    // Corner a above the side from (0, 0) to (l, 0).
    const double l = t.Lengths[a];
    return apex[1] / l - (apex[0] / apex[1]) * ((l - apex[0]) / l);
  }

  /// The tensor of a triangle in axes along its side `a`.
  static Eigen::Vector3d TensorAlong(const Triangle& t, int a)
  {
    const Vec2 apex = Apex(t.Lengths[0], t.Lengths[1], t.Lengths[2]);
    const std::array<Vec2, 3> corners{ Vec2(0.0, 0.0), Vec2(t.Lengths[2], 0.0), apex };
    const Vec2 direction = corners[Last(a)] - corners[Next(a)];
    return Turn(t.Tensor, std::atan2(direction[1], direction[0]));
  }

  /// False for what round-off has pressed flat: it would have no finite weights.
  static bool IsProper(const std::array<double, 3>& l)
  {
    constexpr double flat = 4.0 * std::numeric_limits<double>::epsilon(); // as in TriangleMesh
    const double longest = std::max({ l[0], l[1], l[2] });
    return l[2] * Apex(l[0], l[1], l[2])[1] > flat * longest * longest;
  }

  /// Replace the edge PQ of triangles A P Q and B Q P by the edge AB; false, and nothing done,
  /// where that makes a flat triangle.
  bool Flip(Index side)
  {
    const Index twin = this->At(side).Twins[side % 3];
    const Index first = side / 3;
    const Index second = twin / 3;
    const Triangle f = this->Triangles[first];
    const Triangle g = this->Triangles[second];
    const int a = side % 3;
    const int b = twin % 3;
    const double pq = f.Lengths[a];
    // P at the origin, Q at (pq, 0), A above and B below.
    const Vec2 above = Apex(f.Lengths[Next(a)], f.Lengths[Last(a)], pq);
    Vec2 below = Apex(g.Lengths[Last(b)], g.Lengths[Next(b)], pq);
    below[1] = -below[1];
    const double ab = (above - below).norm();
    const std::array<double, 3> leftLengths{ g.Lengths[Next(b)], ab, f.Lengths[Last(a)] };
    const std::array<double, 3> rightLengths{ f.Lengths[Next(a)], ab, g.Lengths[Last(b)] };
    if (!IsProper(leftLengths) || !IsProper(rightLengths))
    {
      return false;
    }

    // Outer sides: A P, Q A of the first, B Q, P B of the second, in their new places.
    const std::array<std::pair<Index, Index>, 4> outer{ { { 3 * first + Last(a), 3 * first + 2 },
      { 3 * first + Next(a), 3 * second + 0 }, { 3 * second + Last(b), 3 * second + 2 },
      { 3 * second + Next(b), 3 * first + 0 } } };
    const auto moved = [&](Index old)
    {
      for (const auto& place : outer)
      {
        if (place.first == old)
        {
          return place.second;
        }
      }
      return old;
    };
    const std::array<Index, 4> twins{ moved(f.Twins[Last(a)]), moved(f.Twins[Next(a)]),
      moved(g.Twins[Last(b)]), moved(g.Twins[Next(b)]) };

    const Index A = f.Vertices[a];
    const Index P = f.Vertices[Next(a)];
    const Index Q = f.Vertices[Last(a)];
    const Index B = g.Vertices[b];
    Triangle& left = this->Triangles[first];
    Triangle& right = this->Triangles[second];
    left.Vertices = { A, P, B };
    left.Lengths = leftLengths;
    right.Vertices = { B, Q, A };
    right.Lengths = rightLengths;
    this->Join(3 * first + 1, 3 * second + 1);
    for (int k = 0; k < 4; ++k)
    {
      this->Join(outer[k].second, twins[k]);
    }

    // In axes along PQ the second triangle's own side runs from Q to P: half a turn, which a
    // tensor does not feel.
    const Eigen::Vector3d sum = TensorAlong(f, a) + TensorAlong(g, b);
    const auto area = [](const Triangle& t)
    { return 0.5 * t.Lengths[2] * Apex(t.Lengths[0], t.Lengths[1], t.Lengths[2])[1]; };
    const double leftShare = area(left) / (area(left) + area(right));
    left.Tensor = leftShare * Turn(sum, std::atan2(-above[1], -above[0]));
    const Vec2 fromBToQ = Vec2(pq, 0.0) - below;
    right.Tensor = (1.0 - leftShare) * Turn(sum, std::atan2(fromBToQ[1], fromBToQ[0]));
    return true;
  }

  std::vector<Triangle> Triangles;
  double SheetWeight = 1.0;
};

} // namespace

std::shared_ptr<TriangleMesh> IntrinsicDelaunay(const TriangleMesh& mesh, TangentVectors* frames,
  const ParallelFor& parallel, const ProgressMonitor& progress)
{
  Flipper flipper(mesh, frames);
  flipper.Run(progress);
  return flipper.Result(mesh, frames, parallel);
}

} // namespace SurfaceDiffusion
