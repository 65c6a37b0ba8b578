// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/BlurSettings.h"

#include <algorithm>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// The widths, in mean edge lengths, that the mesh resolves and that leave enough to restore.
constexpr double LeastWidth = 2.0;
constexpr double LargestWidth = 8.0;

/// The number of products with H that the choice of a solver counts on.
constexpr double ExpectedProducts = 100.0;

/// H has to be symmetric for the methods that use it.
constexpr double LargestTolerance = 1e-10;

} // namespace

void BlurSettings::Visit(SettingVisitor& visitor)
{
  visitor.Number({ "BlurFWHM", "coordinates",
                   "Full width at half maximum, in the unit of the coordinates, of a blur that "
                   "the data have gone through on the surface and that Mode SteadyState removes. "
                   "0: none. It is meant for widths of 2 to 8 mean edge lengths. The blur of a "
                   "camera's image is not a blur on the surface.",
                   "(Mode=SteadyState and Regularizer=TV and FidelityNorm=L2 and "
                   "Discretization=Linear and ColorModel=RGB) or BlurFWHM!=0" },
    this->FWHM, SettingRange::NonNegative());
  visitor.Integer({ "BlurSteps", "",
                    "Number of implicit steps that model the blur of BlurFWHM. With 4 its point "
                    "spread function has the half maximum of a Gaussian but longer tails: if the "
                    "blur was that of heat flow, waves of 1 to 2 widths come back up to half too "
                    "high. More steps are more similar to a Gaussian, and amplify noise more: 64 "
                    "restore waves of 1.5 widths to 2 %.",
                    "BlurFWHM!=0" },
    this->Steps, SettingRange::Between(2.0, 64.0, "2 to 64"));
}

void BlurSettings::Warn(const ModelInputs& inputs, RunResult& result) const
{
  const double edges = this->FWHM / inputs.Units.MeanEdgeLength;
  if (edges < LeastWidth || edges > LargestWidth)
  {
    Sentence text;
    text << Word::Setting("BlurFWHM") << " is " << this->FWHM << ", " << edges
         << " mean edge lengths; a restoration is "
         << "reliable from " << LeastWidth << " to " << LargestWidth << " mean edge lengths";
    result.Warnings.push_back(text);
  }
}

std::unique_ptr<HeatBlur> BlurSettings::Make(
  ModelInputs& inputs, const IterationLimits& limits) const
{
  const double width = this->FWHM / inputs.Units.LengthUnit;
  const double h = inputs.Units.CoreEdgeLength();
  SolverTask task;
  task.NumberOfVertices = inputs.Surface.Mesh().NumberOfVertices();
  task.NumberOfColumns = static_cast<int>(inputs.Columns);
  task.DiffusionNumber = HeatBlur::TimeOfWidth(width, this->Steps) / this->Steps / (h * h);
  task.NumberOfSolves = ExpectedProducts * this->Steps;
  std::shared_ptr<LinearSolver> solver = inputs.Solvers.Find(SolverPurpose::Blur, task);
  solver->SetLimits(
    { std::min(limits.Tolerance, LargestTolerance), limits.MaximumNumberOfIterations });
  return std::make_unique<HeatBlur>(
    inputs.Surface.SharedAssembler(), width, this->Steps, std::move(solver), inputs.Parallel);
}

} // namespace SurfaceDiffusion
