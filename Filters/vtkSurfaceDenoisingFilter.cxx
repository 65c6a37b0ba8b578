// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceDenoisingFilter.h"

#include "Conversion/FieldReader.h"
#include "Conversion/InputArrays.h"
#include "Conversion/NewArray.h"
#include "Conversion/PointNormals.h"
#include "Conversion/SurfaceRuns.h"
#include "Run/DenoisingRun.h"
#include "Run/OwnedSettings.h"

#include "vtkDoubleArray.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

#include <algorithm>

using namespace SurfaceDiffusion;

vtkStandardNewMacro(vtkSurfaceDenoisingFilter);

struct vtkSurfaceDenoisingFilter::RunState
{
  SurfaceRuns<DenoisingRun> Runs;
};

namespace
{

/// The displacement of each point, with the name of the result.
vtkSmartPointer<vtkDataArray> WriteDisplacement(const DenoisingRun& run, const std::string& name)
{
  const Points& given = run.GetSurface().Points();
  const Points& moved = run.MovedPoints();
  auto result = NewArray<vtkDoubleArray>(name, 3, given.rows());
  for (Eigen::Index i = 0; i < given.rows(); ++i)
  {
    const Eigen::RowVector3d displacement = moved.row(i) - given.row(i);
    result->SetTuple(i, displacement.data());
  }
  return result;
}

} // namespace

vtkSurfaceDenoisingFilter::vtkSurfaceDenoisingFilter()
  : Superclass(OwnedSettings::Make<DenoisingRunSettings>())
  , State(std::make_unique<RunState>())
{
  this->ResultArrayName = "Displacement";
}

vtkSurfaceDenoisingFilter::~vtkSurfaceDenoisingFilter() = default;

void vtkSurfaceDenoisingFilter::ProcessSurfaces(
  const std::vector<SurfaceBlock>& blocks, const ProgressMonitor& progress)
{
  auto& settings = static_cast<DenoisingRunSettings&>(this->GetSettings());
  Problems problems;
  CheckRanges(settings, problems);
  this->CheckSurfaceProperties(problems);
  if (this->ResultArrayName.empty())
  {
    problems.emplace_back("ResultArrayName is empty; allowed: any name");
  }
  const std::vector<SurfaceBlock> surfaces = this->SelectSurfaces(blocks, problems);
  std::vector<InputFields> fields(surfaces.size());
  BlockSentences found;
  std::vector<std::string> names;
  for (std::size_t b = 0; b < surfaces.size(); ++b)
  {
    Problems here;
    const InputArrays inputs(this, surfaces[b].Input, fields[b], here);
    fields[b].Fixed = inputs.Find(3, "FixedArray", 1, fields[b].FixedOnCells);
    found.Add(here, surfaces[b].Name);
    names.push_back(surfaces[b].Name);
  }
  found.AppendTo(problems, surfaces.size());
  Problems absences;
  SettleAbsence(fields, names, problems, absences);
  if (this->ReportProblems(problems))
  {
    return;
  }

  std::vector<SurfaceInput> inputs;
  for (std::size_t b = 0; b < surfaces.size(); ++b)
  {
    inputs.push_back({ surfaces[b].Input, &fields[b], surfaces[b].Name });
  }
  auto& runs = this->State->Runs;
  runs.Update(inputs, settings, progress);
  std::vector<vtkSmartPointer<vtkDataArray>> results;
  std::vector<vtkSmartPointer<vtkPoints>> points;
  for (std::size_t b = 0; b < surfaces.size(); ++b)
  {
    results.push_back(WriteDisplacement(runs[b], this->ResultArrayName));
    points.push_back(WritePoints(runs[b].MovedPoints(), surfaces[b].Input->GetPoints()));
  }
  this->BeginWriting();
  ResultAdder adder(this->ResultArrayName);
  for (std::size_t b = 0; b < surfaces.size(); ++b)
  {
    if (runs[b].Report().MaximumDisplacement > 0.0)
    {
      surfaces[b].Output->SetPoints(points[b]);
      UpdateNormals(surfaces[b].Input, surfaces[b].Output);
    }
    adder.Add(results[b], nullptr, surfaces[b].Output->GetPointData());
  }
  this->SummarizeReports();
  std::vector<Warning> warnings = runs.FindWarnings("have no normal");
  adder.AppendWarning(warnings);
  for (const std::string& sentence : absences)
  {
    warnings.push_back({ sentence, Fingerprint() });
  }
  this->ReportWarnings(std::move(warnings));
}

/// Other normals than the active ones are not gathered.
void vtkSurfaceDenoisingFilter::CompletePiece(const SurfaceBlock& piece)
{
  if (piece.Output->GetPoints() != piece.Input->GetPoints())
  {
    DropNormals(piece.Input, piece.Output);
  }
}

void vtkSurfaceDenoisingFilter::SummarizeReports()
{
  const auto& runs = this->State->Runs;
  this->MeanEdgeLength = runs.MeanEdgeLength();
  this->EffectiveNoiseLevel = this->MeanDisplacement = this->MaximumDisplacement = 0.0;
  this->VolumeBefore = this->VolumeAfter = 0.0;
  constexpr double Mixed = SURFACE_TYPE_AUTOMATIC;
  double vertices = 0.0;
  double moved = 0.0;
  for (std::size_t b = 0; b < runs.Size(); ++b)
  {
    const DenoisingReport& report = runs[b].Report();
    const double count = runs[b].GetSurface().InputMesh().NumberOfVertices();
    vertices += count;
    moved += report.MeanDisplacement * count;
    this->EffectiveNoiseLevel = std::max(this->EffectiveNoiseLevel, report.NoiseLevel);
    this->MaximumDisplacement = std::max(this->MaximumDisplacement, report.MaximumDisplacement);
    this->VolumeBefore += runs[b].VolumeBefore();
    this->VolumeAfter += runs[b].VolumeAfter();
    const auto type = static_cast<double>(runs[b].FoundType());
    this->EffectiveSurfaceType = b == 0 || this->EffectiveSurfaceType == type ? type : Mixed;
  }
  this->MeanDisplacement = vertices > 0.0 ? moved / vertices : 0.0;
}

void vtkSurfaceDenoisingFilter::VisitReported(const std::function<void(double&)>& visit)
{
  this->Superclass::VisitReported(visit);
  visit(this->EffectiveNoiseLevel);
  visit(this->EffectiveSurfaceType);
  visit(this->MeanDisplacement);
  visit(this->MaximumDisplacement);
  visit(this->VolumeBefore);
  visit(this->VolumeAfter);
}

void vtkSurfaceDenoisingFilter::ReleaseCache()
{
  this->Superclass::ReleaseCache();
  this->State->Runs.Clear();
}

void vtkSurfaceDenoisingFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "EffectiveNoiseLevel: " << this->EffectiveNoiseLevel << "\n";
  os << indent << "EffectiveSurfaceType: " << this->GetEffectiveSurfaceType() << "\n";
  os << indent << "MeanDisplacement: " << this->MeanDisplacement << "\n";
  os << indent << "MaximumDisplacement: " << this->MaximumDisplacement << "\n";
  os << indent << "VolumeBefore: " << this->VolumeBefore << "\n";
  os << indent << "VolumeAfter: " << this->VolumeAfter << "\n";
}
