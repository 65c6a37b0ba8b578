// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/ErrorCauses.h"

#include "Core/Models/Textures/ReactionDiffusion.h"
#include "Core/Solvers/LinearSolver.h"
#include "Core/Solvers/NotPositiveDefinite.h"
#include "Core/Solvers/SolverChoice.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

class ValueFinder : public NumberVisitor
{
public:
  explicit ValueFinder(std::string name)
    : Name(std::move(name))
  {
  }

  std::optional<double> Value;

private:
  void See(const SettingInfo& info, double value) override
  {
    if (this->Name == info.Name)
    {
      this->Value = value;
    }
  }

  const std::string Name;
};

/// The number, or the number of the choice; none if there is no such setting.
std::optional<double> FindValue(Settings& settings, const std::string& name)
{
  ValueFinder finder(name);
  settings.Visit(finder);
  return finder.Value;
}

/// Lists the settings whose squares may be too large or too small for a double.
class ExtremesFinder : public NumberVisitor
{
public:
  Sentence Found;

private:
  void See(const SettingInfo& info, double value) override
  {
    constexpr double large = 1e100;
    const double size = std::abs(value);
    if (size > large || (size > 0.0 && size < 1.0 / large))
    {
      this->Found << (this->Found.Words().empty() ? "" : " and ") << Word::Setting(info.Name)
                  << " is " << value;
    }
  }
};

} // namespace

Sentence ExplainError(Settings& settings, const std::runtime_error& error)
{
  if (const auto* const worded = dynamic_cast<const InputError*>(&error))
  {
    return worded->Message();
  }
  Sentence text(error.what());
  if (dynamic_cast<const NotConverged*>(&error) && FindValue(settings, "Solver"))
  {
    text << "; allow a larger " << Word::Setting("Tolerance") << " or "
         << Word::Setting("MaximumNumberOfIterations") << ", or set " << Word::Setting("Solver")
         << " to " << Word::Choice("Solver", SolverMethod::Direct, "Direct");
  }
  else if (dynamic_cast<const NotPositiveDefinite*>(&error) &&
    FindValue(settings, "IntrinsicDelaunay") == 0.0)
  {
    text << "; if triangles are all but flat, " << Word::Setting("IntrinsicDelaunay")
         << " makes it so";
  }
  else if (dynamic_cast<const UnboundedGrowth*>(&error))
  {
    text << ": take a smaller " << Word::Setting("TimeStep")
         << ", other parameters of the kinetics, or clamp at zero";
  }
  return text;
}

Sentence NameExtremes(Settings& settings, const Sentence& message)
{
  ExtremesFinder finder;
  settings.Visit(finder);
  Sentence& text = finder.Found;
  const auto isNamed = [&](const Word& word)
  {
    return word.Type == Word::Kind::Setting &&
      std::any_of(message.Words().begin(), message.Words().end(),
        [&](const Word& other) { return other.Type == word.Type && other.Name == word.Name; });
  };
  if (text.Words().empty() || std::any_of(text.Words().begin(), text.Words().end(), isNamed))
  {
    return message;
  }
  return text << ", with which " << message
              << "; allowed: magnitudes whose squares a double can hold";
}

} // namespace SurfaceDiffusion
