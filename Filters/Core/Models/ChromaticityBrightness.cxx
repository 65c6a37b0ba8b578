// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/ChromaticityBrightness.h"

#include "Core/Models/Harmonic/UnitVectors.h"
#include "Core/Models/InitialState.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

ChromaticityBrightness::ChromaticityBrightness(std::shared_ptr<const Assembler> assembler,
  PointData data, const Settings& settings, const BrightnessMaker& makeBrightness,
  const ChromaticityMaker& makeChromaticity, const ParallelFor& parallel)
  : Assembly(std::move(assembler))
  , Options(settings)
  , Parallel(parallel)
{
  if (settings.SteadyState)
  {
    FixFreeComponents(this->Assembly->Mesh(), data, settings.Fidelity);
  }
  this->Start = data.Start;
  this->Fixed = data.Fixed;
  this->U = data.Start;
  this->Weights.resize(data.Start.rows());
  for (Index i = 0; i < static_cast<Index>(this->Weights.size()); ++i)
  {
    this->Weights[i] = data.FidelityFactor(i);
  }
  PointData brightness = this->BrightnessData(data);
  this->GivenBrightness = brightness.Given;
  PointData chromaticity = this->ChromaticityData(data);
  this->GivenChromaticity = chromaticity.Given;
  this->BrightnessModel = makeBrightness(std::move(brightness));
  this->ChromaticityModel = makeChromaticity(std::move(chromaticity));
  this->BrightnessTarget = this->GivenBrightness;
  this->OldBrightness = this->Brightness();
  this->ChromaticityWeights.resize(this->Weights.size());
  this->UpdateBrightnessData();
  this->UpdateChromaticityWeights();
}

PointData ChromaticityBrightness::BrightnessData(const PointData& data)
{
  PointData brightness;
  brightness.Given = data.Given.rowwise().norm();
  brightness.Start = data.Start.rowwise().norm();
  brightness.Missing = data.Missing;
  brightness.Fixed = data.Fixed;
  brightness.FidelityFactors = data.FidelityFactors;
  for (Index i = 0; i < static_cast<Index>(data.Missing.size()); ++i)
  {
    if (data.Missing[i])
    {
      brightness.Given(i, 0) = 0.0;
    }
  }
  return brightness;
}

/// Black vertices are missing. They start from the chromaticities around them.
PointData ChromaticityBrightness::ChromaticityData(const PointData& data) const
{
  PointData chromaticity = data;
  Flags known = data.Missing;
  for (Index i = 0; i < static_cast<Index>(data.Missing.size()); ++i)
  {
    known[i] = Normalize(chromaticity.Start.row(i));
    chromaticity.Fixed[i] = data.Fixed[i] && known[i];
    if (data.Missing[i] || !Normalize(chromaticity.Given.row(i)))
    {
      chromaticity.Missing[i] = true;
      chromaticity.Given.row(i).setZero(); // not read as data
    }
  }
  SpreadUnitVectors(this->Assembly->Mesh(), chromaticity.Start, known, false);
  return chromaticity;
}

/// C . C_f; 0 where the data of C are missing.
double ChromaticityBrightness::Agreement(Index i) const
{
  return this->Chromaticity().row(i).dot(this->GivenChromaticity.row(i));
}

/// The data of B for the present C.
void ChromaticityBrightness::UpdateBrightnessData()
{
  ForEach(this->Parallel, static_cast<Index>(this->Weights.size()),
    [&](Index i)
    { this->BrightnessTarget(i, 0) = this->GivenBrightness(i, 0) * this->Agreement(i); });
  this->BrightnessModel->SetGiven(this->BrightnessTarget);
}

/// The factors of the fidelity of C for the present B.
void ChromaticityBrightness::UpdateChromaticityWeights()
{
  ForEach(this->Parallel, static_cast<Index>(this->Weights.size()),
    [&](Index i)
    {
      this->ChromaticityWeights[i] =
        this->Weights[i] * this->Brightness()(i, 0) * this->GivenBrightness(i, 0);
    });
  this->ChromaticityModel->SetFidelityFactors(this->ChromaticityWeights);
}

StepReport ChromaticityBrightness::Advance(const ProgressMonitor& progress)
{
  StepReport report;
  if (this->Options.SteadyState)
  {
    this->StepToSteadyState(report, progress);
  }
  else
  {
    this->Alternate(report, progress);
  }
  this->Started = true;
  this->UpdateState();
  return report;
}

void ChromaticityBrightness::StepToSteadyState(StepReport& report, const ProgressMonitor& progress)
{
  const double tolerance = this->Options.StopTolerance;
  double energy = this->Energy();
  double fraction = 0.0;
  for (int k = 0; k < this->Options.MaximumNumberOfAlternations; ++k)
  {
    this->Alternate(report, progress.Part(fraction, fraction));
    const double former = energy;
    energy = this->Energy();
    report.Residual = former > 0.0 ? std::max(0.0, former - energy) / former : 0.0;
    if (report.Residual <= tolerance)
    {
      break;
    }
    const double left = std::log(1.0 / std::min(1.0, report.Residual));
    fraction = std::max(fraction, std::min(1.0, left / std::log(1.0 / tolerance)));
    progress.Report(fraction);
  }
  progress.Report(1.0);
}

/// A step of B at fixed C and a step of C at fixed B.
void ChromaticityBrightness::Alternate(StepReport& report, const ProgressMonitor& progress)
{
  this->StepBrightness(report, progress.Part(0.0, 0.5));
  this->UpdateChromaticityWeights();
  const StepReport step = this->ChromaticityModel->Advance(progress.Part(0.5, 1.0));
  report.Iterations += step.Iterations;
  report.MissedResidual = std::max(report.MissedResidual, step.MissedResidual);
  this->UpdateBrightnessData();
}

void ChromaticityBrightness::StepBrightness(StepReport& report, const ProgressMonitor& progress)
{
  this->OldBrightness = this->Brightness();
  const double energy = this->BrightnessModel->Energy();
  const StepReport step = this->BrightnessModel->Advance(progress);
  report.Iterations += step.Iterations;
  report.Residual = step.Residual;
  report.MissedResidual = std::max(report.MissedResidual, step.MissedResidual);
  if (this->Assembly->Mesh().GetReduction().Any((this->Brightness().array() < 0.0).any()))
  {
    this->BrightnessTarget = this->Brightness().cwiseMax(0.0); // memory that is free now
    this->BrightnessModel->SetState(this->BrightnessTarget);
  }
  if (this->BrightnessModel->Energy() > energy)
  {
    this->BrightnessModel->SetState(this->OldBrightness);
  }
}

/// The model of B has its energy for the data B_f (C . C_f), and that of C over mu has the fidelity
/// B B_f |C - C_f|^2. Of |B C - f|^2 this leaves B_f (1 - C . C_f) (B_f (1 + C . C_f) - 2 B).
double ChromaticityBrightness::Energy() const
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  const double rest = Sum(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      const double given = this->GivenBrightness(i, 0);
      if (given == 0.0)
      {
        return 0.0;
      }
      const double apart =
        0.5 * (this->Chromaticity().row(i) - this->GivenChromaticity.row(i)).squaredNorm();
      return mesh.ControlAreas()[i] * this->Weights[i] * given * apart *
        (given * (2.0 - apart) - 2.0 * this->Brightness()(i, 0));
    });
  return this->BrightnessModel->Energy() +
    this->Options.ChromaticityWeight * this->ChromaticityModel->Energy() +
    0.5 * this->Options.Fidelity * mesh.GetReduction().Sum(rest);
}

DiffusionStep ChromaticityBrightness::Diffusion() const
{
  DiffusionStep step = this->BrightnessModel->Diffusion();
  step.SharesTensor = true;
  if (this->Options.SteadyState)
  {
    step.TimeStep = InfiniteTime;
  }
  return step;
}

void ChromaticityBrightness::UpdateState()
{
  if (!this->Started)
  {
    this->U = this->Start;
    return;
  }
  ForEach(this->Parallel, static_cast<Index>(this->U.rows()),
    [&](Index i)
    {
      if (this->Fixed[i])
      {
        this->U.row(i) = this->Start.row(i);
      }
      else
      {
        this->U.row(i) = this->Brightness()(i, 0) * this->Chromaticity().row(i);
      }
    });
}

std::size_t ChromaticityBrightness::CheckpointSize() const
{
  return 1 + this->BrightnessModel->CheckpointSize() + this->ChromaticityModel->CheckpointSize();
}

void ChromaticityBrightness::Save(double* checkpoint) const
{
  *checkpoint = this->Started ? 1.0 : 0.0;
  this->BrightnessModel->Save(checkpoint + 1);
  this->ChromaticityModel->Save(checkpoint + 1 + this->BrightnessModel->CheckpointSize());
}

void ChromaticityBrightness::Restore(const double* checkpoint)
{
  this->Started = *checkpoint > 0.0;
  this->BrightnessModel->Restore(checkpoint + 1);
  this->ChromaticityModel->Restore(checkpoint + 1 + this->BrightnessModel->CheckpointSize());
  this->UpdateBrightnessData();
  this->UpdateChromaticityWeights();
  this->UpdateState();
}

} // namespace SurfaceDiffusion
