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

/// Of g1, below which g2 - g1 gives no direction.
constexpr double RoundOff = 1e-12;

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
  this->DampRoundOff(); // g1 vanishes across steep edges
}

/// Without coherence, the mean of g1 and g2 in all directions.
StructureDiffusion::Tensor StructureDiffusion::Diffusivity(Index t) const
{
  const Eigen::RowVector2d deviator = this->Structure->Deviators().row(t);
  const double half = deviator.norm(); // (m1 - m2)/2
  const double square = this->Options.Contrast * this->Options.Contrast;
  Tensor d;
  if (this->Options.Model == Kind::CoherenceEnhancing)
  {
    const double ratio = square / (2.0 * half); // infinite without coherence: g2 = alpha
    d.G1 = this->Options.Alpha;
    d.Excess = (1.0 - d.G1) * std::exp(-ratio * ratio);
  }
  else
  {
    const double ratio = square / (0.5 * this->Structure->Traces()[t] + half);
    const double flux = FluxFactor * std::pow(ratio, 4);
    d.G1 = -std::expm1(-flux);
    d.Excess = std::exp(-flux);
  }
  if (half > 0.0)
  {
    d.E2 = StrongestAxis({ -deviator[0], -deviator[1], deviator[0] });
  }
  else
  {
    d.G1 += 0.5 * d.Excess;
    d.Excess = 0.0;
  }
  if (!this->Factors.IsOne())
  {
    const PlaneTensor s = this->Factors(t);
    d.Square = d.Square.Between(s);
    d.E2 = { s.XX * d.E2[0] + s.XY * d.E2[1], s.XY * d.E2[0] + s.YY * d.E2[1] };
  }
  return d;
}

void StructureDiffusion::FillWeights(
  Eigen::Index, Eigen::Index, StepReport& report, const ProgressMonitor& progress)
{
  this->Structure->Evaluate(this->U, report, progress);
  const TriangleMesh& mesh = this->Mesh();
  ForEach(this->Parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      const TriangleMesh::Shape shape = mesh.Shapes()[t];
      const Tensor d = this->Diffusivity(t);
      this->Weighted.row(t) = d.G1 * TensorWeights(shape, d.Square) +
        d.Excess * DirectionalWeights(shape, d.E2[0], d.E2[1]);
    });
}

double StructureDiffusion::Energy() const
{
  const TriangleMesh& mesh = this->Mesh();
  FindMeans(mesh, this->U, this->Mean, this->Parallel);
  return mesh.GetReduction().Sum(0.5 *
    Sum(this->Parallel, mesh.NumberOfVertices(),
      [&](Index i)
      { return mesh.ControlAreas()[i] * (this->U.row(i) - this->Mean).squaredNorm(); }));
}

TangentVectors StructureDiffusion::Axes(const ProgressMonitor& progress) const
{
  StepReport unused;
  this->Structure->Evaluate(this->U, unused, progress);
  TangentVectors axes(this->Mesh().NumberOfTriangles(), 2);
  ForEach(this->Parallel, this->Mesh().NumberOfTriangles(),
    [&](Index t)
    {
      Tensor d = this->Diffusivity(t);
      if (this->Factors.IsOne() && d.Excess > RoundOff * d.G1)
      {
        d.G1 = 0.0; // D - g1 has the same axes, whose digits g1 would take
      }
      const auto entry = [&](double square, int i, int j)
      { return d.G1 * square + d.Excess * d.E2[i] * d.E2[j]; };
      axes.row(t) = StrongestAxis(
        { entry(d.Square.XX, 0, 0), entry(d.Square.XY, 0, 1), entry(d.Square.YY, 1, 1) });
    });
  return axes;
}

} // namespace SurfaceDiffusion
