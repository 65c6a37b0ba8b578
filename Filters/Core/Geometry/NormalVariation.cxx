// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/NormalVariation.h"

#include "Core/Foundation/Columns.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// r of the energy, which keeps slopes of triangles without neighbours at 0.
constexpr double Ridge = 1e-6;
constexpr double SmallestArea = 1e-4; ///< over the mean

/// The normal and the slope of a triangle, or their differences at an edge: of the normal, and of
/// the slope along the edge and across it. The last column is 0: rows of four are vectors of the
/// processor.
struct Block
{
  double Rows[3][4] = {};
};

/// An edge between two triangles.
struct Edge
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

using EdgesOfFace = std::array<Index, 3>; ///< -1: none
using Inverse = std::array<double, 6>; ///< a symmetric matrix: xx, xy, xz, yy, yz, zz

/// v += what the differences at the edge have from one of its triangles, x.
inline void AddDifferences(const Edge& edge, int side, const Block& x, Block& v)
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
inline void AddForces(const Edge& edge, int side, const Block& v, Block& y)
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

/// Shrink the rows of v to balls of the radii w a1 and w a0: these are the multipliers.
inline void Shrink(const Edge& edge, const NormalVariationSettings& settings, Block& v)
{
  const double square = SquareOf(v.Rows[0]);
  const double squares = SquareOf(v.Rows[1]) + SquareOf(v.Rows[2]);
  const double first = edge.Weight * settings.First;
  const double second = edge.Weight * settings.Second;
  const double f = square > first * first ? first / std::sqrt(square) : 1.0;
  const double s = squares > second * second ? second / std::sqrt(squares) : 1.0;
  for (int c = 0; c < 4; ++c)
  {
    v.Rows[0][c] *= f;
    v.Rows[1][c] *= s;
    v.Rows[2][c] *= s;
  }
}

inline double Product(const Block& a, const Block& b)
{
  double sums[4] = {};
  for (int c = 0; c < 4; ++c)
  {
    sums[c] =
      a.Rows[0][c] * b.Rows[0][c] + a.Rows[1][c] * b.Rows[1][c] + a.Rows[2][c] * b.Rows[2][c];
  }
  return sums[0] + sums[1] + sums[2];
}

/// What all triangles read.
struct Lists
{
  const Edge* Edges;
  const EdgesOfFace* EdgesOf;
  const Inverse* Inverses;
  const double* Areas;
};

/// Row f of the product of M + D^T L D and x.
inline Block Multiply(const Lists& lists, const Block* x, Index f)
{
  Block y;
  for (int c = 0; c < 4; ++c)
  {
    y.Rows[0][c] = lists.Areas[f] * x[f].Rows[0][c];
    y.Rows[1][c] = Ridge * x[f].Rows[1][c];
    y.Rows[2][c] = Ridge * x[f].Rows[2][c];
  }
  for (const Index e : lists.EdgesOf[f])
  {
    if (e >= 0)
    {
      const Edge& edge = lists.Edges[e];
      Block v;
      AddDifferences(edge, 0, x[edge.Faces[0]], v);
      AddDifferences(edge, 1, x[edge.Faces[1]], v);
      AddForces(edge, edge.Faces[0] == f ? 0 : 1, v, y);
    }
  }
  return y;
}

SURFACEDIFFUSION_ANY_VECTORS void SplitEdges(const Edge* edges, const Block* state,
  const NormalVariationSettings& settings, Block* differences, Index begin, Index end)
{
  for (Index e = begin; e < end; ++e)
  {
    const Edge& edge = edges[e];
    Block v = differences[e];
    Shrink(edge, settings, v);
    AddDifferences(edge, 0, state[edge.Faces[0]], v);
    AddDifferences(edge, 1, state[edge.Faces[1]], v);
    differences[e] = v;
  }
}

/// Directions of descent from the residuals M d + D^T L (v - 2 b) - image, b the multipliers of v.
/// Returns their product with the residuals.
SURFACEDIFFUSION_ANY_VECTORS double FindDirections(const Lists& lists, const double* given,
  const Block* differences, const NormalVariationSettings& settings, const Block* image,
  Block* direction, Index begin, Index end)
{
  double sum = 0.0;
  for (Index f = begin; f < end; ++f)
  {
    Block r;
    for (int c = 0; c < 3; ++c)
    {
      r.Rows[0][c] = lists.Areas[f] * given[3 * f + c];
    }
    for (const Index e : lists.EdgesOf[f])
    {
      if (e >= 0)
      {
        const Edge& edge = lists.Edges[e];
        const Block& v = differences[e];
        Block force = v;
        Shrink(edge, settings, force);
        for (int k = 0; k < 3; ++k)
        {
          for (int c = 0; c < 4; ++c)
          {
            force.Rows[k][c] = v.Rows[k][c] - 2.0 * force.Rows[k][c];
          }
        }
        AddForces(edge, edge.Faces[0] == f ? 0 : 1, force, r);
      }
    }
    const Inverse& m = lists.Inverses[f];
    for (int k = 0; k < 3; ++k)
    {
      for (int c = 0; c < 4; ++c)
      {
        r.Rows[k][c] -= image[f].Rows[k][c];
      }
    }
    Block& d = direction[f];
    for (int c = 0; c < 4; ++c)
    {
      const double x = r.Rows[0][c], y = r.Rows[1][c], z = r.Rows[2][c];
      d.Rows[0][c] = m[0] * x + m[1] * y + m[2] * z;
      d.Rows[1][c] = m[1] * x + m[3] * y + m[4] * z;
      d.Rows[2][c] = m[2] * x + m[4] * y + m[5] * z;
    }
    sum += Product(d, r);
  }
  return sum;
}

/// Returns the sum of the products of x and y = A x.
SURFACEDIFFUSION_ANY_VECTORS double MultiplyAll(
  const Lists& lists, const Block* x, Block* y, Index begin, Index end)
{
  double sum = 0.0;
  for (Index f = begin; f < end; ++f)
  {
    y[f] = Multiply(lists, x, f);
    sum += Product(x[f], y[f]);
  }
  return sum;
}

/// The axes of a triangle: along the edge after one of its corners, and to the left of it.
struct Axes
{
  Axes(const TriangleMesh& mesh, const Points& points, const FaceGeometry& geometry, Index f,
    int corner)
  {
    const auto corners = mesh.TriangleVertices().row(f);
    this->First =
      (points.row(corners[(corner + 1) % 3]) - points.row(corners[corner])).normalized();
    this->Second = Eigen::RowVector3d(geometry.Normals.row(f)).cross(this->First);
  }
  Eigen::Vector2d operator()(const Eigen::RowVector3d& v) const
  {
    return { this->First.dot(v), this->Second.dot(v) };
  }

  Eigen::RowVector3d First, Second;
};

/// The corner of a triangle before its longest edge.
char CornerBeforeLongestEdge(const TriangleMesh& mesh, const Points& points, Index f)
{
  const auto corners = mesh.TriangleVertices().row(f);
  const auto square = [&](int a)
  { return (points.row(corners[(a + 1) % 3]) - points.row(corners[a])).squaredNorm(); };
  int longest = square(1) > square(0) ? 1 : 0;
  longest = square(2) > square(longest) ? 2 : longest;
  return static_cast<char>(longest);
}

/// The corner of triangle f opposite the edge that it shares with triangle g; -1: none.
int CornerOpposite(const Triangles& triangles, Index f, Index g)
{
  int opposite = -1;
  int shared = 0;
  for (int a = 0; a < 3; ++a)
  {
    const Index v = triangles(f, a);
    const bool isShared = v == triangles(g, 0) || v == triangles(g, 1) || v == triangles(g, 2);
    shared += isShared;
    opposite = isShared ? opposite : a;
  }
  return shared == 2 ? opposite : -1;
}

/// The only triangle on the other side of the edge of f opposite a corner; -1: none or several.
Index OnlyNeighbour(const FaceGraph& graph, Index f, int corner)
{
  Index found = -1;
  for (Offset k = graph.Across.Begin[f]; k < graph.Across.Begin[f + 1]; ++k)
  {
    const Index g = graph.Across.Entries[k];
    if (CornerOpposite(graph.Mesh.TriangleVertices(), f, g) == corner)
    {
      if (found >= 0)
      {
        return -1;
      }
      found = g;
    }
  }
  return found;
}

/// The sum over blocks of add(begin, end), in their order.
template <typename Add>
double SumOfBlocks(const ParallelFor& parallel, Index count, const Add& add)
{
  std::vector<double> sums(NumberOfBlocks(count));
  ForEachBlock(
    parallel, count, [&](Index block, Index begin, Index end) { sums[block] = add(begin, end); });
  double sum = 0.0;
  for (const double part : sums)
  {
    sum += part;
  }
  return sum;
}

} // namespace

class NormalVariation::Splitting
{
public:
  Splitting(const FaceGraph& graph, double unit, const ParallelFor& parallel)
    : Graph(graph)
    , Unit(unit)
    , Parallel(parallel)
    , EdgesOf(static_cast<std::size_t>(graph.NumberOfFaces()), { -1, -1, -1 })
    , Inverses(EdgesOf.size())
  {
    const Triangles& triangles = graph.Mesh.TriangleVertices();
    for (Index f = 0; f < graph.NumberOfFaces(); ++f)
    {
      for (int a = 0; a < 3; ++a)
      {
        const Index g = OnlyNeighbour(graph, f, a);
        if (g > f)
        {
          const int b = CornerOpposite(triangles, g, f);
          this->EdgesOf[f][a] = this->EdgesOf[g][b] = this->NumberOfEdges();
          Edge edge;
          edge.Faces = { f, g };
          this->Edges.push_back(edge);
        }
      }
    }
  }

  void SetPlaces(const Points& points, const FaceGeometry& geometry)
  {
    const TriangleMesh& mesh = this->Graph.Mesh;
    const double mean = geometry.Areas.sum() / std::max<Index>(1, this->Graph.NumberOfFaces());
    if (this->FirstCorners.empty())
    {
      this->FirstCorners.resize(this->EdgesOf.size());
      ForEach(this->Parallel, this->Graph.NumberOfFaces(),
        [&](Index f) { this->FirstCorners[f] = CornerBeforeLongestEdge(mesh, points, f); });
    }
    this->Areas = (geometry.Areas / mean).cwiseMax(SmallestArea);
    ForEach(this->Parallel, this->NumberOfEdges(),
      [&](Index e)
      {
        Edge& edge = this->Edges[e];
        const Index f = edge.Faces[0];
        const int a = CornerOpposite(mesh.TriangleVertices(), f, edge.Faces[1]);
        const Eigen::RowVector3d first = points.row(mesh.TriangleVertices()(f, (a + 1) % 3));
        const Eigen::RowVector3d last = points.row(mesh.TriangleVertices()(f, (a + 2) % 3));
        edge.Length = (last - first).norm() / this->Unit;
        for (int side = 0; side < 2; ++side)
        {
          const Index t = edge.Faces[side];
          const Axes axes(mesh, points, geometry, t, this->FirstCorners[t]);
          const Eigen::Vector2d middle =
            axes(0.5 * (first + last) - geometry.Centroids.row(t)) / this->Unit;
          const Eigen::Vector2d along = axes(last - first).normalized();
          const double out = along[0] * middle[1] - along[1] * middle[0];
          Eigen::Map<Eigen::Vector2d>(edge.Middle[side]) = middle;
          Eigen::Map<Eigen::Vector2d>(edge.Along[side]) = along;
          edge.Side[side] = out > 0.0 ? 1.0F : -1.0F;
        }
      });
    ForEach(this->Parallel, this->Graph.NumberOfFaces(), [&](Index f) { this->SetInverse(f); });
  }

  void SetWeights(const Points& normals, double range)
  {
    ForEach(this->Parallel, this->NumberOfEdges(),
      [&](Index e)
      {
        Edge& edge = this->Edges[e];
        const double square =
          (normals.row(edge.Faces[0]) - normals.row(edge.Faces[1])).squaredNorm();
        edge.Weight = 1.0 / (1.0 + square / (range * range));
      });
  }

  Points Minimize(
    const Points& given, const NormalVariationSettings& settings, const ProgressMonitor& progress)
  {
    const Index count = this->Graph.NumberOfFaces();
    this->Settings = settings;
    this->Given = given;
    if (this->State.empty())
    {
      for (std::vector<Block>* const list : { &this->State, &this->Image, &this->Direction })
      {
        list->assign(this->EdgesOf.size(), Block());
      }
      this->Differences.assign(this->Edges.size(), Block());
      for (Index f = 0; f < count; ++f)
      {
        std::copy_n(given.data() + static_cast<std::ptrdiff_t>(f) * 3, 3, this->State[f].Rows[0]);
      }
    }
    const Lists lists = this->GetLists();
    ForEachBlock(this->Parallel, count,
      [&](Index, Index begin, Index end)
      { MultiplyAll(lists, this->State.data(), this->Image.data(), begin, end); });
    std::vector<Block> product(this->EdgesOf.size());
    for (int iteration = 0; iteration < settings.Iterations; ++iteration)
    {
      progress.Report(static_cast<double>(iteration) / settings.Iterations);
      this->Iterate(lists, product);
    }
    Points normals(count, 3);
    for (Index f = 0; f < count; ++f)
    {
      std::copy_n(this->State[f].Rows[0], 3, normals.data() + static_cast<std::ptrdiff_t>(f) * 3);
    }
    return normals;
  }

  Energy MeasureEnergy() const
  {
    const NormalVariationSettings& settings = this->Settings;
    double energy = 0.0;
    for (const Edge& edge : this->Edges)
    {
      Block v;
      AddDifferences(edge, 0, this->State[edge.Faces[0]], v);
      AddDifferences(edge, 1, this->State[edge.Faces[1]], v);
      energy += edge.Length * edge.Weight *
        (settings.First * std::sqrt(SquareOf(v.Rows[0])) +
          settings.Second * std::sqrt(SquareOf(v.Rows[1]) + SquareOf(v.Rows[2])));
    }
    double dual = 0.0;
    for (Index f = 0; f < this->Graph.NumberOfFaces(); ++f)
    {
      Block force; // D^T L of the multipliers
      for (const Index e : this->EdgesOf[f])
      {
        if (e >= 0)
        {
          const Edge& edge = this->Edges[e];
          Block multipliers = this->Differences[e];
          Shrink(edge, settings, multipliers);
          AddForces(edge, edge.Faces[0] == f ? 0 : 1, multipliers, force);
        }
      }
      const double area = this->Areas[f];
      for (int c = 0; c < 3; ++c)
      {
        const double d = this->Given(f, c);
        const auto square = [](double x) { return x * x; };
        const auto& x = this->State[f].Rows;
        energy +=
          0.5 * area * square(x[0][c] - d) + 0.5 * Ridge * (square(x[1][c]) + square(x[2][c]));
        dual += force.Rows[0][c] * (d - 0.5 * force.Rows[0][c] / area) -
          0.5 * (square(force.Rows[1][c]) + square(force.Rows[2][c])) / Ridge;
      }
    }
    return { energy, energy - dual };
  }

private:
  Index NumberOfEdges() const { return static_cast<Index>(this->Edges.size()); }

  Lists GetLists() const
  {
    return { this->Edges.data(), this->EdgesOf.data(), this->Inverses.data(), this->Areas.data() };
  }

  /// The inverse of the diagonal block of the system.
  void SetInverse(Index f)
  {
    Eigen::Matrix3d diagonal = Eigen::Vector3d(this->Areas[f], Ridge, Ridge).asDiagonal();
    for (const Index e : this->EdgesOf[f])
    {
      if (e >= 0)
      {
        const Edge& edge = this->Edges[e];
        const int side = edge.Faces[0] == f ? 0 : 1;
        Block unit, differences, column;
        for (int k = 0; k < 3; ++k)
        {
          unit.Rows[k][k] = 1.0;
        }
        AddDifferences(edge, side, unit, differences);
        AddForces(edge, side, differences, column);
        for (int k = 0; k < 3; ++k)
        {
          for (int c = 0; c < 3; ++c)
          {
            diagonal(k, c) += column.Rows[k][c];
          }
        }
      }
    }
    const Eigen::Matrix3d m = diagonal.inverse();
    this->Inverses[f] = { m(0, 0), m(0, 1), m(0, 2), m(1, 1), m(1, 2), m(2, 2) };
  }

  /// v = D x + b, and one step of descent of 1/2 x (M + D^T L D) x - (M d + D^T L (v - 2 b)) x.
  void Iterate(const Lists& lists, std::vector<Block>& product)
  {
    const Index count = this->Graph.NumberOfFaces();
    ForEachBlock(this->Parallel, this->NumberOfEdges(),
      [&](Index, Index begin, Index end)
      {
        SplitEdges(
          lists.Edges, this->State.data(), this->Settings, this->Differences.data(), begin, end);
      });
    const double descent = SumOfBlocks(this->Parallel, count,
      [&](Index begin, Index end)
      {
        return FindDirections(lists, this->Given.data(), this->Differences.data(), this->Settings,
          this->Image.data(), this->Direction.data(), begin, end);
      });
    const double curvature = SumOfBlocks(this->Parallel, count,
      [&](Index begin, Index end)
      { return MultiplyAll(lists, this->Direction.data(), product.data(), begin, end); });
    if (!(curvature > 0.0))
    {
      return;
    }
    const double length = descent / curvature;
    ForEach(this->Parallel, count,
      [&](Index f)
      {
        for (int k = 0; k < 3; ++k)
        {
          for (int c = 0; c < 4; ++c)
          {
            this->State[f].Rows[k][c] += length * this->Direction[f].Rows[k][c];
            this->Image[f].Rows[k][c] += length * product[f].Rows[k][c];
          }
        }
      });
  }

  const FaceGraph& Graph;
  const double Unit;
  const ParallelFor& Parallel;
  NormalVariationSettings Settings;
  std::vector<Edge> Edges;
  std::vector<EdgesOfFace> EdgesOf;
  std::vector<Inverse> Inverses;
  /// Of the axes of the triangles: slopes keep their components while points move.
  std::vector<char> FirstCorners;
  Vector Areas; ///< over their mean
  Points Given;
  std::vector<Block> State; ///< (n, u); no entries before the first Minimize()
  std::vector<Block> Image; ///< the product of the matrix of the system and State
  std::vector<Block> Direction;
  std::vector<Block> Differences; ///< per edge: v
};

NormalVariation::NormalVariation(const FaceGraph& graph, double unit, const ParallelFor& parallel)
  : Work(std::make_unique<Splitting>(graph, unit, parallel))
{
}

NormalVariation::NormalVariation(NormalVariation&& other) noexcept = default;

NormalVariation::~NormalVariation() = default;

void NormalVariation::SetPlaces(const Points& points, const FaceGeometry& geometry)
{
  this->Work->SetPlaces(points, geometry);
}

void NormalVariation::SetWeights(const Points& normals, double range)
{
  this->Work->SetWeights(normals, range);
}

Points NormalVariation::Minimize(
  const Points& given, const NormalVariationSettings& settings, const ProgressMonitor& progress)
{
  return this->Work->Minimize(given, settings, progress);
}

NormalVariation::Energy NormalVariation::MeasureEnergy() const
{
  return this->Work->MeasureEnergy();
}

} // namespace SurfaceDiffusion
