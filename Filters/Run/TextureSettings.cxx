// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/TextureSettings.h"

#include "Core/Models/Textures/DispersionRelation.h"
#include "Run/TextureRates.h"

#include <string>

namespace SurfaceDiffusion
{

namespace
{

std::vector<const char*> WordsOfKinetics()
{
  std::vector<const char*> words;
  for (int k = 0; k < NumberOfKinetics; ++k)
  {
    words.push_back(GetKinetics(static_cast<KineticsName>(k)).Name);
  }
  return words;
}

std::string DescribeKinetics()
{
  std::string text = "The reaction terms F, G. ";
  for (int k = 0; k < NumberOfKinetics; ++k)
  {
    const Kinetics& terms = GetKinetics(static_cast<KineticsName>(k));
    text += std::string(terms.Name) + ": " + terms.Formula + ". ";
  }
  return text +
    "All are multiplied by ReactionRate. Use AutomaticTimeStep with kinetics other than Turing.";
}

SettingRange RangeOf(const Kinetics::Parameter& parameter)
{
  switch (parameter.Allowed)
  {
    case Kinetics::Range::Positive:
      return SettingRange::Positive();
    case Kinetics::Range::NonNegative:
      return SettingRange::NonNegative();
    case Kinetics::Range::AnyFinite:
      return SettingRange::AnyFinite();
  }
  return SettingRange::Anything();
}

} // namespace

void TextureSettings::Visit(SettingVisitor& visitor)
{
  this->TimeSettings::Visit(visitor);
  VisitTimeIntegrator(visitor, this->TimeIntegrator, { true, true, false, false, false });
  static const std::string kinetics = DescribeKinetics();
  visitor.Choice({ "Kinetics", "", kinetics.c_str() }, this->Kinetics, WordsOfKinetics());
  visitor.Number({ "ReactionRate", "1/time",
                   "s, the factor of F and G, above 0, in 1/time. The natural unit of time is "
                   "1/s." },
    this->ReactionRate, SettingRange::Positive());
  visitor.Number({ "DiffusionRate1", "h^2 ReactionRate",
                   "Diffusion rate of u1, along the direction if there is one, 0 or more, in "
                   "length^2/time (natural units: h^2 ReactionRate). With the default kinetics a "
                   "pattern requires more than four times DiffusionRate2.",
                   "!DiffusionRateArray" },
    this->DiffusionRate1, SettingRange::NonNegative());
  visitor.Number({ "DiffusionRate2", "h^2 ReactionRate",
                   "Diffusion rate of u2, along the direction if there is one, 0 or more, in "
                   "length^2/time (natural units: h^2 ReactionRate).",
                   "!DiffusionRateArray" },
    this->DiffusionRate2, SettingRange::NonNegative());
  const auto across =
    SettingRange::NonNegativeOr(-1.0, "finite numbers, 0 or more, or -1: as along");
  visitor.Number({ "DiffusionRateAcross1", "h^2 ReactionRate",
                   "Diffusion rate of u1 across the direction, 0 or more, in the unit of "
                   "DiffusionRate1. -1: the same as along it.",
                   "DirectionArray or DiffusionRateAcross1!=-1" },
    this->DiffusionRateAcross1, across);
  visitor.Number({ "DiffusionRateAcross2", "h^2 ReactionRate",
                   "Diffusion rate of u2 across the direction, 0 or more, in the unit of "
                   "DiffusionRate2. -1: the same as along it.",
                   "DirectionArray or DiffusionRateAcross2!=-1" },
    this->DiffusionRateAcross2, across);
  visitor.Number(
    { "FeatureSize", "coordinates",
      "The wavelength of the pattern: the fastest-growing wavelength along the "
      "direction, in the unit of the coordinates. All diffusion rates are "
      "multiplied by the factor that gives this wavelength. The mesh should have at "
      "least six edges per wavelength. 0: with the default rates in natural units, an eighth of "
      "the root of the area where this has fewer than 64 mean edge lengths, and "
      "otherwise the rates as they are." },
    this->FeatureSize, SettingRange::NonNegative());
  visitor.Number({ "InitialNoise", "",
                   "Half width of the uniform noise around the steady state at the start, "
                   "relative to the steady state.",
                   "!InputArray" },
    this->InitialNoise, SettingRange::NonNegative());
  visitor.Switch({ "ClampToNonNegative", "",
                   "Keep concentrations nonnegative. Without it, Turing is unstable as soon as "
                   "u2 becomes negative. (The variables of FitzHughNagumo are not concentrations "
                   "and are not clamped.)" },
    this->ClampToNonNegative);
  visitor.Switch({ "AutomaticTimeStep", "",
                   "Choose the time step for the kinetics: 1/8 of the time constant of their "
                   "fastest mode. TimeStep is ignored." },
    this->AutomaticTimeStep);
  visitor.Number({ "StopTolerance", "1/time",
                   "Stop before NumberOfTimeSteps when the pattern is stationary, that is, when "
                   "its relative change per unit of time is at most this value. At 0.05 it looks "
                   "finished. 0: run all steps." },
    this->StopTolerance, SettingRange::NonNegative());
  visitor.Integer({ "CoarseStartSize", "vertices",
                    "On a surface with more vertices than this, the pattern grows on a coarser "
                    "mesh until its relative change is 2.5 StopTolerance, and only the last two "
                    "steps run on the surface itself. The first result is an order of magnitude "
                    "sooner, with about the same wavelength, but differs in detail. 0: all steps "
                    "run on the surface." },
    this->CoarseStartSize, SettingRange::AtLeast(0.0, "0 or more vertices"));

  for (int k = 0; k < NumberOfKinetics; ++k)
  {
    // The parameters of kinetics that are not chosen have no effect and may be anything.
    const bool chosen = static_cast<int>(this->Kinetics) == k;
    const auto& list = GetKinetics(static_cast<KineticsName>(k)).Parameters;
    const std::string onlyIf =
      std::string("Kinetics=") + GetKinetics(static_cast<KineticsName>(k)).Name;
    for (std::size_t p = 0; p < list.size(); ++p)
    {
      if (list[p].Name)
      {
        visitor.Number({ list[p].Name, "", list[p].Documentation,
                         chosen ? SettingScope::Model : SettingScope::Output, onlyIf.c_str() },
          this->Parameters[static_cast<std::size_t>(k)][p],
          chosen ? RangeOf(list[p]) : SettingRange::Anything());
      }
    }
  }
  visitor.Choice({ "TextureChemical", "", "The chemical that Texture and TextureColor show.",
                   SettingScope::Output },
    this->TextureChemical, { "U1", "U2" }, {});
  visitor.Switch(
    { "ColorOutput", "", "Whether the texture is written as colours, too.", SettingScope::Output },
    this->ColorOutput);
  visitor.Numbers(
    { "LowColor", "", "Red, green and blue, from 0 to 1, for low concentrations of the chemical.",
      SettingScope::Output, "ColorOutput=1" },
    this->LowColor, SettingRange::ClosedUnitInterval());
  visitor.Numbers(
    { "HighColor", "", "Red, green and blue, from 0 to 1, for high concentrations of the chemical.",
      SettingScope::Output, "ColorOutput=1" },
    this->HighColor, SettingRange::ClosedUnitInterval());
}

TextureSettings::TextureSettings()
{
  this->TimeStep = 1.0 / 16.0;
  this->NumberOfTimeSteps = 640;
  for (int k = 0; k < NumberOfKinetics; ++k)
  {
    this->Parameters[static_cast<std::size_t>(k)] =
      GetKinetics(static_cast<KineticsName>(k)).Defaults();
  }
}

bool TextureSettings::HasKnownKinetics() const
{
  const int number = static_cast<int>(this->Kinetics);
  return number >= 0 && number < NumberOfKinetics;
}

const KineticsParameters& TextureSettings::ChosenParameters() const
{
  return this->Parameters[static_cast<std::size_t>(this->Kinetics)];
}

Eigen::Matrix2d TextureSettings::JacobianAtRest() const
{
  const auto& terms = GetKinetics(this->Kinetics);
  const Eigen::Vector2d steady = terms.SteadyState(this->ChosenParameters());
  return terms.Jacobian(this->ChosenParameters(), steady[0], steady[1]);
}

bool TextureSettings::HasDirectedRates() const
{
  const auto differs = [](double along, double across)
  { return across != -1.0 && across != along; };
  return differs(this->DiffusionRate1, this->DiffusionRateAcross1) ||
    differs(this->DiffusionRate2, this->DiffusionRateAcross2);
}

void TextureSettings::CheckTogether(const FieldSummary* fields, Problems& problems) const
{
  this->TimeSettings::CheckTogether(fields, problems);
  for (const auto& [name, color] :
    { std::pair{ "LowColor", &this->LowColor }, std::pair{ "HighColor", &this->HighColor } })
  {
    Require(color->size() == 3, Sentence("the number of entries of ") << Word::Setting(name),
      static_cast<double>(color->size()), "3", problems);
  }
  if (!fields)
  {
    return;
  }
  const Word data = Word::Array("InputArray");
  const Word rates = Word::Array("DiffusionRateArray");
  const Word directions = Word::Array("DirectionArray");
  if (fields->Data && fields->DataComponents != 2)
  {
    problems.push_back(Sentence(data)
      << " holds colours, whose last component is alpha; allowed: 2 components of a type other "
         "than unsigned char");
  }
  if (fields->Rates && this->IntrinsicDelaunay)
  {
    problems.push_back(Sentence(Word::Setting("IntrinsicDelaunay"))
      << " is " << Word::Switch(true) << " but " << rates << " gives rates per " << Word::Cell()
      << ", whose triangles it would replace; allowed: one of the two");
  }
  if (!fields->Directions && !fields->Rates && this->HasDirectedRates())
  {
    problems.push_back(Sentence(Word::Setting("DiffusionRateAcross1"))
      << " or " << Word::Setting("DiffusionRateAcross2") << " differs from the rate along but "
      << directions << " is not set; allowed: -1, or an array of directions");
  }
  if (fields->Fixed && !fields->Data)
  {
    problems.push_back(Sentence(Word::Array("FixedArray"))
      << " is set but " << data << ", the values to hold, is not; allowed: both or neither");
  }
}

double TextureSettings::EdgeLengthForFeatures(double meanEdgeLength) const
{
  return this->FeatureSize < TextureRates::EdgesPerWavelength * meanEdgeLength
    ? this->FeatureSize / TextureRates::EdgesOfRefinement
    : 0.0;
}

double TextureSettings::EffectiveTimeStep() const
{
  if (!this->AutomaticTimeStep || !this->HasKnownKinetics())
  {
    return this->TimeStep;
  }
  const double step = ReactionTimeStep(this->JacobianAtRest());
  if (!std::isfinite(step))
  {
    return this->TimeStep; // no steady state
  }
  return this->IsAbsolute() ? step / this->ReactionRate : step;
}

ModelTraits TextureSettings::DescribeModel() const
{
  ModelTraits traits = this->DescribeSteps();
  traits.MayEndEarly = this->StopTolerance > 0.0;
  traits.TimeStep = this->EffectiveTimeStep();
  traits.TimeFactor = 1.0 / this->ReactionRate;
  traits.Energy = { 2.0, 0.0 };
  traits.HasValueRange = false;
  traits.CountsClamped = true;
  traits.UsesRandomNumbers = true;
  return traits;
}

} // namespace SurfaceDiffusion
