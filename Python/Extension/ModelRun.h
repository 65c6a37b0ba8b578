// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "InputData.h"
#include "Run/Run.h"
#include "Threads.h"

#include <memory>
#include <string>

namespace SurfaceDiffusion
{

/// A run of a model on one or more surfaces, which Python drives. Surfaces, orderings
/// and factors are kept from update to update as far as they do not change.
class ModelRun
{
public:
  explicit ModelRun(std::string model)
    : Name(std::move(model))
  {
  }
  ModelRun(const ModelRun&) = delete;
  ModelRun& operator=(const ModelRun&) = delete;

  /// Check and take settings and inputs, a list of PythonFields. history: whether the history has
  /// energy and totals. Throws InputError and nanobind::value_error.
  void Update(const nanobind::list& blocks, const nanobind::dict& settings,
    const nanobind::object& progress, bool history);
  /// Move to a step, or to the last one if that is -1.
  void Seek(int step, const nanobind::object& progress);

  /// Free what is kept for the next update, but not which warnings are known.
  void Clear() { this->Model.Clear(); }

  int NumberOfSteps() const { return this->Settings->DescribeModel().NumberOfSteps; }
  /// The last step of a run that may end early, for which it is computed to its end.
  int FindLastStep(const nanobind::object& progress);
  /// All warnings that hold, as lists of words.
  nanobind::list GetWarnings() const;
  /// Those that hold now and did not hold at the last call since ForgetWarnings().
  nanobind::list GetNewWarnings();
  void ForgetWarnings() { this->Reported = {}; }
  nanobind::dict GetHistory() const;
  /// The read-only values of the classes for VTK, as lists of rows.
  nanobind::dict GetNumbers() const;
  /// The units of the run, and the number of points without triangle of a surface.
  nanobind::dict GetResults(std::size_t block) const;
  /// See OutputTable.h.
  nanobind::list ListOutputs(std::size_t block) const;
  /// Write an output of the list. source: the input of the surface. first: the column of `output`
  /// from which on the columns of the output are written, and no others; -1: all columns.
  /// integers: the data were integers, which what nothing determines keeps in place of NaN.
  void Write(std::size_t block, std::size_t number, const OutputArray& output,
    const PythonFields& source, int first, bool integers) const;

private:
  std::string Name;
  std::shared_ptr<RunSettings> Settings;
  SurfaceDiffusion::Run Model{ PythonThreads::Instance() };
  WarningLog Reported;
  int Step = 0;
  bool InUse = false;
};

} // namespace SurfaceDiffusion
