// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/SegmentationSettings.h"

#include "Core/Models/RegionMeans.h"
#include "Core/Models/Segmentation.h"
#include "Run/ModelInputs.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

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
      throw std::runtime_error("SeedArray has the label " + std::to_string(seed) +
        "; allowed: 0 to NumberOfRegions " + std::to_string(regions));
    }
  }
}

/// u at the input's points; 0 at points of no triangle.
Values StateOfPoints(const Surface& surface, const Values& state)
{
  Values u = Values::Zero(surface.Points().rows(), state.cols());
  for (Index i = 0; i < static_cast<Index>(u.rows()); ++i)
  {
    const Index v = surface.VertexOf(i);
    if (v >= 0)
    {
      u.row(i) = state.row(v);
    }
  }
  return u;
}

/// The areas of control cells over those of the drawn surface, per point.
Vector AreaFactorsOfPoints(const Surface& surface)
{
  const TriangleMesh& mesh = surface.InputMesh();
  Vector factors = Vector::Ones(surface.Points().rows());
  for (Index i = 0; i < static_cast<Index>(factors.size()); ++i)
  {
    const Index v = surface.VertexOf(i);
    if (v >= 0)
    {
      factors[i] = mesh.ControlAreas()[v] / mesh.ThirdOfTriangles(v);
    }
  }
  return factors;
}

std::shared_ptr<RegionResults> MeasureRegions(
  const Surface& surface, const Segmentation& model, const ParallelFor& parallel)
{
  auto regions = std::make_shared<RegionResults>();
  const auto count = static_cast<Index>(model.State().cols());
  regions->Labels = model.Labels();
  const Values u = StateOfPoints(surface, model.State());
  const Triangles triangles = surface.MakeTriangles();
  regions->Areas =
    RegionAreas(surface.Points(), triangles, u, AreaFactorsOfPoints(surface), parallel);
  regions->Boundaries = FindRegionBoundaries(surface.Points(), triangles, u);
  regions->BoundaryLengths = Vector::Zero(count);
  for (const RegionBoundary& curve : regions->Boundaries.Curves)
  {
    for (const Index region : curve.Regions)
    {
      regions->BoundaryLengths[region - 1] += curve.Length;
    }
  }
  regions->Components =
    CountRegionComponents(surface.InputMesh().TriangleVertices(), regions->Labels, count);
  return regions;
}

/// The lambda of AutomaticFidelity, in units of the numerics. Data without contrast need none.
double FidelityOfContrast(const ModelInputs& inputs, const Segmentation::Input& input)
{
  const double contrast =
    MeanContrast(inputs.Surface.Mesh(), input.Data, input.Means, inputs.Parallel);
  return contrast > 0.0 ? AutomaticWeight / (inputs.Units.CoreEdgeLength() * contrast) : 0.0;
}

void WarnOfEmptyRegions(const RegionResults& regions, RunResult& result)
{
  std::string empty;
  for (std::size_t k = 0; k < regions.Components.size(); ++k)
  {
    if (regions.Components[k] == 0)
    {
      empty += (empty.empty() ? "" : ", ") + std::to_string(k + 1);
    }
  }
  if (!empty.empty())
  {
    result.WarnOnce("no point is in the regions " + empty +
      " (to keep smaller regions, turn off AutomaticFidelity and raise FidelityWeight)");
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
                   "mean difference between the smallest two of a point. FidelityWeight is "
                   "ignored." },
    this->AutomaticFidelity);
  visitor.Number({ "FidelityWeight", "1/(h R^2)",
                   "lambda, the weight of the data against the length of the boundaries, 0 or "
                   "more, in 1/(length value^2) (natural units: 1/(h R^2)), and in 1/(length "
                   "value) for given data terms. The larger it is, the smaller are the regions "
                   "that are kept. The range R includes the noise: under strong noise lambda has "
                   "to be many times larger. It has no effect with AutomaticFidelity." },
    this->FidelityWeight, SettingRange::NonNegative());
  visitor.Switch({ "AutomaticMeans", "",
                   "On: the means of the regions are found, from clusters of the values "
                   "(k-means++) at first. Regions are numbered by ascending mean, unless there "
                   "are seeds. Off: the means are the given ones, or the clusters if none are "
                   "given." },
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
  if (!fields)
  {
    return;
  }
  const int components = fields->DataComponents;
  if (fields->DataAreTerms)
  {
    Require(components == this->NumberOfRegions, "DataTermArray's number of components", components,
      (std::to_string(this->NumberOfRegions) + ", one per region of NumberOfRegions").c_str(),
      problems);
    return;
  }
  const auto needed = static_cast<std::size_t>(this->NumberOfRegions) *
    static_cast<std::size_t>(std::max(components, 1));
  Require(this->AutomaticMeans || this->Means.empty() || this->Means.size() == needed,
    "the number of Means", static_cast<double>(this->Means.size()),
    (std::to_string(needed) +
      ", one per region and component of InputArray, or any with AutomaticMeans on")
      .c_str(),
    problems);
}

ModelTraits SegmentationSettings::DescribeModel() const
{
  ModelTraits traits;
  traits.NumberOfSteps = 1;
  traits.TimeStep = this->TimeStep;
  traits.AbsoluteTime = true; // no model time
  traits.Energy = { 1.0, 0.0 };
  traits.StateHasUnitOfValues = false;
  traits.UsesFidelity = true;
  traits.SettingsInRange = this->AutomaticFidelity ? nullptr : "FidelityWeight";
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
  input.Data = std::move(inputs.Data);
  input.Seeds = std::move(inputs.Seeds);
  if (!inputs.DataAreTerms && (this->AutomaticMeans || this->Means.empty()))
  {
    input.Means = FindRegionMeans(inputs.Surface.Mesh(), input.Data, this->NumberOfRegions,
      input.Seeds, this->RandomSeed, inputs.Ids, inputs.Parallel);
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
  result.EffectiveFidelityWeight = settings.Fidelity / unit;
  if (this->AutomaticFidelity && this->FidelityWeight != SegmentationSettings().FidelityWeight)
  {
    std::ostringstream text;
    text << "FidelityWeight is " << this->FidelityWeight
         << " but AutomaticFidelity finds the weight (to use the given one, turn it off)";
    result.WarnOnce(text.str());
  }
  return std::make_unique<Segmentation>(
    inputs.Surface.SharedAssembler(), std::move(input), settings, inputs.Parallel);
}

void SegmentationSettings::Finish(const RunState& state, RunResult& result) const
{
  const auto& model = dynamic_cast<const Segmentation&>(state.Path.CurrentModel());
  const auto regions = MeasureRegions(state.Surface, model, state.Parallel);
  if (state.Path.Step() > 0)
  {
    regions->Gap = model.Gap();
    regions->LabelGap = model.LabelGap();
    regions->NumberOfAlternations = model.NumberOfAlternations();
  }
  regions->Means = model.Means() * state.Units.ValueUnit;
  regions->DataMeans = model.DataMeans() * state.Units.ValueUnit;
  if (state.Path.Step() > 0)
  {
    WarnOfEmptyRegions(*regions, result);
  }
  if (regions->Gap > this->StopTolerance && !result.HasUnfinishedMinimum)
  {
    result.HasUnfinishedMinimum = true; // reported once, not at every requested time
    std::ostringstream text;
    text << "the minimisation ended at its largest number of iterations with a relative duality "
         << "gap of " << regions->Gap << ", above StopTolerance";
    result.Warnings.push_back(text.str());
  }
  result.Regions = regions;
}

} // namespace SurfaceDiffusion
