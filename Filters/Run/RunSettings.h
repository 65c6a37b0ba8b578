// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/InitialState.h"
#include "Core/Models/Model.h"
#include "Core/Solvers/LinearSolver.h"
#include "Core/Solvers/SolverChoice.h"
#include "Run/Settings.h"
#include "Run/Units.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

struct ModelInputs;
struct Output;
struct RunResult;
struct RunState;

enum class UnitsMode
{
  Natural,
  Absolute
};

enum class MaskMode
{
  Inpaint, ///< masked points are missing and are filled in
  Exclude ///< triangles with a masked vertex are ignored
};

enum class TimeIntegrator
{
  FirstOrder,
  SecondOrder,
  Implicit,
  Exponential,
  Automatic
};

/// The properties of the input arrays that the settings have to agree with.
struct FieldSummary
{
  bool Data = false;
  int DataComponents = 0; ///< alpha of colours not counted
  Word DataName = Word::Array("InputArray");
  bool Directions = false;
  bool Fixed = false;
  bool Rates = false;
  bool DataAreTerms = false; ///< the data are the data terms of a segmentation, one per region
  bool Sources = false; ///< points or lines, in place of data
  bool Speeds = false, AlongSpeeds = false, AcrossSpeeds = false;
  bool StartTimes = false;
  int SlopeErrorComponents = 0; ///< 0: there are no errors of slopes
  bool PathPoints = false;
};

/// Append a problem if factors along and across a direction differ and there are no directions.
/// along, across: the names of their settings.
void RequireDirections(const FieldSummary& fields, const char* along, double ofAlong,
  const char* across, double ofAcross, Problems& problems);

/// For systems without inertia, whose errors exceed residuals by far: a hole in nine tenths of a
/// sphere, filled to 1e-6, is off by 1e-3 of the range (41k vertices). They are solved to 1e-10;
/// what conjugate gradients reach on the largest surfaces is an answer with a warning.
IterationLimits WithoutInertia(IterationLimits limits);

/// How data of three components are taken.
enum class VectorType
{
  Automatic, ///< Tangent if they are: see TangentShare
  Components, ///< as so many scalars
  Tangent ///< as tangent vectors, three components each
};

/// The properties of a model that a run needs before it makes the model. By default it has no time:
/// its state is computed in one step.
struct ModelTraits
{
  bool IsSteady = true; ///< there are no times, neither of the start nor of the one step
  int NumberOfSteps = 1;
  double TimeStep = 1.0; ///< in the unit that TimeStep is in
  /// The model itself depends on NumberOfSteps, and not only how far it runs.
  bool DependsOnNumberOfSteps = false;
  std::size_t CheckpointMemory = 0; ///< in bytes, for states to which a run goes back
  SolverMethod Solver = SolverMethod::Automatic; ///< of linear systems
  IterationLimits Limits; ///< of the same
  bool AbsoluteTime = false; ///< times are in coordinate units even with natural units
  Dimension Time; ///< of the natural unit of time
  double TimeFactor = 1.0; ///< of the natural unit of time, beyond its dimension
  Dimension Energy;
  bool HasValueRange = true; ///< false: R is 1
  /// The settings measured in R that the result depends on, for a warning.
  std::vector<const char*> SettingsInRange;
  bool StateHasUnitOfValues = true; ///< false: u is a pure number
  bool UsesFidelity = false;
  /// Data of fidelity factor 0 have no effect, also not as the start of time steps.
  bool WeightlessAreMissing = true;
  bool UsesKnownValues = false; ///< see KnownValues; the data may be samples
  bool EstimatesNoise = false; ///< needs PointData::Measured
  double MaximumDistance = 0.0; ///< of samples from the surface; 0: any
  std::vector<double> MissingValues = {}; ///< stand for NaN in data and samples
  bool NeedsDirections = false; ///< diffusivities along and across differ
  bool HoldsKnownValues = false;
  /// No column of the state depends on other ones or on their number, given the missing points.
  bool ColumnsAreIndependent = false;
  bool MaskHasEffect = true; ///< in mode Inpaint, if there are data
  bool MayEndEarly = false; ///< the state may become stationary before the last step
  bool CountsClamped = false;
  bool BoundsError = false; ///< steps report a bound of their error
  bool UsesRandomNumbers = false;
  bool StartsFromKnownValues = false; ///< a component without any is left out, see Undetermined
  bool ResultOnCells = false; ///< if the data are on cells
  bool KeepCellDetail = true;
  bool NeedsCellDetail() const { return this->KeepCellDetail && this->ResultOnCells; }
  const char* ResultSuffix = ""; ///< of the name of the result, after that of the data
  bool StateIsUnitVectors = false;
  bool StateIsLines = false; ///< unit vectors whose sign has no meaning
  double Period = 0.0; ///< of the data, see Angles.h; 0: none
  VectorType Vectors = VectorType::Components;
  bool DropsNormalPart = true; ///< of tangent vectors
  bool CanBeDistributed = true; ///< solved by processes with a piece of the surface each
  bool UsesLinearLight = false; ///< unsigned char colours are in sRGB, see LinearLight.h
};

/// The settings that every model has, in the user's terms. A subclass describes its model with four
/// virtual functions: Visit() lists the settings, DescribeModel() gives the traits, Make() makes
/// the model and Finish() lists its results. CheckTogether() has a default.
struct RunSettings : Settings
{
  UnitsMode Units = UnitsMode::Natural;
  SurfaceDiffusion::MaskMode MaskMode = SurfaceDiffusion::MaskMode::Inpaint;
  int RandomSeed = 0;
  bool IntrinsicDelaunay = false;
  bool MergeCoincidentPoints = false;
  double MergeTolerance = 0.0;

  void Visit(SettingVisitor& visitor) override;

  /// The traits of the model. The settings have passed Check().
  virtual ModelTraits DescribeModel() const = 0;

  /// The model in its initial state. Throws std::runtime_error and Aborted.
  virtual std::unique_ptr<Model> Make(ModelInputs& inputs, RunResult& result) const = 0;

  /// What the model returns at the current step, except for the numbers of Make(), in the order in
  /// which it is written. It may take long or fail. The default returns the state as the result of
  /// the data.
  virtual std::vector<Output> Finish(const RunState& state, RunResult& result) const;

  /// Problems of single settings and of settings that do not go together, all at once.
  void Check(const FieldSummary* fields, Problems& problems) override;

  bool IsAbsolute() const { return this->Units == UnitsMode::Absolute; }

protected:
  virtual void CheckTogether(const FieldSummary* fields, Problems& problems) const;
  /// Of models that have no result without data.
  static void RequireData(const FieldSummary* fields, Problems& problems);
};

/// The settings of a model with time steps: the steps, which of them are published, and the linear
/// solver of each.
struct TimeSettings : RunSettings
{
  double TimeStep = 1.0;
  int NumberOfTimeSteps = 10;
  bool GenerateTimeSteps = false;
  int OutputInterval = 1;
  int CheckpointMemoryLimit = 512;
  SolverMethod Solver = SolverMethod::Automatic;
  double Tolerance = 1e-10;
  int MaximumNumberOfIterations = 1000;

  void Visit(SettingVisitor& visitor) override;

  /// Whether there are published times.
  bool PublishesTimes() const { return this->GenerateTimeSteps && !this->DescribeModel().IsSteady; }
  /// The times of the published states of a run that ends at step `last`, in the unit of TimeStep.
  std::vector<double> PublishedTimes(int last) const;
  /// The step of the last of them at or before `time`.
  int FindStep(double time, int last) const;

protected:
  /// The traits that follow from these settings. steady: whether the others ask for the steady
  /// state in one step.
  ModelTraits DescribeSteps(bool steady = false) const;
  void CheckTogether(const FieldSummary* fields, Problems& problems) const override;
};

/// The settings of models of given data: fidelity, diffusivities, and the start on missing points.
struct DataSettings : TimeSettings
{
  double FidelityWeight = 0.0;
  SurfaceDiffusion::InitialFill InitialFill = SurfaceDiffusion::InitialFill::Mean;
  bool HoldKnownValues = false;
  double AlongDiffusivity = 1.0;
  double AcrossDiffusivity = 1.0;
  bool ResultOnCells = true;
  bool KeepCellDetail = true;

  void Visit(SettingVisitor& visitor) override;

  bool IsDirected() const { return this->AlongDiffusivity != this->AcrossDiffusivity; }
  double LargestDiffusivity() const;
  double Anisotropy() const; ///< of SolverTask

protected:
  void CheckTogether(const FieldSummary* fields, Problems& problems) const override;
};

/// The settings MergeCoincidentPoints and MergeTolerance.
void VisitMerging(SettingVisitor& visitor, bool& merge, double& tolerance);

/// The setting TimeIntegrator of a model with these time integrators.
void VisitTimeIntegrator(SettingVisitor& visitor, TimeIntegrator& integrator,
  const std::vector<bool>& allowed, const char* onlyIf = "");

/// The setting ResultOnCells.
void VisitResultOnCells(SettingVisitor& visitor, bool& onCells);

/// The settings AutomaticFidelity, which is offered under the condition, and NoiseLevel.
void VisitAutomaticFidelity(
  SettingVisitor& visitor, bool& automatic, double& noiseLevel, const char* onlyIf);

} // namespace SurfaceDiffusion
