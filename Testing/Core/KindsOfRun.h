// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/Settings.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

/// The lines of kinds_of_run.txt, which says what they mean.
namespace SurfaceDiffusion::Testing
{

struct KindLine
{
  std::vector<std::string> Words;
  std::vector<std::pair<std::string, std::string>> Values; ///< NAME=VALUE
};

inline KindLine ParseKind(const std::string& text)
{
  KindLine line;
  std::istringstream words(text);
  for (std::string word; words >> word;)
  {
    const std::size_t sign = word.find('=');
    if (sign == std::string::npos)
    {
      line.Words.push_back(word);
    }
    else
    {
      line.Values.emplace_back(word.substr(0, sign), word.substr(sign + 1));
    }
  }
  return line;
}

/// The lines of models, without their first word, or those of filters.
inline std::vector<KindLine> ReadKindsOfRun(const char* path, bool ofModels)
{
  const std::string first = "model ";
  std::vector<KindLine> lines;
  std::ifstream file(path);
  for (std::string text; std::getline(file, text);)
  {
    const bool isModel = text.rfind(first, 0) == 0;
    if (!text.empty() && text[0] != '#' && isModel == ofModels)
    {
      lines.push_back(ParseKind(isModel ? text.substr(first.size()) : text));
    }
  }
  return lines;
}

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

/// Throws std::invalid_argument if there is no setting of this name or no choice with this word.
inline void SetByText(Settings& settings, const std::string& name, const std::string& value)
{
  TextSetter setter(name, value);
  settings.Visit(setter);
  if (!setter.IsDone)
  {
    throw std::invalid_argument("there is no setting " + name + " or no value " + value);
  }
}

} // namespace SurfaceDiffusion::Testing
