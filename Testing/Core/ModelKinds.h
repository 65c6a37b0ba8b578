// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "KindsOfRun.h"
#include "Run/HarmonicMapSettings.h"
#include "Run/HeatSettings.h"
#include "Run/InterpolationSettings.h"
#include "Run/MumfordShahSettings.h"
#include "Run/SegmentationSettings.h"
#include "Run/TensorDiffusionSettings.h"
#include "Run/TextureSettings.h"
#include "Run/TotalVariationSettings.h"

#include <algorithm>
#include <functional>
#include <memory>
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

/// The model of a line.
inline ModelKind MakeModelKind(const KindLine& line)
{
  const auto wordAt = [&](std::size_t place)
  { return place < line.Words.size() ? line.Words[place] : std::string("None"); };
  const auto indexOf = [](const auto& words, const std::string& word)
  { return std::find(std::begin(words), std::end(words), word) - std::begin(words); };
  ModelKind kind;
  kind.Name = wordAt(0);
  kind.Data = static_cast<Content>(indexOf(ContentWords, wordAt(2)));
  kind.From = static_cast<Exemption>(indexOf(ExemptionWords, wordAt(3)));
  const auto* const made = std::find_if(std::begin(SettingsOfModels), std::end(SettingsOfModels),
    [&](const auto& entry) { return entry.first == wordAt(1); });
  if (made == std::end(SettingsOfModels) || kind.Data > Content::UnitVectorsOnCells ||
    kind.From > Exemption::Allocation)
  {
    throw std::invalid_argument("kinds_of_run.txt has an unknown word for " + kind.Name);
  }
  kind.Make = [values = line.Values, make = made->second](Model** model)
  {
    auto settings = make(model);
    for (const auto& [name, value] : values)
    {
      SetByText(*settings, name, value);
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
    for (const KindLine& line : ReadKindsOfRun(SURFACEDIFFUSION_KINDS_OF_RUN, true))
    {
      kinds.push_back(MakeModelKind(line));
    }
    return kinds;
  }();
  return all;
}

} // namespace SurfaceDiffusion::Testing
