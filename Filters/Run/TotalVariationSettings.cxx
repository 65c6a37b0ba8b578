// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/TotalVariationSettings.h"

#include "Core/Models/CrouzeixRaviart.h"
#include "Core/Models/NonlinearDiffusion.h"
#include "Core/Models/TotalVariationDeblurring.h"
#include "Core/Models/TotalVariationFlow.h"
#include "Run/DataPreparation.h"
#include "Run/ModelInputs.h"

#include <algorithm>
#include <sstream>

namespace SurfaceDiffusion
{

namespace
{

/// L1 fidelity of the lagged scheme is rounded below this distance, in R.
constexpr double L1Rounding = 1e-3;

/// The smallest duality gap of the minimisers that the search for lambda computes.
constexpr double SearchTolerance = 1e-3;

/// The gradient at which the diffusivity is judged for the choice of a solver, in R/h.
constexpr double TypicalGradient = 0.01;

std::vector<const char*> WordsOfEdgeFunctions()
{
  std::vector<const char*> words;
  for (int kind = 0; kind < NumberOfEdgeFunctions; ++kind)
  {
    words.push_back(GetEdgeFunction(static_cast<EdgeFunctionKind>(kind)).Name);
  }
  return words;
}

/// The properties of an edge-stopping function. Numbers that are none, which Check() reports, get
/// the properties of TotalVariation.
EdgeFunctionProperties PropertiesOf(EdgeFunctionKind kind)
{
  const int number = static_cast<int>(kind);
  const bool known = number >= 0 && number < NumberOfEdgeFunctions;
  return GetEdgeFunction(known ? kind : EdgeFunctionKind::TotalVariation);
}

/// Makes the models that the settings ask for.
class ModelMaker
{
public:
  ModelMaker(const TotalVariationSettings& options, ModelInputs& inputs)
    : Options(options)
    , Inputs(inputs)
    , Units(inputs.Units)
    , Time(options.DescribeModel().Time)
  {
  }

  /// One unit of FidelityWeight in units of the numerics.
  double FidelityUnit() const
  {
    const double l1 = this->Options.FidelityNorm == FidelityNorm::L1 ? 1.0 : 0.0;
    return this->Units.ToCore(1.0, -this->Time.Length, l1 - this->Time.Value);
  }

  /// The lambda of AutomaticFidelity, in units of the numerics: that of the model and steps of the
  /// run itself.
  double FindFidelityWeight(RunResult& result) const
  {
    const double h = this->Units.CoreEdgeLength();
    const bool dimensionless = GetEdgeFunction(this->Options.EdgeFunction).Dimensionless;
    const double start = 1.0 / (h * (dimensionless ? h : this->Units.CoreValueRange()));
    const double tolerance = std::max(SearchTolerance, this->Options.StopTolerance);
    const auto blur =
      this->Options.Blur.IsOn() ? this->Options.Blur.Make(this->Inputs, {}) : nullptr;
    return FindFidelity(
      this->Inputs, this->Options.NoiseLevel, start, this->Options.DescribeModel().NumberOfSteps,
      [&](double fidelity) { return this->Make(this->Inputs.Data, fidelity, tolerance); }, result,
      blur.get());
  }

  /// Prepares the edges for CrouzeixRaviart. This takes seconds for a million vertices. In the
  /// background it does not delay an abort.
  void MakeEdges()
  {
    const auto edges = std::make_shared<EdgeUnknowns>();
    RunInBackground(
      [edges, mesh = this->Inputs.Surface.SharedMesh(), &parallel = this->Inputs.Parallel]
      {
        edges->Mesh = std::make_shared<MedialMesh>(*mesh);
        edges->Operators = std::make_shared<Assembler>(edges->Mesh->Edges(), parallel);
      },
      this->Inputs.Progress.Part(0.1, 0.5));
    this->Edges = edges;
  }

  /// The model of the settings, with its steady states and implicit steps to the tolerance.
  std::unique_ptr<Model> Make(PointData data, double fidelity, double tolerance) const
  {
    if (!this->Edges)
    {
      return this->MakeOn(
        this->Inputs.Surface.SharedAssembler(), std::move(data), fidelity, tolerance);
    }
    TotalCorrection conserved;
    if (this->Options.FidelityNorm == FidelityNorm::L2 || fidelity == 0.0)
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

private:
  struct EdgeUnknowns
  {
    std::shared_ptr<const MedialMesh> Mesh;
    std::shared_ptr<const Assembler> Operators;
  };

  /// The model on the mesh of the assembler.
  std::unique_ptr<Model> MakeOn(std::shared_ptr<const Assembler> assembler, PointData data,
    double fidelity, double tolerance) const
  {
    return this->Options.Minimizes()
      ? this->MakeMinimizing(std::move(assembler), std::move(data), fidelity,
          this->Options.Mode == TotalVariationMode::SteadyState, tolerance)
      : this->MakeLagged(std::move(assembler), std::move(data), fidelity);
  }

  std::unique_ptr<Model> MakeMinimizing(std::shared_ptr<const Assembler> assembler, PointData data,
    double fidelity, bool steady, double tolerance) const
  {
    TotalVariationFlow::Settings settings;
    settings.SteadyState = steady;
    settings.TimeStep = this->Units.ToCore(this->Options.TimeStep, this->Time);
    settings.Fidelity = fidelity;
    settings.Function = this->MakeEdgeFunction(this->Options.EdgeFunction);
    settings.AlongDiffusivity = this->Options.AlongDiffusivity;
    settings.AcrossDiffusivity = this->Options.AcrossDiffusivity;
    settings.Coupling = this->Options.ChannelCoupling;
    settings.Norm = this->Options.FidelityNorm;
    settings.StopTolerance = tolerance;
    if (this->Options.Blur.IsOn() && fidelity > 0.0)
    {
      TotalVariationDeblurring::Settings deblurring;
      deblurring.Regularization = settings;
      deblurring.Fidelity = fidelity;
      deblurring.StopTolerance = tolerance;
      return std::make_unique<TotalVariationDeblurring>(std::move(assembler), this->Directions(),
        std::move(data), deblurring, this->Options.Blur.Make(this->Inputs, {}),
        this->Inputs.Parallel);
    }
    return std::make_unique<TotalVariationFlow>(
      std::move(assembler), this->Directions(), std::move(data), settings, this->Inputs.Parallel);
  }

  std::unique_ptr<Model> MakeLagged(
    std::shared_ptr<const Assembler> assembler, PointData data, double fidelity) const
  {
    NonlinearDiffusion::Settings settings;
    settings.TimeStep = this->Units.ToCore(this->Options.TimeStep, this->Time);
    settings.Fidelity = fidelity;
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

    const double h = this->Units.CoreEdgeLength();
    const double gradient = TypicalGradient * this->Units.CoreValueRange() / h;
    const double along = settings.AlongDiffusivity * settings.Along(gradient * gradient);
    const double across = settings.AcrossDiffusivity * settings.Across(gradient * gradient);
    SolverTask task;
    task.NumberOfVertices = assembler->Mesh().NumberOfVertices();
    task.AllowMultigrid = false;
    task.DiffusionNumber = settings.TimeStep * std::max(along, across) / (h * h);
    return std::make_unique<NonlinearDiffusion>(std::move(assembler), this->Directions(),
      std::move(data), settings, this->Inputs.Solvers.Find(SolverPurpose::Step, task),
      this->Inputs.Parallel);
  }

  EdgeFunction MakeEdgeFunction(EdgeFunctionKind kind) const
  {
    EdgeFunction function;
    function.Kind = kind;
    function.Beta = this->Units.ToCore(this->Options.Beta, -2.0, 2.0);
    function.Threshold = this->Units.ToCore(this->Options.EdgeThreshold, -1.0, 1.0);
    return function;
  }

  /// e1 if g1 and g2 differ, no row otherwise.
  TangentVectors Directions() const
  {
    return this->Options.DescribeModel().NeedsDirections ? this->Inputs.Directions
                                                         : TangentVectors(0, 2);
  }

  const TotalVariationSettings& Options;
  ModelInputs& Inputs;
  const UnitSystem& Units;
  const Dimension Time;
  std::shared_ptr<const EdgeUnknowns> Edges; ///< of CrouzeixRaviart
};

} // namespace

void TotalVariationSettings::Visit(SettingVisitor& visitor)
{
  this->DataSettings::Visit(visitor);
  visitor.Choice(
    { "Mode", "", "TimeSteps: NumberOfTimeSteps steps. SteadyState: the minimiser of the energy." },
    this->Mode, { "TimeSteps", "SteadyState" });
  visitor.Choice({ "EdgeFunction", "", "The edge-stopping function g." }, this->EdgeFunction,
    WordsOfEdgeFunctions());
  std::vector<const char*> across = WordsOfEdgeFunctions();
  across.insert(across.begin(), "Same");
  visitor.Choice({ "AcrossEdgeFunction", "", "The edge-stopping function across the direction." },
    this->AcrossEdgeFunction, across, {});
  visitor.Number({ "Beta", "(R/h)^2", "beta of TotalVariation, a rounding of |grad u|." },
    this->Beta, SettingRange::Positive());
  visitor.Number({ "EdgeThreshold", "R/h", "K of the other edge-stopping functions." },
    this->EdgeThreshold, SettingRange::Positive());
  visitor.Choice(
    { "ChannelCoupling", "",
      "PerChannel: each component has its own norm. Joint: one Euclidean norm over all "
      "components." },
    this->ChannelCoupling, { "PerChannel", "Joint" });
  visitor.Choice({ "FidelityNorm", "", "L2 for Gaussian noise, L1 for impulse noise." },
    this->FidelityNorm, { "L2", "L1" });
  VisitAutomaticFidelity(visitor, this->AutomaticFidelity, this->NoiseLevel);
  visitor.Choice({ "Discretization", "", "Linear: vertex values. CrouzeixRaviart: edge values." },
    this->Discretization, { "Linear", "CrouzeixRaviart" });
  visitor.Number({ "StopTolerance", "",
                   "The relative duality gap at which a minimisation stops; with BlurFWHM the "
                   "change of an iteration in the range of the data." },
    this->StopTolerance, SettingRange::OpenUnitInterval());
  this->Blur.Visit(visitor);
}

void TotalVariationSettings::CheckTogether(const FieldSummary* fields, Problems& problems) const
{
  this->DataSettings::CheckTogether(fields, problems);
  this->CheckBlur(problems);
  if (this->Mode == TotalVariationMode::SteadyState)
  {
    this->RequireConvexEnergy("Mode SteadyState", problems);
  }
  else if (this->TimeIntegrator == SurfaceDiffusion::TimeIntegrator::Implicit)
  {
    this->RequireConvexEnergy("TimeIntegrator Implicit", problems);
  }
  if (this->AutomaticFidelity)
  {
    this->RequireConvexEnergy("AutomaticFidelity", problems);
    Require(this->FidelityNorm != SurfaceDiffusion::FidelityNorm::L1, "FidelityNorm",
      static_cast<double>(this->FidelityNorm), "0 L2 together with AutomaticFidelity", problems);
  }
  if (fields && !fields->Directions && this->AcrossEdgeFunction != 0)
  {
    std::ostringstream text;
    text << "AcrossEdgeFunction is " << this->AcrossEdgeFunction
         << " but DirectionArray is not set; allowed: 0 Same, or an array of directions";
    problems.push_back(text.str());
  }
}

void TotalVariationSettings::CheckBlur(Problems& problems) const
{
  if (this->Blur.IsOn())
  {
    Require(this->Mode == TotalVariationMode::SteadyState, "Mode", 0.0,
      "1 SteadyState together with BlurFWHM", problems);
    Require(this->FidelityNorm == SurfaceDiffusion::FidelityNorm::L2, "FidelityNorm",
      static_cast<double>(this->FidelityNorm), "0 L2 together with BlurFWHM", problems);
    Require(this->Discretization == SurfaceDiffusion::Discretization::Linear, "Discretization",
      static_cast<double>(this->Discretization), "0 Linear together with BlurFWHM", problems);
  }
}

void TotalVariationSettings::RequireConvexEnergy(const char* purpose, Problems& problems) const
{
  const std::string with = std::string(" together with ") + purpose;
  std::vector<bool> convex;
  for (int kind = 0; kind < NumberOfEdgeFunctions; ++kind)
  {
    convex.push_back(GetEdgeFunction(static_cast<EdgeFunctionKind>(kind)).Convex);
  }
  Require(PropertiesOf(this->EdgeFunction).Convex, "EdgeFunction",
    static_cast<double>(this->EdgeFunction),
    (ListChoices(WordsOfEdgeFunctions(), convex) + with).c_str(), problems);
  Require(this->AcrossEdgeFunction == 0, "AcrossEdgeFunction", this->AcrossEdgeFunction,
    ("0 Same" + with).c_str(), problems);
  Require(this->AlongDiffusivity > 0.0 || this->AcrossDiffusivity > 0.0,
    "AlongDiffusivity and AcrossDiffusivity", 0.0, ("one above 0" + with).c_str(), problems);
}

ModelTraits TotalVariationSettings::DescribeModel() const
{
  const bool dimensionless = PropertiesOf(this->EdgeFunction).Dimensionless;
  ModelTraits traits;
  traits.NumberOfSteps =
    this->Mode == TotalVariationMode::SteadyState ? 1 : this->NumberOfTimeSteps;
  traits.TimeStep = this->TimeStep;
  traits.AbsoluteTime = this->IsAbsolute();
  traits.Time = dimensionless ? Dimension{ 2.0, 0.0 } : Dimension{ 1.0, 1.0 };
  traits.Energy = dimensionless ? Dimension{ 0.0, 2.0 } : Dimension{ 1.0, 1.0 };
  traits.UsesFidelity = this->AutomaticFidelity || this->FidelityWeight > 0.0;
  traits.CanBeDistributed = !this->AutomaticFidelity &&
    this->Discretization == SurfaceDiffusion::Discretization::Linear && !this->Blur.IsOn();
  traits.BoundsError = this->Minimizes() && !this->Blur.IsOn() &&
    !(this->Mode == TotalVariationMode::SteadyState &&
      (this->FidelityNorm == SurfaceDiffusion::FidelityNorm::L1 || !traits.UsesFidelity));
  DescribeData(*this, traits);
  traits.NeedsDirections = traits.NeedsDirections || this->AcrossEdgeFunction != 0;
  return traits;
}

std::unique_ptr<Model> TotalVariationSettings::Make(ModelInputs& inputs, RunResult& result) const
{
  PrepareData(*this, inputs, result);
  ModelMaker maker(*this, inputs);
  if (this->Blur.IsOn())
  {
    this->Blur.Warn(inputs, result);
  }
  if (this->Discretization == SurfaceDiffusion::Discretization::CrouzeixRaviart)
  {
    maker.MakeEdges();
  }
  const double fidelity = this->AutomaticFidelity ? maker.FindFidelityWeight(result)
                                                  : this->FidelityWeight * maker.FidelityUnit();
  result.EffectiveFidelityWeight = fidelity / maker.FidelityUnit();
  return maker.Make(std::move(inputs.Data), fidelity, this->StopTolerance);
}

void TotalVariationSettings::Finish(const RunState& state, RunResult& result) const
{
  double gap = 0.0;
  for (const StepRecord& record : state.Path.Records())
  {
    gap = std::max(gap, record.Residual);
  }
  if (this->Minimizes() && gap > this->StopTolerance && !result.HasUnfinishedMinimum)
  {
    result.HasUnfinishedMinimum = true; // reported once, not at every requested time
    std::ostringstream text;
    text << "the minimisation ended at its largest number of iterations with a "
         << (this->Blur.IsOn() ? "relative change" : "relative duality gap") << " of " << gap
         << ", above StopTolerance";
    result.Warnings.push_back(text.str());
  }
}

} // namespace SurfaceDiffusion
