// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause

// Grow a texture on a surface. Two chemicals react and diffuse,
//
//     du1/dt = D1 Lap u1 + 16 - u1 u2,   du2/dt = D2 Lap u2 + u1 u2 - u2 - 12,
//
// from the steady state u1 = u2 = 4 with noise, where Lap is the Laplace-Beltrami operator. If u1
// diffuses more than four times as fast as u2, a pattern grows; here it consists of spots.
//
//     turing_texture                     on a torus, generated here
//     turing_texture surface.vtp 0.2     on your own surface, with spots 0.2 apart
//
// The result is written to turing_texture.vtp: u1, u2, Texture and the colours TextureColor.
//
// Try next: SetDiffusionRate1(16 * 2.6), which gives a labyrinth; vtkSurfaceDirectionFieldFilter
// upstream and SetDiffusionRateAcross2(1.3), which gives stripes; SetKineticsToGrayScott().

#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkSuperquadricSource.h>
#include <vtkTable.h>
#include <vtkTuringTextureFilter.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>

#include <cstdlib>
#include <iostream>

vtkSmartPointer<vtkPolyData> Torus()
{
  vtkNew<vtkSuperquadricSource> source;
  source->ToroidalOn();
  source->SetThickness(0.5);
  source->SetSize(1.5);
  source->SetThetaResolution(128);
  source->SetPhiResolution(64);
  source->Update();
  return source->GetOutput();
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
  vtkNew<vtkTuringTextureFilter> turing;
  turing->SetInputData(argc > 1 ? Read(argv[1]) : Torus());
  turing->SetFeatureSize(argc > 2 ? std::atof(argv[2]) : 0.4);
  turing->SetDiffusionRate1(5 * 2.6); // five times DiffusionRate2
  turing->SetTimeStep(1.0 / 8.0);
  turing->SetNumberOfTimeSteps(800);
  turing->SetStopTolerance(0.05); // until the pattern is stationary
  turing->MergeCoincidentPointsOn(); // the source leaves seams in the torus
  turing->SetMergeTolerance(1e-6);
  turing->ColorOutputOn();
  turing->Update();

  // Output 1 has one row per step.
  vtkTable* const history = vtkTable::SafeDownCast(turing->GetOutputDataObject(1));
  const vtkIdType rows = history->GetNumberOfRows();
  if (rows == 0)
  {
    return 1; // the filter has reported the error
  }
  std::cout << "wavelength " << turing->GetWavelength() << ", "
            << turing->GetWavelength() / turing->GetMeanEdgeLength() << " mean edge lengths\n"
            << "stationary after " << rows - 1 << " steps, at time "
            << history->GetValueByName(rows - 1, "Time").ToDouble() << "\n";
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputDataObject(turing->GetOutputDataObject(0));
  writer->SetFileName("turing_texture.vtp");
  writer->SetDataModeToBinary(); // Debian 12's VTK cannot read appended data, the default
  return writer->Write() ? 0 : 1;
}
