// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Fields/RandomField.h"
#include "Run/SurfaceRun.h"
#include "Run/WarningLog.h"

#include <memory>

namespace SurfaceDiffusion
{

/// Random fields in the user's terms.
struct RandomFieldSettings : Settings
{
  enum class Kind
  {
    Gaussian,
    MaternNu1,
    MaternNu3,
    Matern
  };

  Kind Covariance = Kind::Gaussian;
  double FWHM = 0.0;
  double Range = 0.0;
  double Smoothness = 1.0;
  int NumberOfFields = 1;
  int RandomSeed = 0;
  bool Normalize = true;
  bool MergeCoincidentPoints = false;
  double MergeTolerance = 0.0;

  void Visit(SettingVisitor& visitor) override;

  /// nu of Matern's covariance
  double Nu() const;

  /// FWHM or Range, in units of length; 10 and 20 mean edges h for 0.
  double Width(double h) const;
};

/// Random fields on one surface, kept as long as neither inputs nor settings change.
class RandomFieldRun : public SurfaceRun
{
public:
  explicit RandomFieldRun(const ParallelFor& parallel)
    : SurfaceRun(parallel, "have no field", ", across which the field does not continue")
  {
  }

  /// No field is read but for the ids of points.
  void Update(const BlockInput& input, Settings& given, const ProgressMonitor& progress) override;
  bool ExcludesMasked() const override { return true; }

private:
  /// About widths that do not suit the mesh, and about solves that missed their tolerance.
  std::vector<Warning> FindOwnWarnings() const override;

  Sentence Unresolved; ///< empty if the mesh resolves the width
  bool IsInEdges = false; ///< the width is in h
  Sentence UnlikeEdges; ///< empty unless components need widths of their own
  double MissedResidual = 0.0;
};

} // namespace SurfaceDiffusion
