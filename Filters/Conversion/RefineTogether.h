// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Conversion/PieceRefinement.h"
#include "Distributed/Processes.h"
#include "Run/Sentence.h"

#include <functional>
#include <string>
#include <vector>

namespace SurfaceDiffusion
{

/// How the surfaces of one update are refined, in all processes alike.
struct RefinementTask
{
  bool NeedsMeanEdgeLength = false; ///< for FindLength, which is given 0 otherwise
  int MaximumNumberOfTriangles = 0; ///< of a piece
  RefinementRules Rules;
  /// The length above which edges are bisected; 0: the surfaces stay as they are. It appends to the
  /// explanation what a warning should say of the reason.
  std::function<double(double meanEdgeLength, Sentence& explanation)> FindLength;
  /// Does a step in this process. Whether all processes have completed it.
  std::function<bool(const std::function<void()>& step)> Complete;
};

/// Bisect the long edges of the pieces and replace these. Appends warnings. False, in all
/// processes: one was aborted or has failed, and the pieces of the outputs are the given ones.
/// Collective.
bool RefineTogether(PieceRefinement& refinement, std::vector<SurfacePiece>& pieces,
  const RefinementTask& task, const Processes& processes, const ProgressMonitor& progress,
  std::vector<Sentence>& warnings);

} // namespace SurfaceDiffusion
