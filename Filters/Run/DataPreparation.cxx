// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/DataPreparation.h"

#include "Core/Operators/CotanWeights.h"
#include "Core/Statistics/MeasuredVertices.h"
#include "Core/Statistics/NoiseLevel.h"

#include <algorithm>
#include <vector>

namespace SurfaceDiffusion
{

double FindCellNoiseGain(const ModelInputs& inputs)
{
  PointData data = PointData::FromValues(Values::Zero(inputs.Surface.Mesh().NumberOfVertices(), 1));
  data.Measured = inputs.Data.Measured;
  const double found =
    ExpectedEstimate(*inputs.Surface.SharedAssembler(), inputs.Surface.Points(), data,
      [&](const std::vector<Index>& vertices, const Vector& weights)
      { return inputs.Cells->DeviationOf(vertices, weights, inputs.GivenCells); });
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

PointData DataOfColumns(const PointData& data, Eigen::Index first, Eigen::Index count)
{
  if (count == data.Given.cols())
  {
    return data;
  }
  PointData some;
  some.Given = data.Given.middleCols(first, count);
  some.Start = data.Start.middleCols(first, count);
  some.Missing = data.Missing;
  some.Fixed = data.Fixed;
  some.FidelityFactors = data.FidelityFactors;
  some.Measured = data.Measured;
  return some;
}

void WarnOfUnlikeColumns(const ModelInputs& inputs, const Sentence& apart, RunResult& result)
{
  const PointData& data = inputs.Data;
  if (data.Given.cols() < 2 || !inputs.Surface.Mesh().GetReduction().IsSerial())
  {
    return;
  }
  std::vector<double> noise;
  for (Eigen::Index k = 0; k < data.Given.cols(); ++k)
  {
    const NoiseEstimate found = EstimateNoise(
      *inputs.Surface.SharedAssembler(), inputs.Surface.Points(), DataOfColumns(data, k, 1));
    noise.push_back(found.Level() / NoiseGain(inputs) * inputs.Units.ValueUnit);
  }
  constexpr double factor = 5.0;
  constexpr double roundOff = 1e-6; // of a component of vectors in a plane
  const double largest = *std::max_element(noise.begin(), noise.end());
  double smallest = largest;
  for (const double of : noise)
  {
    smallest = of > roundOff * largest ? std::min(smallest, of) : smallest;
  }
  if (largest > factor * smallest)
  {
    result.WarnOnce(Sentence("the noise of the columns of ")
      << Word::Array("InputArray") << " goes from " << smallest << " to " << largest
      << ", and the larger ones decide where there are edges in all (if their units differ, divide "
         "each by its noise, or "
      << apart << ")");
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

} // namespace SurfaceDiffusion
