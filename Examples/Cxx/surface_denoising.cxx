// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause

// Remove the noise of the points of a surface, and keep its sharp edges. The normals of the
// triangles are regularised by descent on
//
//     sum w_fg rho(|n_f - n_g|) + mu sum |n_f - n0_f|^2,   |n_f| = 1,
//
// where rho saturates at sharp edges, and the points are moved to fit them and to stay near their
// given places. Both steps alternate. All weights follow from the noise level, which is measured.
//
//     surface_denoising                a cube with noise, generated here
//     surface_denoising surface.vtp    your own surface
//
// The result is written to surface_denoising.vtp: the moved points, with their displacements.
//
// Try next: SetSurfaceTypeToOrganic(), which rounds the edges of the cube; SetNoiseLevel(), if too
// much or too little is removed; input array 3, which holds points where they are.

#include <vtkMinimalStandardRandomSequence.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkSphereSource.h>
#include <vtkSurfaceDenoisingFilter.h>
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
  vtkNew<vtkSurfaceDenoisingFilter> denoising;
  denoising->SetInputData(argc > 1 ? Read(argv[1]) : NoisyCube());
  denoising->Update();
  if (denoising->GetMeanEdgeLength() == 0.0)
  {
    return 1; // the filter has reported the error
  }
  const char* const kinds[] = { "a surface", "a CAD shape", "an organic shape" };
  std::cout << kinds[denoising->GetEffectiveSurfaceType()] << " with noise of "
            << denoising->GetEffectiveNoiseLevel() << ", or "
            << denoising->GetEffectiveNoiseLevel() / denoising->GetMeanEdgeLength()
            << " mean edge lengths\npoints moved by " << denoising->GetMeanDisplacement()
            << " on average, at most " << denoising->GetMaximumDisplacement() << "\nvolume "
            << denoising->GetVolumeBefore() << " before, " << denoising->GetVolumeAfter()
            << " after\n";
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputDataObject(denoising->GetOutputDataObject(0));
  writer->SetFileName("surface_denoising.vtp");
  writer->SetDataModeToBinary(); // Debian 12's VTK cannot read appended data, the default
  return writer->Write() ? 0 : 1;
}
