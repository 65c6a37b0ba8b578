// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Conversion/RefineTogether.h"

#include "Run/InputSentences.h"

#include <algorithm>
#include <numeric>

namespace SurfaceDiffusion
{

namespace
{

double Sum(const Processes& processes, double number)
{
  const std::vector<double> all = processes.GatherAll({ number });
  return std::accumulate(all.begin(), all.end(), 0.0);
}

} // namespace

bool RefineTogether(PieceRefinement& refinement, std::vector<SurfacePiece>& pieces,
  const RefinementTask& task, const Processes& processes, const ProgressMonitor& progress,
  std::vector<Sentence>& warnings)
{
  refinement.Begin();
  const int limit = task.MaximumNumberOfTriangles;
  double length = 0.0;
  double left = 0.0;
  const auto bisect = [&] { left = refinement.Bisect(pieces, length, limit, progress); };
  bool completed = true;
  double mean = 0.0;
  if (task.NeedsMeanEdgeLength)
  {
    PieceRefinement::EdgeSum edges;
    completed = task.Complete([&] { edges = refinement.SumEdges(pieces); });
    edges = { Sum(processes, edges.Length), Sum(processes, edges.Number) };
    mean = edges.Number > 0.0 ? edges.Length / edges.Number : 0.0;
  }
  Sentence reason;
  if (completed && limit > 0)
  {
    length = task.FindLength(mean, reason);
  }
  double triangles = 0.0;
  if (completed && length > 0.0)
  {
    const double asked = length;
    completed = task.Complete(bisect);
    const std::vector<double> all = processes.GatherAll({ left });
    const double longest = *std::max_element(all.begin(), all.end());
    if (completed && longest > 0.0)
    {
      warnings.push_back(Say("Stopped", longest, asked, limit));
      if (Sum(processes, static_cast<double>(pieces.size())) > 1.0)
      {
        length = longest; // in every piece, so that pieces of a surface fit
        completed = task.Complete(bisect);
      }
    }
    completed =
      completed && task.Complete([&] { triangles = refinement.Replace(pieces, task.Rules); });
    triangles = Sum(processes, triangles);
  }
  if (triangles > 0.0 && !reason.Words().empty())
  {
    warnings.push_back(Say("Bisected", static_cast<vtkIdType>(triangles), reason));
  }
  if (!completed)
  {
    refinement.Undo();
  }
  return completed;
}

} // namespace SurfaceDiffusion
