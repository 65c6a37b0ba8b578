// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/Run.h"

#include <algorithm>

namespace SurfaceDiffusion
{

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
          units.FromCore(path.TotalAt(std::min(row, last), static_cast<Index>(k)), 2.0, 1.0);
      }
    }
  }
  return history;
}

bool Run::MaskChangesNothing(const ProcessGroup& processes) const
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

std::vector<std::string> Run::TakeWarnings(const ProcessGroup& processes)
{
  SurfaceDiagnostics sum;
  for (const auto& block : this->Blocks)
  {
    const SurfaceDiagnostics& found = block->Surface->Diagnostics();
    sum.DegenerateTriangles += found.DegenerateTriangles;
    sum.UnusedPoints += found.UnusedPoints;
    if (block->Decomposition)
    {
      sum.UnusedPoints -= block->Decomposition->NumberOfCopies();
    }
    sum.NonManifoldEdges += found.NonManifoldEdges;
    sum.CoincidentBoundaryPoints += found.CoincidentBoundaryPoints;
  }
  if (this->WarnAgain)
  {
    this->Reported.clear();
    this->WarnAgain = false;
  }
  std::vector<std::string> sentences;
  const auto add = [&](const std::string& sentence)
  {
    if (std::find(this->Reported.begin(), this->Reported.end(), sentence) == this->Reported.end())
    {
      sentences.push_back(sentence);
      this->Reported.push_back(sentence);
    }
  };
  const auto addCount = [&](Index here, const char* sentence)
  {
    const auto count = static_cast<long long>(processes.Sum(static_cast<double>(here)));
    if (count > 0)
    {
      add(std::to_string(count) + sentence);
    }
  };
  addCount(sum.DegenerateTriangles, " triangles of zero area were left out");
  addCount(sum.UnusedPoints, " points that no triangle uses keep their values");
  addCount(
    sum.NonManifoldEdges, " edges have three or more triangles, which all exchange over them");
  addCount(sum.CoincidentBoundaryPoints,
    " boundary points coincide with others and nothing flows between them (to join them, set "
    "MergeCoincidentPoints)");
  for (const auto& block : this->Blocks)
  {
    for (const std::string& sentence : block->Result.Warnings)
    {
      add(sentence);
    }
  }
  if (this->MaskChangesNothing(processes))
  {
    add("the mask changes nothing with these settings");
  }
  return sentences;
}

} // namespace SurfaceDiffusion
