// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/DistanceSources.h"
#include "Run/SurfaceRun.h"
#include "Run/WarningLog.h"

#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

enum class DistanceMethod
{
  Heat,
  Eikonal
};

/// Distances from sources in the user's terms.
struct DistanceSettings : Settings
{
  DistanceMethod Method = DistanceMethod::Heat;
  double MaximumDistance = 0.0;
  double AlongSpeed = 1.0;
  double AcrossSpeed = 1.0;
  bool ComputeGradient = false;
  bool MergeCoincidentPoints = false;
  double MergeTolerance = 0.0;

  void Visit(SettingVisitor& visitor) override;
  void Check(const FieldSummary* fields, Problems& problems) override;

  bool IsDirected() const { return this->AlongSpeed != this->AcrossSpeed; }
  /// Whether fronts have another speed than 1, apart from that of an array.
  bool HasSpeed() const { return this->AlongSpeed != 1.0 || this->AcrossSpeed != 1.0; }
};

/// Distances or arrival times on one surface, kept as long as neither inputs nor settings change.
class DistanceRun : public SurfaceRun
{
public:
  explicit DistanceRun(const ParallelFor& parallel)
    : SurfaceRun(parallel, "are barriers", ", across which no path leads")
  {
  }

  /// Data, with a row per point, or Sources, and Speeds and StartTimes of the fields are read. A
  /// surface without source has infinite distances.
  void Update(const BlockInput& input, Settings& given, const ProgressMonitor& progress) override;
  bool ExcludesMasked() const override { return true; }

  /// Throws InputError, which says why, if none of the surfaces has a source. If all triangles that
  /// the mask leaves have no area, that is no error.
  static void RequireSource(const std::vector<const DistanceRun*>& runs);

private:
  /// The sources as fronts and as heat, and what NearestSource says of each label.
  struct SourceSet
  {
    std::vector<FrontSource> Fronts;
    std::vector<HeatSource> Heat;
    std::vector<double> NameOfLabel;
    Index Count = 0; ///< of sources on the surface
    Index Given = 0; ///< of all
    Index TooFar = 0, Outside = 0;
    bool AreShapes = false;
    Sentence Farness; ///< of shapes: a warning, or empty
  };

  std::vector<Warning> FindOwnWarnings() const override;
  FrontShapes MakeShapes(const Fields& fields, const DistanceSettings& settings) const;
  SourceSet FindSources(const BlockInput& input, const Fields& fields, const FrontShapes& triangles,
    double maximumDistance, const ProgressMonitor& progress);
  SourceSet FindMarked(const Fields& fields) const;
  SourceSet FindProjected(const BlockInput& input, const SourceShapes& shapes,
    const FrontShapes& triangles, double maximumDistance, const ProgressMonitor& progress);
  GeodesicDistance::Arrival Solve(const SourceSet& sources, FrontShapes triangles,
    const DistanceSettings& settings, const ProgressMonitor& progress);
  Vector SolveHeat(const SourceSet& sources, const ProgressMonitor& progress);
  Values FindGradient(const std::vector<double>& times, const FrontShapes& triangles) const;

  SourceSet Found; ///< without its fronts
  bool AllAreSources = false;
  /// Of the surface, kept for other sources.
  std::shared_ptr<const Assembler> HeatOperators;
  std::unique_ptr<const HeatDistance> Heat;
  std::unique_ptr<const SourceProjection> Projection;
  Fingerprint ProjectionVersion;
};

} // namespace SurfaceDiffusion
