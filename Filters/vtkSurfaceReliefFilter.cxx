// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceReliefFilter.h"

#include "Conversion/FieldReader.h"
#include "Conversion/InputArrays.h"
#include "Conversion/SurfaceRuns.h"
#include "Run/OwnedSettings.h"
#include "Run/ReliefRun.h"
#include "vtkSurfaceFilterInternals.h"

#include "vtkCellArray.h"
#include "vtkDataObject.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

#include <utility>

using namespace SurfaceDiffusion;

vtkStandardNewMacro(vtkSurfaceReliefFilter);

namespace
{

/// Reverse the polygons of the triangles that a relief has the other way round.
void TurnPolygons(vtkPolyData* surface, const ReliefRun& run, const std::vector<Index>& cells)
{
  const std::vector<char>& turned = run.TurnedTriangles();
  const vtkIdType first = surface->GetNumberOfVerts() + surface->GetNumberOfLines();
  std::vector<char> isTurned(static_cast<std::size_t>(surface->GetNumberOfPolys()), 0);
  bool any = false;
  for (std::size_t t = 0; t < turned.size(); ++t)
  {
    const Index row = run.GetSurface().InputTriangle(static_cast<Index>(t));
    const vtkIdType polygon = cells[static_cast<std::size_t>(row)] - first;
    if (turned[t] && polygon >= 0 && polygon < surface->GetNumberOfPolys())
    {
      isTurned[static_cast<std::size_t>(polygon)] = 1;
      any = true;
    }
  }
  if (!any)
  {
    return;
  }
  vtkNew<vtkCellArray> polygons;
  polygons->DeepCopy(surface->GetPolys());
  for (std::size_t p = 0; p < isTurned.size(); ++p)
  {
    if (isTurned[p])
    {
      polygons->ReverseCellAtId(static_cast<vtkIdType>(p));
    }
  }
  surface->SetPolys(polygons);
}

} // namespace

struct vtkSurfaceReliefFilter::UpdateState
{
  SurfaceRuns<ReliefRun> Runs;
};

vtkSurfaceReliefFilter::vtkSurfaceReliefFilter()
  : Superclass(OwnedSettings::Make<ReliefSettings>())
  , State(std::make_unique<UpdateState>())
{
  for (const char* const name : { "VolumeChange", "SmallestWall", "LoweredPoints", "OpenEdges",
         "NonManifoldEdges", "CrossingTrianglesBefore", "CrossingTriangles" })
  {
    this->DeclareNumber(name);
  }
  this->ResultArrayName = "ReliefHeight";
  this->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Texture");
}

vtkSurfaceReliefFilter::~vtkSurfaceReliefFilter() = default;

ReliefSettings& vtkSurfaceReliefFilter::GetReliefSettings() const
{
  return static_cast<ReliefSettings&>(this->GetSettings());
}

void vtkSurfaceReliefFilter::SetUpDirection(double x, double y, double z)
{
  std::vector<double> given{ x, y, z };
  if (this->GetReliefSettings().UpDirection != given)
  {
    this->GetReliefSettings().UpDirection = std::move(given);
    this->Modified();
  }
}

void vtkSurfaceReliefFilter::SetUpDirection(const double direction[3])
{
  this->SetUpDirection(direction[0], direction[1], direction[2]);
}

double* vtkSurfaceReliefFilter::GetUpDirection()
{
  return this->GetReliefSettings().UpDirection.data();
}

void vtkSurfaceReliefFilter::ProcessSurfaces(
  const std::vector<SurfaceBlock>& blocks, const ProgressMonitor& progress)
{
  // A copy: an observer of the progress may change properties during the update.
  const auto copy = std::static_pointer_cast<ReliefSettings>(this->Private->Properties.Copy());
  Problems problems;
  copy->Check(nullptr, problems);
  this->CheckSurfaceProperties(problems);
  if (this->ResultArrayName.empty())
  {
    problems.emplace_back("ResultArrayName is empty; allowed: any name");
  }
  std::vector<SurfaceBlock> surfaces = this->SelectSurfaces(blocks, problems);
  std::vector<InputFields> fields(surfaces.size());
  BlockSentences found;
  std::vector<std::string> names;
  for (std::size_t b = 0; b < surfaces.size(); ++b)
  {
    Problems here;
    const InputArrays inputs(this, surfaces[b].Input, fields[b], here);
    fields[b].Data = inputs.Find(0, "InputArray", 1);
    if (fields[b].Data.OnCells)
    {
      here.emplace_back("InputArray is a cell array; allowed: point arrays of 1 component");
    }
    fields[b].Mask = inputs.Find(1, "MaskArray", 1);
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
  PassBlocksWithoutData(surfaces, fields);

  auto& runs = this->State->Runs;
  runs.Update(surfaces, fields, *copy, progress);
  this->BeginWriting();
  for (std::size_t b = 0; b < surfaces.size(); ++b)
  {
    TurnPolygons(surfaces[b].Output, runs.RunOf(b), runs.CellsOf(b));
  }
  std::vector<Warning> warnings =
    runs.Write(surfaces, fields, &InputFields::Data, this->ResultArrayName, absences);
  this->Private->Numbers = runs.FindNumbers();
  this->ReportWarnings(std::move(warnings));
}

void vtkSurfaceReliefFilter::ReleaseCache()
{
  this->Superclass::ReleaseCache();
  this->State->Runs.Clear();
}
