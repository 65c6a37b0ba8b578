// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Trajectory.h"
#include "Core/Operators/CellTransfer.h"
#include "Run/CellFields.h"
#include "Run/Fields.h"
#include "Run/Output.h"
#include "Run/Sentence.h"
#include "Run/SolverStore.h"
#include "Run/Units.h"

#include <algorithm>
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
  const Reduction& Processes;
  Eigen::Index Columns = 0; ///< of all panels of the data together; see Fields
  bool IsLastPanel = true; ///< of them
  bool DataAreTerms = false; ///< as in Fields
  std::vector<Index> Seeds; ///< per vertex, see MakeSeeds()
  const CellTransfer* Cells = nullptr; ///< that has made the data; null if they are on points
  Index LargestCellSeed = 0; ///< of seeds on cells, which vertices between cells do not have
  KnownValues Known = {}; ///< of models that use them
  std::vector<Index> GivenCells = {}; ///< as in Fields
  bool AreTangent = false; ///< the data are tangent vectors, as ModelTraits::Vectors asks
};

/// A run on one surface at its current step.
struct RunState
{
  const SurfaceDiffusion::Surface& Surface;
  const UnitSystem& Units;
  const Trajectory& Path;
  const CellState* Cells; ///< null unless the result is on cells
  const ParallelFor& Parallel;
  ProgressMonitor Progress;
};

/// What making the model of one surface, or finishing its results, has found.
struct RunResult
{
  bool HasMissing = false;
  std::vector<Output> Numbers; ///< that the model depends on, the same at every step
  /// Of the solves of Finish() or of that for InitialFill Harmonic; see StepReport.
  double MissedResidual = 0.0;
  /// Of the weights of AutomaticFidelity in the connected components, per vertex and column, or of
  /// all columns in one, by which the fidelity factors of the data are multiplied; no entry if there
  /// is one component.
  Values FidelityFactors;
  std::vector<Sentence> Warnings;

  void AddNumber(const std::string& name, double value, OutputType type = OutputType::Double)
  {
    this->Numbers.push_back(Output::OfNumber(name, value, Combination::Reported, type));
  }

  /// Add a warning that other steps may have added already.
  void WarnOnce(const Sentence& text)
  {
    if (std::find(this->Warnings.begin(), this->Warnings.end(), text) == this->Warnings.end())
    {
      this->Warnings.push_back(text);
    }
  }
};

} // namespace SurfaceDiffusion
