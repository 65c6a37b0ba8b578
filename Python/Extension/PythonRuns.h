// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "InputData.h"
#include "Run/SurfaceRun.h"
#include "Run/WarningLog.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace SurfaceDiffusion
{

/// A computation without time steps on one or more surfaces, each for itself, with its settings: a
/// line field, denoised points, curvatures, derivatives, distances, random fields or relief.
class PythonRuns
{
public:
  /// name: of the function in Python. Throws nanobind::key_error.
  explicit PythonRuns(std::string name);
  PythonRuns(const PythonRuns&) = delete;
  PythonRuns& operator=(const PythonRuns&) = delete;

  /// Check and take settings and inputs, a list of PythonFields, and compute. The mask of the inputs
  /// is read by those that leave masked triangles out. Throws InputError and nanobind::value_error.
  void Update(const nanobind::list& surfaces, const nanobind::dict& settings,
    const nanobind::object& progress);
  /// Free what is kept for the next update, but not which warnings are known.
  void Clear();
  /// All warnings that hold, as lists of words.
  nanobind::list GetWarnings() const;
  /// Those that hold now and did not hold at the last call.
  nanobind::list GetNewWarnings();
  /// See SurfaceRun::FindAllNumbers().
  nanobind::dict GetNumbers() const;
  ///@{
  /// As those of ModelRun.
  nanobind::list ListOutputs(std::size_t surface) const;
  void Write(std::size_t surface, std::size_t number, const OutputArray& output,
    const PythonFields& source) const;
  ///@}
  /// Of distance: data, indices and indptr of the distances from each of the points, or from all: see
  /// DistanceRun::FindEach().
  nanobind::tuple FindEach(const PythonFields& surface, const nanobind::dict& settings,
    const std::optional<LongArray>& points, double cutoff, const nanobind::object& progress);
  /// Of distance, see DistanceRun::FindPath(): points, the face of each segment, and the length. places:
  /// their names, and per row of `coordinates` a point and a triangle, or -1 for none.
  nanobind::tuple FindPath(const PythonFields& surface, const nanobind::dict& settings,
    const std::vector<std::string>& names, const LongArray& points, const LongArray& triangles,
    const DoubleArray& coordinates, bool closed, const nanobind::object& progress);
  /// Of distance, see DistanceRun::FindDisk(): the area, and the curves of the boundary. center: as
  /// places, one of them.
  nanobind::tuple FindDisk(const PythonFields& surface, const nanobind::dict& settings,
    const std::vector<std::string>& names, const LongArray& points, const LongArray& triangles,
    const DoubleArray& coordinates, double radius, const nanobind::object& progress);
  /// Of relief: the rows of the triangles of a surface that the relief has turned.
  nanobind::object TurnedTriangles(std::size_t surface) const;
  /// Of relief: the thickness of the wall at each point; empty for other runs.
  nanobind::object Walls(std::size_t surface) const;

private:
  /// The settings, checked together with the inputs. Throws InputError and nanobind::value_error.
  std::unique_ptr<Settings> TakeSettings(
    const nanobind::dict& values, const std::vector<FieldSummary>& summaries) const;
  /// find(run, input, settings, monitor) of a DistanceRun on one surface.
  template <typename Find>
  void WithDistances(const PythonFields& surface, const nanobind::dict& values,
    const nanobind::object& progress, const Find& find);
  std::vector<const SurfaceRun*> ListRuns() const;
  std::vector<Warning> FindWarnings() const;
  /// Throws std::runtime_error unless the last update has succeeded.
  const SurfaceRun& RunOf(std::size_t surface) const;

  std::string Name;
  std::vector<std::unique_ptr<SurfaceRun>> Runs; ///< per surface
  std::vector<std::string> BlockNames; ///< likewise
  WarningLog Reported;
  bool IsComplete = false; ///< the last update has succeeded
  bool InUse = false;
};

} // namespace SurfaceDiffusion
