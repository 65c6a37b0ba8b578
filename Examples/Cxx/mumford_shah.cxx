// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause

// Find the edges of data on a surface, and smooth the data between them, by the functional of
// Mumford and Shah in the approximation of Ambrosio and Tortorelli: the minimum over u and v of
//
//     int lambda/2 |u - f|^2 + 1/2 v^2 |grad u|^2 + beta (eps |grad v|^2 + (1 - v)^2/(4 eps)),
//
// where v is near 0 on edges. A jump above EdgeThreshold, which is found from the data, is an edge.
//
//     mumford_shah                        a noisy cap on a sphere, generated here
//     mumford_shah surface.vtp array      your own data
//
// The result is written to mumford_shah.vtp: u, and the array Edges, 1 - v. The third output of the
// filter has the edges as curves.
//
// Try next: AutomaticThresholdOff() and SetEdgeThreshold(0.5), which keeps fewer edges; a mask as
// input array 1, whose points are filled in, with their edges.

#include <vtkDataObject.h>
#include <vtkDoubleArray.h>
#include <vtkMinimalStandardRandomSequence.h>
#include <vtkMumfordShahFilter.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkSphereSource.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>

#include <iostream>

// 1 on a cap of 60 degrees of the unit sphere and 0 elsewhere, with noise of up to 0.1.
vtkSmartPointer<vtkPolyData> NoisyCap(const char* name)
{
  vtkNew<vtkSphereSource> source;
  source->SetRadius(1.0);
  source->SetThetaResolution(150);
  source->SetPhiResolution(100);
  source->Update();
  vtkSmartPointer<vtkPolyData> sphere = source->GetOutput();
  vtkNew<vtkMinimalStandardRandomSequence> random;
  vtkNew<vtkDoubleArray> values;
  values->SetName(name);
  for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
  {
    values->InsertNextValue(
      (sphere->GetPoint(i)[0] > 0.5 ? 1.0 : 0.0) + random->GetNextRangeValue(-0.1, 0.1));
  }
  sphere->GetPointData()->AddArray(values);
  return sphere;
}

vtkSmartPointer<vtkPolyData> Read(const char* file)
{
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(file);
  reader->Update();
  return reader->GetOutput();
}

int main(int argc, char* argv[])
{
  const char* const name = argc > 2 ? argv[2] : "f";
  vtkNew<vtkMumfordShahFilter> edges;
  edges->SetInputData(argc > 1 ? Read(argv[1]) : NoisyCap(name));
  edges->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, name);
  edges->Update();
  vtkPolyData* const curves = vtkPolyData::SafeDownCast(edges->GetOutputDataObject(2));
  if (curves->GetNumberOfLines() == 0)
  {
    return 1; // no edge, or the filter has reported an error
  }
  std::cout << curves->GetNumberOfLines() << " edges of length " << edges->GetEdgeLength()
            << " (5.44 for the cap)\n";
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputDataObject(edges->GetOutputDataObject(0));
  writer->SetFileName("mumford_shah.vtp");
  writer->SetDataModeToBinary(); // Debian 12's VTK cannot read appended data, the default
  return writer->Write() ? 0 : 1;
}
