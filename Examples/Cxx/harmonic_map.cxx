// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause

// Denoise a mesh through its normals. The normals u diffuse as unit vectors,
//
//     u_t = div(grad u / |grad u|) + u |grad u|,   u(0) = the normals of the noisy surface,
//
// which is the harmonic map flow with exponent p = 1: it removes noise and preserves creases. Then
// the points are moved so that the triangles turn as their normals have turned. Times
// are in mean edge lengths.
//
//     harmonic_map                a cube with noise, generated here
//     harmonic_map surface.vtp    your own surface
//
// The result is written to harmonic_map.vtp: the moved points with the regularised normals.
//
// Try next: SetExponent(2.0), which rounds the edges of the cube; SetMoveVertices(false), which
// changes only the shading; LineField and another array, for directions without a sign.

#include <vtkDataObject.h>
#include <vtkHarmonicMapFilter.h>
#include <vtkMinimalStandardRandomSequence.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkSphereSource.h>
#include <vtkTable.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>

#include <algorithm>
#include <cmath>
#include <iostream>

// A cube of side 2: a sphere projected onto it, with noise of up to 0.015 in every coordinate.
vtkSmartPointer<vtkPolyData> NoisyCube()
{
  vtkNew<vtkSphereSource> source;
  source->SetRadius(1.0);
  source->SetThetaResolution(100);
  source->SetPhiResolution(100);
  source->GenerateNormalsOff();
  source->Update();
  vtkSmartPointer<vtkPolyData> cube = source->GetOutput();
  vtkNew<vtkMinimalStandardRandomSequence> random;
  for (vtkIdType i = 0; i < cube->GetNumberOfPoints(); ++i)
  {
    double p[3];
    cube->GetPoint(i, p);
    const double size = std::max({ std::abs(p[0]), std::abs(p[1]), std::abs(p[2]) });
    for (double& x : p)
    {
      x = x / size + random->GetNextRangeValue(-0.015, 0.015);
    }
    cube->GetPoints()->SetPoint(i, p);
  }
  return cube;
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
  vtkNew<vtkHarmonicMapFilter> harmonic;
  harmonic->SetInputData(argc > 1 ? Read(argv[1]) : NoisyCube());
  harmonic->SetTimeStep(0.02);
  harmonic->SetNumberOfTimeSteps(10);
  harmonic->MoveVerticesOn();
  harmonic->Update();

  // Output 1, the history, shows that the energy, the total variation of the normals, decreases.
  vtkTable* const history = vtkTable::SafeDownCast(harmonic->GetOutputDataObject(1));
  if (history->GetNumberOfRows() == 0)
  {
    return 1; // the filter has reported the error
  }
  std::cout << "time  energy\n";
  for (vtkIdType row = 0; row < history->GetNumberOfRows(); ++row)
  {
    std::cout << history->GetValueByName(row, "Time").ToDouble() << "  "
              << history->GetValueByName(row, "Energy").ToDouble() << "\n";
  }
  std::cout << "mean edge length " << harmonic->GetMeanEdgeLength() << "; points moved by "
            << harmonic->GetMeanDisplacement() << " on average, at most "
            << harmonic->GetMaximumDisplacement() << "\nvolume " << harmonic->GetVolumeBefore()
            << " before, " << harmonic->GetVolumeAfter() << " after\n";
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputDataObject(harmonic->GetOutputDataObject(0));
  writer->SetFileName("harmonic_map.vtp");
  writer->SetDataModeToBinary(); // Debian 12's VTK cannot read appended data, the default
  return writer->Write() ? 0 : 1;
}
