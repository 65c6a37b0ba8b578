// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/TotalVariationSettings.h"

#include "Core/Models/ChromaticityBrightness.h"
#include "Core/Models/EdgeFunctions.h"
#include "Core/Models/Harmonic/HarmonicMap.h"
#include "Core/Models/NonlinearDiffusion.h"
#include "Core/Models/OpponentColors.h"
#include "Core/Models/TotalVariation/CrouzeixRaviart.h"
#include "Core/Models/TotalVariation/TotalVariationDeblurring.h"
#include "Core/Models/TotalVariation/TotalVariationFlow.h"
#include "Core/Operators/CotanWeights.h"
#include "Run/DataPreparation.h"
#include "Run/FidelitySearch.h"
#include "Run/ModelInputs.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

/// L1 fidelity of the lagged scheme is rounded below this distance, in R.
constexpr double L1Rounding = 1e-3;

/// The smallest duality gaps of the minimisers that the search for lambda computes: the discrepancy of
/// deblurring needs a smaller one.
constexpr double SearchTolerance = 1e-2;
constexpr double BlurSearchTolerance = 1e-3;

/// The gradient at which the diffusivity is judged for the choice of a solver, in R/h.
constexpr double TypicalGradient = 0.01;

/// The time step of the alternations towards a steady state of ChromaticityBrightness, in natural
/// units. Longer ones take fewer alternations of more iterations each.
constexpr double SteadyTimeStep = 1e3;

/// Makes the models that TotalVariationSettings ask for. Models of values at edges
/// (CrouzeixRaviart) and of colours are made of models of their channels.
class TotalVariationModels
{
public:
  TotalVariationModels(const TotalVariationSettings& options, ModelInputs& inputs);

  /// One unit of FidelityWeight in units of the numerics.
  double FidelityUnit() const;

  /// The lambda of AutomaticFidelity, in units of the numerics: that of the model and steps of the
  /// run itself.
  FidelityWeights FindWeights(RunResult& result) const;

  /// Prepares the edges for CrouzeixRaviart. This takes seconds for a million vertices. In the
  /// background it does not delay an abort.
  void MakeEdges();

  /// The model of the settings, with its steady states and implicit steps to the tolerance.
  std::unique_ptr<Model> Make(PointData data, double fidelity, double tolerance) const;

private:
  struct EdgeUnknowns
  {
    std::shared_ptr<const MedialMesh> Mesh;
    std::shared_ptr<const Assembler> Operators;
  };
  /// What the models of one run on one mesh have in common.
  struct Task
  {
    std::shared_ptr<const Assembler> Operators;
    double Fidelity;
    double Tolerance;
    double TimeStep; ///< not of steady states
    bool IsSteady;
    bool ConservesTotal;
    std::vector<double> ChannelWeights; ///< see Fidelity
  };

  std::unique_ptr<Model> MakeOn(std::shared_ptr<const Assembler> assembler, PointData data,
    double fidelity, double tolerance) const;
  std::unique_ptr<Model> MakeOfChannels(const Task& task, PointData data) const;
  std::unique_ptr<Model> MakeChromaticityBrightness(Task task, PointData data) const;
  std::unique_ptr<HarmonicMap> MakeChromaticity(const Task& task, PointData data) const;
  std::unique_ptr<DataModel> MakeDiffusion(const Task& task, PointData data) const;
  std::unique_ptr<NonlinearDiffusion> MakeLagged(const Task& task, PointData data) const;
  TotalVariationFlow::Settings MakeFlowSettings(const Task& task) const;
  EdgeFunction MakeEdgeFunction(EdgeFunctionKind kind) const;
  double ChromaticityWeight() const;
  TangentVectors Directions() const;

  const TotalVariationSettings& Options;
  ModelInputs& Inputs;
  const UnitSystem& Units;
  const Dimension Time;
  std::shared_ptr<const EdgeUnknowns> Edges; ///< of CrouzeixRaviart
};

TotalVariationModels::TotalVariationModels(
  const TotalVariationSettings& options, ModelInputs& inputs)
  : Options(options)
  , Inputs(inputs)
  , Units(inputs.Units)
  , Time(options.DescribeModel().Time)
{
}

double TotalVariationModels::FidelityUnit() const
{
  const double l1 = this->Options.FidelityNorm == FidelityNorm::L1 ? 1.0 : 0.0;
  return this->Units.ToCore(1.0, -this->Time.Length, l1 - this->Time.Value);
}

FidelityWeights TotalVariationModels::FindWeights(RunResult& result) const
{
  const bool dimensionless = GetEdgeFunction(this->Options.EdgeFunction).Dimensionless;
  const double largest = this->Options.Blur.IsOn() ? BlurSearchTolerance : SearchTolerance;
  const double tolerance = std::max(largest, this->Options.StopTolerance);
  const auto blur = this->Options.Blur.IsOn() ? this->Options.Blur.Make(this->Inputs, {}) : nullptr;
  FidelityTask search;
  search.NoiseLevel = this->Options.NoiseLevel;
  search.StartsByArea = dimensionless;
  search.IsStartOverNoise = !dimensionless;
  search.Steps = this->Options.DescribeModel().NumberOfSteps;
  search.ColumnsShareWeight =
    this->Options.ChannelCoupling == ChannelCoupling::Joint || !this->Options.Color.IsRGB();
  search.Blur = blur.get();
  return FindFidelity(
    this->Inputs, search,
    [&](PointData data, double fidelity)
    { return this->Make(std::move(data), fidelity, tolerance); },
    result);
}

void TotalVariationModels::MakeEdges()
{
  const auto edges = std::make_shared<EdgeUnknowns>();
  RunInBackground(
    this->Inputs.Parallel.ForOtherThread(
      [edges, mesh = this->Inputs.Surface.SharedMesh(), &parallel = this->Inputs.Parallel]
      {
        edges->Mesh = std::make_shared<MedialMesh>(*mesh);
        edges->Operators = std::make_shared<Assembler>(edges->Mesh->Edges(), parallel);
      }),
    this->Inputs.Progress.Part(0.1, 0.5));
  this->Edges = edges;
}

std::unique_ptr<Model> TotalVariationModels::Make(
  PointData data, double fidelity, double tolerance) const
{
  if (!this->Edges)
  {
    return this->MakeOn(
      this->Inputs.Surface.SharedAssembler(), std::move(data), fidelity, tolerance);
  }
  TotalCorrection conserved;
  if ((this->Options.FidelityNorm == FidelityNorm::L2 || fidelity == 0.0) &&
    this->Options.Color.Model != ColorModel::ChromaticityBrightness)
  {
    conserved =
      TotalCorrection(this->Inputs.Surface.Mesh(), data, fidelity > 0.0, this->Inputs.Parallel);
  }
  return std::make_unique<CrouzeixRaviartModel>(
    this->Inputs.Surface.SharedAssembler(), this->Edges->Mesh, std::move(data),
    std::move(conserved),
    [&](PointData onEdges)
    { return this->MakeOn(this->Edges->Operators, std::move(onEdges), fidelity, tolerance); },
    this->Inputs.Parallel);
}

/// The model on the mesh of the assembler.
std::unique_ptr<Model> TotalVariationModels::MakeOn(std::shared_ptr<const Assembler> assembler,
  PointData data, double fidelity, double tolerance) const
{
  const Task task{ std::move(assembler), fidelity, tolerance,
    this->Units.ToCore(this->Options.TimeStep, this->Time),
    this->Options.Mode == TotalVariationMode::SteadyState, true,
    this->Options.Color.ChannelWeights() };
  switch (this->Options.Color.Model)
  {
    case ColorModel::Opponent:
      return std::make_unique<OpponentColors>(
        std::move(data),
        [&](PointData channels) { return this->MakeOfChannels(task, std::move(channels)); },
        this->Inputs.Parallel);
    case ColorModel::ChromaticityBrightness:
      return this->MakeChromaticityBrightness(task, std::move(data));
    default:
      return this->MakeOfChannels(task, std::move(data));
  }
}

std::unique_ptr<Model> TotalVariationModels::MakeOfChannels(const Task& task, PointData data) const
{
  if (!this->Options.Blur.IsOn() || task.Fidelity == 0.0)
  {
    return this->MakeDiffusion(task, std::move(data));
  }
  TotalVariationDeblurring::Settings deblurring;
  deblurring.Regularization = this->MakeFlowSettings(task);
  deblurring.Fidelity = task.Fidelity;
  deblurring.StopTolerance = task.Tolerance;
  return std::make_unique<TotalVariationDeblurring>(task.Operators, this->Directions(),
    std::move(data), deblurring, this->Options.Blur.Make(this->Inputs, {}), this->Inputs.Parallel);
}

//------------------------------------------------------------------------------------------------
/// mu; int |grad C|^p has the dimension length^(2 - p).
double TotalVariationModels::ChromaticityWeight() const
{
  const Dimension energy = this->Options.DescribeModel().Energy;
  return this->Units.ToCore(this->Options.Color.ChromaticityWeight,
    energy.Length - 2.0 + this->Options.Color.ChromaticityExponent, energy.Value);
}

std::unique_ptr<Model> TotalVariationModels::MakeChromaticityBrightness(
  Task task, PointData data) const
{
  ChromaticityBrightness::Settings settings;
  settings.Fidelity = task.Fidelity;
  settings.ChromaticityWeight = this->ChromaticityWeight();
  settings.SteadyState = task.IsSteady;
  settings.StopTolerance = task.Tolerance;
  if (task.IsSteady)
  {
    task.TimeStep = SteadyTimeStep * std::pow(this->Units.CoreEdgeLength(), this->Time.Length) *
      std::pow(this->Units.CoreValueRange(), this->Time.Value);
    task.IsSteady = false;
  }
  task.ConservesTotal = task.Fidelity == 0.0;
  return std::make_unique<ChromaticityBrightness>(
    task.Operators, std::move(data), settings,
    [&](PointData brightness) { return this->MakeDiffusion(task, std::move(brightness)); },
    [&](PointData chromaticity) { return this->MakeChromaticity(task, std::move(chromaticity)); },
    this->Inputs.Parallel);
}

std::unique_ptr<HarmonicMap> TotalVariationModels::MakeChromaticity(
  const Task& task, PointData data) const
{
  const double range = this->Units.CoreValueRange();
  const double weight = this->ChromaticityWeight();
  const double fastest = this->Options.LargestDiffusivity();
  HarmonicMap::Settings settings;
  settings.Exponent = this->Options.Color.ChromaticityExponent;
  settings.TimeStep = task.TimeStep * weight / (range * range);
  settings.Beta = this->Units.ToCore(this->Options.Beta, -2.0, 2.0) / (range * range);
  settings.Fidelity = task.Fidelity / weight;
  settings.LargestDiffusivity = fastest > 0.0 ? fastest : 1.0;
  settings.Limits.Tolerance = this->Options.Tolerance;
  settings.Limits.MaximumNumberOfIterations = this->Options.MaximumNumberOfIterations;

  const TriangleMesh& mesh = task.Operators->Mesh();
  const CornerWeights isotropic = CotanWeights(mesh, this->Inputs.Parallel);
  CornerWeights weights = this->Options.IsDirected()
    ? AnisotropicWeights(mesh, isotropic, this->Inputs.Directions, this->Options.AlongDiffusivity,
        this->Options.AcrossDiffusivity, this->Inputs.Parallel)
    : CornerWeights(this->Options.AlongDiffusivity * isotropic);
  SolverTask solver;
  solver.NumberOfVertices = mesh.NumberOfVertices();
  solver.DiffusionNumber =
    fastest * settings.TimeStep / std::pow(this->Units.CoreEdgeLength(), settings.Exponent);
  solver.IsPreconditioner = true;
  return std::make_unique<HarmonicMap>(task.Operators, std::move(weights), std::move(data),
    settings, this->Inputs.Solvers.Find(SolverPurpose::Chromaticity, solver),
    this->Inputs.Parallel);
}

//------------------------------------------------------------------------------------------------
std::unique_ptr<DataModel> TotalVariationModels::MakeDiffusion(
  const Task& task, PointData data) const
{
  if (!this->Options.Minimizes())
  {
    return this->MakeLagged(task, std::move(data));
  }
  return std::make_unique<TotalVariationFlow>(task.Operators, this->Directions(), std::move(data),
    this->MakeFlowSettings(task), this->Inputs.Parallel);
}

TotalVariationFlow::Settings TotalVariationModels::MakeFlowSettings(const Task& task) const
{
  TotalVariationFlow::Settings settings;
  settings.SteadyState = task.IsSteady;
  settings.TimeStep = task.TimeStep;
  settings.Fidelity = task.Fidelity;
  settings.Function = this->MakeEdgeFunction(this->Options.EdgeFunction);
  settings.AlongDiffusivity = this->Options.AlongDiffusivity;
  settings.AcrossDiffusivity = this->Options.AcrossDiffusivity;
  settings.GeneralizedLength = this->Options.Regularizer == Regularizer::TGV
    ? this->Units.ToCore(this->Options.TGVLength, 1.0, 0.0)
    : 0.0;
  settings.Coupling = this->Options.ChannelCoupling;
  settings.Norm = this->Options.FidelityNorm;
  settings.StopTolerance = task.Tolerance;
  settings.ConservesTotal = task.ConservesTotal;
  settings.ChannelWeights = task.ChannelWeights;
  return settings;
}

std::unique_ptr<NonlinearDiffusion> TotalVariationModels::MakeLagged(
  const Task& task, PointData data) const
{
  NonlinearDiffusion::Settings settings;
  settings.TimeStep = task.TimeStep;
  settings.Fidelity = task.Fidelity;
  settings.Along = this->MakeEdgeFunction(this->Options.EdgeFunction);
  settings.Across = settings.Along;
  settings.AlongDiffusivity = this->Options.AlongDiffusivity;
  settings.AcrossDiffusivity = this->Options.AcrossDiffusivity;
  if (this->Options.AcrossEdgeFunction != 0)
  {
    const auto across = static_cast<EdgeFunctionKind>(this->Options.AcrossEdgeFunction - 1);
    settings.Across = this->MakeEdgeFunction(across);
    // In natural units g2 is a formula in x/h and u/R, independent of the dimension of time.
    const auto power = [](EdgeFunctionKind kind)
    { return GetEdgeFunction(kind).Dimensionless ? 0.0 : 1.0; };
    const double difference = power(this->Options.EdgeFunction) - power(across);
    settings.AcrossDiffusivity *= this->Units.ToCore(1.0, difference, -difference);
  }
  settings.Coupling = this->Options.ChannelCoupling;
  settings.Norm = this->Options.FidelityNorm;
  settings.FidelityRounding = L1Rounding * this->Units.CoreValueRange();
  settings.ConservesTotal = task.ConservesTotal;
  settings.ChannelWeights = task.ChannelWeights;

  const double h = this->Units.CoreEdgeLength();
  const double gradient = TypicalGradient * this->Units.CoreValueRange() / h;
  const double along = settings.AlongDiffusivity * settings.Along(gradient * gradient);
  const double across = settings.AcrossDiffusivity * settings.Across(gradient * gradient);
  SolverTask solver;
  solver.NumberOfVertices = task.Operators->Mesh().NumberOfVertices();
  solver.AllowMultigrid = false;
  solver.DiffusionNumber = settings.TimeStep * std::max(along, across) / (h * h);
  return std::make_unique<NonlinearDiffusion>(task.Operators, this->Directions(), std::move(data),
    settings, this->Inputs.Solvers.Find(SolverPurpose::Step, solver), this->Inputs.Parallel);
}

EdgeFunction TotalVariationModels::MakeEdgeFunction(EdgeFunctionKind kind) const
{
  EdgeFunction function;
  function.Kind = kind;
  function.Beta = this->Units.ToCore(this->Options.Beta, -2.0, 2.0);
  function.Threshold = this->Units.ToCore(this->Options.EdgeThreshold, -1.0, 1.0);
  return function;
}

/// e1 if g1 and g2 differ, no row otherwise.
TangentVectors TotalVariationModels::Directions() const
{
  return this->Options.DescribeModel().NeedsDirections ? this->Inputs.Directions
                                                       : TangentVectors(0, 2);
}

} // namespace

std::unique_ptr<Model> TotalVariationSettings::Make(ModelInputs& inputs, RunResult& result) const
{
  PrepareData(*this, inputs, result);
  if (this->ChannelCoupling == ChannelCoupling::Joint && this->Color.IsRGB())
  {
    WarnOfUnlikeColumns(inputs,
      Sentence("set ") << Word::Setting("ChannelCoupling") << " to "
                       << Word::Choice(
                            "ChannelCoupling", ChannelCoupling::PerChannel, "PerChannel"),
      result);
  }
  TotalVariationModels maker(*this, inputs);
  if (this->Blur.IsOn())
  {
    this->Blur.Warn(inputs, result);
  }
  if (this->Discretization == SurfaceDiffusion::Discretization::CrouzeixRaviart)
  {
    maker.MakeEdges();
  }
  const FidelityWeights weights = this->FindsFidelity()
    ? maker.FindWeights(result)
    : FidelityWeights{ { this->FidelityWeight * maker.FidelityUnit() } };
  result.AddNumber("EffectiveFidelityWeight",
    this->FindsFidelity() ? weights.OfColumns.front() / maker.FidelityUnit()
                          : this->FidelityWeight);
  return weights.MakeModels(std::move(inputs.Data),
    [&](PointData data, double fidelity)
    { return maker.Make(std::move(data), fidelity, this->StopTolerance); });
}

} // namespace SurfaceDiffusion
