// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/Run.h"

#include "Core/Models/Harmonic/HarmonicMap.h"
#include "Run/BlockSentences.h"
#include "Run/UnlikeEdges.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace SurfaceDiffusion
{

namespace
{

Sentence DescribeMissedTolerance(const Shortfalls& found)
{
  Sentence text("the linear solver missed its tolerance in ");
  if (found.MissedSteps > 0)
  {
    text << found.MissedSteps << " of " << found.Steps << " steps";
  }
  else
  {
    text << "filling in missing values or moving vertices";
  }
  text << "; the largest relative residual is " << found.MissedResidual;
  return text;
}

/// used: R; robust: without outliers.
Sentence DescribeOutliers(
  double used, double whole, double robust, const std::vector<const char*>& settings)
{
  Sentence names;
  for (const char* const name : settings)
  {
    names << (names.Words().empty() ? "" : " and ") << Word::Setting(name);
  }
  Sentence text;
  if (used < whole)
  {
    text << "the values have outliers: the range R, the unit of " << names << ", is " << used
         << ", that of all but 1 % of the surface, in place of " << whole;
  }
  else
  {
    text << "the range R of the values, " << whole << ", is that of outliers: it is " << robust
         << " without 1 % of the surface, and it is the unit of " << names;
  }
  text << " (clip or mask the outliers, or set " << Word::Setting("Units") << " to "
       << Word::Choice("Units", UnitsMode::Absolute, "Absolute") << ")";
  return text;
}

std::string DescribeUndetermined(long long components)
{
  return std::to_string(components) +
    (components == 1 ? " connected component has" : " connected components have") +
    " no known value: results are NaN there, labels 0, and arrays of integers the input";
}

Sentence DescribeUnsettledSteps(const Shortfalls& found)
{
  Sentence text;
  text << "the repetitions ended at their largest number in " << found.UnsettledSteps << " of "
       << found.Steps << " steps of "
       << Word::Choice("Scheme", HarmonicMap::Scheme::MinimizingMovement, "MinimizingMovement")
       << "; the last one still made up to " << 100.0 * found.UnsettledDecrease
       << " % of the decrease of the energy (smaller time steps need fewer)";
  return text;
}

/// The kind of a warning whose figures change from step to step.
std::string WithoutFigures(const Sentence& sentence)
{
  std::string kind = sentence.Text();
  const auto isFigure = [](char c) { return std::strchr("0123456789+-.e", c) != nullptr; };
  kind.erase(std::remove_if(kind.begin(), kind.end(), isFigure), kind.end());
  return kind;
}

} // namespace

int Run::FindLastStep(const ProgressMonitor& progress)
{
  const ModelTraits traits = this->Settings->DescribeModel();
  int last = 0;
  for (std::size_t b = 0; b < this->Blocks.size() && traits.MayEndEarly; ++b)
  {
    const double share = static_cast<double>(this->Blocks.size());
    Trajectory& path = *this->Blocks[b]->Path;
    const Index before = path.NumberOfAdvances();
    NameBlockInErrors(this->Blocks[b]->Name, *this->Settings,
      [&]
      {
        last = std::max(last,
          static_cast<int>(
            path.FindLastStep(traits.NumberOfSteps, progress.Part(b / share, (b + 1) / share))));
      });
    this->StepsComputed += path.NumberOfAdvances() - before;
  }
  return traits.MayEndEarly ? last : traits.NumberOfSteps;
}

const Run::Block& Run::ReportedBlock() const
{
  const auto found = std::find_if(this->Blocks.begin(), this->Blocks.end(),
    [](const auto& block) { return block->Surface->Mesh().NumberOfVertices() > 0; });
  return found == this->Blocks.end() ? *this->Blocks.front() : **found;
}

History Run::MakeHistory(int step) const
{
  const ModelTraits traits = this->Settings->DescribeModel();
  int rows = 0;
  Eigen::Index components = 0;
  for (const auto& block : this->Blocks)
  {
    rows = std::max(rows, std::min(step + 1, static_cast<int>(block->Path->Records().size())));
    components = std::max(components, block->Path->State().cols());
  }
  History history;
  history.CountsClamped = traits.CountsClamped;
  history.BoundsError = traits.BoundsError;
  history.Records.resize(static_cast<std::size_t>(rows));
  history.Totals.assign(
    static_cast<std::size_t>(components), std::vector<double>(static_cast<std::size_t>(rows), 0.0));
  history.Time.reserve(static_cast<std::size_t>(rows));
  for (int row = 0; row < rows; ++row)
  {
    history.Time.push_back(row * traits.TimeStep);
  }
  for (const auto& block : this->Blocks)
  {
    const UnitSystem& units = block->Units;
    const double energyUnit = units.FromCore(1.0, traits.Energy.Length, traits.Energy.Value);
    const Trajectory& path = *block->Path;
    const int last = static_cast<int>(path.Records().size()) - 1;
    for (int row = 0; row < rows; ++row)
    {
      const StepRecord& record = path.Records()[static_cast<std::size_t>(std::min(row, last))];
      StepRecord& sum = history.Records[static_cast<std::size_t>(row)];
      sum.Energy += record.Energy * energyUnit;
      sum.Clamped += record.Clamped;
      if (row <= last)
      {
        sum.Iterations += record.Iterations;
        sum.Residual = std::max(sum.Residual, record.Residual);
        sum.ErrorBound = std::max(sum.ErrorBound, units.FromCore(record.ErrorBound, 0.0, 1.0));
        sum.Seconds += record.Seconds;
      }
      for (Eigen::Index k = 0; k < path.State().cols(); ++k)
      {
        history.Totals[static_cast<std::size_t>(k)][static_cast<std::size_t>(row)] +=
          units.FromCore(path.TotalAt(std::min(row, last), static_cast<Index>(k)), 2.0,
            traits.StateHasUnitOfValues ? 1.0 : 0.0);
      }
    }
  }
  return history;
}

long long Run::CountUnusedPoints(const Reduction& processes) const
{
  Index count = 0;
  for (const auto& block : this->Blocks)
  {
    count += block->Surface->Diagnostics().UnusedPoints;
    if (block->Decomposition)
    {
      count -= block->Decomposition->NumberOfCopies();
    }
  }
  return static_cast<long long>(processes.Sum(static_cast<double>(count)));
}

bool Run::MaskChangesNothing(const Reduction& processes) const
{
  bool anyMask = false;
  bool anyMasked = false;
  bool anyData = false;
  for (const auto& block : this->Blocks)
  {
    anyMask = anyMask || block->HasMask;
    anyMasked = anyMasked || block->HasMasked;
    anyData = anyData || block->HasData;
  }
  anyMask = processes.Any(anyMask);
  anyMasked = processes.Any(anyMasked);
  anyData = processes.Any(anyData);
  const bool inert = this->Settings->MaskMode == MaskMode::Inpaint &&
    !(anyData && this->Settings->DescribeModel().MaskHasEffect);
  return anyMask && (!anyMasked || inert);
}

/// Over all steps computed so far.
Shortfalls Run::FindShortfalls() const
{
  Shortfalls found;
  for (const auto& block : this->Blocks)
  {
    for (const StepRecord& record : block->Path->Records())
    {
      ++found.Steps;
      found.MissedSteps += record.MissedResidual > 0.0;
      found.MissedResidual = std::max(found.MissedResidual, record.MissedResidual);
      found.UnsettledSteps += record.UnsettledDecrease > 0.0;
      found.UnsettledDecrease = std::max(found.UnsettledDecrease, record.UnsettledDecrease);
    }
    --found.Steps; // the initial state
    found.Inputs.Add(block->SurfaceVersion);
    found.Inputs.Add(block->FieldsVersion);
    found.MissedResidual = std::max(
      found.MissedResidual, std::max(block->Result.MissedResidual, block->Finished.MissedResidual));
  }
  return found;
}

std::vector<Warning> Run::FindWarnings(const Reduction& processes) const
{
  SurfaceDiagnostics sum;
  Fingerprint surfaces;
  Fingerprint masks;
  for (const auto& block : this->Blocks)
  {
    const SurfaceDiagnostics& found = block->Surface->Diagnostics();
    sum.DegenerateTriangles += found.DegenerateTriangles;
    sum.NonManifoldEdges += found.NonManifoldEdges;
    sum.CoincidentBoundaryPoints += found.CoincidentBoundaryPoints;
    sum.CoincidenceDistance = std::max(sum.CoincidenceDistance, found.CoincidenceDistance);
    sum.MergesPoints = found.MergesPoints;
    sum.EdgesLeft += found.EdgesLeft;
    surfaces.Add(block->SurfaceVersion);
    masks.Add(block->MaskVersion);
  }
  std::vector<Warning> warnings;
  const auto addCount = [&](Index here, const Sentence& sentence)
  {
    const auto count = static_cast<long long>(processes.Sum(static_cast<double>(here)));
    if (count > 0)
    {
      warnings.push_back({ Sentence() << count << sentence, surfaces });
    }
  };
  addCount(sum.DegenerateTriangles, " triangles of zero area were left out");
  addCount(
    sum.NonManifoldEdges, " edges have three or more triangles, which all exchange over them");
  processes.Max(&sum.CoincidenceDistance, 1);
  addCount(
    sum.CoincidentBoundaryPoints, SentenceOfCoincidence(sum, " and nothing flows between them"));
  addCount(sum.EdgesLeft,
    " edges of the intrinsic Delaunay triangulation could not be flipped within the limit of 50 "
    "checks per side, or at triangles that are nearly flat: values can leave the bounds of the "
    "data there");
  BlockSentences ofBlocks, ofFinish;
  Fingerprint inputs;
  double undetermined = 0.0;
  for (const auto& block : this->Blocks)
  {
    inputs.Add(block->SurfaceVersion);
    inputs.Add(block->FieldsVersion);
    ofBlocks.Add(block->Result.Warnings, block->Name);
    ofFinish.Add(block->Finished.Warnings, block->Name);
    undetermined += block->Undetermined.NumberOfComponents;
  }
  std::vector<Sentence> sentences;
  ofBlocks.AppendTo(sentences, this->Blocks.size());
  for (const Sentence& sentence : sentences)
  {
    warnings.push_back({ sentence, inputs });
  }
  sentences.clear();
  ofFinish.AppendTo(sentences, this->Blocks.size());
  for (const Sentence& sentence : sentences)
  {
    warnings.push_back({ sentence, inputs, WithoutFigures(sentence) });
  }
  const long long components = std::llround(processes.Sum(undetermined));
  if (components > 0)
  {
    warnings.push_back({ DescribeUndetermined(components), inputs });
  }
  if (this->LongEdges > 0.0 && !this->Settings->IsAbsolute() &&
    !this->Settings->DescribeModel().AbsoluteTime)
  {
    warnings.push_back({ SentenceOfLongEdges(this->LongEdges), surfaces });
  }
  const std::vector<const char*> inRange = this->Settings->DescribeModel().SettingsInRange;
  if (!inRange.empty() && !this->Settings->IsAbsolute() &&
    (this->WholeValueRange > OutlierFactor * this->RobustValueRange ||
      this->CommonUnits.ValueRange < this->WholeValueRange))
  {
    warnings.push_back({ DescribeOutliers(this->CommonUnits.ValueRange, this->WholeValueRange,
                           this->RobustValueRange, inRange),
      inputs });
  }
  const Shortfalls shortfalls = this->FindShortfalls();
  if (shortfalls.MissedResidual > 0.0)
  {
    warnings.push_back(
      { DescribeMissedTolerance(shortfalls), shortfalls.Inputs, "MissedResidual" });
  }
  if (shortfalls.UnsettledDecrease > 0.0)
  {
    warnings.push_back(
      { DescribeUnsettledSteps(shortfalls), shortfalls.Inputs, "UnsettledDecrease" });
  }
  masks.AddNumber(static_cast<std::uint64_t>(this->Settings->MaskMode));
  if (this->MaskChangesNothing(processes))
  {
    warnings.push_back({ "the mask changes nothing with these settings", masks });
  }
  return warnings;
}

} // namespace SurfaceDiffusion
