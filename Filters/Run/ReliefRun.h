// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geometry/Relief.h"
#include "Run/SurfaceRun.h"
#include "Run/WarningLog.h"

#include <vector>

namespace SurfaceDiffusion
{

/// Relief from values at points, in the user's terms.
struct ReliefSettings : Settings
{
  double Height = 1.0;
  double Base = 0.0;
  int Levels = 0; ///< 0: smooth, 1: two
  double Threshold = 0.5;
  double Flank = 0.0;
  double Overhang = -1.0; ///< -1: faces of any direction have relief
  std::vector<double> UpDirection = { 0.0, 0.0, 1.0 };
  bool MergeCoincidentPoints = false;
  double MergeTolerance = 0.0;

  void Visit(SettingVisitor& visitor) override;
  void Check(const FieldSummary* fields, Problems& problems) override;
};

/// The relief of one surface, kept as long as neither inputs nor settings change.
class ReliefRun : public SurfaceRun
{
public:
  explicit ReliefRun(const ParallelFor& parallel)
    : SurfaceRun(parallel, "have no normal", nullptr)
  {
  }

  /// Data, of one column at points, and Mask of the fields are read.
  void Update(const BlockInput& input, Settings& given, const ProgressMonitor& progress) override;

  /// The row of the input's triangles and whether the relief has it the other way round.
  const std::vector<char>& TurnedTriangles() const { return this->Turned; }

  /// Per point, see FindWalls(); infinite for points that others represent.
  const std::vector<double>& PointWalls() const { return this->Walls; }

private:
  std::vector<Warning> FindOwnWarnings() const override;
  Vector MakeHeights(
    const BlockInput& input, const ReliefSettings& settings, const Triangles& triangles);
  void ListResults(const Triangles& triangles, const Relief& relief);

  std::vector<Sentence> Sentences;
  std::vector<char> Turned;
  std::vector<double> Walls;
};

} // namespace SurfaceDiffusion
