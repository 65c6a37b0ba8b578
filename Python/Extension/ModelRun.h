// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "InputData.h"
#include "Run/DenoisingRun.h"
#include "Run/DirectionFieldRun.h"
#include "Run/Run.h"
#include "Threads.h"

#include <memory>
#include <string>
#include <vector>

namespace SurfaceDiffusion
{

/// A run of a time-dependent model on one or more surfaces, which Python drives. Surfaces, orderings
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
  /// energy and totals. Throws nanobind::value_error.
  void Update(const nanobind::list& blocks, const nanobind::dict& settings,
    const nanobind::object& progress, bool history);
  /// Move to a step, or to the last one if that is -1.
  void Seek(int step, const nanobind::object& progress);

  int NumberOfSteps() const { return this->Settings->DescribeModel().NumberOfSteps; }
  double TimeStep() const { return this->Settings->DescribeModel().TimeStep; }
  /// The sentences of all warnings that hold.
  std::vector<std::string> GetWarnings() const;
  nanobind::dict GetHistory() const;
  /// Numbers that describe the run on one surface.
  nanobind::dict GetResults(std::size_t block) const;

  /// Write the current state at the points of a surface, or at its faces if the data are on them and
  /// the settings say so. `source` gives the values of points or faces that take no part and of
  /// alpha; without it they are 0 and opaque. first: the column of `output` that the panel
  /// of columns begins at; columns outside of it are left as they are. -1: all columns are written.
  /// Where nothing determines a value it is NaN, but that of the source with `integers`.
  void WriteState(std::size_t block, const OutputArray& output,
    const std::optional<InputArray>& source, int first, bool integers) const;
  /// The same for unit vectors of colours, with the brightness of the input.
  void WriteColorsOfVectors(
    std::size_t block, const OutputArray& output, const InputFields& source) const;
  /// The texture, stretched to [0, 1].
  void WriteTexture(std::size_t block, const OutputArray& output) const;
  void WriteTextureColors(std::size_t block, const OutputArray& output,
    const std::array<double, 3>& low, const std::array<double, 3>& high) const;
  /// 1 - v of the Mumford-Shah model; 0 at points that take no part.
  void WriteEdges(std::size_t block, const OutputArray& output) const;
  /// The number of points of each curve along its edges, and the points of all curves.
  std::vector<Index> GetCurveSizes(std::size_t block) const;
  void WriteCurves(std::size_t block, const OutputArray& output) const;
  /// The regions of a segmentation: lists with an entry per region, and their boundaries.
  nanobind::dict GetRegions(std::size_t block) const;
  /// The labels of the points; 0 at points that take no part.
  void WriteLabels(std::size_t block, const OutputArray& output) const;
  /// The direction of the strongest diffusion per polygon of the surface; false if there is none.
  bool WriteAxes(std::size_t block, const InputSurface& surface, const OutputArray& output) const;
  /// The moved points (float64 or float32); false if no point was moved.
  bool WriteMovedPoints(std::size_t block, const OutputArray& output) const;

  /// Whether the results are at the faces of the surface.
  bool HasResultOnFaces(std::size_t block) const;

private:
  std::string Name;
  std::shared_ptr<RunSettings> Settings;
  SurfaceDiffusion::Run Model{ PythonThreads::Instance() };
  ProcessGroup Alone;
  int Step = 0;
};

/// The line field of one surface.
class DirectionRun
{
public:
  DirectionRun() = default;
  DirectionRun(const DirectionRun&) = delete;
  DirectionRun& operator=(const DirectionRun&) = delete;

  void Update(
    const InputFields& input, const nanobind::dict& settings, const nanobind::object& progress);
  double MeanEdgeLength() const { return this->Field.MeanEdgeLength(); }
  /// The sentences of all warnings that hold.
  std::vector<std::string> GetWarnings() const;
  /// Per polygon of the surface.
  void Write(const InputSurface& surface, const OutputArray& output) const;

private:
  DirectionFieldRun Field{ PythonThreads::Instance() };
};

/// The denoised points of one surface.
class MeshDenoiser
{
public:
  MeshDenoiser() = default;
  MeshDenoiser(const MeshDenoiser&) = delete;
  MeshDenoiser& operator=(const MeshDenoiser&) = delete;

  /// Only the fixed points or faces of the input are read.
  void Update(
    const InputFields& input, const nanobind::dict& settings, const nanobind::object& progress);
  /// The attributes of the result, by name.
  nanobind::dict GetResults() const;
  /// The sentences of all warnings that hold.
  std::vector<std::string> GetWarnings() const;
  /// The moved points.
  void Write(const OutputArray& output) const;

private:
  DenoisingRun Run{ PythonThreads::Instance() };
};

} // namespace SurfaceDiffusion
