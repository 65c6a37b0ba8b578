// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
// The duality gap of GeneralizedVariationMinimizer.
#include "Core/Models/TotalVariation/GeneralizedVariationMinimizer.h"
#include "Core/Models/TotalVariation/GroupRows.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// While E falls by more than this times the tolerance between two checks, the gap is larger than
/// the tolerance, and is not worth the measurement.
constexpr double FallOfEnergy = 2.0;

/// Steps of RepairMultipliers(): after 10 to 20 of them the bound is that of converged ones.
constexpr int RepairSteps = 15;

} // namespace

/// The excess of y = div q beyond the length 1 per triangle, over |T|; returns the largest one of
/// all.
template <int K>
double GeneralizedVariationMinimizer::MeasureExcess(const Values& q, bool keepsWhole)
{
  const ColumnCount<K> columns(q.cols());
  return Max(this->Parallel, this->Operator.NumberOfTriangles(),
    [&](Index t)
    {
      double* const excess = GroupOf<K>(this->Excess, t);
      for (int k = 0; k < columns; ++k)
      {
        SetVector<K>(this->Excess, t, k,
          this->Operator.GatherAtTriangle(t, [&](Index e) { return VectorAt<K>(q, e, k); }));
      }
      const double length = std::sqrt(SquareOf<K>(excess, columns)) / this->Bounds[t];
      const double share = length > 1.0 ? (1.0 - 1.0 / length) / this->Bounds[t] : 0.0;
      for (int k = 0; k < 2 * columns; ++k)
      {
        excess[k] *= keepsWhole ? 1.0 : share;
      }
      return std::max(0.0, length - 1.0);
    });
}

/// Q from the multipliers of edges, such that those of triangles, y = div Q, have at most the
/// length 1 as far as RepairSteps achieve it: accelerated projected gradient steps on
/// sum_T |T|/2 (|y_T| - 1)_+^2.
template <int K>
void GeneralizedVariationMinimizer::RepairMultipliers()
{
  const Index triangles = this->Operator.NumberOfTriangles();
  const Index edges = this->Operator.NumberOfEdges();
  const ColumnCount<K> columns(this->X.cols());
  ForEach(this->Parallel, edges,
    [&](Index e)
    {
      const double penalty = this->Growth * this->Penalty[triangles + e];
      const double* const multipliers = GroupOf<K>(this->Multipliers, triangles + e);
      double* const q = GroupOf<K>(this->Q, e);
      for (int k = 0; k < 2 * columns; ++k)
      {
        q[k] = penalty * multipliers[k];
      }
    });
  this->Extrapolated = this->Q;
  double t = 1.0;
  for (int step = 0; step < RepairSteps; ++step)
  {
    if (this->MeasureExcess<K>(this->Extrapolated, false) <= 0.1 * this->Options.StopTolerance)
    {
      break;
    }
    const double next = 0.5 + std::sqrt(0.25 + t * t);
    this->StepTowardsFeasible<K>((t - 1.0) / next);
    t = next;
  }
}

/// From Extrapolated to the next Q, and beyond it by the momentum.
template <int K>
void GeneralizedVariationMinimizer::StepTowardsFeasible(double momentum)
{
  const Index triangles = this->Operator.NumberOfTriangles();
  const ColumnCount<K> columns(this->X.cols());
  ForEach(this->Parallel, this->Operator.NumberOfEdges(),
    [&](Index e)
    {
      const GeneralizedGradient::Edge& edge = this->Operator.GetEdge(e);
      const double stride =
        1.0 / (3.0 * (1.0 / this->Bounds[edge.Left] + 1.0 / this->Bounds[edge.Right]));
      double* const point = GroupOf<K>(this->Extrapolated, e);
      for (int k = 0; k < columns; ++k)
      {
        const Eigen::Vector2d change = VectorAt<K>(this->Excess, edge.Left, k) -
          edge.P * VectorAt<K>(this->Excess, edge.Right, k);
        point[k] -= stride * change[0];
        point[columns + k] -= stride * change[1];
      }
      const double bound = this->Bounds[triangles + e];
      const double length = std::sqrt(SquareOf<K>(point, columns));
      const double share = length > bound ? bound / length : 1.0;
      double* const q = GroupOf<K>(this->Q, e);
      for (int k = 0; k < 2 * columns; ++k)
      {
        const double now = share * point[k];
        point[k] = now + momentum * (now - q[k]);
        q[k] = now;
      }
    });
}

/// The dual function at feasible multipliers near the present ones: the minimum over u of
/// int y . grad u and the terms at the vertices. If larger, that at s y, s <= 1, see
/// TotalVariationMinimizer.
template <int K>
double GeneralizedVariationMinimizer::DualEnergy(const Values& u)
{
  this->RepairMultipliers<K>();
  const double feasible = 1.0 / (1.0 + this->MeasureExcess<K>(this->Q, true));
  const ColumnCount<K> columns(u.cols());
  ForEach(this->Parallel, this->Operator.NumberOfVertices(),
    [&](Index i)
    {
      double* const row = &this->Gathered(i, 0);
      std::fill_n(row, static_cast<int>(columns), 0.0);
      this->Operator.GatherAtVertex<K>(
        i, [&](Index t, int k) { return VectorAt<K>(this->Excess, t, k); }, row, columns);
      for (int k = 0; k < columns; ++k)
      {
        row[k] *= feasible;
      }
    });
  const double dual = this->Vertices->DualEnergy(this->Gathered, u);
  const double share = this->Vertices->FeasibleShare(this->Gathered);
  if (share == 1.0)
  {
    return dual;
  }
  this->Gathered *= share;
  return std::max(dual, this->Vertices->DualEnergy(this->Gathered, u));
}

/// The duality gap of the present state, also relative to E or to `negligible`; not finite if that
/// is not. The bound of the last check stays as long as E falls by more than the tolerance.
void GeneralizedVariationMinimizer::MeasureGap(const Values& u, double negligible, Report& report)
{
  const double energy = this->GroupEnergy(this->X) + this->Vertices->Energy(u);
  const double scale = std::max(energy, negligible);
  if (!(this->LastEnergy - energy > FallOfEnergy * this->Options.StopTolerance * scale))
  {
    const double dual =
      ForColumns(u.cols(), [&](auto k) { return this->DualEnergy<decltype(k)::value>(u); });
    this->BestDual = std::max(this->BestDual, dual);
  }
  this->LastEnergy = energy;
  const double gap = energy - this->BestDual;
  report.AbsoluteGap = gap < 0.0 ? 0.0 : gap; // keeps what is not a number
  report.Gap = scale > 0.0 || std::isnan(scale) ? report.AbsoluteGap / scale : 0.0;
}

} // namespace SurfaceDiffusion
