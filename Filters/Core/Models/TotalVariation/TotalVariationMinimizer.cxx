// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/TotalVariation/TotalVariationMinimizer.h"

#include "Core/Foundation/Resize.h"
#include "Core/Models/TotalVariation/PenaltyPace.h"
#include "Core/Models/TotalVariation/PenaltyRanges.h"
#include "Core/Models/TotalVariation/VertexSplitting.h"
#include "Core/Operators/SparsePattern.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace SurfaceDiffusion
{

namespace
{

constexpr double OverRelaxation = 1.7;

/// In single precision the bounds of the dual function hold up to round-off only, which is more of
/// them where |u_i - f_i| bounds the multipliers at each vertex.
constexpr double SmallestSingleGap = 1e-5;
constexpr double SmallestSingleGapOfSplit = 1e-4;

/// Conjugate gradient iterations on the quadratic problem. Without a growing penalty few of them
/// are best: exact solutions circle around the minimum. With one, PenaltyPace says how exact they
/// are to be; at most 20 are too few for that on large surfaces with weak fidelity.
constexpr int InnerIterations = 4;
constexpr int MostInnerIterations = 60;
/// Many runs to a gap of 1e-3 end between the first two checks: there it is measured once more.
constexpr int EarlyMeasurement = 15;

/// The growth of the penalty per iteration, in mu times the squared edge length: the convergence
/// of an accelerated method is fastest near 1/3.
constexpr double GrowthFactor = 0.35;
constexpr double SquaredEdgeOverHeight = 4.0 / 3.0; ///< of equilateral triangles

EdgeFunction WithoutBeta(EdgeFunction function)
{
  function.Beta = 0.0;
  return function;
}

} // namespace

TotalVariationMinimizer::TotalVariationMinimizer(const std::shared_ptr<const Assembler>& assembler,
  std::shared_ptr<const GradientMaps> gradients, const Values& quadratic, Vector absolute,
  Flags fixed, const Eigen::Ref<const Values>& typical, const Settings& settings,
  const ParallelFor& parallel)
  : TotalVariationMinimizer(assembler, std::move(gradients), quadratic, std::move(absolute),
      std::move(fixed), settings,
      RangesOfTriangles(assembler->Mesh(), typical, quadratic, parallel), parallel)
{
}

TotalVariationMinimizer::TotalVariationMinimizer(const std::shared_ptr<const Assembler>& assembler,
  std::shared_ptr<const GradientMaps> gradients, Values quadratic, Vector absolute, Flags fixed,
  const Settings& settings, const Vector& ranges, const ParallelFor& parallel)
  : TotalVariationMinimizer(assembler, std::move(gradients),
      std::make_unique<VertexSplitting>(assembler->SharedMesh(), std::move(quadratic),
        std::move(absolute), std::move(fixed),
        RangesOfVertices(assembler->Mesh(), ranges, parallel),
        VertexSplitting::Settings{
          WithoutBeta(settings.Function), settings.Coupling, settings.Range },
        parallel),
      ranges, settings, parallel)
{
}

TotalVariationMinimizer::TotalVariationMinimizer(std::shared_ptr<const Assembler> assembler,
  std::shared_ptr<const GradientMaps> gradients, std::unique_ptr<VertexTerms> terms,
  const Vector& ranges, const Settings& settings, const ParallelFor& parallel)
  : VariationMinimizer(settings)
  , Assembly(std::move(assembler))
  , OverProcesses(this->Assembly->Mesh().GetReduction())
  , Parallel(parallel)
  , NumberOfVertices(this->OverProcesses.SumOverVertices(
      parallel, this->Assembly->Mesh().NumberOfVertices(), [](Index) { return 1.0; }))
  , Gradients(this->Assembly->SharedMesh(), std::move(gradients), WithoutBeta(settings.Function),
      settings.Coupling, ranges, this->NumberOfVertices, parallel)
  , Vertices(std::move(terms))
  , Weights(Gradients.MakeCoefficients())
  , Descent(parallel)
{
  if (!GetEdgeFunction(settings.Function.Kind).Convex)
  {
    throw std::invalid_argument(std::string("the energy of the edge function ") +
      GetEdgeFunction(settings.Function.Kind).Name + " is not convex");
  }
  Vector owned;
  this->Diagonal = this->OverProcesses.OwnedPart(this->Vertices->MakeDiagonal(), owned);
  this->ColumnShifts = this->Vertices->MakeColumnShifts();
  for (Index i = 0; i < static_cast<Index>(this->ColumnShifts.rows()); ++i)
  {
    if (this->Vertices->GetFixed()[i] || !this->OverProcesses.Owns(i))
    {
      this->ColumnShifts.row(i).setZero();
    }
  }
  const double stiffness = this->Gradients.Stiffness();
  this->GrowthRate = stiffness > 0.0
    ? GrowthFactor * SquaredEdgeOverHeight * this->Vertices->QuadraticWeight() / stiffness
    : 0.0;
  this->LargestGrowth = PenaltyPace::LargestGrowth(this->Vertices->ShareWithoutData());
  this->Assembly->TakePattern(this->Matrix, parallel);
}

TotalVariationMinimizer::Report TotalVariationMinimizer::Minimize(const Values& g, const Values& f,
  Values& u, const ProgressMonitor& progress, bool keepMultipliers)
{
  bool isSingle = this->Options.StopTolerance >=
    (this->Vertices->IsSplit() ? SmallestSingleGapOfSplit : SmallestSingleGap);
  this->Start(u, keepMultipliers, isSingle);
  this->Vertices->Start(g, f, u, keepMultipliers);
  this->Initial = this->Vertices->Admissible(u);
  const double startEnergy = this->Energy(this->Initial);
  if (!std::isfinite(startEnergy))
  {
    throw std::runtime_error("the minimisation has no finite solution");
  }
  const double negligible = std::max(1e-3 * startEnergy,
    1e-6 *
      this->NoiseEnergy(this->OverProcesses.Sum(this->Assembly->Mesh().ControlAreas().sum()),
        this->NumberOfVertices));
  const bool grows = this->GrowthRate > 0.0;
  Report report;
  PenaltyPace pace;
  pace.Largest = this->LargestGrowth;
  double fraction = 0.0;
  while (true)
  {
    const bool isCheck = report.Iterations % PenaltyPace::IterationsPerCheck == 0;
    if (isCheck || report.Iterations == EarlyMeasurement)
    {
      this->MeasureGap(u, negligible, report);
      const double left = std::log(std::max(1.0, report.Gap / this->Options.StopTolerance));
      fraction = std::max(fraction, 1.0 - left / std::log(1.0 / this->Options.StopTolerance));
    }
    if (!std::isfinite(report.Gap)) // on nearly degenerate triangles
    {
      this->Start(u, false, isSingle);
      this->Vertices->Start(g, f, u, false);
      u = this->Initial;
      report.AbsoluteGap = startEnergy; // no energy is negative
      report.Gap = startEnergy / std::max(startEnergy, negligible);
      progress.Report(1.0);
      return report;
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
        this->Start(u, true, false);
      }
      this->SetPenalty(pace.Growth, u);
      this->SetResidual(u);
    }
    ++report.Iterations;
    this->Gradients.Update(u, OverRelaxation);
    this->Vertices->Update(u, OverRelaxation);
    this->UpdateResidual();
    this->Descent.Improve(
      u, grows ? pace.Reduction : 0.0, grows ? MostInnerIterations : InnerIterations);
  }
  u = this->Vertices->Admissible(u);
  // On nearly degenerate triangles the few inner iterations may not suffice.
  if (report.Gap > this->Options.StopTolerance && !(this->Energy(u) <= startEnergy))
  {
    u = this->Initial;
  }
  this->Gradients.SetGrowth(1.0);
  progress.Report(1.0);
  return report;
}

/// The first iteration: sizes for as many columns as u has, the first penalty, and a right-hand
/// side of zero.
void TotalVariationMinimizer::Start(const Values& u, bool keepMultipliers, bool isSingle)
{
  for (Values* work : { &this->RightHandSide, &this->Gathered, &this->Descent.Residual })
  {
    Resize(*work, u.rows(), u.cols());
  }
  if (this->Load.size() != u.size())
  {
    Resize(this->Load, u.rows(), u.cols());
    this->Load.setZero();
  }
  this->RightHandSide.setZero();
  this->Gradients.Start(static_cast<int>(u.cols()), keepMultipliers, isSingle);
  this->Descent.SetSinglePrecision(isSingle);
  this->AssembleMatrix(u);
}

/// The next penalty: on each triangle that for its p, and `growth` times that of all. Without
/// mu > 0 it stays: measured on segmentations, balance is up to three times slower there.
void TotalVariationMinimizer::SetPenalty(double growth, const Values& u)
{
  const bool balances = this->GrowthRate > 0.0 && this->Gradients.CanBalance();
  if (balances || growth != this->Gradients.Growth())
  {
    if (balances)
    {
      this->Gradients.Balance();
    }
    this->Gradients.SetGrowth(growth);
    this->AssembleMatrix(u);
  }
}

/// The matrix and load at the present penalty.
void TotalVariationMinimizer::AssembleMatrix(const Values& u)
{
  this->Assembly->Fill(this->Matrix, this->Diagonal, this->Gradients.Growth(), this->Weights,
    this->Gradients.GetScales().data(), this->Parallel);
  if (this->Vertices->GetFixed().any())
  {
    this->Assembly->Constrain(
      this->Matrix, this->Vertices->GetFixed(), u, this->Load, this->Parallel);
  }
  this->Descent.SetMatrix(this->Matrix, this->ColumnShifts, this->OverProcesses);
}

/// The residual of u, which loses digits from update to update. Without a splitting what vertices
/// give to the right-hand side does not change, and is added here alone.
void TotalVariationMinimizer::SetResidual(const Values& u)
{
  Values& residual = this->Descent.Residual;
  Multiply(this->Matrix, u, residual, this->Parallel);
  if (this->ColumnShifts.size() > 0)
  {
    residual += this->ColumnShifts.cwiseProduct(u);
  }
  residual = this->Load - residual;
  this->OverProcesses.Accumulate(residual);
  residual += this->RightHandSide;
  if (!this->Vertices->IsSplit())
  {
    ForEach(this->Parallel, static_cast<Index>(u.rows()),
      [&](Index i)
      {
        if (!this->Vertices->GetFixed()[i])
        {
          this->Vertices->AddRightHandSide(i, &residual(i, 0));
        }
      });
  }
}

std::size_t TotalVariationMinimizer::NumberOfMultipliers(Eigen::Index columns) const
{
  const auto ofVertices =
    static_cast<std::size_t>(columns * this->Assembly->Mesh().NumberOfVertices());
  return this->Gradients.NumberOfMultipliers(static_cast<int>(columns)) +
    (this->Vertices->IsSplit() ? ofVertices : 0);
}

void TotalVariationMinimizer::SaveMultipliers(double* numbers, Eigen::Index columns) const
{
  if (this->Gradients.NumberOfColumns() == 0) // before the first call of Minimize()
  {
    std::fill_n(numbers, this->NumberOfMultipliers(columns), 0.0);
    return;
  }
  const Values& c = this->Vertices->Multipliers();
  this->Gradients.GetMultipliers(numbers);
  std::copy(c.data(), c.data() + c.size(),
    numbers + this->Gradients.NumberOfMultipliers(static_cast<int>(columns)));
}

void TotalVariationMinimizer::RestoreMultipliers(const double* numbers, Eigen::Index columns)
{
  this->Gradients.SetMultipliers(numbers, static_cast<int>(columns));
  if (this->Vertices->IsSplit())
  {
    numbers += this->Gradients.NumberOfMultipliers(static_cast<int>(columns));
    Values& c = this->Vertices->Multipliers();
    c.resize(this->Assembly->Mesh().NumberOfVertices(), columns);
    std::copy(numbers, numbers + c.size(), c.data());
  }
}

/// Add the change of the right-hand side to the residual.
void TotalVariationMinimizer::UpdateResidual()
{
  ForColumns(this->RightHandSide.cols(), [&](auto columns) { this->UpdateColumns<columns()>(); });
}

template <int K>
void TotalVariationMinimizer::UpdateColumns()
{
  const ColumnCount<K> columns(this->RightHandSide.cols());
  const bool isSplit = this->Vertices->IsSplit();
  const auto use = [&](Index i, double* sum)
  {
    if (this->Vertices->GetFixed()[i])
    {
      return;
    }
    if (isSplit)
    {
      this->Vertices->AddRightHandSide(i, sum);
    }
    double* side = &this->RightHandSide(i, 0);
    double* residual = &this->Descent.Residual(i, 0);
    for (int k = 0; k < columns; ++k)
    {
      residual[k] += sum[k] - side[k];
      side[k] = sum[k];
    }
  };
  const auto gather = [&](Index i, double* sum) { this->Gradients.GatherRightHandSide<K>(i, sum); };
  if (this->OverProcesses.IsSerial())
  {
    ForEach(this->Parallel, static_cast<Index>(this->Gathered.rows()),
      [&](Index i)
      {
        ColumnRegisters<double, K> registers;
        double* const sum = registers.Or(&this->Gathered(i, 0));
        gather(i, sum);
        use(i, sum);
      });
    return;
  }
  this->OverProcesses.AccumulateEach(
    this->Parallel, this->Gathered, [&](Index i) { gather(i, &this->Gathered(i, 0)); },
    [&](Index i) { use(i, &this->Gathered(i, 0)); });
}

/// The duality gap of the present u and multipliers, also relative to E or to `negligible`; not
/// finite if they are not.
void TotalVariationMinimizer::MeasureGap(const Values& u, double negligible, Report& report)
{
  const double energy = this->Energy(this->Vertices->Admissible(u));
  const double scale = std::max(energy, negligible);
  const double gap = energy - this->DualEnergy(u);
  report.AbsoluteGap = gap < 0.0 ? 0.0 : gap; // keeps what is not a number
  report.Gap = scale > 0.0 || std::isnan(scale) ? report.AbsoluteGap / scale : 0.0;
}

double TotalVariationMinimizer::Energy(const Values& u) const
{
  return this->GradientEnergy(u) + this->Vertices->Energy(u);
}

/// The dual function at the present multipliers y: the minimum over u of
/// int (y . S grad u - psi*(|y|)) and the terms at the vertices. If larger, that at s y, s <= 1,
/// where it is bounded at all vertices with mu = 0 < nu; psi*(s |y|) <= s psi*(|y|).
double TotalVariationMinimizer::DualEnergy(const Values& u)
{
  this->Gradients.GatherMultipliers(this->Gathered);
  this->OverProcesses.Accumulate(this->Gathered);
  const double conjugate = this->OverProcesses.Sum(this->Gradients.ConjugateEnergy());
  const double dual = this->Vertices->DualEnergy(this->Gathered, u) - conjugate;
  const double share = this->Vertices->FeasibleShare(this->Gathered);
  if (share == 1.0)
  {
    return dual;
  }
  this->Gathered *= share;
  return std::max(dual, this->Vertices->DualEnergy(this->Gathered, u) - share * conjugate);
}

double TotalVariationMinimizer::GradientEnergy(const Values& u) const
{
  return this->OverProcesses.Sum(this->Gradients.Energy(u));
}

} // namespace SurfaceDiffusion
