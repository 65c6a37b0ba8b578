// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Conversion/BlockInputs.h"
#include "Conversion/ResultWriter.h"
#include "Conversion/SMPParallelFor.h"
#include "Run/BlockSentences.h"
#include "Run/Outputs.h"
#include "Run/SurfaceRun.h"
#include "Run/WarningLog.h"

#include <map>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

namespace SurfaceDiffusion
{

/// Leave out the blocks without the data that others have: they pass through.
template <typename BlockType>
void PassBlocksWithoutData(std::vector<BlockType>& blocks, std::vector<InputFields>& fields)
{
  for (std::size_t b = blocks.size(); b-- > 0;)
  {
    if (!fields[b].Data.Values)
    {
      blocks.erase(blocks.begin() + static_cast<std::ptrdiff_t>(b));
      fields.erase(fields.begin() + static_cast<std::ptrdiff_t>(b));
    }
  }
}

/// The runs of a filter without time steps, one for each surface of its input. They are kept from
/// update to update, so that unchanged surfaces are not computed again.
template <typename RunType>
class SurfaceRuns
{
  static_assert(std::is_base_of_v<SurfaceRun, RunType>);

public:
  /// Update the run of each surface. fields: the arrays of each block. Throws std::runtime_error,
  /// std::bad_alloc, Aborted.
  template <typename BlockType, typename SettingsType>
  void Update(const std::vector<BlockType>& blocks, const std::vector<InputFields>& fields,
    SettingsType& settings, const ProgressMonitor& progress)
  {
    std::vector<SurfaceInput> surfaces;
    for (std::size_t b = 0; b < blocks.size(); ++b)
    {
      surfaces.push_back({ blocks[b].Input, &fields[b], blocks[b].Name });
    }
    this->Runs.resize(surfaces.size());
    this->Names.resize(surfaces.size());
    bool excludeMasked = false; // the same for all runs, which are of one class
    for (std::unique_ptr<RunType>& run : this->Runs)
    {
      if (!run)
      {
        run = std::make_unique<RunType>(SMPParallelFor::Instance());
      }
      excludeMasked = run->ExcludesMasked();
    }
    const std::vector<BlockInput> inputs = this->Inputs.Make(surfaces, excludeMasked);
    const double count = static_cast<double>(surfaces.size());
    for (std::size_t b = 0; b < surfaces.size(); ++b)
    {
      this->Names[b] = inputs[b].Name;
      const ProgressMonitor part = progress.Part(b / count, (b + 0.95) / count);
      NameBlockInErrors(this->Names[b], settings,
        [&]
        { NamingSettings(settings, [&] { this->Runs[b]->Update(inputs[b], settings, part); }); });
    }
  }

  /// Add the outputs of each surface. data: its array that a result of the same name may replace, or
  /// null. absences: of arrays in some blocks. Returns the warnings that hold.
  template <typename BlockType>
  std::vector<Warning> Write(const std::vector<BlockType>& blocks,
    const std::vector<InputFields>& fields, LocatedArray InputFields::*data,
    const std::string& name, const Problems& absences = {}) const
  {
    std::vector<Warning> warnings = this->FindWarnings();
    std::vector<std::string> replaced;
    for (std::size_t b = 0; b < blocks.size(); ++b)
    {
      OutputSource source{ this->Runs[b]->GetSurface(), SMPParallelFor::Instance() };
      source.NumberOfCells = blocks[b].Output->GetNumberOfCells();
      source.CellOf = [&cells = this->Inputs.CellsOf(b)](Index t)
      { return cells[static_cast<std::size_t>(t)]; };
      WriteOutputs(this->Runs[b]->Outputs(), source,
        { blocks[b].Output, fields[b], name, VTK_DOUBLE, data ? (fields[b].*data).Values : nullptr,
          replaced });
    }
    if (!replaced.empty())
    {
      warnings.push_back({ DescribeReplacement(replaced), Fingerprint() });
    }
    for (const Sentence& sentence : absences)
    {
      warnings.push_back({ sentence, Fingerprint() });
    }
    return warnings;
  }

  const RunType& RunOf(std::size_t surface) const { return *this->Runs[surface]; }
  /// The cell of each triangle of a surface.
  const std::vector<Index>& CellsOf(std::size_t surface) const
  {
    return this->Inputs.CellsOf(surface);
  }

  /// The numbers of all surfaces.
  std::map<std::string, Values> FindNumbers() const
  {
    std::vector<const OutputList*> surfaces;
    for (const auto& run : this->Runs)
    {
      surfaces.push_back(&run->Outputs());
    }
    std::map<std::string, Values> numbers = CombineNumbers(surfaces, 0);
    numbers["MeanEdgeLength"] = Values::Constant(1, 1, this->MeanEdgeLength());
    return numbers;
  }

  /// Over all surfaces, in coordinate units; 1 if there is no edge.
  double MeanEdgeLength() const
  {
    double length = 0.0;
    double edges = 0.0;
    for (const auto& run : this->Runs)
    {
      const TriangleMesh& mesh = run->GetSurface().InputMesh();
      length += mesh.TotalEdgeLength() * mesh.LengthUnit();
      edges += mesh.NumberOfEdges();
    }
    return edges > 0.0 ? length / edges : 1.0;
  }

  /// The warnings that hold.
  std::vector<Warning> FindWarnings() const
  {
    std::vector<const SurfaceRun*> runs;
    for (const auto& run : this->Runs)
    {
      runs.push_back(run.get());
    }
    return SurfaceRun::FindAllWarnings(runs, this->Names);
  }

  void Clear()
  {
    this->Runs.clear();
    this->Inputs = BlockInputs();
  }

private:
  BlockInputs Inputs;
  std::vector<std::unique_ptr<RunType>> Runs;
  std::vector<std::string> Names;
};

} // namespace SurfaceDiffusion
