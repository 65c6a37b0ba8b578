// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/BeltramiFlow.h"

#include <cmath>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// The eigenvalues of D differ by b^2 m1, that is by any factor on small triangles. A positive
/// diagonal beside m M does not change that a step lowers E.
constexpr double SmallDamping = 1e-14;

} // namespace

BeltramiFlow::BeltramiFlow(std::shared_ptr<const Assembler> assembler, TangentVectors frames,
  PointData data, const Settings& settings, std::shared_ptr<LinearSolver> solver,
  const ParallelFor& parallel)
  : LaggedDiffusion(std::move(assembler), std::move(data), settings.TimeStep, { settings.Fidelity },
      std::move(solver), parallel)
  , Options(settings)
  , Factors(std::move(frames), settings.AlongDiffusivity, settings.AcrossDiffusivity)
{
  this->Damping = SmallDamping;
  if (settings.MassMetric == Metric::Induced)
  {
    this->AreaRatios.resize(this->Mesh().NumberOfTriangles());
    this->DropConservation();
  }
}

/// det G = 1 + b^2 trace T + b^4 det T.
BeltramiFlow::Metrics BeltramiFlow::Measure(Index t) const
{
  GradientTensor sum = SumGradients(this->Mesh(), this->U, t);
  if (!this->Factors.IsOne())
  {
    const PlaneTensor s = this->Factors(t);
    sum.T = sum.T.Between(s);
    sum.RootDeterminant *= s.XX * s.YY - s.XY * s.XY;
  }
  const double square = this->Options.ColorScale * this->Options.ColorScale;
  return { sum.T, sum.RootDeterminant,
    std::hypot(std::sqrt(1.0 + square * sum.T.Trace()), square * sum.RootDeterminant) };
}

/// D = adj(G) / sqrt(det G).
PlaneTensor BeltramiFlow::Diffusivity(Index t, const Metrics& metrics) const
{
  const double square = this->Options.ColorScale * this->Options.ColorScale;
  const double inverse = 1.0 / metrics.AreaRatio;
  const PlaneTensor d = { (1.0 + square * metrics.T.YY) * inverse, -square * metrics.T.XY * inverse,
    (1.0 + square * metrics.T.XX) * inverse };
  return this->Factors.IsOne() ? d : d.Between(this->Factors(t));
}

void BeltramiFlow::FillWeights(Eigen::Index, Eigen::Index, StepReport&, const ProgressMonitor&)
{
  const TriangleMesh& mesh = this->Mesh();
  const bool induced = this->AreaRatios.size() > 0;
  ForEach(this->Parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      const Metrics metrics = this->Measure(t);
      this->Weighted.row(t) = TensorWeights(mesh.Shapes()[t], this->Diffusivity(t, metrics));
      if (induced)
      {
        this->AreaRatios[t] = metrics.AreaRatio;
      }
    });
}

double BeltramiFlow::MassDensity(Index i) const
{
  if (this->AreaRatios.size() == 0)
  {
    return 1.0;
  }
  const TriangleMesh& mesh = this->Mesh();
  double drawn = 0.0;
  double area = 0.0;
  for (Index c = mesh.VertexCornersBegin()[i]; c < mesh.VertexCornersBegin()[i + 1]; ++c)
  {
    const Index t = mesh.VertexCorners()[c] / 3;
    const double share = mesh.Shapes()[t].Area();
    drawn += share * this->AreaRatios[t];
    area += share;
  }
  return drawn / area;
}

double BeltramiFlow::Energy() const
{
  const TriangleMesh& mesh = this->Mesh();
  const double square = this->Options.ColorScale * this->Options.ColorScale;
  // (sqrt(det G) - 1)/b^2 without cancellation
  const double excess = Sum(this->Parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      const Metrics metrics = this->Measure(t);
      const double determinant =
        metrics.RootDeterminant * (square * metrics.RootDeterminant / (metrics.AreaRatio + 1.0));
      return mesh.Shapes()[t].Area() *
        (metrics.T.Trace() / (metrics.AreaRatio + 1.0) + determinant);
    });
  return mesh.GetReduction().Sum(excess + this->FidelityEnergy());
}

TangentVectors BeltramiFlow::Axes() const
{
  TangentVectors axes(this->Mesh().NumberOfTriangles(), 2);
  ForEach(this->Parallel, this->Mesh().NumberOfTriangles(),
    [&](Index t) { axes.row(t) = StrongestAxis(this->Diffusivity(t, this->Measure(t))); });
  return axes;
}

} // namespace SurfaceDiffusion
