// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"
#include "Distributed/Processes.h"

#include <map>
#include <string>
#include <utility>

namespace SurfaceDiffusion
{

/// The read-only values of a filter: those of its last update by their names, each a matrix, and
/// what stands for them before the first one.
class RunNumbers
{
public:
  /// byDefault: before the first update, and after one without result or such a number.
  void Declare(const std::string& name, double byDefault) { this->Defaults[name] = byDefault; }
  const std::map<std::string, double>& Declared() const { return this->Defaults; }

  void Set(std::map<std::string, Values> numbers) { this->Found = std::move(numbers); }
  /// An entry of a number; NaN beyond its entries, and if it is not declared.
  double Find(const std::string& name, int row = 0, int column = 0) const;

  /// Give all processes the numbers of process 0. Collective.
  void Share(const Processes& processes);

private:
  std::map<std::string, double> Defaults;
  std::map<std::string, Values> Found;
};

} // namespace SurfaceDiffusion
