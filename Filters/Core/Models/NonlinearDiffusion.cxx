// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/NonlinearDiffusion.h"

#include "Core/Operators/CotanWeights.h"

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
  : LaggedDiffusion(std::move(assembler), std::move(data), settings.TimeStep,
      { settings.Fidelity, settings.Norm, settings.Coupling, settings.FidelityRounding, false,
        settings.ChannelWeights },
      std::move(solver), parallel)
  , Frames(std::move(frames))
  , Options(settings)
{
  if (!settings.ConservesTotal)
  {
    this->DropConservation();
  }
  if (this->Frames.rows() > 0)
  {
    this->Directional = DirectionalWeights(this->Mesh(), this->Frames, parallel);
    TangentVectors across(this->Frames.rows(), 2);
    across << -this->Frames.col(1), this->Frames.col(0);
    this->Perpendicular = DirectionalWeights(this->Mesh(), across, parallel);
  }
}

/// The weights (12) of each triangle, with g1 and g2 at the old |grad u|.
void NonlinearDiffusion::FillWeights(
  Eigen::Index first, Eigen::Index last, StepReport&, const ProgressMonitor&)
{
  const TriangleMesh& mesh = this->Mesh();
  ForEach(this->Parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      const double squared = SquareGradient(mesh, this->Frames, this->U, t, first, last).Total;
      const double g1 = this->Options.AlongDiffusivity * this->Options.Along(squared);
      if (this->Frames.rows() == 0)
      {
        this->Weighted.row(t) = g1 * CotanWeights(mesh.Shapes()[t]);
        return;
      }
      const double g2 = this->Options.AcrossDiffusivity * this->Options.Across(squared);
      this->Weighted.row(t) =
        AnisotropicWeights(HasDirection(this->Frames, t), CotanWeights(mesh.Shapes()[t]),
          this->Directional.row(t), this->Perpendicular.row(t), g1, g2);
    });
}

double NonlinearDiffusion::Energy() const
{
  const TriangleMesh& mesh = this->Mesh();
  const Eigen::Index columns = this->ColumnsPerTensor();
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
          psi1 = HasDirection(this->Frames, t)
            ? psi2 + (psi1 - psi2) * (squared.Along / squared.Total)
            : IsotropicMean(psi1, psi2);
        }
        return mesh.Shapes()[t].Area() * psi1;
      });
  }
  return mesh.GetReduction().Sum(energy + this->FidelityEnergy());
}

} // namespace SurfaceDiffusion
