// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/StructureDiffusion.h"

#include <cmath>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

/// With it, the flux of g1 is largest where m1 = K^2 (Weickert 1998, for the exponent 4).
constexpr double FluxFactor = 3.31488;

} // namespace

StructureDiffusion::StructureDiffusion(std::shared_ptr<const Assembler> assembler,
  TangentVectors frames, PointData data, const Settings& settings,
  std::unique_ptr<StructureTensor> structure, std::shared_ptr<LinearSolver> solver,
  const ParallelFor& parallel)
  : LaggedDiffusion(std::move(assembler), std::move(data), settings.TimeStep, { settings.Fidelity },
      std::move(solver), parallel)
  , Options(settings)
  , Factors(std::move(frames), settings.AlongDiffusivity, settings.AcrossDiffusivity)
  , Structure(std::move(structure))
{
}

/// D = (g1 + g2)/2 I + (g1 - g2)/2 (cos 2a, sin 2a; sin 2a, -cos 2a) with e1 at the angle a.
PlaneTensor StructureDiffusion::Diffusivity(Index t) const
{
  const Eigen::Vector2d deviator = this->Structure->Deviators().row(t);
  const double half = deviator.norm(); // (m1 - m2)/2
  const double square = this->Options.Contrast * this->Options.Contrast;
  double g1 = this->Options.Alpha;
  double g2 = g1;
  if (this->Options.Model == Kind::CoherenceEnhancing)
  {
    const double ratio = square / (2.0 * half); // infinite without coherence: g2 = alpha
    g2 += (1.0 - g1) * std::exp(-ratio * ratio);
  }
  else
  {
    const double ratio = square / (0.5 * this->Structure->Traces()[t] + half);
    g1 = -std::expm1(-FluxFactor * std::pow(ratio, 4));
    g2 = 1.0;
  }
  const double mean = 0.5 * (g1 + g2);
  const double scale = half > 0.0 ? 0.5 * (g1 - g2) / half : 0.0;
  const PlaneTensor d = { mean + scale * deviator[0], scale * deviator[1],
    mean - scale * deviator[0] };
  return this->Factors.IsOne() ? d : d.Between(this->Factors(t));
}

void StructureDiffusion::FillWeights(
  Eigen::Index, Eigen::Index, StepReport& report, const ProgressMonitor& progress)
{
  this->Structure->Evaluate(this->U, report, progress);
  const TriangleMesh& mesh = this->Mesh();
  ForEach(this->Parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    { this->Weighted.row(t) = TensorWeights(mesh.Shapes()[t], this->Diffusivity(t)); });
}

double StructureDiffusion::Energy() const
{
  const TriangleMesh& mesh = this->Mesh();
  Eigen::RowVectorXd mean;
  FindMeans(mesh, this->U, mean, this->Parallel);
  return mesh.GetReduction().Sum(0.5 *
    Sum(this->Parallel, mesh.NumberOfVertices(),
      [&](Index i) { return mesh.ControlAreas()[i] * (this->U.row(i) - mean).squaredNorm(); }));
}

TangentVectors StructureDiffusion::Axes(const ProgressMonitor& progress) const
{
  StepReport unused;
  this->Structure->Evaluate(this->U, unused, progress);
  TangentVectors axes(this->Mesh().NumberOfTriangles(), 2);
  ForEach(this->Parallel, this->Mesh().NumberOfTriangles(),
    [&](Index t) { axes.row(t) = StrongestAxis(this->Diffusivity(t)); });
  return axes;
}

} // namespace SurfaceDiffusion
