// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/DataPreparation.h"

#include "Core/Foundation/Random.h"
#include "Core/Models/HeatBlur.h"
#include "Core/Operators/CotanWeights.h"
#include "Core/Statistics/MeasuredVertices.h"
#include "Core/Statistics/NoiseCorrelation.h"
#include "Core/Statistics/NoiseLevel.h"

#include <cmath>
#include <cstdint>
#include <map>

namespace SurfaceDiffusion
{

namespace
{

NoiseEstimate EstimateNoiseOf(const ModelInputs& inputs, const PointData& data)
{
  return EstimateNoise(*inputs.Surface.SharedAssembler(), inputs.Surface.Points(), data);
}

/// The estimate of noise between neighbours is that of white noise. A warning if there is none.
void WarnOfSmoothData(const ModelInputs& inputs, double estimate, RunResult& result)
{
  const NeighbourVariation variation = MeasureVariation(
    *inputs.Surface.SharedAssembler(), inputs.Surface.Points(), inputs.Data, estimate);
  if (!variation.IsSmooth())
  {
    return;
  }
  const double unit = inputs.Units.ValueUnit;
  const Word level = Word::Setting("NoiseLevel");
  Sentence text = level;
  text << ": the data show no white noise but are smooth over about " << variation.Width
       << " (full width at half maximum), as correlated noise is, so that its estimate, "
       << estimate * unit << ", may be too small; without a signal the noise is "
       << variation.Deviation * unit << " (set " << level << ")";
  result.Warnings.push_back(text);
}

/// Of the first guess of the search for a weight: keeps data to seven digits.
constexpr double WeightWithoutNoise = 1e8;

/// The measured data that the result has to differ from by the noise.
PointData WithoutConstantParts(const ModelInputs& inputs)
{
  PointData data = inputs.Data;
  const Flags varying = FindVaryingVertices(*inputs.Surface.SharedAssembler(), data);
  if (varying.any())
  {
    data.Missing = !varying;
  }
  else if (data.Measured)
  {
    data.Missing = data.Missing || data.Measured->IsBetween;
  }
  return data;
}

} // namespace

double FindCellNoiseGain(const ModelInputs& inputs)
{
  const CellTransfer& cells = *inputs.Cells;
  Values noise = Values::Zero(cells.NumberOfCells(), 1);
  std::map<Index, std::int64_t> numbers; // of those that were measured as one cell
  std::int64_t next = 0; // cells that are no polygons, and their numbers, must not matter
  for (Index c = 0; c < cells.NumberOfCells(); ++c)
  {
    if (!cells.Participates(c))
    {
      continue;
    }
    std::int64_t number = next;
    if (!inputs.GivenCells.empty())
    {
      number =
        numbers.insert({ inputs.GivenCells[static_cast<std::size_t>(c)], next }).first->second;
    }
    next += number == next ? 1 : 0;
    noise(c, 0) = std::sqrt(3.0) * (2.0 * UniformRandom(0, 0, number) - 1.0); // of deviation 1
  }
  PointData data = PointData::FromValues(cells.ToVertices(noise, Vector::Ones(noise.rows())).Of);
  data.Measured = inputs.Data.Measured;
  const double found = EstimateNoiseOf(inputs, data).BetweenNeighbours;
  return found > 0.0 ? NoiseGain(inputs) / found : 0.0;
}

double NoiseGain(const ModelInputs& inputs)
{
  const auto& measured = inputs.Data.Measured;
  return inputs.Cells
    ? inputs.Cells->NoiseGain(inputs.GivenCells, measured ? measured->IsBetween : Flags())
    : 1.0;
}

double NoiseAtVertices(const ModelInputs& inputs, double noiseLevel)
{
  return noiseLevel / inputs.Units.ValueUnit * NoiseGain(inputs);
}

void DescribeData(const DataSettings& settings, ModelTraits& traits)
{
  traits.StartsFromKnownValues = true;
  traits.NeedsDirections = settings.IsDirected();
  traits.HoldsKnownValues = settings.HoldKnownValues;
  traits.ResultOnCells = settings.ResultOnCells;
  traits.KeepCellDetail = settings.KeepCellDetail;
  traits.UsesRandomNumbers = settings.InitialFill == InitialFill::Noise;
  traits.MaskHasEffect =
    settings.InitialFill != InitialFill::Input || traits.UsesFidelity || settings.HoldKnownValues;
}

void PrepareData(const DataSettings& settings, ModelInputs& inputs, RunResult& result)
{
  FillMissing(
    inputs.Surface.Mesh(), inputs.Data, settings.InitialFill, settings.RandomSeed, inputs.Ids);
  FillHarmonicallyIf(settings.InitialFill == InitialFill::Harmonic, inputs, result);
  CompletePreparation(settings, inputs, result);
}

void FillHarmonicallyIf(bool harmonic, ModelInputs& inputs, RunResult& result)
{
  const Reduction& reduction = inputs.Surface.Mesh().GetReduction();
  if (!harmonic || !reduction.Any(inputs.Data.Missing.any()))
  {
    return;
  }
  SolverTask task;
  task.NumberOfVertices = inputs.Surface.Mesh().NumberOfVertices();
  task.DiffusionNumber.reset();
  task.NumberOfColumns = static_cast<int>(inputs.Columns);
  const StepReport report = FillHarmonically(inputs.Surface.SharedAssembler(), inputs.Data,
    inputs.Solvers.Find(SolverPurpose::Fill, task), inputs.Parallel,
    inputs.Progress.Part(0.0, 0.4));
  if (inputs.IsLastPanel)
  {
    inputs.Solvers.Release(SolverPurpose::Fill);
  }
  result.MissedResidual = report.MissedResidual;
}

void CompletePreparation(const DataSettings& settings, ModelInputs& inputs, RunResult& result)
{
  result.HasMissing = inputs.Data.Missing.any();
  if (inputs.Data.FidelityFactors.size() > 0 && !settings.DescribeModel().UsesFidelity)
  {
    result.Warnings.push_back(Sentence(Word::Array("FidelityArray"))
      << " has no effect, since " << Word::Setting("FidelityWeight") << " is 0");
  }
  if (settings.HoldKnownValues)
  {
    inputs.Data.Fixed = inputs.Data.Fixed || !inputs.Data.Missing;
  }
}

CornerWeights MakeWeights(const DataSettings& settings, const ModelInputs& inputs)
{
  const TriangleMesh& mesh = inputs.Surface.Mesh();
  const CornerWeights isotropic = CotanWeights(mesh, inputs.Parallel);
  return settings.IsDirected()
    ? AnisotropicWeights(mesh, isotropic, inputs.Directions, settings.AlongDiffusivity,
        settings.AcrossDiffusivity, inputs.Parallel)
    : CornerWeights(settings.AlongDiffusivity * isotropic);
}

double MeanFidelityFactor(const TriangleMesh& mesh, const PointData& data)
{
  double sum = 0.0;
  double area = 0.0;
  for (Index i = 0; i < mesh.NumberOfVertices() && data.FidelityFactors.size() > 0; ++i)
  {
    const double factor = data.FidelityFactor(i);
    sum += mesh.ControlAreas()[i] * factor;
    area += factor > 0.0 ? mesh.ControlAreas()[i] : 0.0;
  }
  return sum > 0.0 ? sum / area : 1.0;
}

double FindFidelity(const ModelInputs& inputs, double noiseLevel, double start, int steps,
  const std::function<std::unique_ptr<Model>(double)>& makeModel, RunResult& result, HeatBlur* blur)
{
  const double unit = inputs.Units.ValueUnit;
  const NoiseEstimate estimate =
    noiseLevel == 0.0 ? EstimateNoiseOf(inputs, inputs.Data) : NoiseEstimate();
  double noise = NoiseAtVertices(inputs, noiseLevel);
  if (inputs.Cells && noiseLevel == 0.0)
  {
    noise = estimate.BetweenNeighbours * FindCellNoiseGain(inputs);
  }
  else if (noiseLevel == 0.0)
  {
    noise = estimate.Level();
    if (estimate.IsCorrelated())
    {
      result.Warnings.push_back(Sentence("the noise is correlated: its standard deviation is ")
        << estimate.BetweenNeighbours * unit << " between neighbours and " << noise * unit
        << " farther apart, which " << Word::Setting("AutomaticFidelity")
        << " uses (to set another, use " << Word::Setting("NoiseLevel") << ")");
    }
    else
    {
      WarnOfSmoothData(inputs, noise, result);
    }
  }
  if (noise == 0.0)
  {
    result.Warnings.push_back(Sentence(Word::Setting("AutomaticFidelity"))
      << (estimate.IsUndetermined
             ? " finds no known value, of a weight other than 0, with enough others "
               "around it to estimate the noise from, so that known values stay as "
               "they are"
             : " finds no noise in the data, which stay as they are")
      << " (to set the standard deviation of the noise, use " << Word::Setting("NoiseLevel")
      << ")");
    return WeightWithoutNoise * start;
  }
  const PointData compared = WithoutConstantParts(inputs);
  const auto discrepancy = [&](double fidelity)
  {
    const std::unique_ptr<Model> model = makeModel(fidelity);
    for (int step = 0; step < steps; ++step)
    {
      model->Advance(inputs.Progress.Part(0.5, 0.5));
    }
    Values predicted = model->State();
    if (blur)
    {
      StepReport unused;
      blur->Apply(predicted, unused);
    }
    return Discrepancy(inputs.Surface.Mesh(), compared, predicted);
  };
  const FidelityChoice choice = FindFidelityByDiscrepancy(discrepancy, noise, start);
  if (!choice.IsFound)
  {
    result.Warnings.push_back(Sentence(Word::Setting("AutomaticFidelity"))
      << " found no weight at which the result differs from the data by the noise, " << noise * unit
      << ": at the end of its search the difference is " << choice.Discrepancy * unit);
  }
  return choice.Weight;
}

} // namespace SurfaceDiffusion
