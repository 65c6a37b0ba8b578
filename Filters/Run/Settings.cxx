// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/Settings.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <sstream>
#include <utility>

namespace SurfaceDiffusion
{

bool SettingRange::Contains(double value) const
{
  if (!this->Restricted)
  {
    return true;
  }
  if (!std::isfinite(value))
  {
    return false;
  }
  if (!(this->Low < this->High) || (this->HasSpecial && value == this->Special))
  {
    return true;
  }
  return (this->LowIncluded ? value >= this->Low : value > this->Low) &&
    (this->HighIncluded ? value <= this->High : value < this->High);
}

SettingRange SettingRange::Anything()
{
  SettingRange range;
  range.Text = "any number";
  range.Restricted = false;
  return range;
}

SettingRange SettingRange::AnyFinite()
{
  SettingRange range;
  range.Text = "finite numbers";
  return range;
}

SettingRange SettingRange::AtLeast(double low, const char* text)
{
  return Between(low, std::numeric_limits<double>::infinity(), text);
}

SettingRange SettingRange::Positive()
{
  SettingRange range = AtLeast(0.0, "finite numbers above 0");
  range.LowIncluded = false;
  return range;
}

SettingRange SettingRange::NonNegative()
{
  return AtLeast(0.0, "finite numbers, 0 or more");
}

SettingRange SettingRange::OpenUnitInterval()
{
  SettingRange range = Between(0.0, 1.0, "numbers between 0 and 1, ends excluded");
  range.LowIncluded = range.HighIncluded = false;
  return range;
}

SettingRange SettingRange::ClosedUnitInterval()
{
  return Between(0.0, 1.0, "numbers from 0 to 1");
}

SettingRange SettingRange::Between(double low, double high, const char* text)
{
  SettingRange range;
  range.Text = text;
  range.Low = low;
  range.High = high;
  return range;
}

SettingRange SettingRange::NonNegativeOr(double special, const char* text)
{
  SettingRange range = AtLeast(0.0, text);
  range.HasSpecial = true;
  range.Special = special;
  return range;
}

namespace
{

class Collector : public NumberVisitor
{
public:
  Collector(SettingScope scope, std::vector<double>& values)
    : Scope(scope)
    , Values(values)
  {
  }

private:
  void See(const SettingInfo& info, double value) override
  {
    if (info.Scope == this->Scope)
    {
      this->Values.push_back(value);
    }
  }

  const SettingScope Scope;
  std::vector<double>& Values;
};

class RangeChecker : public SettingVisitor
{
public:
  using SettingVisitor::Choice;
  explicit RangeChecker(Problems& found)
    : Found(found)
  {
  }
  void Number(const SettingInfo& info, double& value, const SettingRange& range) override
  {
    Require(range.Contains(value), Word::Setting(info.Name), value, range.Text, this->Found);
  }
  void Integer(const SettingInfo& info, int& value, const SettingRange& range) override
  {
    Require(range.Contains(value), Word::Setting(info.Name), value, range.Text, this->Found);
  }
  void Switch(const SettingInfo&, bool&) override {}
  void Choice(const SettingInfo& info, int& value, const std::vector<const char*>& words,
    const std::vector<bool>& allowed) override
  {
    const auto index = static_cast<std::size_t>(value);
    const bool holds = value >= 0 && index < words.size() && (allowed.empty() || allowed[index]);
    Require(holds, Word::Setting(info.Name), Word::Number(info.Name, value),
      ListChoices(info.Name, words, allowed), this->Found);
  }

private:
  Problems& Found;
};

class Describer : public SettingVisitor
{
public:
  using SettingVisitor::Choice;
  explicit Describer(std::string indent)
    : Indent(std::move(indent))
  {
  }
  void Number(const SettingInfo& info, double& value, const SettingRange&) override
  {
    this->Text << this->Indent << info.Name << ": " << value << "\n";
  }
  void Integer(const SettingInfo& info, int& value, const SettingRange&) override
  {
    this->Text << this->Indent << info.Name << ": " << value << "\n";
  }
  void Numbers(const SettingInfo& info, std::vector<double>& values, const SettingRange&) override
  {
    this->Text << this->Indent << info.Name << ":" << (values.empty() ? " none" : "");
    for (const double value : values)
    {
      this->Text << ' ' << value;
    }
    this->Text << "\n";
  }
  void Switch(const SettingInfo& info, bool& value) override
  {
    this->Text << this->Indent << info.Name << ": " << (value ? "On" : "Off") << "\n";
  }
  void Choice(const SettingInfo& info, int& value, const std::vector<const char*>& words,
    const std::vector<bool>&) override
  {
    const bool known = value >= 0 && static_cast<std::size_t>(value) < words.size();
    this->Text << this->Indent << info.Name << ": " << (known ? words[value] : "Unknown") << "\n";
  }

  std::ostringstream Text;

private:
  const std::string Indent;
};

class WordFinder : public SettingVisitor
{
public:
  using SettingVisitor::Choice;
  explicit WordFinder(const std::string& name)
    : Name(name)
  {
  }
  void Number(const SettingInfo&, double&, const SettingRange&) override {}
  void Integer(const SettingInfo&, int&, const SettingRange&) override {}
  void Switch(const SettingInfo&, bool&) override {}
  void Choice(const SettingInfo& info, int& value, const std::vector<const char*>& words,
    const std::vector<bool>&) override
  {
    if (this->Name == info.Name && value >= 0 && static_cast<std::size_t>(value) < words.size())
    {
      this->Word = words[value];
    }
  }

  const char* Word = "Unknown";

private:
  const std::string& Name;
};

} // namespace

SettingsSnapshot::SettingsSnapshot(Settings& settings, SettingScope scope)
{
  Collector collector(scope, this->Values);
  settings.Visit(collector);
}

void Require(bool holds, const Sentence& subject, const Sentence& value, const Sentence& allowed,
  Problems& problems)
{
  if (!holds)
  {
    problems.emplace_back(subject);
    problems.back() << " is " << value << "; allowed: " << allowed;
  }
}

void Require(
  bool holds, const Sentence& subject, double value, const Sentence& allowed, Problems& problems)
{
  std::ostringstream text;
  text.precision(std::numeric_limits<double>::max_digits10 - 2);
  text << value;
  Require(holds, subject, Sentence(text.str()), allowed, problems);
}

void ThrowProblems(Problems problems)
{
  std::sort(problems.begin(), problems.end());
  problems.erase(std::unique(problems.begin(), problems.end()), problems.end());
  if (!problems.empty())
  {
    throw InputError(Join(problems));
  }
}

void Settings::Check(const FieldSummary*, Problems& problems)
{
  CheckRanges(*this, problems);
}

void CheckRanges(Settings& settings, Problems& problems)
{
  RangeChecker checker(problems);
  settings.Visit(checker);
}

std::string Describe(Settings& settings, const std::string& indent)
{
  Describer describer(indent);
  settings.Visit(describer);
  return describer.Text.str();
}

const char* FindWord(Settings& settings, const std::string& name)
{
  WordFinder finder(name);
  settings.Visit(finder);
  return finder.Word;
}

Sentence ListChoices(
  const std::string& name, const std::vector<const char*>& words, const std::vector<bool>& allowed)
{
  Sentence list;
  for (std::size_t w = 0; w < words.size(); ++w)
  {
    if (allowed.empty() || allowed[w])
    {
      list << (list.Words().empty() ? "" : ", ") << Word::NumberedChoice(name, w, words[w]);
    }
  }
  return list;
}

} // namespace SurfaceDiffusion
