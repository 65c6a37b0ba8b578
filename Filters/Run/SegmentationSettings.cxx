// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/SegmentationSettings.h"

#include "Core/Foundation/RobustRange.h"
#include "Core/Models/Segmentation.h"
#include "Core/Statistics/NeighbourMeans.h"
#include "Core/Statistics/NoiseLevel.h"
#include "Core/Statistics/RegionMeans.h"
#include "Run/DataPreparation.h"
#include "Run/ModelInputs.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

/// Data with regions take 50 to 200 iterations and up to 10 alternations. Noise without any region
/// takes far more, and its minimum is of no use.
constexpr int LargestNumberOfIterations = 1000;
constexpr int LargestNumberOfAlternations = 20;

constexpr double LargestNumberOfRegions = 1000;

/// lambda of AutomaticFidelity times h and the contrast of the data terms: a disk of uniform data
/// is kept from a radius of 3 h on, and noise of the size of the contrast's root is not.
constexpr double AutomaticWeight = 0.6;

void CheckSeeds(const std::vector<Index>& seeds, int regions)
{
  for (const Index seed : seeds)
  {
    if (seed > regions)
    {
      throw InputError(Sentence(Word::Array("SeedArray"))
        << " has the label " << seed << "; allowed: 0 to " << Word::Setting("NumberOfRegions")
        << " " << regions);
    }
  }
}

/// The smallest distance between two means that are used.
double SmallestDistance(const Values& means)
{
  const Values used = UsedMeans(means);
  double smallest = std::numeric_limits<double>::infinity();
  for (Eigen::Index k = 0; k < used.rows(); ++k)
  {
    for (Eigen::Index l = 0; l < k; ++l)
    {
      smallest = std::min(smallest, (used.row(k) - used.row(l)).norm());
    }
  }
  return smallest;
}

/// The clusters of the values or, under strong noise, whose clusters these would be, those of averages
/// over neighbours in which the noise is small against their distances. Returns whether it is.
bool FindMeans(const ModelInputs& inputs, const PointData& data,
  const std::function<Values(const PointData&)>& cluster, Values& means)
{
  constexpr double clear = 2.5; // the distance of means in deviations of the noise
  constexpr int mostPasses = 64; // over five edges
  const Assembler& assembler = *inputs.Surface.SharedAssembler();
  const double noise = EstimateNoise(assembler, inputs.Surface.Points(), data).BetweenNeighbours *
    (inputs.Cells ? FindCellNoiseGain(inputs) : 1.0);
  PointData averages = data;
  means = cluster(averages);
  bool isStrong = false;
  double remaining = 1.0;
  for (int passes = 1; passes <= mostPasses && SmallestDistance(means) < clear * remaining * noise;
       passes += passes / 2 + 1)
  {
    isStrong = true;
    averages.Given = NeighbourMeans(assembler, data, passes, inputs.Parallel);
    means = cluster(averages);
    remaining = 0.4 / std::sqrt(passes); // see NeighbourMeans()
  }
  return isStrong;
}

/// The lambda of AutomaticFidelity, in units of the numerics. Data without contrast need none, but
/// above 0 their terms keep regions out that are not used.
double FidelityOfContrast(const ModelInputs& inputs, const Segmentation::Input& input)
{
  const double found =
    MeanContrast(inputs.Surface.Mesh(), input.Data, input.Means, inputs.Parallel);
  const double contrast = found == 0.0 && input.Means.hasNaN() ? 1.0 : found;
  const double scale = inputs.Units.CoreEdgeLength() * contrast *
    MeanFidelityFactor(inputs.Surface.Mesh(), input.Data);
  return contrast > 0.0 ? AutomaticWeight / scale : 0.0;
}

/// Outliers become the bound that they are beyond: means would be those of outliers, and of the
/// rest.
void LimitOutliers(double unit, PointData& data, RunResult& result)
{
  std::vector<double> known;
  for (Eigen::Index k = 0; k < data.Given.cols(); ++k)
  {
    known.clear();
    ValueBounds all;
    for (Eigen::Index i = 0; i < data.Given.rows(); ++i)
    {
      if (data.FidelityFactor(static_cast<Index>(i)) > 0.0)
      {
        known.push_back(data.Given(i, k));
        all.Widen({ known.back(), known.back() });
      }
    }
    const ValueBounds bounds = RobustBounds(known);
    if (bounds.Width() > 0.0 && all.Width() > OutlierFactor * bounds.Width())
    {
      data.Given.col(k) = data.Given.col(k).cwiseMax(bounds.Low).cwiseMin(bounds.High);
      result.WarnOnce(Sentence("the values reach from ")
        << all.Low * unit << " to " << all.High * unit << ", but without the largest and the "
        << "smallest 0.1 % of them only from " << bounds.Low * unit << " to " << bounds.High * unit
        << ": the others count as outliers, and as these bounds");
    }
  }
}

} // namespace

void SegmentationSettings::Visit(SettingVisitor& visitor)
{
  this->RunSettings::Visit(visitor);
  visitor.Integer(
    { "NumberOfRegions", "", "K, the number of regions, 2 or more. Regions can come out empty." },
    this->NumberOfRegions, SettingRange::Between(2.0, LargestNumberOfRegions, "2 to 1000"));
  visitor.Switch({ "AutomaticFidelity", "",
                   "Find the weight of the data from their contrast, which suits data with and "
                   "without noise: lambda = 0.6/(h D) with the contrast D of the data terms, the "
                   "mean difference between the smallest two of a point, divided by the mean "
                   "fidelity factor. FidelityWeight is ignored." },
    this->AutomaticFidelity);
  visitor.Number({ "FidelityWeight", "1/(h R^2)",
                   "lambda, the weight of the data against the length of the boundaries, 0 or "
                   "more, in 1/(length value^2) (natural units: 1/(h R^2)), and in 1/(length "
                   "value) for given data terms. The larger it is, the smaller are the regions "
                   "that are kept. The range R includes the noise: under strong noise lambda has "
                   "to be many times larger. It has no effect with AutomaticFidelity.",
                   "AutomaticFidelity=0" },
    this->FidelityWeight, SettingRange::NonNegative());
  visitor.Switch({ "AutomaticMeans", "",
                   "On: the means of the regions are found, from clusters of the values "
                   "(k-means) at first; under strong noise they are clusters of averages over "
                   "neighbours, and stay. Regions are numbered by ascending mean, unless there "
                   "are seeds. If there are fewer different values than regions, the others are "
                   "not used, and their means are NaN. Off: the means are the given ones, or the "
                   "clusters if none are given." },
    this->AutomaticMeans);
  visitor.Numbers(
    { "Means", "values",
      "The means c_1, c_2, ... of the regions with AutomaticMeans off, all components of the first "
      "region before those of the second. None: the clusters of the data." },
    this->Means,
    this->AutomaticMeans ? SettingRange::Anything()
                         : SettingRange::Between(-1e300, 1e300, "finite numbers, all of them set"));
  visitor.Number({ "StopTolerance", "",
                   "The duality gap at which the minimisation stops, between 0 and 1, relative "
                   "to the part of the energy that depends on the regions. The gap bounds the "
                   "difference between the energy and its minimum." },
    this->StopTolerance, SettingRange::OpenUnitInterval());
  VisitResultOnCells(visitor, this->ResultOnCells);
}

void SegmentationSettings::CheckTogether(const FieldSummary* fields, Problems& problems) const
{
  this->RunSettings::CheckTogether(fields, problems);
  RequireData(fields, problems);
  if (!fields || !fields->Data)
  {
    return;
  }
  const int components = fields->DataComponents;
  if (fields->DataAreTerms)
  {
    Require(components == this->NumberOfRegions,
      Sentence(Word::Array("DataTermArray")) << "'s number of components", components,
      Sentence() << this->NumberOfRegions << ", one per region of "
                 << Word::Setting("NumberOfRegions"),
      problems);
    return;
  }
  const auto needed = static_cast<std::size_t>(this->NumberOfRegions) *
    static_cast<std::size_t>(std::max(components, 1));
  Require(this->AutomaticMeans || this->Means.empty() || this->Means.size() == needed,
    Sentence("the number of ") << Word::Setting("Means"), static_cast<double>(this->Means.size()),
    Sentence() << needed << ", one per region and component of " << Word::Array("InputArray")
               << ", or any with " << Word::Setting("AutomaticMeans") << " " << Word::Switch(true),
    problems);
}

ModelTraits SegmentationSettings::DescribeModel() const
{
  ModelTraits traits;
  traits.ResultSuffix = "Segmented";
  traits.Energy = { 1.0, 0.0 };
  traits.StateHasUnitOfValues = false;
  traits.UsesFidelity = true;
  if (!this->AutomaticFidelity)
  {
    traits.SettingsInRange = { "FidelityWeight" };
  }
  traits.UsesRandomNumbers = true;
  traits.StartsFromKnownValues = true;
  traits.ResultOnCells = this->ResultOnCells;
  traits.CanBeDistributed = false;
  return traits;
}

std::unique_ptr<Model> SegmentationSettings::Make(ModelInputs& inputs, RunResult& result) const
{
  CheckSeeds(inputs.Seeds, this->NumberOfRegions);
  CheckSeeds({ inputs.LargestCellSeed }, this->NumberOfRegions);
  result.HasMissing = inputs.Data.Missing.any();
  inputs.Data.Given =
    inputs.Data.Given.unaryExpr([](double value) { return std::isfinite(value) ? value : 0.0; });
  Segmentation::Settings settings;
  settings.StopTolerance = this->StopTolerance;
  settings.MaximumNumberOfIterations = LargestNumberOfIterations;
  settings.MaximumNumberOfAlternations = LargestNumberOfAlternations;
  settings.UpdateMeans = this->AutomaticMeans && !inputs.DataAreTerms;
  Segmentation::Input input;
  input.Data = inputs.Data; // which the estimate of noise reads, too
  input.Seeds = std::move(inputs.Seeds);
  if (!inputs.DataAreTerms && (this->AutomaticMeans || this->Means.empty()))
  {
    LimitOutliers(inputs.Units.ValueUnit, input.Data, result);
    const auto cluster = [&](const PointData& data)
    {
      return FindRegionMeans(inputs.Surface.Mesh(), data, this->NumberOfRegions, input.Seeds,
        this->RandomSeed, inputs.Ids, inputs.Parallel);
    };
    // The means of values in regions under strong noise would be those of the noise that they fit.
    const bool isStrong = FindMeans(inputs, input.Data, cluster, input.Means);
    settings.UpdateMeans = settings.UpdateMeans && !isStrong;
  }
  else if (!inputs.DataAreTerms)
  {
    input.Means =
      Eigen::Map<const Values>(this->Means.data(), this->NumberOfRegions, input.Data.Given.cols());
    input.Means /= inputs.Units.ValueUnit;
  }
  const double unit = inputs.Units.ToCore(1.0, -1.0, inputs.DataAreTerms ? -1.0 : -2.0);
  settings.Fidelity =
    this->AutomaticFidelity ? FidelityOfContrast(inputs, input) : this->FidelityWeight * unit;
  result.AddNumber("EffectiveFidelityWeight", settings.Fidelity / unit);
  if (this->AutomaticFidelity && this->FidelityWeight != SegmentationSettings().FidelityWeight)
  {
    result.WarnOnce(Sentence(Word::Setting("FidelityWeight"))
      << " is " << this->FidelityWeight << " but " << Word::Setting("AutomaticFidelity")
      << " finds the weight (to use the given one, turn it off)");
  }
  return std::make_unique<Segmentation>(
    inputs.Surface.SharedAssembler(), std::move(input), settings, inputs.Parallel);
}

} // namespace SurfaceDiffusion
