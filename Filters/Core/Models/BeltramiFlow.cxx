// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/BeltramiFlow.h"

#include <cmath>
#include <utility>

namespace SurfaceDiffusion
{

BeltramiFlow::BeltramiFlow(std::shared_ptr<const Assembler> assembler, TangentVectors frames,
  PointData data, const Settings& settings, std::shared_ptr<LinearSolver> solver,
  const ParallelFor& parallel)
  : LaggedDiffusion(std::move(assembler), std::move(data), settings.TimeStep, { settings.Fidelity },
      std::move(solver), parallel)
  , Options(settings)
  , Factors(std::move(frames), settings.AlongDiffusivity, settings.AcrossDiffusivity)
{
  this->DampRoundOff(); // the eigenvalues of D differ by b^2 m1: by any factor on small triangles
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
  return { sum, std::hypot(std::sqrt(1.0 + square * sum.T.Trace()), square * sum.RootDeterminant) };
}

/// D = adj(G) / sqrt(det G).
PlaneTensor BeltramiFlow::Diffusivity(Index t, const Metrics& metrics) const
{
  const double square = this->Options.ColorScale * this->Options.ColorScale;
  const double inverse = 1.0 / metrics.AreaRatio;
  const PlaneTensor d = { (1.0 + square * metrics.Gradients.T.YY) * inverse,
    -square * metrics.Gradients.T.XY * inverse, (1.0 + square * metrics.Gradients.T.XX) * inverse };
  return this->Factors.IsOne() ? d : d.Between(this->Factors(t));
}

/// adj(G) = 1 + b^2 sum over the channels of r r^T with r = grad u turned by 90 degrees, and
/// r . grad(phi_a) = d_a / (2 area) with the difference d_a along the edge opposite corner a. As
/// squares, the weights of the channels stay positive semi-definite where the entries of D have
/// lost their small eigenvalue.
Eigen::RowVector3d BeltramiFlow::Weights(Index t, const Metrics& metrics) const
{
  const TriangleMesh::Shape shape = this->Mesh().Shapes()[t];
  PlaneTensor plain;
  double determinant = 1.0;
  if (!this->Factors.IsOne())
  {
    const PlaneTensor s = this->Factors(t);
    plain = plain.Between(s);
    determinant = s.XX * s.YY - s.XY * s.XY;
  }
  Eigen::RowVector3d weights = TensorWeights(shape, plain) / metrics.AreaRatio;
  const double factor = this->Options.ColorScale * determinant *
    std::sqrt(0.5 * shape.Weight / metrics.AreaRatio) /
    (std::sqrt(shape.Length) * std::sqrt(shape.Y));
  const GradientTensor& gradients = metrics.Gradients;
  const auto corners = this->Mesh().TriangleVertices().row(t);
  for (Eigen::Index k = 0; k < this->U.cols(); ++k)
  {
    const auto value = [&](int a) { return gradients.ValueScale * this->U(corners[a], k); };
    const Eigen::RowVector3d d = factor * gradients.Scale *
      Eigen::RowVector3d(value(2) - value(1), value(0) - value(2), value(1) - value(0));
    weights -= Eigen::RowVector3d(d[1] * d[2], d[2] * d[0], d[0] * d[1]);
  }
  return weights;
}

void BeltramiFlow::FillWeights(Eigen::Index, Eigen::Index, StepReport&, const ProgressMonitor&)
{
  const TriangleMesh& mesh = this->Mesh();
  const bool induced = this->AreaRatios.size() > 0;
  ForEach(this->Parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      const Metrics metrics = this->Measure(t);
      this->Weighted.row(t) = this->Weights(t, metrics);
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
      const double determinant = metrics.Gradients.RootDeterminant *
        (square * metrics.Gradients.RootDeterminant / (metrics.AreaRatio + 1.0));
      return mesh.Shapes()[t].Area() *
        (metrics.Gradients.T.Trace() / (metrics.AreaRatio + 1.0) + determinant);
    });
  return mesh.GetReduction().Sum(excess + this->FidelityEnergy());
}

TangentVectors BeltramiFlow::Axes(const ProgressMonitor& /*progress*/) const
{
  TangentVectors axes(this->Mesh().NumberOfTriangles(), 2);
  ForEach(this->Parallel, this->Mesh().NumberOfTriangles(),
    [&](Index t) { axes.row(t) = StrongestAxis(this->Diffusivity(t, this->Measure(t))); });
  return axes;
}

} // namespace SurfaceDiffusion
