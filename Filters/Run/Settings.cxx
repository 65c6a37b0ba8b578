// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/Settings.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <sstream>

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

/// A visitor that sees every value as a number.
class NumberVisitor : public SettingVisitor
{
public:
  using SettingVisitor::Choice;
  void Number(const SettingInfo& info, double& value, const SettingRange&) override
  {
    this->See(info, value);
  }
  void Integer(const SettingInfo& info, int& value, const SettingRange&) override
  {
    this->See(info, value);
  }
  void Switch(const SettingInfo& info, bool& value) override { this->See(info, value ? 1.0 : 0.0); }
  void Choice(const SettingInfo& info, int& value, const std::vector<const char*>&,
    const std::vector<bool>&) override
  {
    this->See(info, value);
  }

protected:
  virtual void See(const SettingInfo& info, double value) = 0;
};

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
    Require(range.Contains(value), info.Name, value, range.Text, this->Found);
  }
  void Integer(const SettingInfo& info, int& value, const SettingRange& range) override
  {
    Require(range.Contains(value), info.Name, value, range.Text, this->Found);
  }
  void Switch(const SettingInfo&, bool&) override {}
  void Choice(const SettingInfo& info, int& value, const std::vector<const char*>& words,
    const std::vector<bool>& allowed) override
  {
    const auto index = static_cast<std::size_t>(value);
    const bool holds = value >= 0 && index < words.size() && (allowed.empty() || allowed[index]);
    Require(holds, info.Name, value, ListChoices(words, allowed).c_str(), this->Found);
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

/// Lists the settings whose squares may be too large or too small for a double.
class ExtremesFinder : public NumberVisitor
{
public:
  std::ostringstream Text;

private:
  void See(const SettingInfo& info, double value) override
  {
    constexpr double large = 1e100;
    const double size = std::abs(value);
    if (size > large || (size > 0.0 && size < 1.0 / large))
    {
      this->Text << (this->Text.tellp() > 0 ? " and " : "") << info.Name << " is " << value;
    }
  }
};

} // namespace

SettingsSnapshot::SettingsSnapshot(Settings& settings, SettingScope scope)
{
  Collector collector(scope, this->Values);
  settings.Visit(collector);
}

void Require(bool holds, const char* name, double value, const char* allowed, Problems& problems)
{
  if (!holds)
  {
    std::ostringstream text;
    text.precision(std::numeric_limits<double>::max_digits10 - 2);
    text << name << " is " << value << "; allowed: " << allowed;
    problems.push_back(text.str());
  }
}

std::string JoinProblems(Problems problems)
{
  std::sort(problems.begin(), problems.end());
  problems.erase(std::unique(problems.begin(), problems.end()), problems.end());
  std::string text;
  for (const std::string& problem : problems)
  {
    text += (text.empty() ? "" : "; ") + problem;
  }
  return text;
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

std::string NameExtremes(Settings& settings, const std::string& failure)
{
  ExtremesFinder finder;
  settings.Visit(finder);
  const std::string found = finder.Text.str();
  return found.empty()
    ? failure
    : found + ", with which " + failure + "; allowed: magnitudes whose squares a double can hold";
}

std::string ListChoices(const std::vector<const char*>& words, const std::vector<bool>& allowed)
{
  std::string list;
  for (std::size_t w = 0; w < words.size(); ++w)
  {
    if (allowed.empty() || allowed[w])
    {
      list += (list.empty() ? "" : ", ") + std::to_string(w) + " " + words[w];
    }
  }
  return list;
}

} // namespace SurfaceDiffusion
