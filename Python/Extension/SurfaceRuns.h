// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "InputData.h"
#include "Run/SurfaceRun.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace SurfaceDiffusion
{

/// A computation without time steps on one or more surfaces, each for itself, with its settings: a
/// line field, denoised points, curvatures, derivatives, distances, random fields or relief.
class SurfaceRuns
{
public:
  /// name: of the function in Python. Throws nanobind::key_error.
  explicit SurfaceRuns(std::string name);
  SurfaceRuns(const SurfaceRuns&) = delete;
  SurfaceRuns& operator=(const SurfaceRuns&) = delete;

  /// Check and take settings and inputs, a list of InputFields, and compute. The mask of the inputs
  /// is read by those that leave masked triangles out. Throws InputError and nanobind::value_error.
  void Update(const nanobind::list& surfaces, const nanobind::dict& settings,
    const nanobind::object& progress);
  /// Of all surfaces, in coordinate units; 1 if there is no edge.
  double MeanEdgeLength() const;
  /// All warnings that hold, as lists of words.
  nanobind::list GetWarnings() const;
  nanobind::dict GetNumbers() const;
  ///@{
  /// As those of ModelRun.
  nanobind::list ListOutputs(std::size_t surface) const;
  void Write(std::size_t surface, std::size_t number, const OutputArray& output,
    const InputFields& source) const;
  ///@}
  /// Of relief: the faces of a surface that have a triangle which it has the other way round.
  std::vector<std::int64_t> TurnedFaces(std::size_t surface, const InputSurface& source) const;

private:
  std::string Name;
  std::vector<std::unique_ptr<SurfaceRun>> Runs; ///< per surface
  std::vector<std::string> BlockNames; ///< likewise
  bool InUse = false;
};

} // namespace SurfaceDiffusion
