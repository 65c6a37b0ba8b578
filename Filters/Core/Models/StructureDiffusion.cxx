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
  this->DampRoundOff(); // g1 vanishes across steep edges
}

/// Without coherence, the mean of g1 and g2 in all directions.
StructureDiffusion::Tensor StructureDiffusion::Diffusivity(Index t) const
{
  const Eigen::RowVector2d deviator = this->Structure->Deviators().row(t);
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
  const PlaneTensor s = this->Factors(t);
  if (!(half > 0.0))
  {
    const double mean = 0.5 * (g1 + g2);
    return { mean, mean, { s.XX, s.XY }, { s.XY, s.YY } };
  }
  const Eigen::RowVector2d e = StrongestAxis({ deviator[0], deviator[1], -deviator[0] });
  return { g1, g2, { s.XX * e[0] + s.XY * e[1], s.XY * e[0] + s.YY * e[1] },
    { s.XY * e[0] - s.XX * e[1], s.YY * e[0] - s.XY * e[1] } };
}

void StructureDiffusion::FillWeights(
  Eigen::Index, Eigen::Index, StepReport& report, const ProgressMonitor& progress)
{
  this->Structure->Evaluate(this->U, report, progress);
  const TriangleMesh& mesh = this->Mesh();
  ForEach(this->Parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      const TriangleMesh::Shape& shape = mesh.Shapes()[t];
      const Tensor d = this->Diffusivity(t);
      this->Weighted.row(t) = d.G1 * DirectionalWeights(shape, d.E1[0], d.E1[1]) +
        d.G2 * DirectionalWeights(shape, d.E2[0], d.E2[1]);
    });
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
    [&](Index t)
    {
      const Tensor d = this->Diffusivity(t);
      const auto entry = [&](int i, int j)
      { return d.G1 * (d.E1[i] * d.E1[j]) + d.G2 * (d.E2[i] * d.E2[j]); };
      axes.row(t) = StrongestAxis({ entry(0, 0), entry(0, 1), entry(1, 1) });
    });
  return axes;
}

} // namespace SurfaceDiffusion
