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
constexpr float Ridge = 1e-6F;
constexpr double SmallestArea = 1e-4; ///< over the mean
/// Of the descent. The eigenvalues of the preconditioned system are at most 2, since each edge has
/// two triangles, and the splitting converges for lengths below 2/3 (B. He, F. Ma, X. Yuan,
/// Optimally Linearizing the Alternating Direction Method of Multipliers, COAP 75, 2020).
constexpr float StepLength = 0.66F;

using Block = VariationBlock;
using Blocks = std::vector<VariationBlock>;
using Edge = VariationEdge;
using Inverse = std::array<float, 6>; ///< a symmetric matrix: xx, xy, xz, yy, yz, zz

/// What all triangles read.
struct Lists
{
  const Edge* Edges;
  const VariationEdges::OfFace* EdgesOf;
  const Inverse* Inverses;
  const float* Areas;
};

/// v + D x at an edge.
inline Block DifferencesAt(const Edge& edge, const Block* x, Block v = Block())
{
  AddDifferences(edge, 0, x[edge.Faces[0]], v);
  AddDifferences(edge, 1, x[edge.Faces[1]], v);
  return v;
}

/// b, the multipliers, become those of v = D x + b.
SURFACEDIFFUSION_ANY_VECTORS void UpdateMultipliers(const Edge* edges, const Block* state,
  const NormalVariationSettings& settings, Block* multipliers, Index begin, Index end)
{
  const auto first = static_cast<float>(settings.First);
  const auto second = static_cast<float>(settings.Second);
  for (Index e = begin; e < end; ++e)
  {
    Block v = DifferencesAt(edges[e], state, multipliers[e]);
    Shrink(edges[e], first, second, v);
    multipliers[e] = v;
  }
}

/// Row f of D^T L b.
inline Block ForceOn(const Lists& lists, const Block* multipliers, Index f)
{
  Block force;
  for (const Index e : lists.EdgesOf[f])
  {
    if (e >= 0)
    {
      const Edge& edge = lists.Edges[e];
      AddForces(edge, edge.Faces[0] == f ? 0 : 1, multipliers[e], force);
    }
  }
  return force;
}

SURFACEDIFFUSION_ANY_VECTORS void FindForces(
  const Lists& lists, const Block* multipliers, Block* forces, Index begin, Index end)
{
  for (Index f = begin; f < end; ++f)
  {
    forces[f] = ForceOn(lists, multipliers, f);
  }
}

/// Move the state along P (M (d - x) + D^T L (b' - 2 b)), P the preconditioner and b' the
/// multipliers before the last ones, b. forces: those of b', and after the call of b.
SURFACEDIFFUSION_ANY_VECTORS void Descend(const Lists& lists, const VariationRow* given,
  const Block* multipliers, Block* forces, Block* state, Index begin, Index end)
{
  for (Index f = begin; f < end; ++f)
  {
    const Block force = ForceOn(lists, multipliers, f);
    Block& x = state[f];
    Block r;
    r.Rows[0] =
      lists.Areas[f] * (given[f] - x.Rows[0]) + (forces[f].Rows[0] - 2.0F * force.Rows[0]);
    r.Rows[1] = -Ridge * x.Rows[1] + (forces[f].Rows[1] - 2.0F * force.Rows[1]);
    r.Rows[2] = -Ridge * x.Rows[2] + (forces[f].Rows[2] - 2.0F * force.Rows[2]);
    forces[f] = force;
    const Inverse& m = lists.Inverses[f];
    x.Rows[0] += StepLength * (m[0] * r.Rows[0] + m[1] * r.Rows[1] + m[2] * r.Rows[2]);
    x.Rows[1] += StepLength * (m[1] * r.Rows[0] + m[3] * r.Rows[1] + m[4] * r.Rows[2]);
    x.Rows[2] += StepLength * (m[2] * r.Rows[0] + m[4] * r.Rows[1] + m[5] * r.Rows[2]);
  }
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
    this->Areas = (geometry.Areas / mean).cwiseMax(SmallestArea).cast<float>();
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
    this->SetGiven(given);
    const Lists lists = this->GetLists();
    ForEach(this->Parallel, this->Edges.Size(),
      [&](Index e) { this->ShrinkAt(e, this->Multipliers[e]); });
    ForEachBlock(this->Parallel, count,
      [&](Index, Index begin, Index end)
      { FindForces(lists, this->Multipliers.data(), this->Forces.data(), begin, end); });
    for (int iteration = 0; iteration < settings.Iterations; ++iteration)
    {
      progress.Report(static_cast<double>(iteration) / settings.Iterations);
      this->Iterate(lists);
    }
    Points normals(count, 3);
    ForEach(this->Parallel, count,
      [&](Index f)
      { normals.row(f) = this->State[f].Rows[0].head<3>().transpose().cast<double>(); });
    return normals;
  }

  Energy MeasureEnergy(const Points& given) const
  {
    const NormalVariationSettings& settings = this->Settings;
    double energy = 0.0;
    Blocks multipliers = this->Multipliers;
    for (Index e = 0; e < this->Edges.Size(); ++e)
    {
      const Edge& edge = this->Edges[e];
      const Block v = DifferencesAt(edge, this->State.data());
      energy += edge.Length * edge.Weight *
        (settings.First * std::sqrt(SquareOf(v.Rows[0])) +
          settings.Second * std::sqrt(SquareOf(v.Rows[1]) + SquareOf(v.Rows[2])));
      this->ShrinkAt(e, multipliers[e]);
    }
    double dual = 0.0;
    const Lists lists = this->GetLists();
    for (Index f = 0; f < this->Graph.NumberOfFaces(); ++f)
    {
      const Block force = ForceOn(lists, multipliers.data(), f);
      const Block& x = this->State[f];
      const double area = this->Areas[f];
      const VariationRow d = RowOf(given, f);
      energy += 0.5 * area * SquareOf(x.Rows[0] - d) +
        0.5 * Ridge * (SquareOf(x.Rows[1]) + SquareOf(x.Rows[2]));
      dual += (force.Rows[0] * d).sum() - 0.5 * SquareOf(force.Rows[0]) / area -
        0.5 * (SquareOf(force.Rows[1]) + SquareOf(force.Rows[2])) / Ridge;
    }
    return { energy, energy - dual };
  }

private:
  static VariationRow RowOf(const Points& given, Index f)
  {
    VariationRow row = VariationRow::Zero();
    row.head<3>() = given.row(f).transpose().array().cast<float>();
    return row;
  }

  static double SquareOf(const VariationRow& row) { return row.square().sum(); }

  void ShrinkAt(Index e, Block& multipliers) const
  {
    Shrink(this->Edges[e], static_cast<float>(this->Settings.First),
      static_cast<float>(this->Settings.Second), multipliers);
  }

  /// The first time they are the state, without slopes.
  void SetGiven(const Points& given)
  {
    const auto count = static_cast<std::size_t>(this->Graph.NumberOfFaces());
    const bool isFirst = this->State.empty();
    if (isFirst)
    {
      this->Forces.resize(count);
      this->Given.resize(count);
      this->Multipliers.resize(static_cast<std::size_t>(this->Edges.Size()));
      this->State.resize(count); // last: with it, this is the second time
    }
    ForEach(this->Parallel, this->Graph.NumberOfFaces(),
      [&](Index f)
      {
        this->Given[f] = RowOf(given, f);
        if (isFirst)
        {
          this->State[f].Rows[0] = this->Given[f];
        }
      });
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
          unit.Rows[k][k] = 1.0F;
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
  void Iterate(const Lists& lists)
  {
    const Index count = this->Graph.NumberOfFaces();
    ForEachBlock(this->Parallel, this->Edges.Size(),
      [&](Index, Index begin, Index end)
      {
        UpdateMultipliers(
          lists.Edges, this->State.data(), this->Settings, this->Multipliers.data(), begin, end);
      });
    ForEachBlock(this->Parallel, count,
      [&](Index, Index begin, Index end)
      {
        Descend(lists, this->Given.data(), this->Multipliers.data(), this->Forces.data(),
          this->State.data(), begin, end);
      });
  }

  const FaceGraph& Graph;
  const ParallelFor& Parallel;
  NormalVariationSettings Settings;
  VariationEdges Edges;
  std::vector<Inverse> Inverses;
  Eigen::VectorXf Areas; ///< over their mean
  Blocks State; ///< (n, u); no entries before the first Minimize()
  Blocks Forces; ///< D^T L b
  std::vector<VariationRow> Given;
  Blocks Multipliers; ///< per edge: b
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
