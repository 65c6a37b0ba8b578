// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause

// Divide a surface into regions by its data, by the convex model of Chan and Vese: the minimum over
// probabilities u_k of
//
//     1/2 sum_k int |grad u_k| + lambda sum_k int u_k |f - c_k|^2,
//
// the length of the boundaries plus the distance of the data from the means c_k. The filter finds
// lambda and the means from the data.
//
//     segmentation                        a cap on a sphere under strong noise, generated here
//     segmentation surface.vtp array      your own data
//
// The result is written to segmentation.vtp, with the region of each point in the array RegionId.
// The second output has a row per region, and the third one the boundaries as curves.
//
// Try next: SetNumberOfRegions(3); labels at a few points as input array 6, which they keep;
// AutomaticFidelityOff() and SetFidelityWeight(), larger for smaller regions.

#include <vtkDataObject.h>
#include <vtkDoubleArray.h>
#include <vtkMinimalStandardRandomSequence.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkSphereSource.h>
#include <vtkSurfaceSegmentationFilter.h>
#include <vtkTable.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>

#include <iostream>

// 1 on a cap of 60 degrees of the unit sphere and 0 elsewhere, with noise of up to 0.9.
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
      (sphere->GetPoint(i)[0] > 0.5 ? 1.0 : 0.0) + random->GetNextRangeValue(-0.9, 0.9));
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
  vtkNew<vtkSurfaceSegmentationFilter> regions;
  regions->SetInputData(argc > 1 ? Read(argv[1]) : NoisyCap(name));
  regions->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, name);
  regions->Update();
  vtkTable* const table = vtkTable::SafeDownCast(regions->GetOutputDataObject(1));
  if (table->GetNumberOfRows() == 0)
  {
    return 1; // the filter has reported the error
  }
  std::cout << "region  mean  area (9.42 and 3.14)  length of its boundary (5.44)\n";
  for (vtkIdType row = 0; row < table->GetNumberOfRows(); ++row)
  {
    std::cout << table->GetValueByName(row, "Region").ToInt() << "  "
              << table->GetValueByName(row, "Mean_0").ToDouble() << "  "
              << table->GetValueByName(row, "Area").ToDouble() << "  "
              << table->GetValueByName(row, "BoundaryLength").ToDouble() << "\n";
  }
  std::cout << "lambda " << regions->GetEffectiveFidelityWeight()
            << ", certified to a relative gap of " << regions->GetGap() << "\n";
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputDataObject(regions->GetOutputDataObject(0));
  writer->SetFileName("segmentation.vtp");
  writer->SetDataModeToBinary(); // Debian 12's VTK cannot read appended data, the default
  return writer->Write() ? 0 : 1;
}
