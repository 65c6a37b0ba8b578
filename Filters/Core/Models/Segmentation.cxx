// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Segmentation.h"

#include "Core/Models/TotalVariation/SimplexSplitting.h"
#include "Core/Statistics/RegionMeans.h"
#include "Core/Statistics/ValueRange.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// Means have settled if none has moved by more than this share of their range.
constexpr double SettledMeans = 1e-3;

/// The size of u that sets the penalty of the gradients. u has the range 1, but jumps in a belt of
/// triangles alone: measured on a cap under noise, 12 to 24 needs the fewest iterations to gaps of
/// 1e-3 and 1e-5, a sixth of those with 1.
constexpr double TypicalSize = 16.0;

Flags FindSeeds(const std::vector<Index>& seeds, Index vertices)
{
  Flags fixed = Flags::Constant(vertices, false);
  for (std::size_t i = 0; i < seeds.size(); ++i)
  {
    fixed[static_cast<Index>(i)] = seeds[i] > 0;
  }
  return fixed;
}

} // namespace

Segmentation::Segmentation(std::shared_ptr<const Assembler> assembler, Input input,
  const Settings& settings, const ParallelFor& parallel)
  : Assembly(std::move(assembler))
  , Given(std::move(input))
  , Options(settings)
  , Parallel(parallel)
  , C(this->Given.Means)
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  const Index n = mesh.NumberOfVertices();
  const Eigen::Index regions = this->C.rows() > 0 ? this->C.rows() : this->Given.Data.Given.cols();
  const bool isClamped = regions == 2 && !settings.UseSimplex;
  this->EnergyFactor = isClamped ? 1.0 : 2.0;
  this->U.resize(n, regions);
  this->Relaxed.resize(n, isClamped ? 1 : regions);
  this->Costs.resize(n, this->Relaxed.cols());
  this->Farthest = this->C.hasNaN() ? LargestSquare(this->Given.Data) : 0.0;
  this->SetStart();
  this->UpdateCosts();

  // The spread of the costs at most vertices.
  Vector spread(n);
  ForEach(parallel, n,
    [&](Index i)
    {
      const auto costs = this->Costs.row(i);
      spread[i] = isClamped ? std::abs(costs[0]) : costs.maxCoeff() - costs.minCoeff();
    });
  const double typicalCost = mesh.GetReduction().Quantile(spread, 0.5);
  TotalVariationMinimizer::Settings minimizer;
  minimizer.Function.Kind = EdgeFunctionKind::TotalVariation;
  minimizer.Coupling = ChannelCoupling::PerChannel;
  minimizer.Range = 1.0;
  minimizer.StopTolerance = settings.StopTolerance;
  minimizer.MaximumNumberOfIterations = settings.MaximumNumberOfIterations;
  this->Minimizer = std::make_unique<TotalVariationMinimizer>(this->Assembly,
    std::make_shared<const GradientMaps>(this->Assembly->SharedMesh()),
    std::make_unique<SimplexSplitting>(
      this->Assembly->SharedMesh(), FindSeeds(this->Given.Seeds, n), typicalCost, parallel),
    Vector::Constant(mesh.NumberOfTriangles(), TypicalSize), minimizer, parallel);
}

double Segmentation::DataTerm(Index i, Index region) const
{
  const double factor = this->Given.Data.FidelityFactor(i);
  if (factor == 0.0)
  {
    return 0.0;
  }
  const Values& f = this->Given.Data.Given;
  if (this->C.rows() == 0)
  {
    return factor * f(i, region);
  }
  return factor *
    (IsUsed(this->C, region) ? (f.row(i) - this->C.row(region)).squaredNorm() : this->Farthest);
}

/// The label of the smallest data term.
void Segmentation::SetStart()
{
  const Index regions = this->NumberOfRegions();
  ForEach(this->Parallel, static_cast<Index>(this->U.rows()),
    [&](Index i)
    {
      const Index seed = this->Given.Seeds.empty() ? 0 : this->Given.Seeds[i];
      if (seed == 0 && this->Given.Data.FidelityFactor(i) == 0.0)
      {
        this->U.row(i).setConstant(1.0 / regions);
        return;
      }
      Index best = std::max(seed - 1, 0);
      for (Index k = 1; k < regions && seed == 0; ++k)
      {
        best = this->DataTerm(i, k) < this->DataTerm(i, best) ? k : best;
      }
      this->U.row(i).setZero();
      this->U(i, best) = 1.0;
    });
  this->Relaxed = this->U.leftCols(this->Relaxed.cols());
}

/// The costs of the minimiser. They do not count at seeds, where u cannot change.
void Segmentation::UpdateCosts()
{
  const double factor = this->EnergyFactor * this->Options.Fidelity;
  ForEach(this->Parallel, static_cast<Index>(this->U.rows()),
    [&](Index i)
    {
      if (!this->Given.Seeds.empty() && this->Given.Seeds[i] > 0)
      {
        this->Costs.row(i).setZero();
      }
      else if (this->Costs.cols() == 1)
      {
        this->Costs(i, 0) = factor * (this->DataTerm(i, 0) - this->DataTerm(i, 1));
      }
      else
      {
        for (Index k = 0; k < this->NumberOfRegions(); ++k)
        {
          this->Costs(i, k) = factor * this->DataTerm(i, k);
        }
      }
    });
}

StepReport Segmentation::Advance(const ProgressMonitor& progress)
{
  StepReport report;
  this->EnergiesOfStep.clear();
  TotalVariationMinimizer::Report last;
  double done = 0.0;
  for (int alternation = 0; alternation < this->Options.MaximumNumberOfAlternations; ++alternation)
  {
    const double next = this->Options.UpdateMeans ? 0.5 * (1.0 + done) : 1.0;
    last = this->Minimize(progress.Part(done, next), alternation == 0);
    done = next;
    report.Iterations += last.Iterations;
    this->Alternations = alternation + 1;
    // Means that leave hardly any contrast, as of regions that are too small to be kept, settle late
    // or never.
    const bool isLate = report.Iterations >= 2 * this->Options.MaximumNumberOfIterations;
    if (!this->Options.UpdateMeans || isLate ||
      alternation + 1 == this->Options.MaximumNumberOfAlternations || !this->UpdateMeans())
    {
      break;
    }
  }
  report.Residual = this->GapOfState = last.Gap;
  const std::vector<Index>& seeds = this->Given.Seeds;
  if (this->Options.UpdateMeans &&
    std::none_of(seeds.begin(), seeds.end(), [](Index seed) { return seed > 0; }))
  {
    this->SortRegions();
  }
  this->MeasureLabels(last);
  return report;
}

/// Minimises over u, from the present one. It stays if the minimiser finds no lower energy.
TotalVariationMinimizer::Report Segmentation::Minimize(
  const ProgressMonitor& progress, bool isFirst)
{
  this->UpdateCosts();
  this->Former = this->Relaxed;
  const double before = isFirst ? 0.0 : this->Energy();
  const TotalVariationMinimizer::Report report =
    this->Minimizer->Minimize(this->Costs, this->Costs, this->Relaxed, progress, !isFirst);
  this->TakeState();
  if (!isFirst && this->Energy() > before)
  {
    this->Relaxed = this->Former;
    this->TakeState();
  }
  this->EnergiesOfStep.push_back(this->Energy());
  return report;
}

void Segmentation::TakeState()
{
  if (this->Relaxed.cols() == this->U.cols())
  {
    this->U = this->Relaxed;
    return;
  }
  ForEach(this->Parallel, static_cast<Index>(this->U.rows()),
    [&](Index i)
    {
      this->U(i, 0) = this->Relaxed(i, 0);
      this->U(i, 1) = 1.0 - this->Relaxed(i, 0);
    });
}

/// The best means for the present u, unless they have settled. A region without area keeps its own.
bool Segmentation::UpdateMeans()
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  const Reduction& reduction = mesh.GetReduction();
  const Values& f = this->Given.Data.Given;
  const Eigen::Index regions = this->C.rows();
  const Eigen::Index components = f.cols();
  this->Sums.setZero(regions, components + 1);
  for (Eigen::Index k = 0; k < regions; ++k)
  {
    const auto sumOf = [&](const auto& value)
    {
      return Sum(this->Parallel, mesh.NumberOfVertices(),
        [&](Index i)
        {
          const double factor = this->Given.Data.FidelityFactor(i);
          return factor > 0.0 ? mesh.ControlAreas()[i] * factor * this->U(i, k) * value(i) : 0.0;
        });
    };
    this->Sums(k, components) = sumOf([](Index) { return 1.0; });
    for (Eigen::Index c = 0; c < components; ++c)
    {
      this->Sums(k, c) = sumOf([&](Index i) { return f(i, c); });
    }
  }
  reduction.Sum(this->Sums.data(), static_cast<Index>(this->Sums.size()));
  double change = 0.0;
  for (Eigen::Index k = 0; k < regions; ++k)
  {
    if (this->Sums(k, components) > 0.0 && IsUsed(this->C, k))
    {
      this->Sums.row(k).head(components) /= this->Sums(k, components);
      change = std::max(
        change, (this->Sums.row(k).head(components) - this->C.row(k)).cwiseAbs().maxCoeff());
    }
    else
    {
      this->Sums.row(k).head(components) = this->C.row(k);
    }
  }
  if (!(change > SettledMeans * ValueRange(UsedMeans(this->C), reduction)))
  {
    return false;
  }
  this->C = this->Sums.leftCols(components);
  this->EnergiesOfStep.push_back(this->Energy());
  return true;
}

/// By ascending mean: the updates may have changed their order.
void Segmentation::SortRegions()
{
  const std::vector<Eigen::Index> order = AscendingOrder(this->C);
  if (order.empty())
  {
    return;
  }
  const Values means = this->C;
  const Values former = this->U;
  for (Eigen::Index k = 0; k < means.rows(); ++k)
  {
    this->C.row(k) = means.row(order[static_cast<std::size_t>(k)]);
    this->U.col(k) = former.col(order[static_cast<std::size_t>(k)]);
  }
  this->Relaxed = this->U.leftCols(this->Relaxed.cols());
  this->EnergiesOfStep.back() = this->Energy(); // up to round-off the same
}

double Segmentation::EnergyOf(const Values& relaxed) const
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  const double data = mesh.GetReduction().Sum(Sum(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      double sum = 0.0;
      for (Index k = 0; k < this->NumberOfRegions(); ++k)
      {
        const double u = k < relaxed.cols() ? relaxed(i, k) : 1.0 - relaxed(i, 0);
        sum += u * this->DataTerm(i, k);
      }
      return mesh.ControlAreas()[i] * sum;
    }));
  return this->Minimizer->GradientEnergy(relaxed) / this->EnergyFactor +
    this->Options.Fidelity * data;
}

double Segmentation::Energy() const
{
  return this->EnergyOf(this->Relaxed);
}

/// E of the labels in relation to the bound of the last minimisation.
void Segmentation::MeasureLabels(const TotalVariationMinimizer::Report& report)
{
  const std::vector<Index> labels = this->Labels();
  this->Former.setZero();
  ForEach(this->Parallel, static_cast<Index>(labels.size()),
    [&](Index i)
    {
      if (labels[i] <= this->Former.cols())
      {
        this->Former(i, labels[i] - 1) = 1.0;
      }
    });
  const TriangleMesh& mesh = this->Assembly->Mesh();
  const double smallest = this->Options.Fidelity *
    mesh.GetReduction().Sum(Sum(this->Parallel, mesh.NumberOfVertices(),
      [&](Index i)
      {
        const Index seed = this->Given.Seeds.empty() ? 0 : this->Given.Seeds[i];
        double least = this->DataTerm(i, std::max(seed - 1, 0));
        for (Index k = 1; k < this->NumberOfRegions() && seed == 0; ++k)
        {
          least = std::min(least, this->DataTerm(i, k));
        }
        return mesh.ControlAreas()[i] * least;
      }));
  const double ofLabels = this->EnergyOf(this->Former);
  const double bound = this->Energy() - report.AbsoluteGap / this->EnergyFactor;
  this->GapOfLabels =
    ofLabels > smallest ? std::max(0.0, ofLabels - bound) / (ofLabels - smallest) : 0.0;
}

std::map<std::string, Values> Segmentation::Results() const
{
  const auto number = [](double value) -> Values { return Values::Constant(1, 1, value); };
  const std::vector<Index> labels = this->Labels();
  return { { "Labels",
             Eigen::Map<const Eigen::VectorXi>(labels.data(), this->U.rows()).cast<double>() },
    { "Means", this->Means() }, { "DataMeans", this->DataMeans() }, { "Gap", number(this->Gap()) },
    { "LabelGap", number(this->LabelGap()) },
    { "NumberOfAlternations", number(this->NumberOfAlternations()) } };
}

std::vector<Index> Segmentation::Labels() const
{
  std::vector<Index> labels(static_cast<std::size_t>(this->U.rows()));
  ForEach(this->Parallel, static_cast<Index>(this->U.rows()),
    [&](Index i)
    {
      Eigen::Index best = 0;
      this->U.row(i).maxCoeff(&best);
      labels[i] = static_cast<Index>(best) + 1;
    });
  return labels;
}

Values Segmentation::DataMeans() const
{
  const Vector& areas = this->Assembly->Mesh().ControlAreas();
  const std::vector<Index> labels = this->Labels();
  Values means = Values::Zero(this->C.rows(), this->C.cols());
  Vector weights = Vector::Zero(this->C.rows());
  for (std::size_t i = 0; i < labels.size() && this->C.rows() > 0; ++i)
  {
    const auto v = static_cast<Index>(i);
    if (this->Given.Data.FidelityFactor(v) > 0.0)
    {
      weights[labels[i] - 1] += areas[v];
      means.row(labels[i] - 1) += areas[v] * this->Given.Data.Given.row(v);
    }
  }
  for (Eigen::Index k = 0; k < means.rows(); ++k)
  {
    means.row(k) = weights[k] > 0.0 ? (means.row(k) / weights[k]).eval() : this->C.row(k).eval();
  }
  return means;
}

std::size_t Segmentation::CheckpointSize() const
{
  return static_cast<std::size_t>(this->U.size() + this->C.size());
}

void Segmentation::Save(double* checkpoint) const
{
  std::copy(this->C.data(), this->C.data() + this->C.size(),
    std::copy(this->U.data(), this->U.data() + this->U.size(), checkpoint));
}

void Segmentation::Restore(const double* checkpoint)
{
  std::copy(checkpoint, checkpoint + this->U.size(), this->U.data());
  std::copy(
    checkpoint + this->U.size(), checkpoint + this->U.size() + this->C.size(), this->C.data());
  this->Relaxed = this->U.leftCols(this->Relaxed.cols());
}

} // namespace SurfaceDiffusion
