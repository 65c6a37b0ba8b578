// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/TotalVariation/GeneralizedVariationMinimizer.h"

#include "Core/Foundation/Resize.h"
#include "Core/Models/TotalVariation/GroupRows.h"
#include "Core/Models/TotalVariation/PenaltyPace.h"
#include "Core/Models/TotalVariation/PenaltyRanges.h"
#include "Core/Models/TotalVariation/VertexSplitting.h"
#include "Core/Operators/SparseProduct.h"

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
  this->Matrix = this->Operator.MakeMatrix(this->Penalty, parallel);
  this->Entries.assign(this->Matrix.valuePtr(), this->Matrix.valuePtr() + this->Matrix.nonZeros());
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
  this->IsSingle = this->Options.StopTolerance >=
    (this->Vertices->IsSplit() ? SmallestSingleGapOfSplit : SmallestSingleGap);
  this->Initial = u;
  this->Vertices->Start(g, f, u, false);
  this->Start(u);
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
      this->AdaptPenalty(report, pace);
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
    u = this->Initial;
    this->X.topRows(u.rows()) = u;
    this->X.bottomRows(this->X.rows() - u.rows()).setZero();
  }
  progress.Report(1.0);
  return report;
}

/// The next penalty, and the residual at it; double precision if the gap does not fall any more.
void GeneralizedVariationMinimizer::AdaptPenalty(const Report& report, PenaltyPace& pace)
{
  if (report.Iterations > 0)
  {
    pace.Take(report.AbsoluteGap, this->GrowthRate);
  }
  if (this->IsSingle && pace.ChecksSinceSmallest == PenaltyPace::MostChecks)
  {
    this->IsSingle = false;
    this->Descent.SetSinglePrecision(false);
    this->SetMatrix();
  }
  this->SetGrowth(this->GrowthRate > 0.0 ? pace.Growth : 1.0);
  this->SetResidual();
}

/// The first iteration: w = 0, no multipliers, and the first penalty.
void GeneralizedVariationMinimizer::Start(const Values& u)
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
    [&](Index g)
    {
      for (int k = 0; k < static_cast<int>(u.cols()); ++k)
      {
        SetVector<0>(this->Split, g, k, this->Operator.Apply(g, this->X, k));
      }
    });
  this->SetLoad(u);
  this->Growth = 1.0;
  this->BestDual = 0.0; // no energy is negative
  this->LastEnergy = std::numeric_limits<double>::infinity();
  this->Descent.SetSinglePrecision(this->IsSingle);
  this->SetMatrix();
}

/// The rows of fixed vertices are Dirichlet conditions.
bool GeneralizedVariationMinimizer::IsFixed(Index row) const
{
  return row < this->Operator.NumberOfVertices() && this->Vertices->GetFixed()[row];
}

/// What fixed vertices give to the other rows, at the first penalties.
void GeneralizedVariationMinimizer::SetLoad(const Values& u)
{
  if (!this->Vertices->GetFixed().any())
  {
    return;
  }
  const Index* const outer = this->Matrix.outerIndexPtr();
  ForEach(this->Parallel, this->Operator.NumberOfRows(),
    [&](Index row)
    {
      for (Index slot = outer[row]; slot < outer[row + 1] && !this->IsFixed(row); ++slot)
      {
        const Index column = this->Matrix.innerIndexPtr()[slot];
        if (this->IsFixed(column))
        {
          this->Load.row(row) -= this->Entries[static_cast<std::size_t>(slot)] * u.row(column);
        }
      }
    });
}

/// The penalties at another growth; the multipliers themselves stay.
void GeneralizedVariationMinimizer::SetGrowth(double growth)
{
  if (growth != this->Growth)
  {
    this->Multipliers *= this->Growth / growth;
    this->Growth = growth;
    this->SetMatrix();
  }
}

void GeneralizedVariationMinimizer::SetMatrix()
{
  const Index* const outer = this->Matrix.outerIndexPtr();
  ForEach(this->Parallel, this->Operator.NumberOfRows(),
    [&](Index row)
    {
      const double ofVertex =
        row < this->Operator.NumberOfVertices() ? this->VertexDiagonal[row] : 0.0;
      for (Index slot = outer[row]; slot < outer[row + 1]; ++slot)
      {
        const Index column = this->Matrix.innerIndexPtr()[slot];
        const double entry = this->Growth * this->Entries[static_cast<std::size_t>(slot)];
        const bool isOut = column != row && (this->IsFixed(row) || this->IsFixed(column));
        this->Matrix.valuePtr()[slot] = isOut ? 0.0 : column == row ? entry + ofVertex : entry;
      }
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
      for (int k = 0; k < columns; ++k)
      {
        const Eigen::Vector2d now = OverRelaxation * this->Operator.Apply(g, this->X, k);
        multipliers[k] += now[0] + (1.0 - OverRelaxation) * split[k];
        multipliers[columns + k] += now[1] + (1.0 - OverRelaxation) * split[columns + k];
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
  return Sum(this->Parallel, this->Operator.NumberOfGroups(),
    [&](Index g)
    {
      double squared = 0.0;
      for (Eigen::Index k = 0; k < x.cols(); ++k)
      {
        squared += this->Operator.Apply(g, x, k).squaredNorm();
      }
      return this->Bounds[g] * std::sqrt(squared);
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

} // namespace SurfaceDiffusion
