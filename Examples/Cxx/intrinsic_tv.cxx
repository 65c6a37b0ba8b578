// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause

// Take noise off colours on a surface and keep their edges, with intrinsic total variation
//
//     u_t = div(grad u / |grad u|) + lambda (f - u),   u(0) = f,
//
// f the noisy colours: first in ten steps of the paper's scheme, then its steady state directly,
// the minimum of int |grad u| + lambda/2 int |u - f|^2. The three channels share one norm of the
// gradient, so that their edges stay in one place.
//
//     intrinsic_tv                        noise on the patches of a sphere, made here
//     intrinsic_tv surface.vtp array      data of your own; the result is written to
//                                         intrinsic_tv.vtp
//
// Try next: SetFidelityWeight(6), which takes off less; SetAutomaticFidelity(true), which finds
// lambda; SetFidelityNormToL1() with FidelityWeight 1.2, for single wrong colours (salt and
// pepper); a mask as input array 1, whose points are filled.

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

// Prints how the last update came about; false if it did not, and the filter has said why. The
// energy of time steps is a little lower at the same u: they round |grad u| by Beta, the minimum
// does not.
bool Report(const char* what, vtkIntrinsicTVFilter* tv)
{
  vtkTable* const history = vtkTable::SafeDownCast(tv->GetOutputDataObject(1));
  const vtkIdType rows = history->GetNumberOfRows();
  if (rows == 0)
  {
    return false;
  }
  std::cout << what << ": energy " << history->GetValueByName(0, "Energy").ToDouble() << " -> "
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
  if (!Report("the minimum", tv))
  {
    return 1;
  }

  // The surface with the array `colorsTV`.
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData(vtkPolyData::SafeDownCast(tv->GetOutputDataObject(0)));
  writer->SetFileName("intrinsic_tv.vtp");
  writer->SetDataModeToBinary(); // Debian 12's VTK cannot read appended data, the default
  return writer->Write() ? 0 : 1;
}
