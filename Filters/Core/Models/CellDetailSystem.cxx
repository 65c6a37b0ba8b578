// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The matrix of a step of CellDetail.

#include "Core/Models/CellDetail.h"

#include "Core/Operators/SparsePattern.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace SurfaceDiffusion
{

/// The triangles of a flipped mesh are not those of the cells, which take the mean of D over all
/// directions around their vertices: area trace D is the sum of the weights times |e|^2.
void CellDetail::TakeDiffusion(Model& model, Eigen::Index column)
{
  const CornerWeights& weights = model.DiffusionWeights(column);
  if (weights.rows() == 0)
  {
    this->Fluxes->SetUnitDiffusion();
    return;
  }
  if (&this->Mesh == &this->ModelMesh)
  {
    this->Fluxes->SetWeights(weights);
    return;
  }
  const TriangleMesh& mesh = this->ModelMesh;
  this->VertexSums.setZero(mesh.NumberOfVertices(), 2);
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      for (Index c = mesh.VertexCornersBegin()[i]; c < mesh.VertexCornersBegin()[i + 1]; ++c)
      {
        const Index t = mesh.VertexCorners()[c] / 3;
        const TriangleMesh::Shape shape = mesh.Shapes()[t];
        for (int a = 0; a < 3; ++a)
        {
          const double length = shape.EdgeLength(a);
          this->VertexSums(i, 0) += 0.5 * weights(t, a) * length * length;
        }
        this->VertexSums(i, 1) += shape.Area();
      }
    });
  this->Diffusivities.resize(this->Mesh.NumberOfTriangles());
  ForEach(this->Parallel, this->Mesh.NumberOfTriangles(),
    [&](Index t)
    {
      double sum = 0.0;
      for (const Index i : this->Mesh.TriangleVertices().row(t))
      {
        sum += this->VertexSums(i, 0) / this->VertexSums(i, 1);
      }
      this->Diffusivities[t] = sum / 3.0;
    });
  this->Fluxes->SetDiffusivities(this->Diffusivities);
}

void CellDetail::Assemble(Eigen::Index first, Eigen::Index last, const DiffusionStep& step,
  const Values& state, const ProgressMonitor& progress)
{
  const bool isSteady = step.TimeStep == InfiniteTime;
  const double inertia = isSteady ? 0.0 : 1.0;
  const double dt = isSteady ? 1.0 : step.TimeStep;
  if (step.IsL1)
  {
    this->MeasureDistances(first, last, state);
  }
  this->Fixed.resize(this->Given.Held.size());
  const Eigen::Index ofFactors = std::min(first, this->Given.Factors.cols() - 1);
  ForEach(this->Parallel, this->Cells.NumberOfCells(),
    [&](Index c)
    {
      const auto cell = static_cast<std::size_t>(c);
      this->Fixed[cell] =
        static_cast<char>(this->Given.Held[cell] != 0 || !this->Cells.Participates(c));
      const double distance = step.IsL1 ? this->Distances[c] : 1.0;
      const double area = this->Cells.CellAreas()[c];
      this->Pull[c] = area * (dt * step.Fidelity * this->Given.Factors(c, ofFactors) / distance);
      this->Balance[c] = inertia * area + this->Pull[c];
    });
  if (isSteady)
  {
    this->FixFreeComponents(first, last);
  }
  this->Fluxes->Assemble(this->Balance, dt, this->Matrix);
  const double number = this->Solver ? 0.0 : this->DiffusionNumber(inertia);
  this->ImposeHeld(first, last);
  if (!this->Solver)
  {
    this->Solver = this->FindSolver(number, step.IsConstant);
  }
  this->Solver->SetMatrix(this->Matrix, progress);
}

/// The rounded distance of the result to f: P* (u - u_0) + d - d_0.
void CellDetail::MeasureDistances(Eigen::Index first, Eigen::Index last, const Values& state)
{
  this->Distances.resize(this->Cells.NumberOfCells());
  ForEach(this->Parallel, this->Cells.NumberOfCells(),
    [&](Index c)
    {
      double square = this->Given.Rounding * this->Given.Rounding;
      for (Eigen::Index k = first; k < last; ++k)
      {
        const double change = this->Detail(c, k) - this->Given.Start(c, k) +
          this->Cells.MeanOver(c, [&](Index i) { return state(i, k) - this->FirstState(i, k); });
        square += change * change;
      }
      this->Distances[c] = square > 0.0 ? std::sqrt(square) : 1.0;
    });
}

/// In a steady state without fidelity and held cells, d is the mean.
void CellDetail::FixFreeComponents(Eigen::Index first, Eigen::Index last)
{
  const Eigen::Index columns = last - first;
  this->Components.Sum(columns + 2,
    [&](Index cell, Eigen::Index k)
    {
      const double area = this->Cells.CellAreas()[cell];
      if (k < columns)
      {
        return area * this->Detail(cell, first + k);
      }
      const bool holds =
        this->Balance[cell] > 0.0 || this->Fixed[static_cast<std::size_t>(cell)] != 0;
      return k == columns ? area : (holds ? 1.0 : 0.0);
    });
  for (Index c = 0; c < this->Components.Count(); ++c)
  {
    if (this->Components.SumOf(c, columns + 1) > 0.0 || !(this->Components.SumOf(c, columns) > 0.0))
    {
      continue;
    }
    for (Index k = this->Components.Begin(c); k < this->Components.End(c); ++k)
    {
      const Index cell = this->Components.Cell(k);
      this->Fixed[static_cast<std::size_t>(cell)] = 1;
      for (Eigen::Index column = 0; column < columns; ++column)
      {
        this->Detail(cell, first + column) =
          this->Components.SumOf(c, column) / this->Components.SumOf(c, columns);
      }
    }
  }
}

double CellDetail::DiffusionNumber(double inertia) const
{
  if (inertia == 0.0)
  {
    return InfiniteTime;
  }
  const Index count = this->Cells.NumberOfCells();
  const double sum = Sum(this->Parallel, count,
    [&](Index c)
    {
      const double area = this->Cells.CellAreas()[c];
      return area > 0.0 ? (DiagonalEntry(this->Matrix, c) - this->Balance[c]) / area : 0.0;
    });
  return 0.25 * sum / std::max(count, 1);
}

/// Dirichlet conditions at fixed cells.
void CellDetail::ImposeHeld(Eigen::Index first, Eigen::Index last)
{
  this->Components.Sum(1,
    [&](Index cell, Eigen::Index)
    { return this->Fixed[static_cast<std::size_t>(cell)] != 0 ? 1.0 : 0.0; });
  this->CanShift.resize(static_cast<std::size_t>(this->Components.Count()));
  for (Index c = 0; c < this->Components.Count(); ++c)
  {
    this->CanShift[static_cast<std::size_t>(c)] =
      static_cast<char>(this->Components.SumOf(c, 0) == 0.0);
  }
  if (std::none_of(this->Fixed.begin(), this->Fixed.end(), [](char fixed) { return fixed != 0; }))
  {
    this->Load.resize(0, 0);
    return;
  }
  this->Load.resize(this->Detail.rows(), this->Detail.cols());
  ForEach(this->Parallel, this->Fluxes->NumberOfRows(),
    [&](Index row)
    {
      this->Load.row(row).segment(first, last - first).setZero();
      for (Index slot = this->Matrix.outerIndexPtr()[row];
           slot < this->Matrix.outerIndexPtr()[row + 1]; ++slot)
      {
        const Index column = this->Matrix.innerIndexPtr()[slot];
        double& a = this->Matrix.valuePtr()[slot];
        if (this->IsFixed(row))
        {
          a = column == row ? 1.0 : 0.0;
        }
        else if (this->IsFixed(column))
        {
          this->Load.row(row).segment(first, last - first) -=
            a * this->Detail.row(column).segment(first, last - first);
          a = 0.0;
        }
      }
    });
}

} // namespace SurfaceDiffusion
