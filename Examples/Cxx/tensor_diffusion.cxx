// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause

// Smooth data along their own lines, by coherence-enhancing diffusion:
//
//     u_t = div(D grad u),
//
// where D is 1 along the lines of the data and Alpha = 0.001 across them. The direction of the
// lines is that of the structure tensor, which is averaged over 4 mean edge lengths with the
// parallel transport of the surface. Noise disappears, gaps are closed, and stripes keep their
// contrast.
//
//     tensor_diffusion                        noisy stripes on a sphere, generated here
//     tensor_diffusion surface.vtp array      your own data
//
// The result is written to tensor_diffusion.vtp: the array with the suffix Coherent, and the cell
// array DiffusionAxes, the direction of the lines.
//
// Try next: SetModelToBeltrami(), which keeps the edges of colours; SetContrast(0.01),
// which closes gaps of weaker lines.

#include <vtkDataObject.h>
#include <vtkDoubleArray.h>
#include <vtkMinimalStandardRandomSequence.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkSphereSource.h>
#include <vtkTensorDiffusionFilter.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>

#include <cmath>
#include <iostream>
#include <string>

double Stripes(const double* x)
{
  return std::sin(15.0 * (0.8 * x[0] + 0.6 * x[2]));
}

// Stripes on the unit sphere, with noise of up to 1.
vtkSmartPointer<vtkPolyData> NoisyStripes(const char* name)
{
  vtkNew<vtkSphereSource> source;
  source->SetRadius(1.0);
  source->SetThetaResolution(120);
  source->SetPhiResolution(84);
  source->Update();
  vtkSmartPointer<vtkPolyData> sphere = source->GetOutput();
  vtkNew<vtkMinimalStandardRandomSequence> random;
  vtkNew<vtkDoubleArray> values;
  values->SetName(name);
  for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
  {
    values->InsertNextValue(Stripes(sphere->GetPoint(i)) + random->GetNextRangeValue(-1.0, 1.0));
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

// The root mean square difference from the stripes without noise.
double ErrorOf(vtkPolyData* surface, vtkDataArray* values)
{
  double sum = 0.0;
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    sum += std::pow(values->GetComponent(i, 0) - Stripes(surface->GetPoint(i)), 2);
  }
  return std::sqrt(sum / static_cast<double>(surface->GetNumberOfPoints()));
}

int main(int argc, char* argv[])
{
  const char* const name = argc > 2 ? argv[2] : "f";
  vtkNew<vtkTensorDiffusionFilter> diffusion;
  diffusion->SetInputData(argc > 1 ? Read(argv[1]) : NoisyStripes(name));
  diffusion->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, name);
  diffusion->SetModelToCoherenceEnhancing();
  diffusion->SetContrast(0.01); // small: strong noise hides how coherent the lines are
  diffusion->DiffusionAxesOn();
  diffusion->Update();
  vtkPolyData* const output = diffusion->GetOutput();
  vtkDataArray* const result =
    output->GetPointData()->GetArray((std::string(name) + "Coherent").c_str());
  if (!result)
  {
    return 1; // the filter has reported an error
  }
  if (argc == 1)
  {
    const double before = ErrorOf(output, output->GetPointData()->GetArray(name));
    const double after = ErrorOf(output, result);
    std::cout << "error of the noisy stripes " << before << ", of the result " << after << "\n";
    if (after > 0.4 * before)
    {
      return 1;
    }
  }
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData(output);
  writer->SetFileName("tensor_diffusion.vtp");
  writer->SetDataModeToBinary(); // Debian 12's VTK cannot read appended data, the default
  return writer->Write() ? 0 : 1;
}
