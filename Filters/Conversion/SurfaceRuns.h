// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Conversion/BlockInputs.h"
#include "Run/SurfaceRun.h"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace SurfaceDiffusion
{

/// The runs of a filter without time steps, one for each surface of its input. They are kept from
/// update to update, so that unchanged surfaces are not computed again.
class SurfaceRuns
{
public:
  /// Runs of the class RunType. data: the array of the input that a result of the same name may
  /// replace; null: none.
  template <typename RunType>
  static SurfaceRuns Of(LocatedArray InputFields::*data = nullptr)
  {
    SurfaceRuns made;
    made.MakeRun = [](const ParallelFor& parallel) -> std::unique_ptr<SurfaceRun>
    { return std::make_unique<RunType>(parallel); };
    made.Data = data;
    return made;
  }

  /// Update the run of each surface. settings: of the class of the runs. Throws std::runtime_error,
  /// std::bad_alloc, Aborted.
  void Update(
    const std::vector<InputFields>& surfaces, Settings& settings, const ProgressMonitor& progress);

  /// Add the outputs of a surface. fields: its arrays. resultArrayName: see vtkSurfaceFilter.
  /// Appends the names of arrays of the input that are replaced.
  void Write(std::size_t surface, const InputFields& fields, const std::string& resultArrayName,
    vtkPolyData* output, std::vector<std::string>& replaced) const;

  const SurfaceRun& RunOf(std::size_t surface) const { return *this->Runs[surface]; }
  /// The cell of each triangle of a surface.
  const TriangleCells& CellsOf(std::size_t surface) const { return this->Inputs.CellsOf(surface); }

  /// The numbers of all surfaces.
  std::map<std::string, Values> FindNumbers() const;

  /// The warnings that hold.
  std::vector<Warning> FindWarnings() const;

  void Clear();

private:
  std::vector<const SurfaceRun*> ListRuns() const;

  std::unique_ptr<SurfaceRun> (*MakeRun)(const ParallelFor&) = nullptr;
  LocatedArray InputFields::*Data = nullptr;
  BlockInputs Inputs;
  std::vector<std::unique_ptr<SurfaceRun>> Runs;
  std::vector<std::string> Names; ///< of the surfaces, if they are blocks
};

} // namespace SurfaceDiffusion
