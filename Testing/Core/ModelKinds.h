// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/HarmonicMapSettings.h"
#include "Run/HeatSettings.h"
#include "Run/InterpolationSettings.h"
#include "Run/MumfordShahSettings.h"
#include "Run/SegmentationSettings.h"
#include "Run/TensorDiffusionSettings.h"
#include "Run/TextureSettings.h"
#include "Run/TotalVariationSettings.h"

#include <algorithm>
#include <fstream>
#include <functional>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

/// All models, for the tests of what every model promises.
namespace SurfaceDiffusion::Testing
{

/// The data that a model is run on.
enum class Content
{
  Scalars,
  Colors,
  UnitVectors,
  Nothing,
  ScalarsOnCells,
  ColorsOnCells,
  UnitVectorsOnCells
};

/// What a model does not promise.
enum class Exemption
{
  None,
  /// It starts on a coarser mesh, or has tangent planes where three sheets meet: by the numbering.
  Numbering,
  Energy, ///< its energy can rise: eps is halved, or the scheme is explicit
  Allocation ///< one solver is used for different systems in turn
};

/// A model with settings that take a way of their own through its code: a line of kinds_of_run.txt.
struct ModelKind
{
  std::string Name;
  /// The settings. The model that is made with them is written to `made`, if that is not null.
  std::function<std::shared_ptr<RunSettings>(Model** made)> Make;
  Content Data = Content::Scalars;
  Exemption From = Exemption::None;

  bool IsOnCells() const { return this->Data >= Content::ScalarsOnCells; }
  bool HasUnitVectors() const
  {
    return this->Data == Content::UnitVectors || this->Data == Content::UnitVectorsOnCells;
  }
  bool HasScalars() const
  {
    return this->Data == Content::Scalars || this->Data == Content::ScalarsOnCells;
  }
  int NumberOfComponents() const { return this->HasScalars() ? 1 : 3; }
};

inline void PrintTo(const ModelKind& kind, std::ostream* os)
{
  *os << kind.Name;
}

/// The words of Content and Exemption in kinds_of_run.txt, in their order.
constexpr const char* ContentWords[] = { "Scalars", "Colors", "UnitVectors", "Nothing",
  "ScalarsOnCells", "ColorsOnCells", "UnitVectorsOnCells" };
constexpr const char* ExemptionWords[] = { "None", "Numbering", "Energy", "Allocation" };

/// Sets one setting to a number or a word.
class TextSetter : public SettingVisitor
{
public:
  using SettingVisitor::Choice;
  TextSetter(std::string name, std::string value)
    : Name(std::move(name))
    , Value(std::move(value))
  {
  }
  void Number(const SettingInfo& info, double& value, const SettingRange&) override
  {
    this->Set(info, value);
  }
  void Integer(const SettingInfo& info, int& value, const SettingRange&) override
  {
    this->Set(info, value);
  }
  void Switch(const SettingInfo& info, bool& value) override { this->Set(info, value); }
  void Choice(const SettingInfo& info, int& value, const std::vector<const char*>& words,
    const std::vector<bool>&) override
  {
    if (info.Name == this->Name)
    {
      value = static_cast<int>(std::find(words.begin(), words.end(), this->Value) - words.begin());
      this->IsDone = value < static_cast<int>(words.size());
    }
  }

  bool IsDone = false;

private:
  template <typename T>
  void Set(const SettingInfo& info, T& value)
  {
    if (info.Name == this->Name)
    {
      value = static_cast<T>(std::stod(this->Value));
      this->IsDone = true;
    }
  }

  const std::string Name, Value;
};

/// Settings of a class that remember the model that is made with them.
template <typename ModelSettings>
std::shared_ptr<RunSettings> MakeWatched(Model** made)
{
  struct Watched : ModelSettings
  {
    Model** Made = nullptr;
    std::unique_ptr<Model> Make(ModelInputs& inputs, RunResult& result) const override
    {
      auto model = this->ModelSettings::Make(inputs, result);
      if (this->Made)
      {
        *this->Made = model.get();
      }
      return model;
    }
  };
  auto settings = std::make_shared<Watched>();
  settings->Made = made;
  return settings;
}

constexpr std::pair<const char*, std::shared_ptr<RunSettings> (*)(Model**)> SettingsOfModels[] = {
  { "Heat", MakeWatched<HeatSettings> },
  { "TotalVariation", MakeWatched<TotalVariationSettings> },
  { "HarmonicMap", MakeWatched<HarmonicMapSettings> },
  { "MumfordShah", MakeWatched<MumfordShahSettings> },
  { "TensorDiffusion", MakeWatched<TensorDiffusionSettings> },
  { "Texture", MakeWatched<TextureSettings> },
  { "Segmentation", MakeWatched<SegmentationSettings> },
  { "Interpolation", MakeWatched<InterpolationSettings> },
};

/// The kind of a line, behind its first word.
inline ModelKind ReadModelKind(std::istream& words)
{
  ModelKind kind;
  std::string className, content;
  std::vector<std::pair<std::string, std::string>> values;
  words >> kind.Name >> className >> content;
  kind.Data = static_cast<Content>(
    std::find(std::begin(ContentWords), std::end(ContentWords), content) - ContentWords);
  for (std::string word; words >> word;)
  {
    const std::size_t sign = word.find('=');
    if (sign != std::string::npos)
    {
      values.emplace_back(word.substr(0, sign), word.substr(sign + 1));
      continue;
    }
    kind.From = static_cast<Exemption>(
      std::find(std::begin(ExemptionWords), std::end(ExemptionWords), word) - ExemptionWords);
  }
  const auto* const made = std::find_if(std::begin(SettingsOfModels), std::end(SettingsOfModels),
    [&](const auto& entry) { return entry.first == className; });
  if (made == std::end(SettingsOfModels) || kind.Data > Content::UnitVectorsOnCells ||
    kind.From > Exemption::Allocation)
  {
    throw std::invalid_argument("kinds_of_run.txt has an unknown word for " + kind.Name);
  }
  kind.Make = [values, make = made->second](Model** model)
  {
    auto settings = make(model);
    for (const auto& [name, value] : values)
    {
      TextSetter setter(name, value);
      settings->Visit(setter);
      if (!setter.IsDone)
      {
        throw std::invalid_argument("there is no setting " + name + " or no value " + value);
      }
    }
    return settings;
  };
  return kind;
}

/// Every model, with every scheme and every discretisation that it has.
inline const std::vector<ModelKind>& AllModelKinds()
{
  static const std::vector<ModelKind> all = []
  {
    std::vector<ModelKind> kinds;
    std::ifstream file(SURFACEDIFFUSION_KINDS_OF_RUN);
    for (std::string line; std::getline(file, line);)
    {
      std::istringstream words(line);
      std::string first;
      if (words >> first && first == "model")
      {
        kinds.push_back(ReadModelKind(words));
      }
    }
    return kinds;
  }();
  return all;
}

} // namespace SurfaceDiffusion::Testing
