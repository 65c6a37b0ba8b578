// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Dice.h"

#include "vtkPolyDataAlgorithm.h"
#include "vtkSmartPointer.h"

#include <functional>
#include <ostream>
#include <string>
#include <vector>

/// Every settable property of every filter: how to draw a random value for it, and how to copy it. Those
/// that are settings follow from what the run declares. A test compares them with the headers.
namespace FilterTest
{

struct RandomProperty
{
  using Filter = vtkPolyDataAlgorithm;
  std::string Name;
  std::function<void(Filter*, Dice&)> Set; ///< mostly to an allowed value
  std::function<void(Filter* from, Filter* to)> Copy;
  std::function<bool(Filter*, Filter*)> Equal;
  /// Sets a value that no number or choice allows, and returns it; empty if the property is neither.
  std::function<std::string(Filter*)> SetForbidden = [](Filter*) { return std::string(); };
};

struct FilterClass
{
  std::string Name;
  std::vector<RandomProperty> Properties;

  vtkSmartPointer<vtkPolyDataAlgorithm> Make() const;
};

inline void PrintTo(const FilterClass& kind, std::ostream* os)
{
  *os << kind.Name;
}

const std::vector<FilterClass>& AllFilterClasses();

} // namespace FilterTest
