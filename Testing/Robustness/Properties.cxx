// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Properties.h"

#include "AllFilters.h"

#include <stdexcept>
#include <utility>

using SurfaceDiffusion::SettingInfo;
using SurfaceDiffusion::SettingRange;

namespace FilterTest
{
namespace
{

/// The protected members of filters that read and write a setting by its name.
struct Access : vtkSurfaceFilter
{
  static SurfaceDiffusion::Settings& SettingsOf(vtkSurfaceFilter* filter)
  {
    return (filter->*&Access::GetSettings)();
  }
  template <typename T>
  static T Read(vtkSurfaceFilter* filter, const std::string& name)
  {
    T value{};
    constexpr void (vtkSurfaceFilter::*read)(const char*, T&) const = &Access::ReadProperty<T>;
    (filter->*read)(name.c_str(), value);
    return value;
  }
  template <typename T>
  static void Write(vtkSurfaceFilter* filter, const std::string& name, T value)
  {
    constexpr void (vtkSurfaceFilter::*write)(const char*, T) = &Access::WriteProperty<T>;
    (filter->*write)(name.c_str(), value);
  }
};

/// Lists of numbers are no properties of this kind.
class Lister : public SurfaceDiffusion::SettingVisitor
{
public:
  using SettingVisitor::Choice;
  void Number(const SettingInfo& info, double& value, const SettingRange& range) override
  {
    this->List.push_back({ info.Name, Property::Form::Number, value, range });
  }
  void Integer(const SettingInfo& info, int& value, const SettingRange& range) override
  {
    this->List.push_back({ info.Name, Property::Form::Integer, double(value), range });
  }
  void Numbers(const SettingInfo&, std::vector<double>&, const SettingRange&) override {}
  void Switch(const SettingInfo& info, bool& value) override
  {
    this->List.push_back({ info.Name, Property::Form::Switch, value ? 1.0 : 0.0 });
  }
  void Choice(const SettingInfo& info, int& value, const std::vector<const char*>& words,
    const std::vector<bool>& allowed) override
  {
    this->List.push_back({ info.Name, Property::Form::Choice, double(value), {},
      { words.begin(), words.end() }, allowed });
  }

  std::vector<Property> List;
};

template <typename Filter>
vtkSmartPointer<vtkPolyDataAlgorithm> Make()
{
  return vtkSmartPointer<Filter>::New();
}

constexpr std::pair<const char*, vtkSmartPointer<vtkPolyDataAlgorithm> (*)()> Classes[] = {
  { "vtkFVMHeatFilter", Make<vtkFVMHeatFilter> },
  { "vtkIntrinsicTVFilter", Make<vtkIntrinsicTVFilter> },
  { "vtkHarmonicMapFilter", Make<vtkHarmonicMapFilter> },
  { "vtkMumfordShahFilter", Make<vtkMumfordShahFilter> },
  { "vtkTensorDiffusionFilter", Make<vtkTensorDiffusionFilter> },
  { "vtkTuringTextureFilter", Make<vtkTuringTextureFilter> },
  { "vtkSurfaceDenoisingFilter", Make<vtkSurfaceDenoisingFilter> },
  { "vtkSurfaceCurvatureFilter", Make<vtkSurfaceCurvatureFilter> },
  { "vtkSurfaceRandomFieldFilter", Make<vtkSurfaceRandomFieldFilter> },
  { "vtkSurfaceDerivativesFilter", Make<vtkSurfaceDerivativesFilter> },
  { "vtkSurfaceDistanceFilter", Make<vtkSurfaceDistanceFilter> },
  { "vtkSurfaceDirectionFieldFilter", Make<vtkSurfaceDirectionFieldFilter> },
  { "vtkSurfaceReliefFilter", Make<vtkSurfaceReliefFilter> },
  { "vtkSurfaceSegmentationFilter", Make<vtkSurfaceSegmentationFilter> },
  { "vtkSurfaceInterpolationFilter", Make<vtkSurfaceInterpolationFilter> },
};

} // namespace

double Property::Get(vtkPolyDataAlgorithm* filter) const
{
  auto* const surface = vtkSurfaceFilter::SafeDownCast(filter);
  switch (this->Type)
  {
    case Form::Number:
      return Access::Read<double>(surface, this->Name);
    case Form::Switch:
      return Access::Read<bool>(surface, this->Name);
    default:
      return Access::Read<int>(surface, this->Name);
  }
}

void Property::Set(vtkPolyDataAlgorithm* filter, double value) const
{
  auto* const surface = vtkSurfaceFilter::SafeDownCast(filter);
  switch (this->Type)
  {
    case Form::Number:
      return Access::Write(surface, this->Name, value);
    case Form::Switch:
      return Access::Write(surface, this->Name, value != 0.0);
    default:
      return Access::Write(surface, this->Name, static_cast<int>(value));
  }
}

SurfaceDiffusion::Settings& SettingsOf(vtkPolyDataAlgorithm* filter)
{
  return Access::SettingsOf(vtkSurfaceFilter::SafeDownCast(filter));
}

std::vector<Property> PropertiesOf(vtkPolyDataAlgorithm* filter)
{
  Lister lister;
  SettingsOf(filter).Visit(lister);
  return std::move(lister.List);
}

std::vector<std::string> FilterClassNames()
{
  std::vector<std::string> names;
  for (const auto& [name, make] : Classes)
  {
    names.push_back(name);
  }
  return names;
}

vtkSmartPointer<vtkPolyDataAlgorithm> MakeFilter(const std::string& className)
{
  for (const auto& [name, make] : Classes)
  {
    if (className == name)
    {
      return make();
    }
  }
  throw std::invalid_argument("there is no class " + className);
}

} // namespace FilterTest
