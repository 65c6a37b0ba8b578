// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Conversion/BlockInputs.h"
#include "Conversion/ResultWriter.h"
#include "Conversion/SMPParallelFor.h"
#include "Run/BlockSentences.h"
#include "Run/SurfaceRun.h"
#include "Run/WarningLog.h"

#include <memory>
#include <string>
#include <type_traits>
#include <vector>

namespace SurfaceDiffusion
{

/// The runs of a filter without time steps, one for each surface of its input. They are kept from
/// update to update, so that unchanged surfaces are not computed again.
template <typename RunType>
class SurfaceRuns
{
  static_assert(std::is_base_of_v<SurfaceRun, RunType>);

public:
  /// Update the run of each surface. Throws std::runtime_error, std::bad_alloc, Aborted.
  template <typename SettingsType>
  void Update(const std::vector<SurfaceInput>& surfaces, SettingsType& settings,
    const ProgressMonitor& progress)
  {
    const std::vector<BlockInput> inputs = this->Inputs.Make(surfaces, false);
    const double count = static_cast<double>(surfaces.size());
    this->Runs.resize(surfaces.size());
    this->Names.resize(surfaces.size());
    for (std::size_t b = 0; b < surfaces.size(); ++b)
    {
      if (!this->Runs[b])
      {
        this->Runs[b] = std::make_unique<RunType>(SMPParallelFor::Instance());
      }
      this->Names[b] = inputs[b].Name;
      const ProgressMonitor part = progress.Part(b / count, (b + 0.95) / count);
      NameBlockInErrors(this->Names[b],
        [&]
        { NamingExtremes(settings, [&] { this->Runs[b]->Update(inputs[b], settings, part); }); });
    }
  }

  std::size_t Size() const { return this->Runs.size(); }
  const RunType& operator[](std::size_t surface) const { return *this->Runs[surface]; }
  /// The cell of each triangle of a surface.
  const std::vector<Index>& CellsOf(std::size_t surface) const
  {
    return this->Inputs.CellsOf(surface);
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

  /// The warnings that hold: about triangles of zero area, and those of each run. consequence: the
  /// end of the sentence about triangles, such as "have no normal".
  std::vector<Warning> FindWarnings(const std::string& consequence) const
  {
    Index degenerate = 0;
    Fingerprint versions;
    std::vector<Warning> warnings;
    BlockSentences ofRuns;
    Fingerprint causes;
    for (std::size_t b = 0; b < this->Runs.size(); ++b)
    {
      degenerate += this->Runs[b]->GetSurface().Diagnostics().DegenerateTriangles;
      versions.Add(this->Runs[b]->GetSurfaceVersion());
      for (const Warning& warning : this->Runs[b]->FindWarnings())
      {
        ofRuns.Add(warning.Sentence, this->Names[b]);
        causes.Add(warning.Cause);
      }
    }
    std::vector<std::string> sentences;
    ofRuns.AppendTo(sentences, this->Runs.size());
    for (const std::string& sentence : sentences)
    {
      warnings.push_back({ sentence, causes });
    }
    if (degenerate > 0)
    {
      warnings.push_back(
        { std::to_string(degenerate) + " triangles of zero area " + consequence, versions });
    }
    return warnings;
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

/// Adds results of one name to the surfaces of an output.
class ResultAdder
{
public:
  explicit ResultAdder(std::string name)
    : Name(std::move(name))
  {
  }

  /// data: the array that the result was computed from, may be null.
  void Add(vtkDataArray* result, vtkDataArray* data, vtkDataSetAttributes* attributes)
  {
    this->Replaced = ReplaceArray(result, data, attributes) || this->Replaced;
  }

  /// Append the warning about arrays of the input that were replaced.
  void AppendWarning(std::vector<Warning>& warnings) const
  {
    if (this->Replaced)
    {
      warnings.push_back({ DescribeReplacement({ this->Name }), Fingerprint() });
    }
  }

private:
  std::string Name;
  bool Replaced = false;
};

} // namespace SurfaceDiffusion
