// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// A bound of the iterations that each kind of run needs per step, which are counted, not timed.
// Factorisations and the work of filters without steps: Testing/Core/TestWork.cxx.

#include "AllFilters.h"

#include <cstdio>
#include <map>

using namespace FilterTest;

namespace
{

/// The number of iterations per step on rough data, at 1026 points. They were measured; the bounds
/// are about twice as large. Runs with direct solvers have none.
const std::map<std::string, int> LargestNumbers = {
  // Two solves of condition 1 + gamma dt lambda_max, about 3 for a time step of h^2.
  { "HeatConjugateGradient", 80 },
  // The same with one cycle per iteration, which reduces the error by more than ten.
  { "HeatMultigrid", 25 },
  // Preconditioned without the blur: the condition is that of the blur's lowest waves.
  { "HeatDeblurred", 30 },
  // A restoration for each weight that is tried.
  { "HeatDeblurredFound", 260 },
  // One solve to 1e-3, and on edges one of a larger system.
  { "TV", 40 },
  { "TVOfCells", 40 },
  { "TVOpponent", 40 },
  { "TVChromaticity", 50 },
  { "TVCrouzeixRaviart", 80 },
  { "PeronaMalik", 12 },
  // ADMM to gaps of 1e-3, which are measured every tenth iteration. Absolute values are slowest:
  // nothing is strictly convex.
  { "TVImplicit", 90 },
  { "TVSteady", 100 },
  { "TVGeneralized", 150 },
  { "TVWeighted", 120 },
  { "TVOfWeightedCells", 120 },
  { "TVAutomatic", 30 },
  { "TVAbsolute", 600 },
  { "TVDeblurred", 12 },
  { "TVDeblurredFound", 4 },
  { "Segmentation", 50 },
  { "SegmentationOfThree", 30 },
  { "SegmentationWeighted", 50 },
  // On noise alone, as here, it is chance: 155 to 1,330 iterations in eighteen other runs.
  { "SegmentationDefaults", 2700 },
  { "SegmentationOfCells", 600 }, // from averages over neighbours, whose means stay
  // Solves in the tangent planes, whose weights 1/|grad u| differ by large factors.
  { "Harmonic", 60 },
  { "HarmonicMoved", 60 },
  { "HarmonicLines", 60 },
  { "HarmonicTangent", 60 },
  // A step is several of them.
  { "HarmonicMinimizing", 200 },
  // One solve for u and one for v.
  { "MumfordShah", 60 },
  { "MumfordShahOfCells", 60 },
  { "MumfordShahWeighted", 120 }, // solved to 1e-3, as with missing values
  { "MumfordShahGiven", 16 },
  // The solves on the coarse space, which has few unknowns.
  { "TuringCoarseStart", 12 },
};

} // namespace

TEST(Work, OfIterativeSolversPerStepIsBounded)
{
  const auto surface = Sphere(4);
  AddRough(surface);
  AddArraysOfAllFilters(surface);
  std::size_t iterative = 0;
  for (const FilterKind& kind : AllFilters())
  {
    SCOPED_TRACE(kind.Name);
    const auto filter = kind.Make();
    auto* const diffusion = vtkSurfaceModelAlgorithm::SafeDownCast(filter);
    if (!diffusion || vtkSurfaceInterpolationFilter::SafeDownCast(filter)) // has no iterations
    {
      continue;
    }
    filter->SetInputData(surface);
    Messages messages(filter);
    filter->Update();
    const auto steps = static_cast<double>(History(filter)->GetNumberOfRows() - 1);
    ASSERT_GE(steps, 1.0);
    const double found = static_cast<double>(diffusion->GetNumberOfIterations()) / steps;
    const auto largest = LargestNumbers.find(kind.Name);
    if (largest == LargestNumbers.end())
    {
      EXPECT_EQ(found, 0.0) << "has no bound";
      continue;
    }
    std::printf(
      "%-24s %6.1f of %d iterations per step\n", kind.Name.c_str(), found, largest->second);
    EXPECT_LE(found, largest->second);
    EXPECT_GE(10.0 * found, largest->second) << "the bound allows ten times the work";
    ++iterative;
  }
  EXPECT_EQ(iterative, LargestNumbers.size());
}
