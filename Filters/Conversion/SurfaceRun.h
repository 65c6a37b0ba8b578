// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Conversion/PolyDataSurface.h"
#include "Core/Models/InitialState.h"
#include "Core/Models/Model.h"
#include "Core/Models/Trajectory.h"
#include "Core/Solvers/SolverChoice.h"
#include "Distributed/PointIdentity.h"

#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

class vtkDataArray;
class vtkPolyData;

namespace SurfaceDiffusion
{

class PiecePartition;

/// The input arrays of one block, resolved and checked.
struct BlockArrays
{
  vtkDataArray* Data = nullptr; ///< index 0
  vtkDataArray* Mask = nullptr; ///< index 1
  vtkDataArray* Direction = nullptr; ///< index 2
  bool DirectionOnCells = false;
  vtkDataArray* Fixed = nullptr; ///< index 3
  vtkDataArray* Rates = nullptr; ///< index 4
};

/// Lengths and values in the user's units and the core's. The core measures lengths in LengthUnit
/// and values in ValueUnit.
struct UnitSystem
{
  bool Natural = true;
  double MeanEdgeLength = 1.0; ///< h, in coordinate units
  double ValueRange = 1.0; ///< R, in the array's units
  double LengthUnit = 1.0; ///< of the core's mesh, in coordinate units
  double ValueUnit = 1.0; ///< of the core's values, in the array's units

  /// A user's quantity of dimension length^lengthPower value^valuePower in the core's units.
  double ToCore(double quantity, double lengthPower, double valuePower) const
  {
    const double length = (this->Natural ? this->MeanEdgeLength : 1.0) / this->LengthUnit;
    const double value = (this->Natural ? this->ValueRange : 1.0) / this->ValueUnit;
    return quantity * std::pow(length, lengthPower) * std::pow(value, valuePower);
  }
  /// The core's quantity in coordinate and array units.
  double FromCore(double quantity, double lengthPower, double valuePower) const
  {
    return quantity * std::pow(this->LengthUnit, lengthPower) *
      std::pow(this->ValueUnit, valuePower);
  }
};

/// What a model is made from.
struct ModelInput
{
  vtkPolyData* Block;
  const BlockArrays& Arrays;
  const PolyDataSurface& Surface;
  UnitSystem Units;
  PointData Data; ///< in ValueUnit
  TangentVectors Frames; ///< one row per triangle; no row without a direction
  std::vector<std::int64_t> Ids; ///< per vertex, for random numbers
  const ParallelFor& Parallel;
  ProgressMonitor Monitor;
  /// The solver the filter's properties ask for, kept from run to run under this name, so that an
  /// ordering or a factor still valid is used again.
  std::function<std::shared_ptr<LinearSolver>(const std::string& name, const SolverTask& task)>
    Solver;
  /// Do what may throw in one process and calls no other; then it throws in all.
  std::function<void(const std::function<void()>&)> Together;
  std::vector<std::string>& Warnings; ///< told to the user when all is done, once
};

/// What is kept of one block from update to update, each part as long as its key stays the same.
struct SurfaceRun
{
  std::string SurfaceKey;
  std::unique_ptr<PolyDataSurface> Surface;
  std::shared_ptr<PiecePartition> Partition; ///< null where the surface is whole
  PointIdentity Identity; ///< of a piece's points
  std::map<std::string, std::shared_ptr<LinearSolver>> Solvers;
  std::string RunKey;
  bool HasMissing = false;
  UnitSystem Units;
  std::unique_ptr<Trajectory> Path;
  std::vector<std::string> Warnings; ///< of the model
};

} // namespace SurfaceDiffusion
