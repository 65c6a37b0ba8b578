// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Engine.h"

#include "Json.h"
#include "Run/PythonNames.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <stdexcept>

using emscripten::val;

namespace SurfaceDiffusion
{

namespace
{

class Lister : public SettingVisitor
{
public:
  using SettingVisitor::Choice;

  void Number(const SettingInfo& info, double& value, const SettingRange& range) override
  {
    this->Add(info, "number", Json::Number(value), range);
  }
  void Integer(const SettingInfo& info, int& value, const SettingRange& range) override
  {
    this->Add(info, "integer", std::to_string(value), range);
  }
  void Numbers(const SettingInfo& info, std::vector<double>& values, const SettingRange&) override
  {
    this->Add(info, "vector", Json::List(values), SettingRange::AnyFinite());
  }
  void Switch(const SettingInfo& info, bool& value) override
  {
    this->Add(info, "switch", Json::Bool(value), SettingRange::Anything());
  }
  void Choice(const SettingInfo& info, int& value, const std::vector<const char*>& words,
    const std::vector<bool>& allowed) override
  {
    std::vector<std::string> usable;
    for (std::size_t w = 0; w < words.size(); ++w)
    {
      if (allowed.empty() || allowed[w])
      {
        usable.emplace_back(words[w]);
      }
    }
    this->Add(info, "choice", Json::Quoted(words[static_cast<std::size_t>(value)]),
      SettingRange::Anything(), Json::List(usable, Json::Quoted));
  }

  /// The keywords that all functions of Python have beside the settings of the model.
  void AddRefinement(bool mayBeAutomatic)
  {
    double length = mayBeAutomatic ? -1.0 : 0.0;
    int most = 4000000;
    this->Number({ "RefineTo", "coordinates",
                   "Edges that are longer are bisected first, in the unit of "
                   "the coordinates, and the data go along. 0: the surface stays as it is. -1, for "
                   "textures: FeatureSize / 8 if that is less than 6 mean edge lengths." },
      length, SettingRange::NonNegativeOr(length, "0 or more"));
    this->Integer({ "MaximumNumberOfTriangles", "", "Refinement stops before there are more." },
      most, SettingRange::AtLeast(1.0, "1 or more"));
  }

  std::vector<std::string> Entries;

private:
  void Add(const SettingInfo& info, const char* kind, const std::string& value,
    const SettingRange& range, const std::string& choices = "[]")
  {
    if (IsOfPipelines(info.Name))
    {
      return;
    }
    const std::string name = PythonName(info.Name);
    const auto limit = [](double bound)
    { return std::abs(bound) < std::numeric_limits<double>::max() ? Json::Number(bound) : "null"; };
    const std::string limits = range.Low < range.High ? "{\"min\":" + limit(range.Low) +
        ",\"max\":" + limit(range.High) + ",\"text\":" + Json::Quoted(range.Text) + "}"
                                                      : "null";
    this->Entries.push_back("{\"name\":" + Json::Quoted(name) +
      ",\"property\":" + Json::Quoted(info.Name) + ",\"kind\":\"" + kind +
      "\",\"unit\":" + Json::Quoted(info.Unit) + ",\"help\":" + Json::Quoted(info.Documentation) +
      ",\"default\":" + value + ",\"range\":" + limits + ",\"choices\":" + choices +
      ",\"onlyIf\":" + Json::Quoted(info.OnlyIf) + "}");
  }
};

class Assigner : public SettingVisitor
{
public:
  using SettingVisitor::Choice;
  explicit Assigner(const val& given)
    : Given(given)
  {
  }

  void Number(const SettingInfo& info, double& value, const SettingRange&) override
  {
    this->Take(info, "number", "a number", [&](const val& given) { value = given.as<double>(); });
  }
  void Integer(const SettingInfo& info, int& value, const SettingRange&) override
  {
    this->Take(info, "number", "a whole number of 32 bits",
      [&](const val& given)
      {
        const double number = given.as<double>();
        constexpr double largest = std::numeric_limits<int>::max();
        Require(number == std::floor(number) && std::abs(number) <= largest);
        value = static_cast<int>(number);
      });
  }
  void Numbers(const SettingInfo& info, std::vector<double>& values, const SettingRange&) override
  {
    this->Take(info, "object", "a list of numbers",
      [&](const val& given)
      {
        Require(given.isArray());
        values = emscripten::vecFromJSArray<double>(given);
      });
  }
  void Switch(const SettingInfo& info, bool& value) override
  {
    this->Take(
      info, "boolean", "true or false", [&](const val& given) { value = given.as<bool>(); });
  }
  void Choice(const SettingInfo& info, int& value, const std::vector<const char*>& words,
    const std::vector<bool>& allowed) override
  {
    std::string list;
    for (std::size_t w = 0; w < words.size(); ++w)
    {
      if (allowed.empty() || allowed[w])
      {
        list += (list.empty() ? "" : ", ") + std::string(words[w]);
      }
    }
    this->Take(info, "string", list,
      [&](const val& given)
      {
        const auto word = given.as<std::string>();
        const auto found = std::find_if(words.begin(), words.end(),
          [&](const char* known) { return word == known || word == PythonName(known); });
        const auto place = static_cast<std::size_t>(found - words.begin());
        Require(found != words.end() && (allowed.empty() || allowed[place]));
        value = static_cast<int>(place);
      });
  }

  std::vector<std::string> Names; ///< of all settings

private:
  struct WrongType
  {
  };
  static void Require(bool holds)
  {
    if (!holds)
    {
      throw WrongType();
    }
  }

  template <typename Assign>
  void Take(const SettingInfo& info, const std::string& type, const std::string& allowed,
    const Assign& assign)
  {
    const std::string name = PythonName(info.Name);
    if (IsOfPipelines(info.Name))
    {
      return;
    }
    this->Names.push_back(name);
    const val value = this->Given[name];
    if (value.isUndefined())
    {
      return;
    }
    try
    {
      Require(value.typeOf().as<std::string>() == type);
      assign(value);
    }
    catch (const WrongType&)
    {
      const auto text = val::global("JSON").call<val>("stringify", value);
      throw std::runtime_error(name + " is " +
        (text.isUndefined() ? "no value" : text.as<std::string>().substr(0, 60)) +
        "; allowed: " + allowed);
    }
  }

  const val& Given;
};

} // namespace

std::string DescribeModels()
{
  const auto describe = [](const NamedSettings& model)
  {
    Lister lister;
    const std::unique_ptr<Settings> settings = model.Make();
    settings->Visit(lister);
    lister.AddRefinement(dynamic_cast<const TextureSettings*>(settings.get()) != nullptr);
    const auto input = [](const std::string& word)
    { return "{\"name\":" + Json::Quoted(word) + "}"; };
    const auto itself = [](const std::string& text) { return text; };
    return "{\"name\":" + Json::Quoted(model.Function) + ",\"data\":" + Json::Quoted(model.Data) +
      ",\"needsData\":" + Json::Bool(model.NeedsData) +
      ",\"settings\":" + Json::List(lister.Entries, itself) +
      ",\"inputs\":" + Json::List(WordsOf(model.Inputs), input) + "}";
  };
  return "{\"models\":" + Json::List(SettingsOfModels, describe) + "}";
}

void AssignSettings(const NamedSettings& model, Settings& settings, const val& given,
  const std::vector<std::string>& others)
{
  val whole = val::global("Object").call<val>("assign", val::object(), given);
  const std::vector<std::string> found = WordsOf(model.Found);
  for (std::size_t k = 0; k + 1 < found.size(); k += 2)
  {
    if (!given[found[k]].isUndefined() && given[found[k + 1]].isUndefined())
    {
      whole.set(found[k + 1], false);
    }
  }
  Assigner assigner(whole);
  settings.Visit(assigner);
  const std::vector<std::string> keys =
    emscripten::vecFromJSArray<std::string>(val::global("Object").call<val>("keys", given));
  for (const std::string& key : keys)
  {
    const auto isIn = [&](const std::vector<std::string>& names)
    { return std::find(names.begin(), names.end(), key) != names.end(); };
    if (!isIn(assigner.Names) && !isIn(others))
    {
      throw std::runtime_error(std::string(model.Function) + " has no setting or input " + key);
    }
  }
}

} // namespace SurfaceDiffusion
