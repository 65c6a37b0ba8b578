// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/NonlinearDiffusion.h"

#include "Core/Operators/CotanWeights.h"
#include "Core/Operators/SparsePattern.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// Squares of grad u along e1 and in all, summed over channels first .. last - 1.
struct SquaredGradient
{
  double Along = 0.0;
  double Total = 0.0;
};

SquaredGradient SquareGradient(const TriangleMesh& mesh, const TangentVectors& frames,
  const Values& u, Index t, Eigen::Index first, Eigen::Index last)
{
  const Triangles& vertices = mesh.TriangleVertices();
  SquaredGradient squared;
  for (Eigen::Index k = first; k < last; ++k)
  {
    const Eigen::Vector2d gradient =
      Gradient(mesh.Shapes()[t], u(vertices(t, 0), k), u(vertices(t, 1), k), u(vertices(t, 2), k));
    squared.Total += gradient.squaredNorm();
    if (frames.rows() > 0)
    {
      squared.Along += std::pow(frames.row(t).dot(gradient), 2);
    }
  }
  return squared;
}

} // namespace

NonlinearDiffusion::NonlinearDiffusion(std::shared_ptr<const Assembler> assembler,
  TangentVectors frames, PointData data, const Settings& settings,
  std::shared_ptr<LinearSolver> solver, const ParallelFor& parallel)
  : Operators(std::move(assembler))
  , Frames(std::move(frames))
  , Data(std::move(data))
  , Options(settings)
  , Solver(std::move(solver))
  , Parallel(parallel)
  , Isotropic(CotanWeights(this->Operators->Mesh(), parallel))
  , Weighted(this->Isotropic.rows(), 3)
  , Diagonal(this->Data.Start.rows())
  , U(this->Data.Start)
{
  TakePattern(this->Operators->Pattern(), this->Matrix, parallel);
  if (settings.Norm == FidelityNorm::L2 || settings.Fidelity == 0.0) // L1 does not conserve
  {
    this->Conserved =
      TotalCorrection(this->Operators->Mesh(), this->Data, settings.Fidelity > 0.0, parallel);
  }
  if (this->Frames.rows() > 0)
  {
    this->Directional = DirectionalWeights(this->Operators->Mesh(), this->Frames, parallel);
  }
  const Eigen::Index columns = settings.Coupling == ChannelCoupling::Joint ? U.cols() : 1;
  this->Change.resize(this->U.rows(), columns);
  this->RightHandSide.resize(this->U.rows(), columns);
  if (this->Data.Fixed.any())
  {
    this->NoValues = Values::Zero(this->U.rows(), columns);
    this->NoLoad = this->NoValues;
  }
}

void NonlinearDiffusion::Restore(const double* checkpoint)
{
  std::copy(checkpoint, checkpoint + this->U.size(), this->U.data());
}

StepReport NonlinearDiffusion::Advance(const ProgressMonitor& progress)
{
  StepReport report;
  const Eigen::Index columns = this->Change.cols();
  const Eigen::Index systems = this->U.cols() / columns;
  for (Eigen::Index system = 0; system < systems; ++system)
  {
    const double done = static_cast<double>(system) / static_cast<double>(systems);
    this->AdvanceColumns(system * columns, (system + 1) * columns, report,
      progress.Part(done, done + 1.0 / static_cast<double>(systems)));
  }
  this->Conserved.Restore(this->Operators->Mesh(), this->U, this->Parallel);
  return report;
}

void NonlinearDiffusion::AdvanceColumns(
  Eigen::Index first, Eigen::Index last, StepReport& report, const ProgressMonitor& progress)
{
  const TriangleMesh& mesh = this->Operators->Mesh();
  this->FillWeights(first, last);
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      this->Diagonal[i] =
        mesh.ControlAreas()[i] * (1.0 + this->Options.TimeStep * this->FidelityAt(i, first, last));
    });
  this->Operators->Fill(
    this->Matrix, this->Diagonal, this->Options.TimeStep, this->Weighted, nullptr, this->Parallel);
  this->FillChange(first, last);
  if (this->Data.Fixed.any())
  {
    this->Operators->Constrain(
      this->Matrix, this->Data.Fixed, this->NoValues, this->NoLoad, this->Parallel);
  }
  this->Solver->SetMatrix(this->Matrix, progress.Part(0.0, 0.5));
  this->Change.setZero();
  const SolveReport solve =
    this->Solver->Solve(this->RightHandSide, this->Change, progress.Part(0.5, 1.0));
  if (!solve.Converged)
  {
    throw NotConverged(solve);
  }
  report.Iterations += solve.Iterations;
  report.Residual = std::max(report.Residual, solve.Residual);
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      for (Eigen::Index k = first; k < last; ++k)
      {
        this->U(i, k) += this->Change(i, k - first);
      }
    });
}

/// g1 c1 + g2 c2 of (12) on each triangle, g1 and g2 at the old |grad u|.
void NonlinearDiffusion::FillWeights(Eigen::Index first, Eigen::Index last)
{
  const TriangleMesh& mesh = this->Operators->Mesh();
  ForEach(this->Parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      const double squared = SquareGradient(mesh, this->Frames, this->U, t, first, last).Total;
      const double g1 = this->Options.AlongDiffusivity * this->Options.Along(squared);
      if (this->Frames.rows() == 0)
      {
        this->Weighted.row(t) = g1 * this->Isotropic.row(t);
        return;
      }
      const double g2 = this->Options.AcrossDiffusivity * this->Options.Across(squared);
      if (this->Frames.row(t).isZero(0.0))
      {
        this->Weighted.row(t) = std::sqrt(g1) * std::sqrt(g2) * this->Isotropic.row(t);
        return;
      }
      const auto c1 = this->Directional.row(t);
      this->Weighted.row(t) = g1 * c1 + g2 * (this->Isotropic.row(t) - c1);
    });
}

/// dt (-K(u_old) u_old + lambda M 1_D (f - u_old)), from differences along edges; off the diagonal
/// the matrix is dt K.
void NonlinearDiffusion::FillChange(Eigen::Index first, Eigen::Index last)
{
  const TriangleMesh& mesh = this->Operators->Mesh();
  const Index* outer = this->Matrix.outerIndexPtr();
  const Index* inner = this->Matrix.innerIndexPtr();
  const double* a = this->Matrix.valuePtr();
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      const double lambda =
        this->Options.TimeStep * mesh.ControlAreas()[i] * this->FidelityAt(i, first, last);
      for (Eigen::Index k = first; k < last; ++k)
      {
        const double u = this->U(i, k);
        double change = lambda > 0.0 ? lambda * (this->Data.Given(i, k) - u) : 0.0;
        for (Index slot = outer[i]; slot < outer[i + 1]; ++slot)
        {
          change -= a[slot] * (this->U(inner[slot], k) - u);
        }
        this->RightHandSide(i, k - first) = this->Data.Fixed[i] ? 0.0 : change;
      }
    });
}

/// lambda 1_D(v_i); with L1 over the rounded distance of u from f.
double NonlinearDiffusion::FidelityAt(Index i, Eigen::Index first, Eigen::Index last) const
{
  if (this->Data.Missing[i] || this->Options.Fidelity == 0.0)
  {
    return 0.0;
  }
  if (this->Options.Norm == FidelityNorm::L2)
  {
    return this->Options.Fidelity;
  }
  const double squared =
    (this->U.row(i) - this->Data.Given.row(i)).segment(first, last - first).squaredNorm();
  const double delta = this->Options.FidelityRounding;
  return this->Options.Fidelity / std::sqrt(squared + delta * delta);
}

double NonlinearDiffusion::Energy() const
{
  const TriangleMesh& mesh = this->Operators->Mesh();
  const Eigen::Index columns = this->Change.cols();
  double energy = 0.0;
  for (Eigen::Index first = 0; first < this->U.cols(); first += columns)
  {
    const Eigen::Index last = first + columns;
    energy += Sum(this->Parallel, mesh.NumberOfTriangles(),
      [&](Index t)
      {
        const SquaredGradient squared = SquareGradient(mesh, this->Frames, this->U, t, first, last);
        double psi1 = this->Options.AlongDiffusivity * this->Options.Along.Potential(squared.Total);
        if (this->Frames.rows() > 0 && squared.Total > 0.0)
        {
          const double psi2 =
            this->Options.AcrossDiffusivity * this->Options.Across.Potential(squared.Total);
          psi1 = this->Frames.row(t).isZero(0.0)
            ? std::sqrt(psi1) * std::sqrt(psi2)
            : psi2 + (psi1 - psi2) * (squared.Along / squared.Total);
        }
        return mesh.Shapes()[t].Area() * psi1;
      });
    if (this->Options.Fidelity > 0.0)
    {
      energy += Sum(this->Parallel, mesh.NumberOfVertices(),
        [&](Index i)
        {
          if (this->Data.Missing[i])
          {
            return 0.0;
          }
          const double squared =
            (this->U.row(i) - this->Data.Given.row(i)).segment(first, columns).squaredNorm();
          const double delta = this->Options.FidelityRounding;
          const double density = this->Options.Norm == FidelityNorm::L2
            ? 0.5 * squared
            : squared / (std::sqrt(squared + delta * delta) + delta);
          return mesh.ControlAreas()[i] * this->Options.Fidelity * density;
        });
    }
  }
  return mesh.GetReduction().Sum(energy);
}

} // namespace SurfaceDiffusion
