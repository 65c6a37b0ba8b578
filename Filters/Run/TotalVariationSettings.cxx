// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/TotalVariationSettings.h"

#include "Run/DataPreparation.h"
#include "Run/Rewording.h"

#include <algorithm>

namespace SurfaceDiffusion
{

namespace
{

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

} // namespace

void TotalVariationSettings::Visit(SettingVisitor& visitor)
{
  Rewording reworded(visitor,
    { { "Tolerance",
        { "",
          "Relative residual at which the iterative solver of a FirstOrder step stops, between 0 "
          "and 1." } },
      { "FidelityWeight",
        { "1/time",
          "lambda, the weight of the fidelity term lambda chi (f - u), in 1/(unit of time). The "
          "term "
          "pulls the result towards the data wherever they are known (chi = 1). 3, the default, "
          "stands for the weight that AutomaticFidelity finds, if this is on.",
          "" } } });
  this->DataSettings::Visit(reworded);
  VisitTimeIntegrator(visitor, this->TimeIntegrator, { true, false, true, false, false },
    "Mode=TimeSteps and (((EdgeFunction=TotalVariation or EdgeFunction=Charbonnier or "
    "EdgeFunction=Constant) and AcrossEdgeFunction=Same) or TimeIntegrator=Implicit)");
  visitor.Choice({ "Mode", "",
                   "TimeSteps: NumberOfTimeSteps steps of TimeStep. SteadyState: the minimiser "
                   "of the energy, computed directly. It requires EdgeFunction TotalVariation, "
                   "Charbonnier or Constant and AcrossEdgeFunction Same.",
                   "(BlurFWHM=0 and (((EdgeFunction=TotalVariation or EdgeFunction=Charbonnier or "
                   "EdgeFunction=Constant) and AcrossEdgeFunction=Same) or Mode=SteadyState)) or "
                   "(BlurFWHM!=0 and Mode=TimeSteps)" },
    this->Mode, { "TimeSteps", "SteadyState" });
  visitor.Choice(
    { "Regularizer", "",
      "What SteadyState minimises beside the fidelity. TV: total variation, of which "
      "plateaus with sharp edges have least; ramps become stairs. TGV: total "
      "generalised variation of second order, of which ramps and roofs have least, "
      "too; it takes longer. TGV requires Mode SteadyState, EdgeFunction "
      "TotalVariation, equal AlongDiffusivity and AcrossDiffusivity, Discretization "
      "Linear and BlurFWHM 0.",
      "(Mode=SteadyState and EdgeFunction=TotalVariation and Discretization=Linear and "
      "BlurFWHM=0 and ColorModel!=ChromaticityBrightness) or Regularizer=TGV" },
    this->Regularizer, { "TV", "TGV" });
  visitor.Number(
    { "TGVLength", "h",
      "The length alpha of Regularizer TGV, above 0, in the unit of lengths that Units "
      "selects (natural units: h). A bend of the data costs as much as a step of alpha "
      "times the change of the slope. The longer it is, the more the result is like "
      "that of TV.",
      "Regularizer=TGV" },
    this->TGVLength, SettingRange::Positive());
  visitor.Choice({ "EdgeFunction", "",
                   "The diffusivity g(s) of s = |grad u|, where K is the edge threshold. "
                   "TotalVariation: 1/sqrt(s^2 + beta). PeronaMalikExponential: exp(-(s/K)^2). "
                   "PeronaMalikRational: 1/(1 + (s/K)^2). Charbonnier: 1/sqrt(1 + (s/K)^2). "
                   "Weickert: 1 - exp(-3.31488/(s/K)^8). Constant: 1, linear diffusion. "
                   "Perona-Malik and Weickert sharpen edges with a gradient above K; they "
                   "require Mode TimeSteps and TimeIntegrator FirstOrder." },
    this->EdgeFunction, WordsOfEdgeFunctions());
  std::vector<const char*> across = WordsOfEdgeFunctions();
  across.insert(across.begin(), "Same");
  visitor.Choice({ "AcrossEdgeFunction", "",
                   "The function g of g2, across the direction: the same as EdgeFunction or "
                   "another one. Another one requires TimeIntegrator FirstOrder.",
                   "(DirectionArray and (Mode=TimeSteps and TimeIntegrator=FirstOrder)) or "
                   "AcrossEdgeFunction!=Same" },
    this->AcrossEdgeFunction, across, {});
  visitor.Number({ "Beta", "(R/h)^2",
                   "The regularisation beta of TotalVariation, above 0, in (R/h)^2. Gradients "
                   "far below its square root are smoothed as by linear diffusion. "
                   "TimeIntegrator Implicit and Mode SteadyState do not use it.",
                   "(EdgeFunction=TotalVariation or AcrossEdgeFunction=TotalVariation) and "
                   "TimeIntegrator=FirstOrder and Mode=TimeSteps" },
    this->Beta, SettingRange::Positive());
  visitor.Number(
    { "EdgeThreshold", "R/h",
      "The threshold K of the edge function, above 0, in R/h. Steeper gradients "
      "count as edges. 0.1 is one tenth of the range of the data between "
      "neighbouring points.",
      "(EdgeFunction!=TotalVariation and EdgeFunction!=Constant) or (AcrossEdgeFunction!=Same and "
      "AcrossEdgeFunction!=TotalVariation and AcrossEdgeFunction!=Constant)" },
    this->EdgeThreshold, SettingRange::Positive());
  visitor.Choice({ "ChannelCoupling", "",
                   "Joint: one |grad u| over all components, so that the edges of all colour "
                   "channels stay aligned. PerChannel: each component is treated separately." },
    this->ChannelCoupling, { "PerChannel", "Joint" });
  visitor.Choice({ "FidelityNorm", "",
                   "L2: lambda (f - u), for Gaussian noise. L1: lambda (f - u)/|f - u|, for "
                   "salt-and-pepper noise: outliers are replaced and the other values keep their "
                   "contrast. With L1 a weight of 1 to 2 is suitable.",
                   "(BlurFWHM=0 and ColorModel=RGB) or FidelityNorm=L1" },
    this->FidelityNorm, { "L2", "L1" });
  VisitAutomaticFidelity(visitor, this->AutomaticFidelity, this->NoiseLevel,
    "FidelityWeight=3 and FidelityNorm=L2 and (EdgeFunction=TotalVariation or "
    "EdgeFunction=Charbonnier or EdgeFunction=Constant) and AcrossEdgeFunction=Same");
  visitor.Choice({ "Discretization", "",
                   "Linear: unknowns at the points, as in the paper. CrouzeixRaviart: unknowns "
                   "at the edges of the mesh, which are three times as many. It reproduces the "
                   "heights of plateaus to a fraction of a percent.",
                   "(BlurFWHM=0 and Regularizer=TV) or Discretization=CrouzeixRaviart" },
    this->Discretization, { "Linear", "CrouzeixRaviart" });
  visitor.Number({ "StopTolerance", "",
                   "The relative duality gap at which Mode SteadyState and each step of "
                   "TimeIntegrator Implicit stop, between 0 and 1. The duality gap bounds the "
                   "difference between the energy and its minimum. With BlurFWHM it is the "
                   "change of an iteration in the range of the data, and with ColorModel "
                   "ChromaticityBrightness the relative decrease of the energy in an "
                   "alternation.",
                   "Mode=SteadyState or TimeIntegrator=Implicit" },
    this->StopTolerance, SettingRange::OpenUnitInterval());
  this->Blur.Visit(visitor);
  visitor.Switch(
    { "AutomaticBlurFidelity", "",
      "Off: with BlurFWHM, FidelityWeight is used as it is given, also 3, its default.",
      "BlurFWHM!=0 and AutomaticFidelity=1 and FidelityWeight=3" },
    this->AutomaticBlurFidelity);
  this->Color.Visit(visitor);
}

bool TotalVariationSettings::FindsFidelity() const
{
  return this->AutomaticFidelity && this->FidelityWeight == DefaultFidelityWeight &&
    (this->AutomaticBlurFidelity || !this->Blur.IsOn()) &&
    PropertiesOf(this->EdgeFunction).Convex && this->AcrossEdgeFunction == 0 &&
    (this->AlongDiffusivity > 0.0 || this->AcrossDiffusivity > 0.0) &&
    this->FidelityNorm == SurfaceDiffusion::FidelityNorm::L2;
}

void TotalVariationSettings::CheckTogether(const FieldSummary* fields, Problems& problems) const
{
  this->DataSettings::CheckTogether(fields, problems);
  this->CheckBlur(problems);
  this->CheckRegularizer(problems);
  this->CheckColorModel(fields, problems);
  if (this->Mode == TotalVariationMode::SteadyState)
  {
    Sentence purpose = Word::Setting("Mode");
    this->RequireConvexEnergy(
      purpose << " " << Word::Choice("Mode", this->Mode, "SteadyState"), problems);
  }
  else if (this->TimeIntegrator == SurfaceDiffusion::TimeIntegrator::Implicit)
  {
    Sentence purpose = Word::Setting("TimeIntegrator");
    this->RequireConvexEnergy(
      purpose << " " << Word::Choice("TimeIntegrator", this->TimeIntegrator, "Implicit"), problems);
  }
  if (fields && !fields->Directions && this->AcrossEdgeFunction != 0)
  {
    const char* const name = "AcrossEdgeFunction";
    problems.push_back(Sentence(Word::Setting(name))
      << " is " << Word::Number(name, this->AcrossEdgeFunction) << " but "
      << Word::Array("DirectionArray") << " is not set; allowed: "
      << Word::NumberedChoice(name, 0, "Same") << ", or an array of directions");
  }
}

void TotalVariationSettings::CheckBlur(Problems& problems) const
{
  if (this->Blur.IsOn())
  {
    const Word blur = Word::Setting("BlurFWHM");
    RequireChoice(
      "Mode", this->Mode, TotalVariationMode::SteadyState, "SteadyState", blur, problems);
    RequireChoice(
      "FidelityNorm", this->FidelityNorm, SurfaceDiffusion::FidelityNorm::L2, "L2", blur, problems);
    RequireChoice("Discretization", this->Discretization, SurfaceDiffusion::Discretization::Linear,
      "Linear", blur, problems);
    RequireChoice("ColorModel", this->Color.Model, ColorModel::RGB, "RGB", blur, problems);
  }
}

void TotalVariationSettings::CheckRegularizer(Problems& problems) const
{
  if (this->Regularizer != SurfaceDiffusion::Regularizer::TGV)
  {
    return;
  }
  Sentence purpose = Word::Setting("Regularizer");
  purpose << " " << Word::Choice("Regularizer", this->Regularizer, "TGV");
  RequireChoice(
    "Mode", this->Mode, TotalVariationMode::SteadyState, "SteadyState", purpose, problems);
  RequireChoice("EdgeFunction", this->EdgeFunction, EdgeFunctionKind::TotalVariation,
    "TotalVariation", purpose, problems);
  RequireChoice("Discretization", this->Discretization, SurfaceDiffusion::Discretization::Linear,
    "Linear", purpose, problems);
  const Sentence with = Sentence(" together with ") << purpose;
  Require(!(this->Blur.IsOn()), Word::Setting("BlurFWHM"), this->Blur.FWHM, Sentence("0") << with,
    problems);
  Require(this->AlongDiffusivity == this->AcrossDiffusivity, Word::Setting("AcrossDiffusivity"),
    this->AcrossDiffusivity, Sentence("that of ") << Word::Setting("AlongDiffusivity") << with,
    problems);
  if (this->Color.Model == ColorModel::ChromaticityBrightness)
  {
    problems.push_back(Sentence(Word::Setting("ColorModel"))
      << " is " << Word::Number("ColorModel", this->Color.Model)
      << "; allowed: " << Word::NumberedChoice("ColorModel", ColorModel::RGB, "RGB") << " and "
      << Word::NumberedChoice("ColorModel", ColorModel::Opponent, "Opponent") << with);
  }
}

void TotalVariationSettings::CheckColorModel(const FieldSummary* fields, Problems& problems) const
{
  if (this->Color.IsRGB())
  {
    return;
  }
  RequireChoice("FidelityNorm", this->FidelityNorm, SurfaceDiffusion::FidelityNorm::L2, "L2",
    Sentence("a ") << Word::Setting("ColorModel") << " other than "
                   << Word::Choice("ColorModel", ColorModel::RGB, "RGB"),
    problems);
  if (fields && fields->Data && fields->DataComponents != 3)
  {
    problems.push_back(Sentence(Word::Setting("ColorModel"))
      << " is " << Word::Number("ColorModel", this->Color.Model) << " but "
      << Word::Array("InputArray") << " has " << fields->DataComponents
      << " components; allowed: " << Word::NumberedChoice("ColorModel", ColorModel::RGB, "RGB")
      << ", or an array of 3 components (alpha not counted)");
  }
}

void TotalVariationSettings::RequireConvexEnergy(const Sentence& purpose, Problems& problems) const
{
  const Sentence with = Sentence(" together with ") << purpose;
  std::vector<bool> convex;
  for (int kind = 0; kind < NumberOfEdgeFunctions; ++kind)
  {
    convex.push_back(GetEdgeFunction(static_cast<EdgeFunctionKind>(kind)).Convex);
  }
  Require(PropertiesOf(this->EdgeFunction).Convex, Word::Setting("EdgeFunction"),
    Word::Number("EdgeFunction", this->EdgeFunction),
    ListChoices("EdgeFunction", WordsOfEdgeFunctions(), convex) << with, problems);
  RequireChoice("AcrossEdgeFunction", this->AcrossEdgeFunction, 0, "Same", purpose, problems);
  Require(this->AlongDiffusivity > 0.0 || this->AcrossDiffusivity > 0.0,
    Sentence(Word::Setting("AlongDiffusivity")) << " and " << Word::Setting("AcrossDiffusivity"),
    0.0, Sentence("one above 0") << with, problems);
}

/// The edge functions without a threshold have R in the unit of time.
std::vector<const char*> TotalVariationSettings::FindSettingsInRange() const
{
  if (PropertiesOf(this->EdgeFunction).Dimensionless)
  {
    const bool hasThreshold = this->EdgeFunction != EdgeFunctionKind::Constant;
    return hasThreshold ? std::vector<const char*>{ "EdgeThreshold" } : std::vector<const char*>();
  }
  if (this->Mode == TotalVariationMode::TimeSteps)
  {
    return { "TimeStep", "FidelityWeight" };
  }
  return this->FindsFidelity() ? std::vector<const char*>()
                               : std::vector<const char*>{ "FidelityWeight" };
}

ModelTraits TotalVariationSettings::DescribeModel() const
{
  const bool dimensionless = PropertiesOf(this->EdgeFunction).Dimensionless;
  ModelTraits traits = this->DescribeSteps(this->Mode == TotalVariationMode::SteadyState);
  traits.ResultSuffix = "TV";
  traits.DependsOnNumberOfSteps = this->FindsFidelity(); // the weight for all steps of the run
  traits.Time = dimensionless ? Dimension{ 2.0, 0.0 } : Dimension{ 1.0, 1.0 };
  traits.SettingsInRange = this->FindSettingsInRange();
  traits.Energy = dimensionless ? Dimension{ 0.0, 2.0 } : Dimension{ 1.0, 1.0 };
  traits.UsesFidelity = this->FindsFidelity() || this->FidelityWeight > 0.0;
  traits.EstimatesNoise = this->FindsFidelity();
  traits.CanBeDistributed = !this->FindsFidelity() &&
    this->Discretization == SurfaceDiffusion::Discretization::Linear &&
    this->Regularizer == SurfaceDiffusion::Regularizer::TV && !this->Blur.IsOn();
  traits.UsesLinearLight = this->Color.UsesLinearLight();
  traits.BoundsError = this->Minimizes() && !this->Blur.IsOn() &&
    this->Color.Model != ColorModel::ChromaticityBrightness &&
    !(this->Mode == TotalVariationMode::SteadyState &&
      (this->FidelityNorm == SurfaceDiffusion::FidelityNorm::L1 || !traits.UsesFidelity));
  DescribeData(*this, traits);
  traits.NeedsDirections = traits.NeedsDirections || this->AcrossEdgeFunction != 0;
  return traits;
}

const char* TotalVariationSettings::NameOfResidual() const
{
  if (this->Blur.IsOn())
  {
    return "relative change";
  }
  const bool alternates = this->Color.Model == ColorModel::ChromaticityBrightness &&
    this->Mode == TotalVariationMode::SteadyState;
  return alternates ? "relative decrease of the energy" : "relative duality gap";
}

std::vector<Output> TotalVariationSettings::Finish(const RunState& state, RunResult& result) const
{
  double gap = 0.0;
  for (const StepRecord& record : state.Path.Records())
  {
    gap = std::max(gap, record.Residual);
  }
  if (this->Minimizes() && gap > this->StopTolerance)
  {
    result.WarnOnce(Sentence("the minimisation ended at its largest number of iterations with a ")
      << this->NameOfResidual() << " of " << gap << ", above " << Word::Setting("StopTolerance"));
  }
  return this->DataSettings::Finish(state, result);
}

} // namespace SurfaceDiffusion
