// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause

// Denoise colours on a surface and preserve their edges, by intrinsic total variation flow
//
//     u_t = div(grad u / |grad u|) + lambda (f - u),   u(0) = f,
//
// where f is the noisy colours. The program first takes ten time steps of the paper's scheme and
// then computes the steady state directly, the minimiser of int |grad u| + lambda/2 int |u - f|^2.
// The three channels share one norm of the gradient, so that their edges stay aligned.
//
//     intrinsic_tv                        noisy patches on a sphere, generated here
//     intrinsic_tv surface.vtp array      your own data; the result is written to intrinsic_tv.vtp
//
// Try next: SetFidelityWeight(6), which removes less; SetAutomaticFidelity(true), which chooses
// lambda; SetColorModelToOpponent(), which smooths colour more than brightness;
// SetFidelityNormToL1() with FidelityWeight 1.2, for salt-and-pepper noise; a mask as input array
// 1, whose points are filled in.

#include <vtkDataObject.h>
#include <vtkIntrinsicTVFilter.h>
#include <vtkMinimalStandardRandomSequence.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkSphereSource.h>
#include <vtkTable.h>
#include <vtkUnsignedCharArray.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>

#include <cmath>
#include <iostream>

// Patches of two colours with noise of up to 60 of 255.
vtkSmartPointer<vtkPolyData> NoisyPatches(const char* name)
{
  vtkNew<vtkSphereSource> source;
  source->SetRadius(1.0);
  source->SetThetaResolution(100);
  source->SetPhiResolution(100);
  source->Update();
  vtkSmartPointer<vtkPolyData> sphere = source->GetOutput();
  vtkNew<vtkMinimalStandardRandomSequence> random;
  vtkNew<vtkUnsignedCharArray> colors;
  colors->SetName(name);
  colors->SetNumberOfComponents(3);
  for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
  {
    const double* p = sphere->GetPoint(i);
    const bool inside = std::sin(4.0 * p[0]) * std::sin(4.0 * p[1]) * std::sin(4.0 * p[2]) > 0.0;
    double color[3] = { inside ? 200.0 : 80.0, 130.0, inside ? 70.0 : 180.0 };
    for (double& channel : color)
    {
      channel = std::round(channel + random->GetNextRangeValue(-60.0, 60.0));
    }
    colors->InsertNextTuple(color);
  }
  sphere->GetPointData()->SetScalars(colors);
  return sphere;
}

vtkSmartPointer<vtkPolyData> Read(const char* file)
{
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(file);
  reader->Update();
  return reader->GetOutput();
}

// Prints the energy and the iterations of the last update. Returns false if the update failed; the
// filter has then reported the error. At the same u the energy of the time steps is slightly lower
// than that of the minimiser, since they regularise |grad u| by Beta.
bool Report(const char* title, vtkIntrinsicTVFilter* tv)
{
  vtkTable* const history = vtkTable::SafeDownCast(tv->GetOutputDataObject(1));
  const vtkIdType rows = history->GetNumberOfRows();
  if (rows == 0)
  {
    return false;
  }
  std::cout << title << ": energy " << history->GetValueByName(0, "Energy").ToDouble() << " -> "
            << history->GetValueByName(rows - 1, "Energy").ToDouble() << " in "
            << tv->GetNumberOfIterations() << " iterations\n";
  return true;
}

int main(int argc, char* argv[])
{
  const char* const array = argc > 2 ? argv[2] : "colors";
  const vtkSmartPointer<vtkPolyData> surface = argc > 2 ? Read(argv[1]) : NoisyPatches(array);

  vtkNew<vtkIntrinsicTVFilter> tv;
  tv->SetInputData(surface);
  tv->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, array);
  tv->SetFidelityWeight(3.0);
  tv->Update();
  if (!Report("ten time steps", tv))
  {
    return 1;
  }
  tv->SetModeToSteadyState();
  tv->Update();
  if (!Report("the minimiser", tv))
  {
    return 1;
  }

  // Write the surface with the array `colorsTV`.
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData(vtkPolyData::SafeDownCast(tv->GetOutputDataObject(0)));
  writer->SetFileName("intrinsic_tv.vtp");
  writer->SetDataModeToBinary(); // Debian 12's VTK cannot read appended data, the default
  return writer->Write() ? 0 : 1;
}
