// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/MumfordShahSettings.h"

#include "Core/Geometry/RidgeCurves.h"
#include "Core/Models/MumfordShah.h"
#include "Core/Statistics/EdgeScales.h"
#include "Run/DataPreparation.h"
#include "Run/ModelInputs.h"
#include "Run/Rewording.h"
#include "Run/UnlikeEdges.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// Curves and side branches shorter than this are left out, in EdgeWidth: the ends and the bumps of
/// an edge are as long.
constexpr double ShortestCurve = 4.0;

/// Edges on more of the surface are reported.
constexpr double LargestShare = 0.3;

/// The threshold below which noise of deviation 1 makes edges, with the default lengths.
constexpr double NoiseOfEdges = 3.0;

/// A part of a hole that edges enclose hangs on kappa alone. With larger tolerances its values
/// drift.
constexpr double ToleranceInHoles = 1e-3;

/// The share of the surface where v is below a half.
double ShareOfEdges(const TriangleMesh& mesh, const Vector& edges, const ParallelFor& parallel)
{
  double areas[2] = { 0.0, mesh.ControlAreas().sum() };
  areas[0] = Sum(parallel, mesh.NumberOfVertices(),
    [&](Index i) { return edges[i] > 0.5 ? mesh.ControlAreas()[i] : 0.0; });
  mesh.GetReduction().Sum(areas, 2);
  return areas[1] > 0.0 ? areas[0] / areas[1] : 0.0;
}

/// Add the ridges as curves, with the height of the edges at their points.
void AddCurves(const Polylines& ridges, const Vector& edges, std::vector<Output>& outputs)
{
  Curves curves;
  std::vector<Index> rows; // of the points of the ridges
  Values lengths(ridges.NumberOfLines(), 1);
  for (Index l = 0; l < ridges.NumberOfLines(); ++l)
  {
    const Index last = ridges.Begin[l + 1] - 1;
    const bool closed = ridges.Vertices[ridges.Begin[l]] == ridges.Vertices[last];
    const auto first = static_cast<Index>(rows.size());
    for (Index k = ridges.Begin[l]; k < last || (k == last && !closed); ++k)
    {
      curves.Corners.push_back(static_cast<Index>(rows.size()));
      rows.push_back(k);
    }
    if (closed)
    {
      curves.Corners.push_back(first);
    }
    curves.Begin.push_back(static_cast<Index>(curves.Corners.size()));
    lengths(l, 0) = ridges.Length(l);
  }
  curves.Points.resize(static_cast<Eigen::Index>(rows.size()), 3);
  Values heights(curves.Points.rows(), 1);
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    curves.Points.row(static_cast<Eigen::Index>(i)) = ridges.Points.row(rows[i]);
    heights(static_cast<Eigen::Index>(i), 0) = edges[ridges.Vertices[rows[i]]];
  }
  double sum = 0.0;
  for (Eigen::Index l = 0; l < lengths.rows(); ++l)
  {
    sum += lengths(l, 0);
  }
  outputs.push_back(Output::OfCurves("Curves", std::move(curves)));
  outputs.push_back({ "Edges", Place::PerCurvePoint, OutputType::Double, std::move(heights) });
  outputs.push_back({ "Length", Place::PerCurve, OutputType::Double, std::move(lengths) });
  outputs.push_back(Output::OfNumber("EdgeLength", sum, Combination::Sum));
}

void WarnOfUnused(const char* name, double value, double byDefault, RunResult& result)
{
  if (value != byDefault)
  {
    const Word automatic = Word::Setting("AutomaticThreshold");
    result.WarnOnce(Sentence(Word::Setting(name))
      << " is " << value << " but " << automatic << " finds it (to use the given one, turn "
      << automatic << " off)");
  }
}

} // namespace

MumfordShahSettings::MumfordShahSettings()
{
  this->FidelityWeight = 1.0;
  this->NumberOfTimeSteps = 1000;
  this->Tolerance = 0.1;
  this->InitialFill = SurfaceDiffusion::InitialFill::Harmonic; // edges would form at others
}

void MumfordShahSettings::Visit(SettingVisitor& visitor)
{
  Rewording reworded(visitor,
    { { "TimeStep",
        { "",
          "The time between two published states, above 0, in any unit: the states "
          "do not depend on it.",
          "GenerateTimeSteps=1" } },
      { "NumberOfTimeSteps",
        { "", "The largest number of steps. 0: the output is the initial state." } },
      { "Tolerance",
        { "",
          "The residual at which linear solves end, as a part of that at their start, between 0 "
          "and 1. The result hardly depends on it." } },
      { "FidelityWeight",
        { "",
          "A factor of lambda, without a unit: lambda is FidelityWeight/SmoothingLength^2. 0: "
          "the data act only where they are held fixed." } } });
  this->DataSettings::Visit(reworded);
  visitor.Switch({ "AutomaticThreshold", "",
                   "Find EdgeThreshold and SmoothingLength from the noise, the range without "
                   "outliers and the slopes of the data, for each connected component. The given "
                   "ones are ignored." },
    this->AutomaticThreshold);
  visitor.Number({ "NoiseLevel", "values",
                   "Standard deviation of the noise, of one component, in the unit of the data. "
                   "0: estimated from the data.",
                   "AutomaticThreshold=1" },
    this->NoiseLevel, SettingRange::NonNegative());
  visitor.Number({ "EdgeThreshold", "R",
                   "The jump from which on an edge costs less than smoothing, above 0, in the "
                   "unit of values that Units selects (natural units: R). Jumps below 0.9 of it "
                   "are smoothed, and jumps above 1.25 of it are kept. Noise with a standard "
                   "deviation above a third of it, over all components together, makes edges "
                   "everywhere, as do slopes above EdgeThreshold/(2 SmoothingLength). It has no "
                   "effect with AutomaticThreshold.",
                   "AutomaticThreshold=0" },
    this->EdgeThreshold, SettingRange::Positive());
  visitor.Number({ "SmoothingLength", "h",
                   "The length over which data are smoothed between edges, above 0, in the unit "
                   "of lengths that Units selects (natural units: h). lambda is FidelityWeight "
                   "over its square. It has no effect with AutomaticThreshold.",
                   "AutomaticThreshold=0" },
    this->SmoothingLength, SettingRange::Positive());
  visitor.Number({ "EdgeWidth", "h",
                   "eps, the width of the transition of v beside an edge, above 0, in the unit "
                   "of lengths that Units selects (natural units: h). At least the mean edge "
                   "length h." },
    this->EdgeWidth, SettingRange::Positive());
  visitor.Number({ "StopTolerance", "",
                   "The relative decrease of the energy in one step at which the run ends, "
                   "between 0 and 1." },
    this->StopTolerance, SettingRange::OpenUnitInterval());
  visitor.Switch(
    { "EdgeCurves", "", "Whether the edges are extracted as curves.", SettingScope::Output },
    this->EdgeCurves);
}

ModelTraits MumfordShahSettings::DescribeModel() const
{
  ModelTraits traits = this->DescribeSteps();
  traits.MayEndEarly = true;
  traits.WeightlessAreMissing = true; // steps are alternations of a minimisation
  traits.ResultSuffix = "MumfordShah";
  traits.Energy = { 0.0, 2.0 };
  traits.UsesFidelity = this->FidelityWeight > 0.0;
  traits.EstimatesNoise = true; // also for a warning
  if (!this->AutomaticThreshold)
  {
    traits.SettingsInRange = { "EdgeThreshold" };
  }
  traits.CanBeDistributed = !this->EdgeCurves && !this->AutomaticThreshold;
  DescribeData(*this, traits);
  return traits;
}

/// beta of a jump and a length, with the excess of the discrete model.
double MumfordShahSettings::EdgeCost(const UnitSystem& units, double jump, double length) const
{
  const double width = units.ToCore(this->EdgeWidth, 1.0, 0.0);
  return jump * jump / (4.0 * length) / (1.0 + units.CoreEdgeLength() / (4.0 * width));
}

double MumfordShahSettings::UseGivenScales(
  const ModelInputs& inputs, MumfordShah::Settings& settings, RunResult& result) const
{
  const double length = inputs.Units.ToCore(this->SmoothingLength, 1.0, 0.0);
  settings.Fidelity = this->FidelityWeight / (length * length);
  settings.EdgeCost =
    this->EdgeCost(inputs.Units, inputs.Units.ToCore(this->EdgeThreshold, 0.0, 1.0), length);
  result.AddNumber("EffectiveEdgeThreshold", this->EdgeThreshold);
  result.AddNumber("EffectiveSmoothingLength", this->SmoothingLength);
  return length;
}

double MumfordShahSettings::UseFoundScales(
  ModelInputs& inputs, MumfordShah::Settings& settings, RunResult& result) const
{
  const TriangleMesh& mesh = inputs.Surface.Mesh();
  const std::vector<Index>& begin = mesh.ComponentsBegin();
  const std::vector<EdgeScales> scales =
    FindEdgeScales(*inputs.Surface.SharedAssembler(), inputs.Surface.Points(), inputs.Data,
      { settings.EdgeWidth, NoiseAtVertices(inputs, this->NoiseLevel),
        inputs.Cells && this->NoiseLevel == 0.0 ? FindCellNoiseGain(inputs) : 0.0 });
  if (scales.empty())
  {
    return this->UseGivenScales(inputs, settings, result);
  }
  inputs.Data.FidelityFactors /= MeanFidelityFactor(mesh, inputs.Data);
  std::size_t largest = 0;
  double longest = 0.0;
  for (std::size_t c = 0; c < scales.size(); ++c)
  {
    largest = begin[c + 1] - begin[c] > begin[largest + 1] - begin[largest] ? c : largest;
    longest = std::max(longest, scales[c].SmoothingLength);
  }
  const auto cost = [&](const EdgeScales& of)
  { return this->EdgeCost(inputs.Units, of.Threshold, of.SmoothingLength); };
  const EdgeScales& reference = scales[largest];
  const double length = reference.SmoothingLength;
  settings.Fidelity = this->FidelityWeight / (length * length);
  settings.EdgeCost = cost(reference);
  settings.NumberOfStages = 1;
  if (scales.size() > 1)
  {
    Vector& factors = inputs.Data.FidelityFactors;
    if (factors.size() == 0)
    {
      factors = Vector::Ones(mesh.NumberOfVertices());
    }
    for (std::size_t c = 0; c < scales.size(); ++c)
    {
      settings.ValueScales.push_back(std::sqrt(settings.EdgeCost / cost(scales[c])));
      factors.segment(begin[c], begin[c + 1] - begin[c]) *=
        std::pow(reference.SmoothingLength / scales[c].SmoothingLength, 2);
    }
  }
  result.AddNumber(
    "EffectiveEdgeThreshold", reference.Threshold / inputs.Units.ToCore(1.0, 0.0, 1.0));
  result.AddNumber("EffectiveSmoothingLength", length / inputs.Units.ToCore(1.0, 1.0, 0.0));
  result.AddNumber("EstimatedNoiseLevel",
    this->NoiseLevel > 0.0 ? this->NoiseLevel
                           : inputs.Units.FromCore(reference.Noise, 0.0, 1.0) / NoiseGain(inputs));
  const MumfordShahSettings defaults;
  WarnOfUnused("EdgeThreshold", this->EdgeThreshold, defaults.EdgeThreshold, result);
  WarnOfUnused("SmoothingLength", this->SmoothingLength, defaults.SmoothingLength, result);
  return longest;
}

std::unique_ptr<Model> MumfordShahSettings::Make(ModelInputs& inputs, RunResult& result) const
{
  PrepareData(*this, inputs, result);
  result.AddNumber("EffectiveFidelityWeight", this->FidelityWeight);
  WarnOfUnlikeColumns(inputs, "process each alone", result);
  const double h = inputs.Units.CoreEdgeLength();
  if (inputs.Units.Natural)
  {
    WarnOfUnlikeEdges(inputs.Surface.Mesh(), result);
  }
  MumfordShah::Settings settings;
  settings.EdgeWidth = inputs.Units.ToCore(this->EdgeWidth, 1.0, 0.0);
  const double length = this->AutomaticThreshold ? this->UseFoundScales(inputs, settings, result)
                                                 : this->UseGivenScales(inputs, settings, result);
  settings.StopTolerance = this->StopTolerance;
  if (settings.EdgeWidth < h * (1.0 - 1e-9))
  {
    result.WarnOnce(Sentence(Word::Setting("EdgeWidth"))
      << " is below the mean edge length, " << inputs.Units.MeanEdgeLength
      << ": the triangles do not resolve the edges, which then cost more");
  }

  SolverTask task;
  task.NumberOfVertices = inputs.Surface.Mesh().NumberOfVertices();
  task.AllowMultigrid = false;
  task.NumberOfColumns = static_cast<int>(inputs.Data.Start.cols());
  task.DiffusionNumber = this->LargestDiffusivity() * length * length / (h * h);
  const auto smoothing = inputs.Solvers.Find(SolverPurpose::Step, task);
  const bool hasHoles = inputs.Surface.Mesh().GetReduction().Any(inputs.Data.Missing.any());
  if (hasHoles || !(this->FidelityWeight > 0.0))
  {
    IterationLimits limits = smoothing->GetLimits();
    limits.Tolerance = std::min(limits.Tolerance, ToleranceInHoles);
    smoothing->SetLimits(limits);
  }
  task.NumberOfColumns = 1;
  task.DiffusionNumber = 4.0 * settings.EdgeWidth * settings.EdgeWidth / (h * h);
  const auto edges = inputs.Solvers.Find(SolverPurpose::Edges, task);
  return std::make_unique<MumfordShah>(inputs.Surface.SharedAssembler(), MakeWeights(*this, inputs),
    std::move(inputs.Data), settings, smoothing, edges, inputs.Parallel);
}

/// Says why so much of the surface is an edge.
void MumfordShahSettings::WarnOfManyEdges(
  const RunState& state, double share, RunResult& result) const
{
  bool noise = false, slopes = false;
  if (!this->AutomaticThreshold && state.Surface.Mesh().GetReduction().IsSerial())
  {
    const double unit = state.Surface.Mesh().LengthUnit();
    const double jump = state.Units.ToCore(this->EdgeThreshold, 0.0, 1.0);
    const double length = state.Units.ToCore(this->SmoothingLength, 1.0, 0.0) * unit;
    const double channels = std::sqrt(static_cast<double>(state.Path.State().cols()));
    for (const EdgeScales& found : FindEdgeScales(*state.Surface.SharedAssembler(),
           state.Surface.Points(), *state.Path.CurrentModel().GivenData(), { unit, 0.0, 0.0 }))
    {
      noise = noise || NoiseOfEdges * channels * found.Noise > jump;
      slopes = slopes || 2.0 * length * found.Slope > jump;
    }
  }
  const Word automatic = Word::Setting("AutomaticThreshold");
  const Word threshold = Word::Setting("EdgeThreshold");
  const Word length = Word::Setting("SmoothingLength");
  const Word width = Word::Setting("EdgeWidth");
  Sentence text;
  text << std::lround(100.0 * share) << " % of the surface is an edge: ";
  if (noise)
  {
    text << "the standard deviation of the noise is above a third of " << threshold
         << " (to keep noise from making edges, turn " << automatic << " on or raise " << threshold
         << ")";
  }
  else if (slopes)
  {
    text << "slopes above " << threshold << "/(2 " << length
         << ") break into edges (to keep them smooth, turn " << automatic << " on, raise "
         << threshold << " or lower " << length << ")";
  }
  else
  {
    text << "edges are 3 " << width
         << " wide, which is much of their distances (to separate them, lower " << width
         << " or refine the surface; for fewer edges, raise " << threshold;
    if (this->AutomaticThreshold)
    {
      text << ", with " << automatic << " off";
    }
    text << ")";
  }
  result.WarnOnce(text);
}

std::vector<Output> MumfordShahSettings::Finish(const RunState& state, RunResult& result) const
{
  const Model& model = state.Path.CurrentModel();
  const Vector edges = model.Results().at("Edges");
  const double share = ShareOfEdges(state.Surface.Mesh(), edges, state.Parallel);
  if (model.Finished() && share > LargestShare)
  {
    this->WarnOfManyEdges(state, share, result);
  }
  std::vector<Output> outputs{ { "Edges", Place::PerVertex, OutputType::Real, edges } };
  outputs.push_back(Output::OfState(this->DescribeModel().ResultSuffix));
  Polylines ridges;
  if (this->EdgeCurves)
  {
    const double width =
      state.Units.ToCore(this->EdgeWidth, 1.0, 0.0) * state.Surface.Mesh().LengthUnit();
    ridges = FindRidges(state.Surface.InputMesh(), state.Surface.Points(), edges,
      ShortestCurve * width, state.Parallel);
  }
  AddCurves(ridges, edges, outputs);
  return outputs;
}

} // namespace SurfaceDiffusion
