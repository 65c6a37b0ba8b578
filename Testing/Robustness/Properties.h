// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/Settings.h"

#include "vtkPolyDataAlgorithm.h"
#include "vtkSmartPointer.h"

#include <string>
#include <vector>

/// The properties of a filter that are settings of its run, by name, as the run declares them.
namespace FilterTest
{

struct Property
{
  enum class Form
  {
    Number,
    Integer,
    Switch,
    Choice
  };

  std::string Name;
  Form Type = Form::Number;
  double Default = 0.0;
  SurfaceDiffusion::SettingRange Range = {}; ///< of a number
  std::vector<std::string> Words = {}; ///< of a choice
  std::vector<bool> Allowed = {}; ///< of its words; empty: all

  double Get(vtkPolyDataAlgorithm* filter) const;
  void Set(vtkPolyDataAlgorithm* filter, double value) const;
};

/// A change of them is none of the filter.
SurfaceDiffusion::Settings& SettingsOf(vtkPolyDataAlgorithm* filter);
std::vector<Property> PropertiesOf(vtkPolyDataAlgorithm* filter);

/// The names of all classes, and an object of one.
std::vector<std::string> FilterClassNames();
vtkSmartPointer<vtkPolyDataAlgorithm> MakeFilter(const std::string& className);

} // namespace FilterTest
