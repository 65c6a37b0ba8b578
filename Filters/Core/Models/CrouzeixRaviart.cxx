// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/CrouzeixRaviart.h"

#include "Core/Operators/CotanWeights.h"
#include "Core/Operators/SparsePattern.h"
#include "Core/Solvers/LinearSolver.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

constexpr double JumpOnset = 2.5; ///< in mean differences

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

/// u smoothed over about one ring: (sqrt(3) + K) s = sqrt(3) u, which is (8) with time step h^2/2
/// on equilateral triangles of any size.
Values Smoothed(const Assembler& operators, const Values& u, const ParallelFor& parallel)
{
  const Vector diagonal = Vector::Constant(u.rows(), std::sqrt(3.0));
  SparseMatrix matrix;
  TakePattern(operators.Pattern(), matrix, parallel);
  operators.Fill(
    matrix, diagonal, 1.0, CotanWeights(operators.Mesh(), parallel), nullptr, parallel);
  const auto solver = MakeConjugateGradientSolver(parallel);
  solver->SetLimits({ 1e-8, 200 });
  solver->SetMatrix(matrix);
  Values smooth = u;
  solver->Solve(std::sqrt(3.0) * u, smooth);
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
      for (Index c = mesh.VertexCornersBegin()[i]; c < mesh.VertexCornersBegin()[i + 1]; ++c)
      {
        const Index t = mesh.VertexCorners()[c] / 3;
        const double share = mesh.Shapes()[t].Area() / (9.0 * mesh.ThirdOfTriangles(i));
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

} // namespace

Values EdgesFromVertices(
  const Assembler& operators, const MedialMesh& edges, const Values& u, const ParallelFor& parallel)
{
  const TriangleMesh& mesh = operators.Mesh();
  const Values smooth = Smoothed(operators, u, parallel);
  const Values typical = MeanDifference(mesh, u, parallel);
  Values w(static_cast<Eigen::Index>(edges.Ends().size()), u.cols());
  ForEach(parallel, static_cast<Index>(w.rows()),
    [&](Index e)
    {
      const Index i = edges.Ends()[e][0];
      const Index j = edges.Ends()[e][1];
      for (Eigen::Index k = 0; k < u.cols(); ++k)
      {
        w(e, k) = 0.5 * u(i, k) + 0.5 * u(j, k);
        const double difference = std::abs(u(i, k) - u(j, k));
        const double excess = 2.0 * difference / (typical(i, k) + typical(j, k)) - JumpOnset;
        if (excess > 0.0)
        {
          const bool high = smooth(i, k) + smooth(j, k) > u(i, k) + u(j, k);
          w(e, k) += (high ? 0.5 : -0.5) * std::min(1.0, excess) * difference;
        }
      }
    });
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
  std::shared_ptr<const MedialMesh> edges, PointData data, const ModelMaker& makeModel,
  const ParallelFor& parallel)
  : Assembly(std::move(vertices))
  , Edges(std::move(edges))
  , Start(std::move(data.Start))
  , Fixed(std::move(data.Fixed))
  , Parallel(parallel)
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
  ForEach(parallel, static_cast<Index>(onEdges.Start.rows()),
    [&](Index e)
    {
      const Index i = this->Edges->Ends()[e][0];
      const Index j = this->Edges->Ends()[e][1];
      onEdges.Missing[e] = data.Missing[i] || data.Missing[j];
      onEdges.Fixed[e] = this->Fixed[i] && this->Fixed[j];
    });
  this->StartResidue.resize(this->U.rows(), this->U.cols());
  VerticesFromEdges(
    this->Assembly->Mesh(), *this->Edges, onEdges.Start, this->StartResidue, parallel);
  this->StartResidue = this->Start - this->StartResidue;
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
  const Triangles& corners = this->Edges->Edges()->TriangleVertices();
  const Values& w = this->EdgeModel->State();
  VerticesFromEdges(mesh, *this->Edges, w, this->U, this->Parallel);
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      const Index begin = mesh.VertexCornersBegin()[i];
      const Index end = mesh.VertexCornersBegin()[i + 1];
      for (Eigen::Index k = 0; k < this->U.cols(); ++k)
      {
        double low = w(corners.data()[mesh.VertexCorners()[begin]], k);
        double high = low;
        for (Index c = begin; c < end; ++c)
        {
          for (int a = 0; a < 3; ++a)
          {
            const double value = w(corners(mesh.VertexCorners()[c] / 3, a), k);
            low = std::min(low, value);
            high = std::max(high, value);
          }
        }
        const double limited = std::min(high, std::max(low, this->U(i, k)));
        this->Residue(i, k) = this->StartResidue(i, k) + this->U(i, k) - limited;
        this->U(i, k) = limited;
      }
    });
  SpreadFar(mesh, this->Residue, this->TriangleMeans, this->Parallel);
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      if (this->Fixed[i])
      {
        this->U.row(i) = this->Start.row(i);
      }
      else
      {
        this->U.row(i) += this->Residue.row(i);
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
