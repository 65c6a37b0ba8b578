// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/OwnedSettings.h"

#include <cstring>
#include <type_traits>

namespace SurfaceDiffusion
{

namespace
{

/// Calls `use` with the value of type T that has a name.
template <typename T, typename Use>
class ValueFinder : public SettingVisitor
{
public:
  using SettingVisitor::Choice;
  ValueFinder(const char* name, const Use& use)
    : Name(name)
    , WithValue(use)
  {
  }
  void Number(const SettingInfo& info, double& value, const SettingRange&) override
  {
    this->See(info, value);
  }
  void Integer(const SettingInfo& info, int& value, const SettingRange&) override
  {
    this->See(info, value);
  }
  void Numbers(const SettingInfo&, std::vector<double>&, const SettingRange&) override {}
  void Switch(const SettingInfo& info, bool& value) override { this->See(info, value); }
  void Choice(const SettingInfo& info, int& value, const std::vector<const char*>&,
    const std::vector<bool>&) override
  {
    this->See(info, value);
  }

private:
  template <typename U>
  void See(const SettingInfo& info, U& value) const
  {
    if constexpr (std::is_same_v<T, U>)
    {
      if (std::strcmp(info.Name, this->Name) == 0)
      {
        this->WithValue(value);
      }
    }
  }

  const char* const Name;
  const Use& WithValue;
};

template <typename T, typename Use>
void UseSetting(Settings& settings, const char* name, const Use& use)
{
  ValueFinder<T, Use> finder(name, use);
  settings.Visit(finder);
}

} // namespace

template <typename T>
bool ReadSetting(Settings& settings, const char* name, T& value)
{
  bool found = false;
  UseSetting<T>(settings, name,
    [&](const T& present)
    {
      value = present;
      found = true;
    });
  return found;
}

template <typename T>
SettingChange WriteSetting(Settings& settings, const char* name, T value)
{
  auto change = SettingChange::Unknown;
  UseSetting<T>(settings, name,
    [&](T& present)
    {
      change = present == value ? SettingChange::None : SettingChange::Changed;
      present = value;
    });
  return change;
}

template bool ReadSetting(Settings&, const char*, double&);
template bool ReadSetting(Settings&, const char*, int&);
template bool ReadSetting(Settings&, const char*, bool&);
template SettingChange WriteSetting(Settings&, const char*, double);
template SettingChange WriteSetting(Settings&, const char*, int);
template SettingChange WriteSetting(Settings&, const char*, bool);

} // namespace SurfaceDiffusion
