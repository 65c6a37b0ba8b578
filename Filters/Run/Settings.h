// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/Sentence.h"

#include <string>
#include <vector>

namespace SurfaceDiffusion
{

struct FieldSummary;

/// The part of a run that has to be recomputed if a setting changes.
enum class SettingScope
{
  Surface, ///< the mesh, and everything after it
  Model, ///< the model and its states
  Output ///< nothing: no state depends on the setting
};

/// The allowed values of a number, and their wording in error messages.
struct SettingRange
{
  const char* Text = "any finite number";
  double Low = 0.0, High = 0.0; ///< used if Low < High
  bool LowIncluded = true, HighIncluded = true;
  bool Restricted = true; ///< false: any number, even NaN
  bool HasSpecial = false; ///< one more value is allowed, with a meaning of its own
  double Special = 0.0;

  /// False for NaN, for infinite values, and outside the range.
  bool Contains(double value) const;

  /// The range of a setting that has no effect with the present values of the others.
  static SettingRange Anything();
  static SettingRange AnyFinite();
  static SettingRange Positive();
  static SettingRange NonNegative();
  static SettingRange OpenUnitInterval();
  static SettingRange ClosedUnitInterval();
  static SettingRange Between(double low, double high, const char* text);
  static SettingRange AtLeast(double low, const char* text);
  /// 0 or more, or `special`.
  static SettingRange NonNegativeOr(double special, const char* text);
};

/// The description of one setting: the single place for its name, range, unit and meaning.
struct SettingInfo
{
  SettingInfo(const char* name, const char* unit, const char* documentation,
    SettingScope scope = SettingScope::Model, const char* onlyIf = "")
    : Name(name)
    , Unit(unit)
    , Documentation(documentation)
    , Scope(scope)
    , OnlyIf(onlyIf)
  {
  }
  SettingInfo(const char* name, const char* unit, const char* documentation, const char* onlyIf)
    : SettingInfo(name, unit, documentation, SettingScope::Model, onlyIf)
  {
  }

  const char* Name; ///< as in ParaView and VTK, for instance "TimeStep"
  const char* Unit; ///< empty for pure numbers
  const char* Documentation;
  SettingScope Scope;
  /// The condition under which forms offer the setting: it has an effect then, or has a value that excludes
  /// others. "Exact=0 and (MaskArray or Method=Heat)": values of other settings, numbers or the words of
  /// choices; names of arrays that are given, !MaskArray: that are not; CellData: the data are on cells.
  /// ';' separates conditions that hold together. Terms of settings that a model does not have hold.
  const char* OnlyIf;
};

/// Receives every setting of a run with its description. A visitor may change the values.
class SettingVisitor
{
public:
  virtual ~SettingVisitor() = default;
  virtual void Number(const SettingInfo& info, double& value, const SettingRange& range) = 0;
  virtual void Integer(const SettingInfo& info, int& value, const SettingRange& range) = 0;
  /// A list of any length. Unless overridden, each entry is visited as a number.
  virtual void Numbers(
    const SettingInfo& info, std::vector<double>& values, const SettingRange& range)
  {
    for (double& value : values)
    {
      this->Number(info, value, range);
    }
  }
  virtual void Switch(const SettingInfo& info, bool& value) = 0;
  /// `value` is the index of one of the words. Only those with a true entry in `allowed` may be
  /// chosen; an empty list allows all.
  virtual void Choice(const SettingInfo& info, int& value, const std::vector<const char*>& words,
    const std::vector<bool>& allowed) = 0;

  template <typename Enum>
  void Choice(const SettingInfo& info, Enum& value, const std::vector<const char*>& words,
    const std::vector<bool>& allowed = {})
  {
    int number = static_cast<int>(value);
    this->Choice(info, number, words, allowed);
    value = static_cast<Enum>(number);
  }
};

/// Sees every value as a number.
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

/// One sentence per setting: name, value and what is allowed.
using Problems = std::vector<Sentence>;

/// A set of settings that can list itself. Copies are values; the functions below work on any.
class Settings
{
public:
  virtual ~Settings() = default;
  virtual void Visit(SettingVisitor& visitor) = 0;
  /// Append the problems of the settings, and with `fields` those of settings and arrays together.
  /// fields: null if the arrays are not known yet. The default checks the ranges.
  virtual void Check(const FieldSummary* fields, Problems& problems);
};

/// The values of all settings of one scope, in the order of Visit(). Two snapshots of one class are
/// equal if and only if no such setting differs, so that no separate list of the dependencies of a
/// result is necessary.
class SettingsSnapshot
{
public:
  SettingsSnapshot() = default;
  SettingsSnapshot(Settings& settings, SettingScope scope);

  friend bool operator==(const SettingsSnapshot& a, const SettingsSnapshot& b)
  {
    return a.Values == b.Values;
  }
  friend bool operator!=(const SettingsSnapshot& a, const SettingsSnapshot& b) { return !(a == b); }

private:
  std::vector<double> Values;
};

/// Throws InputError with all of them, sorted, each once, if there are any.
void ThrowProblems(Problems problems);

/// Append a sentence for each setting whose value is outside its range.
void CheckRanges(Settings& settings, Problems& problems);

/// Append "`subject` is `value`; allowed: `allowed`" unless `holds`.
void Require(bool holds, const Sentence& subject, const Sentence& value, const Sentence& allowed,
  Problems& problems);
void Require(
  bool holds, const Sentence& subject, double value, const Sentence& allowed, Problems& problems);

/// Append "`name` is `value`; allowed: `needed` together with `purpose`" unless the choice `name`
/// has the value `needed`, whose word is `word`.
template <typename Enum>
void RequireChoice(const char* name, Enum value, Enum needed, const char* word,
  const Sentence& purpose, Problems& problems)
{
  Require(value == needed, Word::Setting(name), Word::Number(name, value),
    Sentence(Word::NumberedChoice(name, needed, word)) << " together with " << purpose, problems);
}

/// "Name: value" lines, with words for choices, each after `indent`.
std::string Describe(Settings& settings, const std::string& indent);

/// The word of the choice `name`; "Unknown" for a number without a word.
const char* FindWord(Settings& settings, const std::string& name);

/// "0 First, 1 Second" for the words of a choice that are allowed.
Sentence ListChoices(const std::string& name, const std::vector<const char*>& words,
  const std::vector<bool>& allowed = {});

} // namespace SurfaceDiffusion
