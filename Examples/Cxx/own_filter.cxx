// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause

// Derive a filter of your own from vtkSurfaceFilter. The subclass overrides one function, which
// gets the surfaces of the input with their outputs; the base class takes care of composite data,
// surfaces in pieces, progress, abort and errors. This filter adds the area of the barycentric
// control cell of every point, the diagonal of the lumped mass matrix of the library.
//
//     own_filter                  the control areas of a sphere, whose sum is printed

#include <vtkCell.h>
#include <vtkDoubleArray.h>
#include <vtkMath.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSphereSource.h>
#include <vtkSurfaceFilter.h>
#include <vtkTriangle.h>

#include <cmath>
#include <iostream>

class vtkControlAreaFilter : public vtkSurfaceFilter
{
public:
  static vtkControlAreaFilter* New();
  vtkTypeMacro(vtkControlAreaFilter, vtkSurfaceFilter);

protected:
  vtkControlAreaFilter() { this->ResultArrayName = "ControlArea"; }

  void ProcessSurfaces(
    const std::vector<SurfaceBlock>& blocks, const SurfaceDiffusion::ProgressMonitor&) override
  {
    Problems problems;
    this->CheckSurfaceProperties(problems);
    const std::vector<SurfaceBlock> surfaces = this->SelectSurfaces(blocks, problems);
    if (this->ReportProblems(problems))
    {
      return;
    }
    this->BeginWriting();
    for (const SurfaceBlock& surface : surfaces)
    {
      vtkNew<vtkDoubleArray> areas;
      areas->SetName(this->ResultArrayName.c_str());
      areas->SetNumberOfTuples(surface.Input->GetNumberOfPoints());
      areas->Fill(0.0);
      for (vtkIdType c = 0; c < surface.Input->GetNumberOfCells(); ++c)
      {
        auto* triangle = vtkTriangle::SafeDownCast(surface.Input->GetCell(c));
        for (int a = 0; triangle && a < 3; ++a)
        {
          const vtkIdType point = triangle->GetPointId(a);
          areas->SetValue(point, areas->GetValue(point) + triangle->ComputeArea() / 3.0);
        }
      }
      surface.Output->GetPointData()->AddArray(areas);
    }
  }
};

vtkStandardNewMacro(vtkControlAreaFilter);

int main()
{
  vtkNew<vtkSphereSource> source;
  source->SetRadius(1.0);
  source->SetThetaResolution(100);
  source->SetPhiResolution(100);
  vtkNew<vtkControlAreaFilter> filter;
  filter->SetInputConnection(source->GetOutputPort());
  filter->Update();
  auto* output = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
  vtkDataArray* areas = output ? output->GetPointData()->GetArray("ControlArea") : nullptr;
  if (!areas)
  {
    std::cerr << "no result\n";
    return 1;
  }
  double sum = 0.0;
  for (vtkIdType i = 0; i < areas->GetNumberOfTuples(); ++i)
  {
    sum += areas->GetComponent(i, 0);
  }
  const double exact = 4.0 * vtkMath::Pi();
  std::cout << "The control areas add up to " << sum << "; a sphere has " << exact << "\n";
  return std::abs(sum / exact - 1.0) < 0.01 ? 0 : 1;
}
