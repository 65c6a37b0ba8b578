// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/Settings.h"

#include <map>
#include <string>
#include <utility>

namespace SurfaceDiffusion
{

/// Passes settings on to a visitor, some of them with another documentation and unit: those that
/// mean something else in a model than in its base class.
class Rewording : public SettingVisitor
{
public:
  using SettingVisitor::Choice;

  struct Words
  {
    const char* Unit;
    const char* Documentation;
    const char* OnlyIf = nullptr; ///< null: that of the base class
  };

  Rewording(SettingVisitor& visitor, std::map<std::string, Words> words)
    : Visitor(visitor)
    , ByName(std::move(words))
  {
  }

  void Number(const SettingInfo& info, double& value, const SettingRange& range) override
  {
    this->Visitor.Number(this->Reword(info), value, range);
  }
  void Integer(const SettingInfo& info, int& value, const SettingRange& range) override
  {
    this->Visitor.Integer(this->Reword(info), value, range);
  }
  void Numbers(
    const SettingInfo& info, std::vector<double>& values, const SettingRange& range) override
  {
    this->Visitor.Numbers(this->Reword(info), values, range);
  }
  void Switch(const SettingInfo& info, bool& value) override
  {
    this->Visitor.Switch(this->Reword(info), value);
  }
  void Choice(const SettingInfo& info, int& value, const std::vector<const char*>& words,
    const std::vector<bool>& allowed) override
  {
    this->Visitor.Choice(this->Reword(info), value, words, allowed);
  }

private:
  SettingInfo Reword(const SettingInfo& info) const
  {
    const auto found = this->ByName.find(info.Name);
    if (found == this->ByName.end())
    {
      return info;
    }
    const Words& words = found->second;
    return { info.Name, words.Unit, words.Documentation, info.Scope,
      words.OnlyIf ? words.OnlyIf : info.OnlyIf };
  }

  SettingVisitor& Visitor;
  const std::map<std::string, Words> ByName;
};

} // namespace SurfaceDiffusion
