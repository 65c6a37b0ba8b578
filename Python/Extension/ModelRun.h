// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "InputData.h"
#include "Run/CurvatureRun.h"
#include "Run/DenoisingRun.h"
#include "Run/DerivativesRun.h"
#include "Run/DirectionFieldRun.h"
#include "Run/Run.h"
#include "Threads.h"

#include <memory>
#include <string>
#include <vector>

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

  /// Check and take settings and inputs, a list of InputFields. history: whether the history has
  /// energy and totals. Throws InputError and nanobind::value_error.
  void Update(const nanobind::list& blocks, const nanobind::dict& settings,
    const nanobind::object& progress, bool history);
  /// Move to a step, or to the last one if that is -1.
  void Seek(int step, const nanobind::object& progress);

  int NumberOfSteps() const { return this->Settings->DescribeModel().NumberOfSteps; }
  double TimeStep() const { return this->Settings->DescribeModel().TimeStep; }
  /// All warnings that hold, as lists of words.
  nanobind::list GetWarnings() const;
  nanobind::dict GetHistory() const;
  /// The units of the run, and the number of points without triangle of a surface.
  nanobind::dict GetResults(std::size_t block) const;
  /// A dict for each output of a surface: its name, place, type, role, shape, and for curves where
  /// each begins and the rows of its corners.
  nanobind::list ListOutputs(std::size_t block) const;
  /// Write an output of the list. source: the input of the surface. first: the column of `output`
  /// from which on the columns of the output are written, and no others; -1: all columns.
  /// integers: the data were integers, which what nothing determines keeps in place of NaN.
  void Write(std::size_t block, std::size_t number, const OutputArray& output,
    const InputFields& source, int first, bool integers) const;

private:
  std::string Name;
  std::shared_ptr<RunSettings> Settings;
  SurfaceDiffusion::Run Model{ PythonThreads::Instance() };
  int Step = 0;
  bool InUse = false;
};

/// A computation on one surface without time steps, with its settings: a line field, denoised
/// points, curvatures or derivatives.
template <typename RunType, typename SettingsType>
class SingleRun
{
public:
  SingleRun() = default;
  SingleRun(const SingleRun&) = delete;
  SingleRun& operator=(const SingleRun&) = delete;

  /// The mask of the input is read by those that leave masked triangles out.
  void Update(
    const InputFields& input, const nanobind::dict& settings, const nanobind::object& progress);
  double MeanEdgeLength() const { return this->Model.MeanEdgeLength(); }
  /// All warnings that hold, as lists of words.
  nanobind::list GetWarnings() const;
  /// As those of ModelRun.
  nanobind::list ListOutputs() const;
  void Write(std::size_t number, const OutputArray& output, const InputFields& source) const;

private:
  RunType Model{ PythonThreads::Instance() };
  bool InUse = false;
};

using DirectionRun = SingleRun<DirectionFieldRun, DirectionFieldSettings>;
using CurvatureFinder = SingleRun<CurvatureRun, CurvatureSettings>;
using DerivativesFinder = SingleRun<DerivativesRun, DerivativesSettings>;
using MeshDenoiser = SingleRun<DenoisingRun, DenoisingRunSettings>;

extern template class SingleRun<CurvatureRun, CurvatureSettings>;
extern template class SingleRun<DerivativesRun, DerivativesSettings>;
extern template class SingleRun<DirectionFieldRun, DirectionFieldSettings>;
extern template class SingleRun<DenoisingRun, DenoisingRunSettings>;

} // namespace SurfaceDiffusion
