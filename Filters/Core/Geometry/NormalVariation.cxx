// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/NormalVariation.h"

#include "Core/Foundation/Columns.h"
#include "Core/Geometry/VariationEdges.h"

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

using Block = VariationBlock;
using Edge = VariationEdge;
/// A symmetric matrix: xx, xy, xz, yy, yz, zz. As the directions of descent, in single precision: the
/// length of a step is found for the direction that is stored.
using Inverse = std::array<float, 6>;

/// What all triangles read.
struct Lists
{
  const Edge* Edges;
  const VariationEdges::OfFace* EdgesOf;
  const Inverse* Inverses;
  const double* Areas;
};

/// b, the multipliers, become those of v = D x + b.
SURFACEDIFFUSION_ANY_VECTORS void UpdateMultipliers(const Edge* edges, const double* state,
  const NormalVariationSettings& settings, double* multipliers, Index begin, Index end)
{
  for (Index e = begin; e < end; ++e)
  {
    const Edge& edge = edges[e];
    Block v = LoadBlock(multipliers, e);
    AddDifferences(edge, 0, LoadBlock(state, edge.Faces[0]), v);
    AddDifferences(edge, 1, LoadBlock(state, edge.Faces[1]), v);
    Shrink(edge, settings.First, settings.Second, v);
    StoreBlock(multipliers, e, v);
  }
}

/// Row f of D^T L b.
inline Block ForceOn(const Lists& lists, const double* multipliers, Index f)
{
  Block force;
  for (const Index e : lists.EdgesOf[f])
  {
    if (e >= 0)
    {
      const Edge& edge = lists.Edges[e];
      AddForces(edge, edge.Faces[0] == f ? 0 : 1, LoadBlock(multipliers, e), force);
    }
  }
  return force;
}

SURFACEDIFFUSION_ANY_VECTORS void FindForces(
  const Lists& lists, const double* multipliers, double* forces, Index begin, Index end)
{
  for (Index f = begin; f < end; ++f)
  {
    StoreBlock(forces, f, ForceOn(lists, multipliers, f));
  }
}

/// Directions of descent from the residuals M (d - x) + D^T L (b' - 2 b), b' the multipliers before
/// the last ones, b. forces: those of b', and after the call of b. Returns the product of the
/// directions with the residuals, and adds the part of the areas to the curvature.
SURFACEDIFFUSION_ANY_VECTORS double FindDirections(const Lists& lists, const double* given,
  const double* state, const double* multipliers, double* forces, float* direction,
  double& curvature, Index begin, Index end)
{
  double sum = 0.0;
  for (Index f = begin; f < end; ++f)
  {
    const Block force = ForceOn(lists, multipliers, f);
    const Block last = LoadBlock(forces, f);
    const Block x = LoadBlock(state, f);
    const double area = lists.Areas[f];
    double d[4] = {};
    std::copy_n(given + 3 * static_cast<std::ptrdiff_t>(f), 3, d);
    Block r;
    for (int c = 0; c < 4; ++c)
    {
      r.Rows[0][c] = area * (d[c] - x.Rows[0][c]);
      r.Rows[1][c] = -Ridge * x.Rows[1][c];
      r.Rows[2][c] = -Ridge * x.Rows[2][c];
    }
    for (int k = 0; k < 3; ++k)
    {
      for (int c = 0; c < 4; ++c)
      {
        r.Rows[k][c] += last.Rows[k][c] - 2.0 * force.Rows[k][c];
      }
    }
    StoreBlock(forces, f, force);
    const Inverse& m = lists.Inverses[f];
    Block p;
    for (int c = 0; c < 4; ++c)
    {
      p.Rows[0][c] = m[0] * r.Rows[0][c] + m[1] * r.Rows[1][c] + m[2] * r.Rows[2][c];
      p.Rows[1][c] = m[1] * r.Rows[0][c] + m[3] * r.Rows[1][c] + m[4] * r.Rows[2][c];
      p.Rows[2][c] = m[2] * r.Rows[0][c] + m[4] * r.Rows[1][c] + m[5] * r.Rows[2][c];
    }
    StoreBlock(direction, f, p);
    p = LoadBlock(direction, f);
    sum += Product(p, r);
    curvature += area * SquareOf(p.Rows[0]) + Ridge * (SquareOf(p.Rows[1]) + SquareOf(p.Rows[2]));
  }
  return sum;
}

/// The part of the edges in the curvature.
SURFACEDIFFUSION_ANY_VECTORS double SumSquaresOfDifferences(
  const Edge* edges, const float* direction, Index begin, Index end)
{
  double sum = 0.0;
  for (Index e = begin; e < end; ++e)
  {
    const Edge& edge = edges[e];
    Block v;
    AddDifferences(edge, 0, LoadBlock(direction, edge.Faces[0]), v);
    AddDifferences(edge, 1, LoadBlock(direction, edge.Faces[1]), v);
    sum += edge.Length * Product(v, v);
  }
  return sum;
}

/// The sum over blocks of add(block, begin, end), in their order.
template <typename Add>
double SumOfBlocks(const ParallelFor& parallel, Index count, const Add& add)
{
  std::vector<double> sums(NumberOfBlocks(count));
  ForEachBlock(parallel, count,
    [&](Index block, Index begin, Index end) { sums[block] = add(block, begin, end); });
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
    , Parallel(parallel)
    , Edges(graph, unit)
    , Inverses(static_cast<std::size_t>(graph.NumberOfFaces()))
  {
  }

  void SetPlaces(const Points& points, const FaceGeometry& geometry)
  {
    const double mean = geometry.Areas.sum() / std::max<Index>(1, this->Graph.NumberOfFaces());
    this->Areas = (geometry.Areas / mean).cwiseMax(SmallestArea);
    this->Edges.SetPlaces(points, geometry, this->Parallel);
    ForEach(this->Parallel, this->Graph.NumberOfFaces(), [&](Index f) { this->SetInverse(f); });
  }

  void SetWeights(const Points& normals, double range)
  {
    this->Edges.SetWeights(normals, range, this->Parallel);
  }

  Points Minimize(
    const Points& given, const NormalVariationSettings& settings, const ProgressMonitor& progress)
  {
    const Index count = this->Graph.NumberOfFaces();
    this->Settings = settings;
    if (this->State.empty())
    {
      this->Start(given);
    }
    const Lists lists = this->GetLists();
    ForEach(this->Parallel, this->Edges.Size(),
      [&](Index e)
      {
        Block b = LoadBlock(this->Multipliers.data(), e);
        Shrink(this->Edges[e], settings.First, settings.Second, b);
        StoreBlock(this->Multipliers.data(), e, b);
      });
    ForEachBlock(this->Parallel, count,
      [&](Index, Index begin, Index end)
      { FindForces(lists, this->Multipliers.data(), this->Forces.data(), begin, end); });
    for (int iteration = 0; iteration < settings.Iterations; ++iteration)
    {
      progress.Report(static_cast<double>(iteration) / settings.Iterations);
      this->Iterate(lists, given);
    }
    Points normals(count, 3);
    for (Index f = 0; f < count; ++f)
    {
      for (int c = 0; c < 3; ++c)
      {
        normals(f, c) = this->State[PlaceOf(f) + c];
      }
    }
    return normals;
  }

  Energy MeasureEnergy(const Points& given) const
  {
    const NormalVariationSettings& settings = this->Settings;
    double energy = 0.0;
    std::vector<double> multipliers = this->Multipliers;
    for (Index e = 0; e < this->Edges.Size(); ++e)
    {
      const Edge& edge = this->Edges[e];
      Block v;
      AddDifferences(edge, 0, LoadBlock(this->State.data(), edge.Faces[0]), v);
      AddDifferences(edge, 1, LoadBlock(this->State.data(), edge.Faces[1]), v);
      energy += edge.Length * edge.Weight *
        (settings.First * std::sqrt(SquareOf(v.Rows[0])) +
          settings.Second * std::sqrt(SquareOf(v.Rows[1]) + SquareOf(v.Rows[2])));
      Block b = LoadBlock(multipliers.data(), e);
      Shrink(edge, settings.First, settings.Second, b);
      StoreBlock(multipliers.data(), e, b);
    }
    double dual = 0.0;
    const Lists lists = this->GetLists();
    for (Index f = 0; f < this->Graph.NumberOfFaces(); ++f)
    {
      const Block force = ForceOn(lists, multipliers.data(), f);
      const Block state = LoadBlock(this->State.data(), f);
      const double area = this->Areas[f];
      for (int c = 0; c < 3; ++c)
      {
        const double d = given(f, c);
        const auto square = [](double x) { return x * x; };
        const auto& x = state.Rows;
        energy +=
          0.5 * area * square(x[0][c] - d) + 0.5 * Ridge * (square(x[1][c]) + square(x[2][c]));
        dual += force.Rows[0][c] * (d - 0.5 * force.Rows[0][c] / area) -
          0.5 * (square(force.Rows[1][c]) + square(force.Rows[2][c])) / Ridge;
      }
    }
    return { energy, energy - dual };
  }

private:
  /// Of block i in a list.
  static std::size_t PlaceOf(Index i) { return 9 * static_cast<std::size_t>(i); }

  /// The given normals without slopes.
  void Start(const Points& given)
  {
    const Index count = this->Graph.NumberOfFaces();
    this->State.assign(PlaceOf(count), 0.0);
    this->Forces.assign(PlaceOf(count), 0.0);
    this->Direction.assign(PlaceOf(count), 0.0F);
    this->Multipliers.assign(PlaceOf(this->Edges.Size()), 0.0);
    for (Index f = 0; f < count; ++f)
    {
      for (int c = 0; c < 3; ++c)
      {
        this->State[PlaceOf(f) + c] = given(f, c);
      }
    }
  }

  Lists GetLists() const
  {
    return { this->Edges.Data(), this->Edges.OfFaces().data(), this->Inverses.data(),
      this->Areas.data() };
  }

  /// The inverse of the diagonal block of the system.
  void SetInverse(Index f)
  {
    Eigen::Matrix3d diagonal = Eigen::Vector3d(this->Areas[f], Ridge, Ridge).asDiagonal();
    for (const Index e : this->Edges.OfFaces()[f])
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
    const Eigen::Matrix3f m = diagonal.inverse().cast<float>();
    this->Inverses[f] = { m(0, 0), m(0, 1), m(0, 2), m(1, 1), m(1, 2), m(2, 2) };
  }

  /// The multipliers of v = D x + b, and one step of descent of
  /// 1/2 x (M + D^T L D) x - (M d + D^T L (v - 2 b)) x.
  void Iterate(const Lists& lists, const Points& given)
  {
    const Index count = this->Graph.NumberOfFaces();
    ForEachBlock(this->Parallel, this->Edges.Size(),
      [&](Index, Index begin, Index end)
      {
        UpdateMultipliers(
          lists.Edges, this->State.data(), this->Settings, this->Multipliers.data(), begin, end);
      });
    std::vector<double> curvatures(NumberOfBlocks(count));
    const double descent = SumOfBlocks(this->Parallel, count,
      [&](Index block, Index begin, Index end)
      {
        return FindDirections(lists, given.data(), this->State.data(), this->Multipliers.data(),
          this->Forces.data(), this->Direction.data(), curvatures[block], begin, end);
      });
    double curvature = SumOfBlocks(this->Parallel, this->Edges.Size(),
      [&](Index, Index begin, Index end)
      { return SumSquaresOfDifferences(lists.Edges, this->Direction.data(), begin, end); });
    for (const double part : curvatures)
    {
      curvature += part;
    }
    if (!(curvature > 0.0))
    {
      return;
    }
    const double length = descent / curvature;
    ForEachBlock(this->Parallel, count,
      [&](Index, Index begin, Index end)
      {
        for (std::size_t k = PlaceOf(begin); k < PlaceOf(end); ++k)
        {
          this->State[k] += length * static_cast<double>(this->Direction[k]);
        }
      });
  }

  const FaceGraph& Graph;
  const ParallelFor& Parallel;
  NormalVariationSettings Settings;
  VariationEdges Edges;
  std::vector<Inverse> Inverses;
  Vector Areas; ///< over their mean
  // Lists of blocks, see LoadBlock().
  std::vector<double> State; ///< (n, u); no entries before the first Minimize()
  std::vector<double> Forces; ///< D^T L b
  std::vector<float> Direction;
  std::vector<double> Multipliers; ///< per edge: b
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

NormalVariation::Energy NormalVariation::MeasureEnergy(const Points& given) const
{
  return this->Work->MeasureEnergy(given);
}

} // namespace SurfaceDiffusion
