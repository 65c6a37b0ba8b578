// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Trajectory.h"
#include "Core/Surface/EdgeLengths.h"
#include "Run/CellFields.h"
#include "Run/Fields.h"
#include "Run/Fingerprint.h"
#include "Run/History.h"
#include "Run/ModelInputs.h"
#include "Run/SolverStore.h"
#include "Run/Undetermined.h"
#include "Run/VectorSettings.h"
#include "Run/WarningLog.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace SurfaceDiffusion
{

/// The domain decomposition of one surface over processes. All calls are collective.
class Decomposition
{
public:
  virtual ~Decomposition() = default;
  /// A power of two near the size of the whole surface.
  virtual double FindLengthUnit() = 0;
  /// Give the surface its reductions, and the store its solvers over processes.
  virtual void Attach(Surface& surface, SolverStore& solvers) = 0;
  /// Points that are copies of another process's points.
  virtual Index NumberOfCopies() const = 0;
};

/// One surface with its fields. The arrays are read only if their fingerprint has changed.
struct BlockInput
{
  std::string Name = {}; ///< of a block of several, for messages; otherwise empty
  Fingerprint SurfaceVersion;
  Fingerprint FieldsVersion;
  std::function<SurfaceArrays()> ReadSurface;
  std::function<Fields()> ReadFields;
  SurfaceDiffusion::Decomposition* Decomposition = nullptr; ///< null: the surface is whole
};

/// The steps, over all surfaces, whose solves or repetitions ended before they had converged.
struct Shortfalls
{
  Index Steps = 0; ///< of all
  Index MissedSteps = 0;
  double MissedResidual = 0.0; ///< the largest; see StepReport
  Index UnsettledSteps = 0;
  double UnsettledDecrease = 0.0; ///< the largest; see StepReport
  Fingerprint Inputs; ///< of all surfaces
};

/// A run of one model on several surfaces that share their units. A run is determined by its inputs
/// and settings: Update() recomputes only the parts that depend on a changed input or setting.
class Run
{
public:
  explicit Run(const ParallelFor& parallel)
    : Parallel(parallel)
  {
  }

  /// Take the inputs and the settings, which must have passed Check(). Throws std::runtime_error,
  /// std::bad_alloc, and Aborted, after which a later Update() continues.
  void Update(const std::vector<BlockInput>& inputs, std::shared_ptr<RunSettings> settings,
    const Reduction& processes, const ProgressMonitor& progress);

  /// The last step of the run: of all steps, or where the last surface has become stationary. A run
  /// that may end early is computed to its end, once.
  int FindLastStep(const ProgressMonitor& progress);

  /// The number of steps that Seek() would compute.
  Index NumberOfStepsTo(int step) const;
  /// Move all surfaces to a step, and finish their results there.
  void Seek(int step, const ProgressMonitor& progress);

  /// Whether the history has the energy and the totals of each state, for which every state is read
  /// once more. Default: true. Counts from the next Update() on.
  void SetKeepsHistory(bool keeps) { this->KeepsHistory = keeps; }

  void Clear() { this->Blocks.clear(); }

  /// One surface of the run.
  struct Block
  {
    std::string Name; ///< as in BlockInput
    std::unique_ptr<SurfaceDiffusion::Surface> Surface; ///< without undetermined components
    /// The surface with them; null if there are none.
    std::unique_ptr<SurfaceDiffusion::Surface> WholeSurface;
    UnitSystem Units;
    std::unique_ptr<Trajectory> Path;
    RunResult Result, Finished; ///< of RunSettings::Make() and of Finish()
    std::vector<Output> Outputs; ///< of RunSettings::Finish(), and Result.Numbers
    int FinishedStep = -1; ///< the step of Outputs
    SettingsSnapshot FinishSettings; ///< of scope Output, that they were made with
    std::unique_ptr<CellState> Cells; ///< null unless the data are on cells

    /// The inputs and settings that the parts above were made from.
    Fingerprint SurfaceVersion, FieldsVersion;
    SettingsSnapshot SurfaceSettings, ModelSettings;
    std::size_t NumberOfBlocks = 0;
    double TimeStep = 0.0;
    int NumberOfSteps = 0; ///< of a model that depends on it
    std::optional<EdgeLengths> Edges; ///< of Surface, once they are measured
    ValueStatistics Statistics;
    SurfaceDiffusion::Undetermined Undetermined;
    bool HasData = false;
    TangentShare Tangents; ///< of VectorType Automatic
    bool AreTangent = false; ///< the model takes the data as tangent vectors
    bool IsInCellPlanes = false; ///< results at cells are
    bool HoldsDetail = false; ///< Path has the detail of the cells
    bool HasLinearLight = false; ///< the state is linear light of sRGB values
    double Period = 0.0; ///< of data of which the state has unit vectors, see Angles.h; 0: none
    ValueBounds Angles; ///< of these data
    double BeginOfAngles = 0.0; ///< of those of all blocks
    bool IsCoded() const { return this->HasLinearLight || this->Period > 0.0; }
    bool HasMask = false;
    bool HasMasked = false; ///< a nonzero entry of the mask
    Fingerprint MaskVersion;
    SolverStore Solvers;
    SurfaceDiffusion::Decomposition* Decomposition = nullptr;

    /// Data as the model has them, and its values as those of the data: sRGB values or angles.
    void Encode(Values& values, const ParallelFor& parallel) const;
    void Decode(Values& values, const ParallelFor& parallel) const;
    /// The current state in array units as values of the data.
    Values DecodedState(const ParallelFor& parallel) const;
    /// MakeCellResult() of the current state; given: the data on cells in array units, likewise.
    Values CellResult(Values given, bool keepDetail, const ParallelFor& parallel) const;
  };
  const Block& GetBlock(std::size_t block) const { return *this->Blocks[block]; }
  /// The first block with a vertex, whose numbers stand for those of all.
  const Block& ReportedBlock() const;
  std::size_t NumberOfBlocks() const { return this->Blocks.size(); }

  /// h and R of all surfaces together, in coordinate and array units.
  const UnitSystem& Units() const { return this->CommonUnits; }
  /// The unit of time in coordinate and array units; 1 if times are absolute.
  double TimeUnit() const { return this->UnitOfTime; }
  /// The number of steps computed by Seek() in the life of this object.
  long long NumberOfStepsComputed() const { return this->StepsComputed; }

  /// The history up to a step.
  History MakeHistory(int step) const;

  /// The number of points, of all surfaces and processes together, that no participating triangle
  /// uses and that keep their values. Points excluded by the mask do not count.
  long long CountUnusedPoints(const Reduction& processes) const;

  /// The warnings that hold, with the inputs that each is about.
  std::vector<Warning> FindWarnings(const Reduction& processes) const;

private:
  bool IsModelCurrent(const Block& block, const BlockInput& input, const SettingsSnapshot& settings,
    const ModelTraits& traits) const;
  void UpdateSurfaces(const std::vector<BlockInput>& inputs, const Reduction& processes,
    const ProgressMonitor& progress);
  std::unique_ptr<Surface> MakeSurface(const BlockInput& input, const Reduction& processes,
    std::vector<char> undetermined, const ProgressMonitor& progress) const;
  void ReadFields(const BlockInput& input, const Reduction& processes, Block& block,
    std::unique_ptr<Fields>& fields, const ProgressMonitor& progress);
  void LeaveOutUndetermined(const BlockInput& input, const Fields& fields,
    const Reduction& processes, Block& block, const ProgressMonitor& progress);
  void RequireKnownValue(
    const std::vector<std::unique_ptr<Fields>>& fields, const Reduction& processes) const;
  void MeasureUnits(const Reduction& processes);
  bool AreTangent() const;
  void MakeModel(Block& block, const Fields& fields, const Reduction& processes,
    const ProgressMonitor& progress);
  PointData MakeData(Block& block, const Fields& fields, const Reduction& processes) const;
  std::size_t CheckpointMemory(const Model& model, const Reduction& processes) const;
  void CheckHold(const Reduction& processes) const;
  Shortfalls FindShortfalls() const;
  bool MaskChangesNothing(const Reduction& processes) const;

  const ParallelFor& Parallel;
  std::shared_ptr<RunSettings> Settings;
  std::vector<std::unique_ptr<Block>> Blocks;
  UnitSystem CommonUnits;
  double WholeValueRange = 0.0, RobustValueRange = 0.0; ///< see ValueStatistics
  TangentShare Tangents; ///< of all surfaces
  double LongEdges = 0.0; ///< the number of edges that do not count for h
  double UnitOfTime = 1.0;
  long long StepsComputed = 0;
  bool KeepsHistory = true;
};

} // namespace SurfaceDiffusion
