// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/TotalVariation/GeneralizedVariationMinimizer.h"

#include "Core/Foundation/Resize.h"
#include "Core/Models/TotalVariation/PenaltyPace.h"
#include "Core/Models/TotalVariation/PenaltyRanges.h"
#include "Core/Models/TotalVariation/VertexSplitting.h"
#include "Core/Operators/SparsePattern.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace SurfaceDiffusion
{

namespace
{

constexpr double OverRelaxation = 1.7;

/// As in TotalVariationMinimizer: below these gaps iterations are in double precision.
constexpr double SmallestSingleGap = 1e-5;
constexpr double SmallestSingleGapOfSplit = 1e-4;

/// Conjugate gradient iterations on the quadratic problem: with half of them there are four times as
/// many iterations, with 12 of them as many.
constexpr int InnerIterations = 8;

/// The first penalty over that of total variation, the penalty of edges over alpha |e| times that of
/// their triangles over their areas, and the growth as in TotalVariationMinimizer. Measured on roofs,
/// cliffs, waves and caps with noise, with weak and strong fidelity: of the products of 0.5, 0.7, 1,
/// 2 and 4, of 0.4 to 2 and of 0 to 1 the ones that need the fewest iterations in all. A faster
/// growth leaves the multipliers behind, up to thousands of iterations.
constexpr double FirstPenalty = 0.7;
constexpr double PenaltyOfEdges = 1.0;
constexpr double GrowthFactor = 0.25;
constexpr double SquaredEdgeOverHeight = 4.0 / 3.0; ///< of equilateral triangles

/// While E falls by more than this times the tolerance between two checks, the gap is larger than
/// the tolerance, and is not worth the measurement.
constexpr double FallOfEnergy = 2.0;

/// Steps of RepairMultipliers(): after 10 to 20 of them the bound is that of converged ones.
constexpr int RepairSteps = 15;

template <int K>
const double* GroupOf(const Values& values, Index g)
{
  const ColumnCount<K> columns(values.cols());
  return values.data() + static_cast<std::ptrdiff_t>(2 * g) * columns;
}
template <int K>
double* GroupOf(Values& values, Index g)
{
  const ColumnCount<K> columns(values.cols());
  return values.data() + static_cast<std::ptrdiff_t>(2 * g) * columns;
}

/// Column k of a group of two rows.
template <int K>
Eigen::Vector2d VectorAt(const Values& values, Index g, int k)
{
  const ColumnCount<K> columns(values.cols());
  const double* const group = GroupOf<K>(values, g);
  return { group[k], group[columns + k] };
}

/// The square of a group over all columns.
template <int K>
double SquareOf(const double* group, Eigen::Index count)
{
  const ColumnCount<K> columns(count);
  double sum = 0.0;
  for (int k = 0; k < 2 * columns; ++k)
  {
    sum += group[k] * group[k];
  }
  return sum;
}

} // namespace

GeneralizedVariationMinimizer::GeneralizedVariationMinimizer(
  std::shared_ptr<const Assembler> assembler, double length, const Values& quadratic,
  Vector absolute, Flags fixed, const Eigen::Ref<const Values>& typical, const Settings& settings,
  const ParallelFor& parallel)
  : VariationMinimizer(settings)
  , Assembly(std::move(assembler))
  , Parallel(parallel)
  , Operator(this->Assembly->SharedMesh(), parallel)
  , Bounds(this->Operator.NumberOfGroups())
  , Descent(parallel)
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  this->Options.Function = EdgeFunction{ EdgeFunctionKind::TotalVariation, 0.0 };
  const Vector ranges =
    RangesOfTriangles(mesh, typical, Values::Zero(quadratic.rows(), 1), parallel);
  this->Vertices = std::make_unique<VertexSplitting>(this->Assembly->SharedMesh(), quadratic,
    std::move(absolute), std::move(fixed), RangesOfVertices(mesh, ranges, parallel),
    VertexSplitting::Settings{ this->Options.Function, ChannelCoupling::Joint, settings.Range },
    parallel);
  ForEach(parallel, this->Operator.NumberOfGroups(),
    [&](Index g)
    {
      const Index triangles = this->Operator.NumberOfTriangles();
      this->Bounds[g] = g < triangles ? mesh.Shapes()[static_cast<std::size_t>(g)].Area()
                                      : length * this->Operator.GetEdge(g - triangles).Length;
    });
  this->SetPenalties(ranges);
  this->VertexDiagonal = this->Vertices->MakeDiagonal();
  const Values shifts = this->Vertices->MakeColumnShifts();
  if (shifts.size() > 0)
  {
    this->ColumnShifts.setZero(this->Operator.NumberOfRows(), shifts.cols());
    this->ColumnShifts.topRows(shifts.rows()) = shifts;
    for (Eigen::Index i = 0; i < shifts.rows(); ++i)
    {
      this->ColumnShifts.row(i) *= this->Vertices->GetFixed()[i] ? 0.0 : 1.0;
    }
  }
}

void GeneralizedVariationMinimizer::SetPenalties(const Vector& ranges)
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  const Index triangles = this->Operator.NumberOfTriangles();
  const GradientMaps maps(this->Assembly->SharedMesh());
  const Vector ofTriangles = FirstPenalty *
    PenaltiesOfTriangles(
      mesh, maps, this->Options.Function, ranges, mesh.NumberOfVertices(), this->Parallel);
  this->Penalty.resize(this->Operator.NumberOfGroups());
  this->Penalty.head(triangles) = ofTriangles;
  const auto density = [&](Index t) { return ofTriangles[t] / this->Bounds[t]; };
  ForEach(this->Parallel, this->Operator.NumberOfEdges(),
    [&](Index e)
    {
      const GeneralizedGradient::Edge& edge = this->Operator.GetEdge(e);
      this->Penalty[triangles + e] = PenaltyOfEdges * this->Bounds[triangles + e] * 0.5 *
        (density(edge.Left) + density(edge.Right));
    });
  const double stiffness = Sum(
    this->Parallel, triangles, [&](Index t) { return ofTriangles[t] * SquaredSteepest(maps[t]); });
  this->GrowthRate = stiffness > 0.0
    ? GrowthFactor * SquaredEdgeOverHeight * this->Vertices->QuadraticWeight() / stiffness
    : 0.0;
}

VariationMinimizer::Report GeneralizedVariationMinimizer::Minimize(const Values& g, const Values& f,
  Values& u, const ProgressMonitor& progress, bool /*keepMultipliers*/)
{
  bool isSingle = this->Options.StopTolerance >=
    (this->Vertices->IsSplit() ? SmallestSingleGapOfSplit : SmallestSingleGap);
  const Values initial = u;
  this->Vertices->Start(g, f, u, false);
  this->Start(u, isSingle);
  const double startEnergy = this->GroupEnergy(this->X) + this->Vertices->Energy(u);
  if (!std::isfinite(startEnergy))
  {
    throw std::runtime_error("the minimisation has no finite solution");
  }
  const TriangleMesh& mesh = this->Assembly->Mesh();
  const double negligible = std::max(1e-3 * startEnergy,
    1e-6 * this->NoiseEnergy(mesh.ControlAreas().sum(), mesh.NumberOfVertices()));
  Report report;
  PenaltyPace pace;
  double fraction = 0.0;
  while (true)
  {
    const bool isCheck = report.Iterations % PenaltyPace::IterationsPerCheck == 0;
    if (isCheck)
    {
      this->MeasureGap(u, negligible, report);
      const double left = std::log(std::max(1.0, report.Gap / this->Options.StopTolerance));
      fraction = std::max(fraction, 1.0 - left / std::log(1.0 / this->Options.StopTolerance));
    }
    if (!std::isfinite(report.Gap)) // on nearly degenerate triangles
    {
      report.AbsoluteGap = startEnergy; // no energy is negative
      report.Gap = startEnergy / std::max(startEnergy, negligible);
      break;
    }
    if (report.Gap <= this->Options.StopTolerance ||
      report.Iterations == this->Options.MaximumNumberOfIterations)
    {
      break;
    }
    progress.Report(fraction);
    if (isCheck)
    {
      if (report.Iterations > 0)
      {
        pace.Take(report.AbsoluteGap, this->GrowthRate);
      }
      if (isSingle && pace.ChecksSinceSmallest == PenaltyPace::MostChecks)
      {
        isSingle = false;
        this->Descent.SetSinglePrecision(false);
        this->SetMatrix();
      }
      this->SetGrowth(this->GrowthRate > 0.0 ? pace.Growth : 1.0);
      this->SetResidual();
    }
    ++report.Iterations;
    this->Vertices->Update(u, OverRelaxation);
    ForColumns(u.cols(),
      [&](auto k)
      {
        this->UpdateGroups<decltype(k)::value>();
        this->UpdateResidual<decltype(k)::value>();
      });
    this->Descent.Improve(this->X, this->GrowthRate > 0.0 ? pace.Reduction : 0.0, InnerIterations);
    u = this->X.topRows(u.rows());
  }
  if (!(this->GroupEnergy(this->X) + this->Vertices->Energy(u) <= startEnergy))
  {
    u = initial;
    this->X.topRows(u.rows()) = u;
    this->X.bottomRows(this->X.rows() - u.rows()).setZero();
  }
  progress.Report(1.0);
  return report;
}

/// The first iteration: w = 0, no multipliers, and the first penalty.
void GeneralizedVariationMinimizer::Start(const Values& u, bool isSingle)
{
  const Index rows = this->Operator.NumberOfRows();
  const Index groups = this->Operator.NumberOfGroups();
  for (Values* work : { &this->X, &this->RightHandSide, &this->Load, &this->Descent.Residual })
  {
    Resize(*work, rows, u.cols());
    work->setZero();
  }
  for (Values* work : { &this->Split, &this->Multipliers })
  {
    Resize(*work, Eigen::Index{ 2 } * groups, u.cols());
  }
  Resize(this->Gathered, u.rows(), u.cols());
  const Index triangles = this->Operator.NumberOfTriangles();
  Resize(this->Excess, Eigen::Index{ 2 } * triangles, u.cols());
  Resize(this->Q, Eigen::Index{ 2 } * (groups - triangles), u.cols());
  this->X.topRows(u.rows()) = u;
  this->Multipliers.setZero();
  ForEach(this->Parallel, groups,
    [&](Index g) { this->Operator.Apply<0>(g, this->X, GroupOf<0>(this->Split, g)); });
  this->Matrix = this->Operator.MakeMatrix(this->Penalty, this->Parallel);
  if (this->Vertices->GetFixed().any())
  {
    this->Constrain(u);
  }
  this->Diagonal.resize(rows);
  ForEach(
    this->Parallel, rows, [&](Index i) { this->Diagonal[i] = DiagonalEntry(this->Matrix, i); });
  this->Growth = 1.0;
  this->BestDual = 0.0; // no energy is negative
  this->LastEnergy = std::numeric_limits<double>::infinity();
  this->Descent.SetSinglePrecision(isSingle);
  this->SetMatrix();
}

/// Dirichlet conditions: only the diagonal stays in rows of fixed vertices.
void GeneralizedVariationMinimizer::Constrain(const Values& u)
{
  const Index n = this->Operator.NumberOfVertices();
  const auto isFixed = [&](Index row) { return row < n && this->Vertices->GetFixed()[row]; };
  ForEach(this->Parallel, this->Operator.NumberOfRows(),
    [&](Index row)
    {
      for (SparseMatrix::InnerIterator a(this->Matrix, row); a; ++a)
      {
        const auto column = static_cast<Index>(a.index());
        if (column == row || !(isFixed(row) || isFixed(column)))
        {
          continue;
        }
        if (!isFixed(row))
        {
          this->Load.row(row) -= a.value() * u.row(column);
        }
        a.valueRef() = 0.0;
      }
    });
}

/// The penalties at another growth; the multipliers themselves stay.
void GeneralizedVariationMinimizer::SetGrowth(double growth)
{
  if (growth != this->Growth)
  {
    const double ratio = growth / this->Growth;
    this->Multipliers *= 1.0 / ratio;
    this->Growth = growth;
    ForEach(this->Parallel, static_cast<Index>(this->Matrix.nonZeros()),
      [&](Index slot) { this->Matrix.valuePtr()[slot] *= ratio; });
    this->SetMatrix();
  }
}

void GeneralizedVariationMinimizer::SetMatrix()
{
  ForEach(this->Parallel, this->Operator.NumberOfRows(),
    [&](Index row)
    {
      const double ofVertex =
        row < this->Operator.NumberOfVertices() ? this->VertexDiagonal[row] : 0.0;
      this->Matrix.coeffRef(row, row) = this->Growth * this->Diagonal[row] + ofVertex;
    });
  this->Descent.SetMatrix(this->Matrix, this->ColumnShifts);
}

/// What group g gives to the equations.
template <int K>
Eigen::Vector2d GeneralizedVariationMinimizer::SideOf(Index group, int k) const
{
  return this->Growth * this->Penalty[group] *
    (VectorAt<K>(this->Split, group, k) - VectorAt<K>(this->Multipliers, group, k));
}

/// The residual of x for a right-hand side of groups and vertices that is not known yet.
void GeneralizedVariationMinimizer::SetResidual()
{
  Multiply(this->Matrix, this->X, this->Descent.Residual, this->Parallel);
  if (this->ColumnShifts.size() > 0)
  {
    this->Descent.Residual += this->ColumnShifts.cwiseProduct(this->X);
  }
  this->Descent.Residual = this->Growth * this->Load - this->Descent.Residual;
  this->RightHandSide.setZero();
}

/// p = grad u - w and z = w_left - P w_right shrunk, and the multipliers.
template <int K>
void GeneralizedVariationMinimizer::UpdateGroups()
{
  const ColumnCount<K> columns(this->X.cols());
  ForEach(this->Parallel, this->Operator.NumberOfGroups(),
    [&](Index g)
    {
      double* const multipliers = GroupOf<K>(this->Multipliers, g);
      double* const split = GroupOf<K>(this->Split, g);
      const double threshold = this->Bounds[g] / (this->Growth * this->Penalty[g]);
      ColumnRegisters<double, K, 2> registers;
      double* const now = registers.Or(split);
      if (K == 0)
      {
        for (int k = 0; k < 2 * columns; ++k)
        {
          multipliers[k] += (1.0 - OverRelaxation) * split[k];
        }
      }
      this->Operator.Apply<K>(g, this->X, now);
      for (int k = 0; k < 2 * columns; ++k)
      {
        const double last = K == 0 ? 0.0 : (1.0 - OverRelaxation) * split[k];
        multipliers[k] += last + OverRelaxation * now[k];
      }
      const double norm = std::sqrt(SquareOf<K>(multipliers, columns));
      const double share = norm > threshold ? threshold / norm : 1.0;
      for (int k = 0; k < 2 * columns; ++k)
      {
        split[k] = (1.0 - share) * multipliers[k];
        multipliers[k] *= share;
      }
    });
}

/// Add the change of the right-hand side to the residual.
template <int K>
void GeneralizedVariationMinimizer::UpdateResidual()
{
  const Index n = this->Operator.NumberOfVertices();
  const ColumnCount<K> columns(this->X.cols());
  const auto take = [&](Index row, int k, double side)
  {
    this->Descent.Residual(row, k) += side - this->RightHandSide(row, k);
    this->RightHandSide(row, k) = side;
  };
  ForEach(this->Parallel, n,
    [&](Index i)
    {
      if (this->Vertices->GetFixed()[i])
      {
        this->Descent.Residual.row(i).setZero();
        return;
      }
      double* const sums = &this->Gathered(i, 0);
      std::fill_n(sums, static_cast<int>(columns), 0.0);
      this->Operator.GatherAtVertex<K>(
        i, [&](Index t, int k) { return this->SideOf<K>(t, k); }, sums, columns);
      this->Vertices->AddRightHandSide(i, sums);
      for (int k = 0; k < columns; ++k)
      {
        take(i, k, sums[k]);
      }
    });
  const Index triangles = this->Operator.NumberOfTriangles();
  ForEach(this->Parallel, triangles,
    [&](Index t)
    {
      for (int k = 0; k < columns; ++k)
      {
        const Eigen::Vector2d side = this->Operator.GatherAtTriangle(t,
                                       [&](Index e) { return this->SideOf<K>(triangles + e, k); }) -
          this->SideOf<K>(t, k);
        take(n + 2 * t, k, side[0]);
        take(n + 2 * t + 1, k, side[1]);
      }
    });
}

double GeneralizedVariationMinimizer::GroupEnergy(const Values& x) const
{
  return ForColumns(x.cols(),
    [&](auto k)
    {
      constexpr int K = decltype(k)::value;
      return Sum(this->Parallel, this->Operator.NumberOfGroups(),
        [&](Index g)
        {
          ColumnRegisters<double, K, 2> registers;
          std::vector<double> many(K == 0 ? 2 * static_cast<std::size_t>(x.cols()) : 0);
          double* const group = registers.Or(many.data());
          this->Operator.Apply<K>(g, x, group);
          return this->Bounds[g] * std::sqrt(SquareOf<K>(group, x.cols()));
        });
    });
}

double GeneralizedVariationMinimizer::GradientEnergy(const Values& u) const
{
  Values x = Values::Zero(this->Operator.NumberOfRows(), u.cols());
  if (this->X.cols() == u.cols())
  {
    x = this->X;
  }
  x.topRows(u.rows()) = u;
  return this->GroupEnergy(x);
}

void GeneralizedVariationMinimizer::SaveMultipliers(double* numbers, Eigen::Index columns) const
{
  std::fill_n(numbers, this->NumberOfMultipliers(columns), 0.0);
  if (this->X.size() > 0)
  {
    const Index begin = this->Operator.NumberOfVertices();
    std::copy(&this->X(begin, 0), this->X.data() + this->X.size(), numbers);
  }
}

void GeneralizedVariationMinimizer::RestoreMultipliers(const double* numbers, Eigen::Index columns)
{
  this->X.resize(this->Operator.NumberOfRows(), columns);
  std::copy_n(
    numbers, this->NumberOfMultipliers(columns), &this->X(this->Operator.NumberOfVertices(), 0));
}

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
        const Eigen::Vector2d y =
          this->Operator.GatherAtTriangle(t, [&](Index e) { return VectorAt<K>(q, e, k); });
        excess[k] = y[0];
        excess[columns + k] = y[1];
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
