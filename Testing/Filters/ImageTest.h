// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkImageData.h"
#include "vtkImageDifference.h"
#include "vtkNew.h"
#include "vtkPNGReader.h"
#include "vtkPNGWriter.h"
#include "vtkRenderWindow.h"
#include "vtkWindowToImageFilter.h"

#include <filesystem>
#include <iostream>
#include <limits>
#include <string>

/**
 * Comparison of the contents of a window with a baseline, Testing/Baseline/<name>.png.
 *
 * A test asks `EXPECT_LE(ImageTest::Error(window, "Name"), ImageTest::Tolerance)`. A negative twin
 * draws something slightly wrong and asks `EXPECT_GT` of the same baseline, which shows that the
 * picture would notice. Use banded colours: smooth ones hide errors.
 */
namespace ImageTest
{
/// The largest error of equal pictures, in pixels that differ fully (black for white). It allows
/// for the rounding of another software renderer along a few edges, but not for a shifted band.
constexpr double Tolerance = 10.0;

/// Draws off screen, without multisampling, which depends on the driver. To be called once, before
/// the first Render().
inline void Prepare(vtkRenderWindow* window, int width = 300, int height = 300)
{
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);
  window->SetSize(width, height);
}

/**
 * Draws the window and returns its difference from the baseline, in fully different pixels;
 * NaN, which fails either way, if there is no baseline or its size differs. The obtained picture is
 * written to SURFACEDIFFUSION_OUTPUT_DIR as <output>.png (the baseline's name if empty; give twins
 * their own), from where a new baseline is copied after a look at it.
 */
inline double Error(
  vtkRenderWindow* window, const std::string& baseline, const std::string& output = "")
{
  window->Render();
  vtkNew<vtkWindowToImageFilter> obtained;
  obtained->SetInput(window);
  obtained->SetInputBufferTypeToRGB();
  obtained->ReadFrontBufferOff();
  obtained->ShouldRerenderOff();
  obtained->Update();

  vtkNew<vtkPNGWriter> writer;
  const std::string written =
    SURFACEDIFFUSION_OUTPUT_DIR "/" + (output.empty() ? baseline : output) + ".png";
  writer->SetFileName(written.c_str());
  writer->SetInputConnection(obtained->GetOutputPort());
  writer->Write();

  const std::string file = SURFACEDIFFUSION_BASELINE_DIR "/" + baseline + ".png";
  if (!std::filesystem::exists(file))
  {
    std::cerr << "no baseline " << file << "; obtained: " << written << "\n";
    return std::numeric_limits<double>::quiet_NaN();
  }
  vtkNew<vtkPNGReader> expected;
  expected->SetFileName(file.c_str());
  expected->Update();
  int size[3];
  int expectedSize[3];
  obtained->GetOutput()->GetDimensions(size);
  expected->GetOutput()->GetDimensions(expectedSize);
  if (size[0] != expectedSize[0] || size[1] != expectedSize[1] ||
    expected->GetOutput()->GetNumberOfScalarComponents() != 3)
  {
    std::cerr << file << " has another size or is not RGB; obtained: " << written << "\n";
    return std::numeric_limits<double>::quiet_NaN();
  }

  // This is stricter than VTK's defaults, which allow shifts of a pixel and average neighbours.
  vtkNew<vtkImageDifference> difference;
  difference->SetInputConnection(obtained->GetOutputPort());
  difference->SetImageConnection(expected->GetOutputPort());
  difference->AllowShiftOff();
  difference->AveragingOff();
  difference->SetThreshold(16);
  difference->Update();
  const double error = difference->GetThresholdedError();
  std::cout << baseline << ": error " << error << ", obtained " << written << "\n";
  return error;
}
}
