// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/TotalVariation/CrouzeixRaviart.h"

#include "Core/Operators/CotanWeights.h"
#include "Core/Operators/SparsePattern.h"
#include "Core/Solvers/LinearSolver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

constexpr double JumpOnset = 2.5; ///< in mean differences
constexpr double HalfWidth = 0.005; ///< of the smoothed jump in which edges take values between

/// Each vertex takes the area-weighted mean of its triangles' means: keeps sum A x.
void Spread(const TriangleMesh& mesh, Values& x, Values& means, const ParallelFor& parallel)
{
  const Triangles& vertices = mesh.TriangleVertices();
  ForEach(parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      means.row(t) = (x.row(vertices(t, 0)) + x.row(vertices(t, 1)) + x.row(vertices(t, 2))) *
        (mesh.Shapes()[t].Area() / 9.0);
    });
  ForEach(parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      x.row(i).setZero();
      for (Index c = mesh.VertexCornersBegin()[i]; c < mesh.VertexCornersBegin()[i + 1]; ++c)
      {
        x.row(i) += means.row(mesh.VertexCorners()[c] / 3);
      }
      x.row(i) /= mesh.ThirdOfTriangles(i);
    });
}

/// Spreads x over about 2 edge lengths: keeps sum A x.
void SpreadFar(const TriangleMesh& mesh, Values& x, Values& means, const ParallelFor& parallel)
{
  for (int sweep = 0; sweep < 8; ++sweep)
  {
    Spread(mesh, x, means, parallel);
  }
}

/// u smoothed over two to three rings: (1/4 + K) s = u/4, which is (8) with time step 3.5 h^2 on
/// equilateral triangles of any size. Less leaves the jump ragged, so that its perimeter differs
/// from one turn of the mesh to another.
Values Smoothed(const Assembler& operators, const Values& u, const ParallelFor& parallel)
{
  constexpr double weight = 0.25;
  const Vector diagonal = Vector::Constant(u.rows(), weight);
  SparseMatrix matrix;
  operators.TakePattern(matrix, parallel);
  operators.Fill(
    matrix, diagonal, 1.0, CotanWeights(operators.Mesh(), parallel), nullptr, parallel);
  const auto solver = MakeConjugateGradientSolver(parallel);
  solver->SetLimits({ 1e-8, 200 });
  solver->SetMatrix(matrix);
  Values smooth = u;
  solver->Solve(weight * u, smooth);
  return smooth;
}

/// The mean of |u_i - u_j| over the edges about 2 edge lengths around each vertex.
Values MeanDifference(const TriangleMesh& mesh, const Values& u, const ParallelFor& parallel)
{
  const Triangles& vertices = mesh.TriangleVertices();
  Values means(mesh.NumberOfTriangles(), u.cols());
  Values differences(u.rows(), u.cols());
  ForEach(parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      differences.row(i).setZero();
      const double third = mesh.ThirdOfTriangles(i);
      for (Index c = mesh.VertexCornersBegin()[i]; c < mesh.VertexCornersBegin()[i + 1]; ++c)
      {
        const Index t = mesh.VertexCorners()[c] / 3;
        const double share = mesh.Shapes()[t].Area() / (9.0 * third);
        for (int a = 0; a < 3; ++a)
        {
          differences.row(i) +=
            share * (u.row(vertices(t, a)) - u.row(vertices(t, (a + 1) % 3))).cwiseAbs();
        }
      }
    });
  SpreadFar(mesh, differences, means, parallel);
  return differences;
}

/// An edge at a jump.
struct Jump
{
  Index Edge;
  double Side; ///< the smoothed data at its midpoint above the mean of its ends, in differences
  double Height; ///< the part of the difference of its ends that it does not average
};

/// The level of Side above which edges take the value of their higher end. It is near 0, where the
/// smoothed jump is, and such that sum A w is as near to that of the means as possible: otherwise
/// the parts between jumps would have other areas than the data give them. Edges whose sides agree
/// stay together.
double FindBalancedLevel(std::vector<Jump>& jumps, const Vector& areas)
{
  constexpr double farthest = 0.1;
  constexpr double same = 1e-6;
  std::sort(jumps.begin(), jumps.end(),
    [](const Jump& a, const Jump& b)
    { return a.Side < b.Side || (a.Side == b.Side && a.Edge < b.Edge); });
  double excess = 0.0; // of sum A w over that of the means, if all edges from here on are high
  for (const Jump& jump : jumps)
  {
    excess += 0.5 * areas[jump.Edge] * jump.Height;
  }
  double level = 0.0;
  double least = std::numeric_limits<double>::infinity();
  double last = -farthest;
  for (const Jump& jump : jumps)
  {
    const double side = std::min(jump.Side, farthest);
    if (side > last + same && std::abs(excess) < least)
    {
      level = 0.5 * (last + side);
      least = std::abs(excess);
    }
    last = std::max(last, side);
    excess -= areas[jump.Edge] * jump.Height;
  }
  if (farthest > last + same && std::abs(excess) < least)
  {
    level = 0.5 * (last + farthest);
  }
  return level;
}

struct Bounds
{
  double Low, High;
};

/// The least and largest value of column k at the edges of the triangles around vertex i.
Bounds BoundsAround(
  const TriangleMesh& mesh, const MedialMesh& edges, const Values& w, Index i, Eigen::Index k)
{
  const Triangles& corners = edges.Edges()->TriangleVertices();
  constexpr double none = std::numeric_limits<double>::infinity();
  Bounds bounds = { none, -none };
  for (Index c = mesh.VertexCornersBegin()[i]; c < mesh.VertexCornersBegin()[i + 1]; ++c)
  {
    for (int a = 0; a < 3; ++a)
    {
      const double value = w(corners(mesh.VertexCorners()[c] / 3, a), k);
      bounds.Low = std::min(bounds.Low, value);
      bounds.High = std::max(bounds.High, value);
    }
  }
  return bounds;
}

} // namespace

Values EdgesFromVertices(
  const Assembler& operators, const MedialMesh& edges, const Values& u, const ParallelFor& parallel)
{
  const TriangleMesh& mesh = operators.Mesh();
  const TriangleMesh& medial = *edges.Edges();
  const Values smooth = Smoothed(operators, u, parallel);
  const Values typical = MeanDifference(mesh, u, parallel);
  Values w(medial.NumberOfVertices(), u.cols());
  std::vector<Jump> jumps;
  for (Eigen::Index k = 0; k < u.cols(); ++k)
  {
    for (Index c = 0; c < medial.NumberOfComponents(); ++c)
    {
      jumps.clear();
      for (Index e = medial.ComponentsBegin()[c]; e < medial.ComponentsBegin()[c + 1]; ++e)
      {
        const Index i = edges.Ends()[e][0];
        const Index j = edges.Ends()[e][1];
        const double middle = 0.5 * u(i, k) + 0.5 * u(j, k);
        const double difference = std::abs(u(i, k) - u(j, k));
        const double excess = 2.0 * difference / (typical(i, k) + typical(j, k)) - JumpOnset;
        w(e, k) = middle;
        if (excess > 0.0)
        {
          const double side = (0.5 * smooth(i, k) + 0.5 * smooth(j, k) - middle) / difference;
          jumps.push_back({ e, side, std::min(1.0, excess) * difference });
        }
      }
      const double level = FindBalancedLevel(jumps, medial.ControlAreas());
      for (const Jump& jump : jumps)
      {
        const double share = (jump.Side - level) / HalfWidth;
        w(jump.Edge, k) += 0.5 * std::max(-1.0, std::min(1.0, share)) * jump.Height;
      }
    }
  }
  return w;
}

void VerticesFromEdges(const TriangleMesh& mesh, const MedialMesh& edges, const Values& w,
  Values& u, const ParallelFor& parallel)
{
  const Triangles& corners = edges.Edges()->TriangleVertices();
  ForEach(parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      u.row(i).setZero();
      for (Index c = mesh.VertexCornersBegin()[i]; c < mesh.VertexCornersBegin()[i + 1]; ++c)
      {
        const Index t = mesh.VertexCorners()[c] / 3;
        const int a = mesh.VertexCorners()[c] % 3;
        u.row(i) += (mesh.Shapes()[t].Area() / 3.0) *
          (w.row(corners(t, (a + 1) % 3)) + w.row(corners(t, (a + 2) % 3)) - w.row(corners(t, a)));
      }
      u.row(i) /= mesh.ThirdOfTriangles(i);
    });
}

CrouzeixRaviartModel::CrouzeixRaviartModel(std::shared_ptr<const Assembler> vertices,
  std::shared_ptr<const MedialMesh> edges, PointData data, TotalCorrection conserved,
  const ModelMaker& makeModel, const ParallelFor& parallel)
  : Assembly(std::move(vertices))
  , Edges(std::move(edges))
  , Start(std::move(data.Start))
  , Fixed(std::move(data.Fixed))
  , Parallel(parallel)
  , StartRange(this->Start.rows(), this->Start.cols())
  , Conserved(std::move(conserved))
  , U(this->Start)
  , Residue(U.rows(), U.cols())
  , TriangleMeans(this->Assembly->Mesh().NumberOfTriangles(), U.cols())
{
  ForEach(parallel, static_cast<Index>(data.Given.rows()),
    [&](Index i)
    {
      if (data.Missing[i]) // not to be read, even for the jumps of known neighbours
      {
        data.Given.row(i) = this->Start.row(i);
      }
    });
  PointData onEdges;
  onEdges.Given = EdgesFromVertices(*this->Assembly, *this->Edges, data.Given, parallel);
  onEdges.Start = EdgesFromVertices(*this->Assembly, *this->Edges, this->Start, parallel);
  onEdges.Missing.resize(onEdges.Start.rows());
  onEdges.Fixed.resize(onEdges.Start.rows());
  onEdges.FidelityFactors.resize(data.FidelityFactors.size() > 0 ? onEdges.Start.rows() : 0);
  ForEach(parallel, static_cast<Index>(onEdges.Start.rows()),
    [&](Index e)
    {
      const Index i = this->Edges->Ends()[e][0];
      const Index j = this->Edges->Ends()[e][1];
      onEdges.Missing[e] = data.Missing[i] || data.Missing[j];
      onEdges.Fixed[e] = this->Fixed[i] && this->Fixed[j];
      if (onEdges.FidelityFactors.size() > 0)
      {
        // The harmonic mean: 0 if one end is, as for missing data.
        const double product = data.FidelityFactor(i) * data.FidelityFactor(j);
        onEdges.FidelityFactors[e] =
          product > 0.0 ? 2.0 * product / (data.FidelityFactor(i) + data.FidelityFactor(j)) : 0.0;
      }
    });
  this->StartResidue.resize(this->U.rows(), this->U.cols());
  VerticesFromEdges(
    this->Assembly->Mesh(), *this->Edges, onEdges.Start, this->StartResidue, parallel);
  this->StartResidue = this->Start - this->StartResidue;
  ForEach(parallel, this->Assembly->Mesh().NumberOfVertices(),
    [&](Index i)
    {
      for (Eigen::Index k = 0; k < this->Start.cols(); ++k)
      {
        const Bounds around =
          BoundsAround(this->Assembly->Mesh(), *this->Edges, onEdges.Start, i, k);
        this->StartRange(i, k) = around.High - around.Low;
      }
    });
  this->EdgeModel = makeModel(std::move(onEdges));
}

StepReport CrouzeixRaviartModel::Advance(const ProgressMonitor& progress)
{
  const StepReport report = this->EdgeModel->Advance(progress);
  this->Started = true;
  this->UpdateState();
  return report;
}

void CrouzeixRaviartModel::UpdateState()
{
  if (!this->Started)
  {
    this->U = this->Start;
    return;
  }
  const TriangleMesh& mesh = this->Assembly->Mesh();
  const Values& w = this->EdgeModel->State();
  VerticesFromEdges(mesh, *this->Edges, w, this->U, this->Parallel);
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      for (Eigen::Index k = 0; k < this->U.cols(); ++k)
      {
        const Bounds around = BoundsAround(mesh, *this->Edges, w, i, k);
        const double limited = std::min(around.High, std::max(around.Low, this->U(i, k)));
        const double start = this->StartRange(i, k);
        const double left = start > 0.0 ? std::min(1.0, (around.High - around.Low) / start) : 0.0;
        this->Residue(i, k) = left * this->StartResidue(i, k) + this->U(i, k) - limited;
        this->U(i, k) = limited;
      }
    });
  SpreadFar(mesh, this->Residue, this->TriangleMeans, this->Parallel);
  this->U += this->Residue;
  this->Conserved.Restore(mesh, this->U, this->Parallel);
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      if (this->Fixed[i])
      {
        this->U.row(i) = this->Start.row(i);
      }
    });
}

void CrouzeixRaviartModel::Save(double* checkpoint) const
{
  *checkpoint = this->Started ? 1.0 : 0.0;
  this->EdgeModel->Save(checkpoint + 1);
}

void CrouzeixRaviartModel::Restore(const double* checkpoint)
{
  this->Started = *checkpoint > 0.0;
  this->EdgeModel->Restore(checkpoint + 1);
  this->UpdateState();
}

} // namespace SurfaceDiffusion
