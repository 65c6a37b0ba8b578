// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SettingsTable.h"

#include "Run/PythonNames.h"
#include "Run/Solve.h"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <sstream>
#include <utility>

namespace nb = nanobind;

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
    nb::dict entry = this->Add(info, "number");
    entry["default"] = value;
    entry["allowed"] = range.Restricted ? range.Text : "finite numbers";
  }
  void Integer(const SettingInfo& info, int& value, const SettingRange& range) override
  {
    nb::dict entry = this->Add(info, "integer");
    entry["default"] = value;
    entry["allowed"] = range.Low < range.High ? range.Text : "integers of 32 bits";
  }
  void Numbers(const SettingInfo& info, std::vector<double>& values, const SettingRange&) override
  {
    nb::dict entry = this->Add(info, "numbers");
    entry["default"] = nb::cast(values);
    entry["allowed"] = "finite numbers";
  }
  void Switch(const SettingInfo& info, bool& value) override
  {
    nb::dict entry = this->Add(info, "switch");
    entry["default"] = value;
    entry["allowed"] = "True or False";
  }
  void Choice(const SettingInfo& info, int& value, const std::vector<const char*>& words,
    const std::vector<bool>& allowed) override
  {
    nb::dict entry = this->Add(info, "choice");
    nb::list all;
    nb::list usable;
    for (std::size_t w = 0; w < words.size(); ++w)
    {
      all.append(words[w]);
      if (allowed.empty() || allowed[w])
      {
        usable.append(words[w]);
      }
    }
    entry["words"] = all;
    entry["usable"] = usable;
    entry["default"] = all[static_cast<std::size_t>(value)];
    entry["allowed"] = nb::str(", ").attr("join")(usable);
  }

  nb::list Entries;

private:
  nb::dict Add(const SettingInfo& info, const char* kind)
  {
    nb::dict entry;
    entry["name"] = info.Name;
    entry["unit"] = info.Unit;
    entry["documentation"] = info.Documentation;
    entry["is_of_pipelines"] = IsOfPipelines(info.Name);
    entry["is_of_output"] = info.Scope == SettingScope::Output;
    entry["kind"] = kind;
    this->Entries.append(entry);
    return entry;
  }
};

class Assigner : public SettingVisitor
{
public:
  using SettingVisitor::Choice;
  explicit Assigner(const nb::dict& values)
    : Given(values)
  {
  }

  void Number(const SettingInfo& info, double& value, const SettingRange&) override
  {
    this->Assign(info, value);
  }
  void Integer(const SettingInfo& info, int& value, const SettingRange&) override
  {
    this->Assign(info, value);
  }
  void Numbers(const SettingInfo& info, std::vector<double>& values, const SettingRange&) override
  {
    this->Assign(info, values);
  }
  void Switch(const SettingInfo& info, bool& value) override { this->Assign(info, value); }
  void Choice(const SettingInfo& info, int& value, const std::vector<const char*>&,
    const std::vector<bool>&) override
  {
    this->Assign(info, value);
  }

private:
  template <typename T>
  void Assign(const SettingInfo& info, T& value)
  {
    if (this->Given.contains(info.Name))
    {
      value = nb::cast<T>(this->Given[info.Name]);
    }
  }

  const nb::dict& Given;
};

const char* NameOf(Word::Kind kind)
{
  switch (kind)
  {
    case Word::Kind::Setting:
      return "setting";
    case Word::Kind::Array:
      return "array";
    case Word::Kind::Choice:
      return "choice";
    case Word::Kind::Switch:
      return "switch";
    case Word::Kind::Cell:
      return "face";
    default:
      return "text";
  }
}

} // namespace

nb::list ListWords(const Sentence& sentence)
{
  nb::list words;
  for (const Word& word : sentence.Words())
  {
    words.append(nb::make_tuple(NameOf(word.Type), word.Spelling, word.Name, word.Value));
  }
  return words;
}

std::unique_ptr<Settings> MakeSettings(const std::string& model)
{
  const NamedSettings* const found = FindModel(model);
  if (!found)
  {
    throw nb::key_error(model.c_str());
  }
  return found->Make();
}

std::unique_ptr<RunSettings> MakeRunSettings(const std::string& model)
{
  std::unique_ptr<Settings> settings = MakeSettings(model);
  auto* const found = dynamic_cast<RunSettings*>(settings.get());
  if (!found)
  {
    throw nb::key_error(model.c_str());
  }
  settings.release();
  return std::unique_ptr<RunSettings>(found);
}

nb::list ListSettings(Settings& settings)
{
  Lister lister;
  settings.Visit(lister);
  return lister.Entries;
}

nb::dict ListFound(const std::string& model)
{
  nb::dict found;
  const NamedSettings* const settings = FindModel(model);
  std::istringstream words(settings ? settings->Found : "");
  for (std::string name, off; words >> name >> off;)
  {
    found[nb::cast(name)] = off;
  }
  return found;
}

void AssignSettings(Settings& settings, const nb::dict& values)
{
  Assigner assigner(values);
  settings.Visit(assigner);
}

nb::list FindProblems(const std::string& model, const nb::dict& values, const FieldSummary* fields)
{
  const std::unique_ptr<Settings> settings = MakeSettings(model);
  AssignSettings(*settings, values);
  Problems problems;
  settings->Check(fields, problems);
  nb::list list;
  for (const Sentence& problem : problems)
  {
    list.append(ListWords(problem));
  }
  return list;
}

namespace
{

/// Null if the model has no time steps.
std::unique_ptr<TimeSettings> MakeTimeSettings(const std::string& model, const nb::dict& values)
{
  std::unique_ptr<Settings> settings = MakeSettings(model);
  AssignSettings(*settings, values);
  auto* const found = dynamic_cast<TimeSettings*>(settings.get());
  if (found)
  {
    settings.release();
  }
  return std::unique_ptr<TimeSettings>(found);
}

} // namespace

nb::object FindTimes(const std::string& model, const nb::dict& values, int last)
{
  const std::unique_ptr<TimeSettings> settings = MakeTimeSettings(model, values);
  Problems problems;
  if (settings)
  {
    settings->Check(nullptr, problems);
  }
  if (!settings || !problems.empty() || !settings->PublishesTimes())
  {
    return nb::none();
  }
  const ModelTraits traits = settings->DescribeModel();
  nb::dict found;
  found["times"] = nb::cast(settings->PublishedTimes(last < 0 ? traits.NumberOfSteps : last));
  found["time_step"] = traits.TimeStep;
  found["number_of_steps"] = traits.NumberOfSteps;
  return found;
}

double FindTimeStep(const std::string& model, const nb::dict& values)
{
  return MakeTimeSettings(model, values)->DescribeModel().TimeStep;
}

bool HasIndependentColumns(const std::string& model, const nb::dict& values)
{
  return MakeTimeSettings(model, values)->DescribeModel().ColumnsAreIndependent;
}

int FindStep(const std::string& model, const nb::dict& values, double time, int last)
{
  return MakeTimeSettings(model, values)->FindStep(time, last);
}

} // namespace SurfaceDiffusion
