// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geometry/RegionBoundaries.h"
#include "Core/Geometry/RidgeCurves.h"
#include "Core/Geometry/VertexUpdating.h"
#include "Core/Models/Trajectory.h"
#include "Core/Operators/CellTransfer.h"
#include "Run/Fields.h"
#include "Run/SolverStore.h"
#include "Run/Units.h"

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

namespace SurfaceDiffusion
{

/// The inputs of a model: one surface with its fields, in units of the numerics.
struct ModelInputs
{
  const SurfaceDiffusion::Surface& Surface;
  UnitSystem Units;
  PointData Data; ///< in ValueUnit; Start is not filled yet
  TangentVectors Directions; ///< e1 per triangle of Surface.Mesh(); no row if there is none
  Values Rates; ///< as in Fields
  std::vector<std::int64_t> Ids; ///< per vertex, for random numbers
  const ParallelFor& Parallel;
  ProgressMonitor Progress;
  SolverStore& Solvers;
  const ProcessGroup& Processes;
  Eigen::Index Columns = 0; ///< of all panels of the data together; see Fields
  bool IsLastPanel = true; ///< of them
  bool DataAreTerms = false; ///< as in Fields
  std::vector<Index> Seeds; ///< per vertex, see MakeSeeds()
  const CellTransfer* Cells = nullptr; ///< that has made the data; null if they are on points
  Index LargestCellSeed = 0; ///< of seeds on cells, which vertices between cells do not have
};

/// The regions of a segmentation at the current step, in coordinate and array units.
struct RegionResults
{
  std::vector<Index> Labels; ///< 1 .. K per vertex
  Values Means; ///< c, a row per region; no row if data terms are given
  Values DataMeans; ///< of the data over the known vertices of each region, likewise
  Vector Areas; ///< within the boundaries
  Vector BoundaryLengths;
  std::vector<Index> Components; ///< the number of connected ones
  RegionBoundaries Boundaries;
  double Gap = 0.0; ///< of the relaxed problem, see Segmentation
  double LabelGap = 0.0;
  int NumberOfAlternations = 0;
};

/// A run on one surface at its current step.
struct RunState
{
  const SurfaceDiffusion::Surface& Surface;
  const UnitSystem& Units;
  const Trajectory& Path;
  const ParallelFor& Parallel;
  ProgressMonitor Progress;
};

/// The results of a run on one surface other than its states.
struct RunResult
{
  bool HasMissing = false;
  double EffectiveFidelityWeight = 0.0; ///< lambda, in the unit of FidelityWeight
  /// Of edges, on the connected component with the most vertices: in the units of EdgeThreshold and
  /// of SmoothingLength, and in array units.
  double EffectiveEdgeThreshold = 0.0;
  double EffectiveSmoothingLength = 0.0;
  double EstimatedNoiseLevel = 0.0;
  double Wavelength = 0.0; ///< of a texture, in coordinate units
  double WavelengthGrowthRate = 0.0;
  double DiffusionRateFactor = 1.0;
  Index CoarseStartVertices = 0; ///< of the coarser mesh on which a texture grew; 0: there is none
  std::array<double, 2> ContrastLimits = { 0.0, 1.0 }; ///< of a texture, at the current step
  Points MovedPoints; ///< per input point, if vertices were moved; otherwise no row
  VertexMotion Motion;
  Vector Edges; ///< 1 - v of the Mumford-Shah model, per vertex
  Polylines EdgeCurves; ///< its ridges, in coordinate units
  std::shared_ptr<const RegionResults> Regions; ///< of a segmentation
  TangentVectors DiffusionAxes; ///< e of the strongest diffusion per triangle; no row: none
  double MissedResidual = 0.0; ///< of the solve for InitialFill Harmonic; see StepReport
  bool HasUnfinishedMinimum = false; ///< a minimisation ended above its tolerance
  std::vector<std::string> Warnings;

  /// Add a warning that other steps may have added already.
  void WarnOnce(const std::string& text)
  {
    if (std::find(this->Warnings.begin(), this->Warnings.end(), text) == this->Warnings.end())
    {
      this->Warnings.push_back(text);
    }
  }
};

} // namespace SurfaceDiffusion
