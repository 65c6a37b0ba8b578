// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause

// Denoise data on a surface with the heat equation
//
//     u_t = div grad u + lambda (f - u),   u(0) = f,
//
// where f is the noisy data and div grad is the Laplace-Beltrami operator. Diffusion removes noise,
// which varies from vertex to vertex, long before it changes larger features. The fidelity term
// (lambda > 0) pulls the result towards the data, so that the solution converges to a smooth
// compromise. In natural units, the default, times are in squared mean edge lengths: the same
// numbers suit every mesh.
//
//     heat                        noise on a sphere, generated here
//     heat surface.vtp array      your own data; the result is written to heat.vtp
//
// Try next: SetFidelityWeight(0) and a long run, which converges to the mean;
// SetModeToSteadyState(), which computes the limit in one solve; SetAutomaticFidelity(true), which
// chooses lambda.

#include <vtkDataObject.h>
#include <vtkDoubleArray.h>
#include <vtkFVMHeatFilter.h>
#include <vtkMinimalStandardRandomSequence.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkSphereSource.h>
#include <vtkTable.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>

#include <iostream>

// The height on a unit sphere, with noise of up to 0.3.
vtkSmartPointer<vtkPolyData> NoisySphere(const char* name)
{
  vtkNew<vtkSphereSource> source;
  source->SetRadius(1.0);
  source->SetThetaResolution(100);
  source->SetPhiResolution(100);
  source->Update();
  vtkSmartPointer<vtkPolyData> sphere = source->GetOutput();
  vtkNew<vtkMinimalStandardRandomSequence> random;
  vtkNew<vtkDoubleArray> data;
  data->SetName(name);
  for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
  {
    data->InsertNextValue(sphere->GetPoint(i)[2] + random->GetNextRangeValue(-0.3, 0.3));
  }
  sphere->GetPointData()->AddArray(data);
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
  const char* const array = argc > 2 ? argv[2] : "height";
  const vtkSmartPointer<vtkPolyData> surface = argc > 2 ? Read(argv[1]) : NoisySphere(array);

  vtkNew<vtkFVMHeatFilter> heat;
  heat->SetInputData(surface);
  heat->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, array);
  heat->SetFidelityWeight(0.1);
  heat->SetTimeStep(5.0);
  heat->SetNumberOfTimeSteps(10);
  heat->Update();

  // Output 0 is the surface with the array `heightDiffused`, output 1 the history of the run.
  vtkPolyData* const result = vtkPolyData::SafeDownCast(heat->GetOutputDataObject(0));
  vtkTable* const history = vtkTable::SafeDownCast(heat->GetOutputDataObject(1));
  if (history->GetNumberOfRows() == 0)
  {
    return 1; // the filter has reported the error
  }
  std::cout << "mean edge length " << heat->GetMeanEdgeLength() << ", unit of time "
            << heat->GetTimeUnit() << "\ntime  integral      energy\n";
  for (vtkIdType row = 0; row < history->GetNumberOfRows(); ++row)
  {
    std::cout << history->GetValueByName(row, "Time").ToDouble() << "  "
              << history->GetValueByName(row, "Total_0").ToDouble() << "  "
              << history->GetValueByName(row, "Energy").ToDouble() << "\n";
  }
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData(result);
  writer->SetFileName("heat.vtp");
  writer->SetDataModeToBinary(); // Debian 12's VTK cannot read appended data, the default
  return writer->Write() ? 0 : 1;
}
