// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Conversion/SurfaceRuns.h"

#include "Conversion/ResultWriter.h"
#include "Conversion/SMPParallelFor.h"
#include "Run/BlockSentences.h"
#include "Run/Outputs.h"

#include "vtkPolyData.h"

namespace SurfaceDiffusion
{

void SurfaceRuns::Update(
  const std::vector<InputFields>& surfaces, Settings& settings, const ProgressMonitor& progress)
{
  this->Runs.resize(surfaces.size());
  this->Names.resize(surfaces.size());
  bool excludeMasked = false; // the same for all runs, which are of one class
  for (std::unique_ptr<SurfaceRun>& run : this->Runs)
  {
    if (!run)
    {
      run = this->MakeRun(SMPParallelFor::Instance());
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
      [&] { NamingSettings(settings, [&] { this->Runs[b]->Update(inputs[b], settings, part); }); });
  }
}

void SurfaceRuns::Write(std::size_t surface, const InputFields& fields,
  const std::string& resultArrayName, vtkPolyData* output, std::vector<std::string>& replaced) const
{
  const SurfaceRun& run = this->RunOf(surface);
  OutputSource source{ run.GetSurface(), SMPParallelFor::Instance() };
  source.NumberOfCells = output->GetNumberOfCells();
  source.CellOf = [&cells = this->CellsOf(surface)](Index t)
  { return cells[static_cast<std::size_t>(t)]; };
  vtkDataArray* const data = this->Data ? (fields.*(this->Data)).Values.Get() : nullptr;
  WriteOutputs(
    run.Outputs(), source, { output, fields, resultArrayName, VTK_DOUBLE, data, replaced });
}

std::vector<const SurfaceRun*> SurfaceRuns::ListRuns() const
{
  std::vector<const SurfaceRun*> runs;
  for (const auto& run : this->Runs)
  {
    runs.push_back(run.get());
  }
  return runs;
}

std::map<std::string, Values> SurfaceRuns::FindNumbers() const
{
  return SurfaceRun::FindAllNumbers(this->ListRuns());
}

std::vector<Warning> SurfaceRuns::FindWarnings() const
{
  return SurfaceRun::FindAllWarnings(this->ListRuns(), this->Names);
}

void SurfaceRuns::Clear()
{
  this->Runs.clear();
  this->Inputs = BlockInputs();
}

} // namespace SurfaceDiffusion
