// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/Settings.h"

#include <memory>

namespace SurfaceDiffusion
{

/// The settings of a filter, of any class, as a value.
class OwnedSettings
{
public:
  /// Settings of the class T, with their defaults.
  template <typename T>
  static OwnedSettings Make()
  {
    OwnedSettings made;
    made.Values = std::make_unique<T>();
    made.MakeCopy = [](const Settings& values) -> std::shared_ptr<Settings>
    { return std::make_shared<T>(static_cast<const T&>(values)); };
    return made;
  }

  Settings& Get() const { return *this->Values; }

  /// An independent copy, which later changes do not reach.
  std::shared_ptr<Settings> Copy() const { return this->MakeCopy(*this->Values); }

private:
  std::unique_ptr<Settings> Values;
  std::shared_ptr<Settings> (*MakeCopy)(const Settings&) = nullptr;
};

/// Read the setting `name`: double is the type of a number, int that of an integer and of the index
/// of a word, and bool that of a switch. False if there is no setting of this name and type.
template <typename T>
bool ReadSetting(Settings& settings, const char* name, T& value);

/// What WriteSetting() has done.
enum class SettingChange
{
  Unknown, ///< there is no setting of this name and type
  None, ///< it has this value already
  Changed
};

/// Set the setting `name`, with the types of ReadSetting(). The value is checked with the others.
template <typename T>
SettingChange WriteSetting(Settings& settings, const char* name, T value);

} // namespace SurfaceDiffusion
