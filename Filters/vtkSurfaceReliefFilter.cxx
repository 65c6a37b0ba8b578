// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceReliefFilter.h"

#include "Conversion/FieldReader.h"
#include "Conversion/InputArrays.h"
#include "Conversion/SurfaceRuns.h"
#include "Run/InputSentences.h"
#include "Run/OwnedSettings.h"
#include "Run/ReliefRun.h"

#include "vtkCellArray.h"
#include "vtkDataObject.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

#include <utility>

using namespace SurfaceDiffusion;

VTK_ABI_NAMESPACE_BEGIN
vtkObjectFactoryNewMacro(vtkSurfaceReliefFilter);

namespace
{

/// Reverse the polygons of the triangles that a relief has the other way round.
void TurnPolygons(vtkPolyData* surface, const ReliefRun& run, const TriangleCells& cells)
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

vtkSurfaceReliefFilter::vtkSurfaceReliefFilter()
  : Superclass(OwnedSettings::Make<ReliefSettings>(),
      SurfaceRuns::Of<ReliefRun>(&InputFields::Data), "ReliefHeight")
{
  for (const char* const name : { "VolumeChange", "SmallestWall", "LoweredPoints", "OpenEdges",
         "NonManifoldEdges", "CrossingTrianglesBefore", "CrossingTriangles" })
  {
    this->DeclareNumber(name);
  }
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

bool vtkSurfaceReliefFilter::FindFields(vtkPolyData* block, InputFields& fields, Problems& problems)
{
  const InputArrays inputs(this, block, fields, problems);
  fields.Data = inputs.Find(0, "InputArray", 1);
  if (fields.Data.OnCells)
  {
    problems.push_back(Say("CellArray", "InputArray"));
  }
  fields.Mask = inputs.Find(1, "MaskArray", 1);
  return fields.Data.Values != nullptr;
}

void vtkSurfaceReliefFilter::PrepareOutputs(
  const std::vector<SurfaceBlock>& surfaces, const SurfaceRuns& runs)
{
  for (std::size_t b = 0; b < surfaces.size(); ++b)
  {
    const auto& run = static_cast<const ReliefRun&>(runs.RunOf(b));
    TurnPolygons(surfaces[b].Output, run, runs.CellsOf(b));
  }
}
VTK_ABI_NAMESPACE_END
