// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/Run.h"

#include "Run/Angles.h"
#include "Run/BlockSentences.h"
#include "Run/Collective.h"
#include "Run/LinearLight.h"
#include "Run/MeanPartArea.h"
#include "Run/Sentinels.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace SurfaceDiffusion
{

namespace
{

/// Squares of values within these bounds neither overflow nor vanish.
constexpr double LargestMagnitude = 1e100;
constexpr double SmallestMagnitude = 1e-100;

/// The smallest and the largest known value of data with a period. values: those of the data.
ValueBounds BoundsOfAngles(
  const Values& values, const Fields& fields, bool inpaint, const Reduction& processes)
{
  ValueBounds bounds;
  for (Eigen::Index i = 0; i < values.rows(); ++i)
  {
    const bool isKnown = !IsSet(fields.Missing, i) && !fields.IsLeftOut(i, inpaint);
    if (isKnown && values.row(i).allFinite())
    {
      bounds.Widen({ values.row(i).minCoeff(), values.row(i).maxCoeff() });
    }
  }
  return OfAllProcesses(bounds, processes);
}

} // namespace

void Run::Update(const std::vector<BlockInput>& inputs, std::shared_ptr<RunSettings> settings,
  const Reduction& processes, const ProgressMonitor& progress)
{
  this->Settings = std::move(settings);
  this->UpdateSurfaces(inputs, processes, progress.Part(0.0, 0.6));
  progress.Report(0.6);

  const SettingsSnapshot snapshot(*this->Settings, SettingScope::Model);
  const ModelTraits traits = this->Settings->DescribeModel();
  const std::size_t count = this->Blocks.size();
  std::vector<std::unique_ptr<Fields>> fields(count);
  for (std::size_t b = 0; b < count; ++b)
  {
    Block& block = *this->Blocks[b];
    if (processes.Any(!this->IsModelCurrent(block, inputs[b], snapshot, traits)))
    {
      block.Path.reset();
      NameBlockInErrors(block.Name, *this->Settings,
        [&] { this->ReadFields(inputs[b], processes, block, fields[b], progress.Part(0.6, 0.6)); });
    }
  }
  this->RequireKnownValue(fields, processes);
  this->MeasureUnits(processes);
  const bool tangent = this->AreTangent();
  for (std::size_t b = 0; b < count; ++b)
  {
    Block& block = *this->Blocks[b];
    UnitSystem units = this->CommonUnits;
    units.LengthUnit = block.Surface->Mesh().LengthUnit();
    if (processes.Any(!block.Path || !(units == block.Units) || tangent != block.AreTangent))
    {
      block.Path.reset();
      block.Units = units;
      block.AreTangent = tangent;
      const double share = static_cast<double>(count);
      NameBlockInErrors(block.Name, *this->Settings,
        [&]
        {
          if (!fields[b])
          {
            this->ReadFields(inputs[b], processes, block, fields[b], progress.Part(0.6, 0.6));
          }
          this->MakeModel(block, *fields[b], processes,
            progress.Part(0.6 + 0.4 * b / share, 0.6 + 0.4 * (b + 1) / share));
        });
      block.FieldsVersion = inputs[b].FieldsVersion;
      block.ModelSettings = snapshot;
      block.NumberOfBlocks = count;
      block.TimeStep = traits.TimeStep;
      block.NumberOfSteps = traits.NumberOfSteps;
    }
    block.Path->Reserve(traits.NumberOfSteps);
    fields[b].reset();
  }
  this->CheckHold(processes);
}

/// Whether the states computed so far are also those of a run with these inputs and settings, whose
/// number of steps may be another one.
bool Run::IsModelCurrent(const Block& block, const BlockInput& input,
  const SettingsSnapshot& settings, const ModelTraits& traits) const
{
  return block.Path && block.FieldsVersion == input.FieldsVersion &&
    block.ModelSettings == settings && (block.Path->KeepsHistory() || !this->KeepsHistory) &&
    block.NumberOfBlocks == this->Blocks.size() && block.TimeStep == traits.TimeStep &&
    (!traits.DependsOnNumberOfSteps || block.NumberOfSteps == traits.NumberOfSteps) &&
    (block.HoldsDetail || !block.Cells || !traits.NeedsCellDetail()) &&
    block.Solvers.ServesRunOf(traits.NumberOfSteps);
}

void Run::ReadFields(const BlockInput& input, const Reduction& processes, Block& block,
  std::unique_ptr<Fields>& fields, const ProgressMonitor& progress)
{
  RunCollectively(processes, [&] { fields = std::make_unique<Fields>(input.ReadFields()); });
  const ModelTraits traits = this->Settings->DescribeModel();
  ReplaceMissingValues(traits.MissingValues, *fields);
  if (fields->Samples)
  {
    ProjectSamples(input.ReadSurface(), traits.MaximumDistance, *fields);
  }
  block.HasLinearLight = fields->DataAreBytes && traits.UsesLinearLight;
  block.Period = traits.Period;
  const Values angles = traits.Period > 0.0 ? fields->Data.Values : Values();
  block.Encode(fields->Data.Values, this->Parallel);
  const std::vector<char> mask = fields->Mask.Values; // as it was given
  fields->Data.OnCells =
    processes.Any(fields->Data.OnCells); // that of a process without points, too
  MoveMarksToData(
    block.WholeSurface ? *block.WholeSurface : *block.Surface, *fields, processes, this->Parallel);
  if (traits.WeightlessAreMissing && traits.UsesFidelity)
  {
    MarkWeightless(block.WholeSurface ? *block.WholeSurface : *block.Surface, *fields);
  }
  this->LeaveOutUndetermined(input, *fields, processes, block, progress);
  const bool inpaint = this->Settings->MaskMode == MaskMode::Inpaint;
  block.Angles = BoundsOfAngles(angles, *fields, inpaint, processes);
  block.Statistics = ValueStatistics();
  block.Statistics.Add(*block.Surface, *fields, inpaint, processes);
  block.HasData = processes.Any(fields->Data.Values.cols() > 0);
  block.Tangents = traits.Vectors == VectorType::Automatic
    ? MeasureTangents(*block.Surface, *fields, processes, this->Parallel)
    : TangentShare();
  block.HasMask = !mask.empty();
  block.HasMasked = std::any_of(mask.begin(), mask.end(), [](char masked) { return masked != 0; });
  block.MaskVersion = Fingerprint();
  block.MaskVersion.AddBytes(mask.data(), mask.size(), this->Parallel);
}

void Run::Block::Encode(Values& values, const ParallelFor& parallel) const
{
  if (this->HasLinearLight)
  {
    DecodeColors(values, parallel);
  }
  if (this->Period > 0.0)
  {
    EncodeAngles(values, this->Period, parallel);
  }
}

void Run::Block::Decode(Values& values, const ParallelFor& parallel) const
{
  if (this->HasLinearLight)
  {
    EncodeColors(values, parallel);
  }
  if (this->Period > 0.0)
  {
    values = DecodeAngles(values, this->Period, this->BeginOfAngles, parallel);
  }
}

Values Run::Block::DecodedState(const ParallelFor& parallel) const
{
  Values values = this->Path->State() * this->Units.ValueUnit;
  this->Decode(values, parallel);
  return values;
}

Values Run::Block::CellResult(Values given, bool keepDetail, const ParallelFor& parallel) const
{
  this->Encode(given, parallel);
  given = MakeCellResult(*this->Cells, this->Path->State(), given, keepDetail);
  if (this->IsInCellPlanes)
  {
    ProjectIntoCells(*this->Surface, this->Cells->Transfer, this->Cells->Model.StateIsUnitVectors,
      given, parallel);
  }
  this->Decode(given, parallel);
  return given;
}

/// h and R of all surfaces together.
void Run::MeasureUnits(const Reduction& processes)
{
  double length = 0.0;
  double edges = 0.0;
  std::vector<const TriangleMesh*> drawn;
  this->LongEdges = 0.0;
  ValueStatistics statistics;
  this->Tangents = TangentShare();
  ValueBounds angles;
  for (const auto& block : this->Blocks)
  {
    const TriangleMesh& mesh = block->Surface->Mesh();
    if (processes.Any(!block->Edges))
    {
      block->Edges = block->Decomposition
        ? MeasureEdgeLengths(block->Surface->InputMesh(), processes)
        : EdgeLengths{ mesh.TotalEdgeLength(), static_cast<double>(mesh.NumberOfEdges()),
            CountLongEdges(block->Surface->InputMesh(), this->Parallel) };
    }
    edges += block->Edges->Number;
    length += block->Edges->Sum * mesh.LengthUnit();
    drawn.push_back(&block->Surface->InputMesh());
    this->LongEdges += block->Edges->LeftOut;
    statistics.Merge(block->Statistics);
    this->Tangents.Merge(block->Tangents);
    angles.Widen(block->Angles);
  }

  const ModelTraits traits = this->Settings->DescribeModel();
  for (const auto& block : this->Blocks)
  {
    block->BeginOfAngles = BeginOfAngles(angles, traits.Period);
  }
  UnitSystem units;
  units.Natural = !this->Settings->IsAbsolute();
  units.MeanEdgeLength = edges > 0.0 ? length / edges : 1.0;
  units.Area = MeanPartArea(drawn);
  units.ValueRange = traits.HasValueRange ? statistics.Range() : 1.0;
  if (!std::isfinite(units.ValueRange) || !std::isfinite(units.MeanEdgeLength))
  {
    throw std::runtime_error(
      "the range of the coordinates or of the values is larger than a double can hold");
  }
  // A power of two changes no bit of a result.
  const double magnitude = traits.HasValueRange ? statistics.Magnitude() : 0.0;
  if (magnitude > 0.0 && (magnitude > LargestMagnitude || magnitude < SmallestMagnitude))
  {
    units.ValueUnit = std::exp2(std::ilogb(magnitude));
  }
  this->CommonUnits = units;
  this->WholeValueRange = statistics.WholeRange();
  this->RobustValueRange = statistics.RobustRange();
  this->UnitOfTime = traits.AbsoluteTime ? 1.0
                                         : std::pow(units.MeanEdgeLength, traits.Time.Length) *
      std::pow(units.ValueRange, traits.Time.Value) * traits.TimeFactor;
}

/// Whether the data are taken as tangent vectors.
bool Run::AreTangent() const
{
  const VectorType type = this->Settings->DescribeModel().Vectors;
  const bool isDecomposed = std::any_of(this->Blocks.begin(), this->Blocks.end(),
    [](const auto& block) { return block->Decomposition != nullptr; });
  return type == VectorType::Tangent ||
    (type == VectorType::Automatic && this->Tangents.AreTangent() &&
      !this->Settings->IntrinsicDelaunay && !isDecomposed);
}

void Run::MakeModel(
  Block& block, const Fields& fields, const Reduction& processes, const ProgressMonitor& progress)
{
  TangentVectors directions;
  RunCollectively(
    processes, [&] { directions = MakeDirections(*block.Surface, fields, this->Parallel); });
  block.Result = block.Finished = RunResult();
  block.FinishedStep = -1;
  const ModelTraits traits = this->Settings->DescribeModel();
  block.Solvers.Configure(traits, this->Parallel);
  PointData data = this->MakeData(block, fields, processes);
  if (traits.EstimatesNoise && block.HasData)
  {
    data.Measured = FindMeasured(*block.Surface, fields);
  }
  ModelInputs inputs{ *block.Surface, block.Units, std::move(data), std::move(directions),
    fields.Rates,
    traits.UsesRandomNumbers ? MakeVertexIds(*block.Surface, fields, block.Units.MeanEdgeLength)
                             : std::vector<std::int64_t>(),
    this->Parallel, progress.Part(0.2, 1.0), block.Solvers, processes,
    std::max(fields.AllColumns, fields.Data.Values.cols()),
    fields.FirstColumn + fields.Data.Values.cols() >= fields.AllColumns, fields.DataAreTerms,
    MakeSeeds(*block.Surface, fields), block.Cells ? &block.Cells->Transfer : nullptr };
  if (fields.Seeds.OnCells && !fields.Seeds.Values.empty())
  {
    inputs.LargestCellSeed =
      *std::max_element(fields.Seeds.Values.begin(), fields.Seeds.Values.end());
  }
  inputs.GivenCells = fields.GivenCells;
  inputs.AreTangent = block.AreTangent;
  block.IsInCellPlanes = block.AreTangent && traits.DropsNormalPart;
  if (traits.Vectors == VectorType::Automatic)
  {
    WarnOfVectors(fields.DataName, this->Tangents, block.AreTangent, block.Result);
  }
  if (traits.UsesKnownValues)
  {
    inputs.Known = FindKnownValues(*block.Surface, fields,
      this->Settings->MaskMode == MaskMode::Inpaint, block.Units.ValueUnit, traits.MaximumDistance);
  }
  progress.Report(0.2);
  const Sentence aboutData = traits.UsesKnownValues
    ? Sentence("if it stands for no value, give it as ") << Word::Setting("MissingValue")
    : Sentence();
  for (const Sentence& warning : AskForSentinels(*block.Surface, fields, processes, aboutData))
  {
    block.Result.WarnOnce(warning);
  }
  std::unique_ptr<Model> model = this->Settings->Make(inputs, block.Result);
  block.HoldsDetail = traits.NeedsCellDetail();
  if (block.Cells)
  {
    block.Cells->Start = model->State();
    if (block.HoldsDetail)
    {
      ScaleFactors(block.Result.FidelityFactors, *block.Cells);
      model = AddCellDetail(std::move(model), *block.Surface, fields, *block.Cells,
        block.Units.CoreValueRange(), block.Solvers, this->Parallel);
    }
    block.Result.HasMissing = block.Result.HasMissing || block.Cells->HasUnknown;
  }
  block.Result.HasMissing = block.Result.HasMissing || block.Undetermined.NumberOfComponents > 0.0;
  const std::size_t limit = this->CheckpointMemory(*model, processes);
  auto path = std::make_unique<Trajectory>(
    block.Surface->SharedMesh(), std::move(model), limit, this->Parallel, this->KeepsHistory);
  progress.Report(1.0);
  block.Path = std::move(path); // last: an aborted run must not look like a finished one
}

/// The data of the vertices. A vertex on an interface takes the data of its owner, or the mean of
/// the cells of all processes.
PointData Run::MakeData(Block& block, const Fields& fields, const Reduction& processes) const
{
  PointData data;
  block.Cells.reset();
  if (!block.HasData)
  {
    return data;
  }
  const bool inpaint = this->Settings->MaskMode == MaskMode::Inpaint;
  if (fields.Data.OnCells)
  {
    block.Cells = std::make_unique<CellState>(
      CellState{ MakeCellTransfer(*block.Surface, fields, this->Parallel),
        this->Settings->DescribeModel(), inpaint, block.Units.ValueUnit });
    block.Cells->Seeds = fields.Seeds.OnCells ? fields.Seeds.Values : std::vector<Index>();
    block.Cells->Undetermined = block.Undetermined.Cells;
    return MakePointDataOfCells(*block.Surface, fields, *block.Cells, processes);
  }
  RunCollectively(processes,
    [&]
    {
      if (fields.Data.Values.cols() > 0)
      {
        data = MakePointData(*block.Surface, fields, inpaint, block.Units.ValueUnit);
      }
    });
  const Reduction& reduction = block.Surface->Mesh().GetReduction();
  if (!reduction.IsSerial())
  {
    double components = static_cast<double>(data.Given.cols());
    reduction.Max(&components, 1);
    const auto columns = static_cast<Eigen::Index>(components);
    const Eigen::Index n = block.Surface->Mesh().NumberOfVertices();
    if (processes.Any(n > 0 && data.Given.cols() != columns))
    {
      throw std::runtime_error("the data have another number of components in another process");
    }
    const bool hasFactors = processes.Any(data.FidelityFactors.size() > 0);
    Values all = Values::Ones(n, columns + 3);
    if (n > 0)
    {
      all.leftCols(columns + 2) << data.Given, data.Missing.cast<double>(),
        data.Fixed.cast<double>();
    }
    if (data.FidelityFactors.size() > 0)
    {
      all.col(columns + 2) = data.FidelityFactors;
    }
    reduction.UpdateFromOwners(all);
    data.Given = all.leftCols(columns);
    data.Missing = all.col(columns).array() != 0.0;
    data.Fixed = all.col(columns + 1).array() != 0.0;
    if (hasFactors)
    {
      data.FidelityFactors = all.col(columns + 2);
    }
  }
  return data;
}

/// The memory for the checkpoints of one surface. All processes keep the same steps.
std::size_t Run::CheckpointMemory(const Model& model, const Reduction& processes) const
{
  const std::size_t all = this->Settings->DescribeModel().CheckpointMemory;
  const std::size_t limit = all / this->Blocks.size();
  if (all == 0 || processes.IsSerial())
  {
    return limit;
  }
  const std::size_t mine = std::max<std::size_t>(model.CheckpointSize(), 1) * sizeof(double);
  const std::vector<double> sizes = processes.Gather({ static_cast<double>(mine) });
  const auto largest = static_cast<std::size_t>(*std::max_element(sizes.begin(), sizes.end()));
  return std::max<std::size_t>(limit / largest, 1) * mine;
}

void Run::CheckHold(const Reduction& processes) const
{
  const bool missing = std::any_of(this->Blocks.begin(), this->Blocks.end(),
    [](const auto& block) { return block->Result.HasMissing; });
  if (this->Settings->DescribeModel().HoldsKnownValues && !processes.Any(missing))
  {
    throw InputError(Sentence(Word::Setting("HoldKnownValues"))
      << " is " << Word::Switch(true)
      << " but nothing is missing, so nothing would change; allowed: " << Word::Switch(true)
      << " with a mask in mode " << Word::Choice("MaskMode", MaskMode::Inpaint, "Inpaint")
      << " or with NaN");
  }
}

Index Run::NumberOfStepsTo(int step) const
{
  Index largest = 0;
  for (const auto& block : this->Blocks)
  {
    largest = std::max(largest, block->Path->NumberOfStepsTo(step));
  }
  return largest;
}

void Run::Seek(int step, const ProgressMonitor& progress)
{
  double all = 0.0;
  for (const auto& block : this->Blocks)
  {
    all += block->Surface->Mesh().NumberOfTriangles();
  }
  double done = 0.0;
  for (const auto& block : this->Blocks)
  {
    const double size = block->Surface->Mesh().NumberOfTriangles();
    const ProgressMonitor part =
      all > 0.0 ? progress.Part(done / all, (done + size) / all) : progress;
    done += size;
    const Index before = block->Path->NumberOfAdvances();
    NameBlockInErrors(block->Name, *this->Settings, [&] { block->Path->Seek(step, part); });
    this->StepsComputed += block->Path->NumberOfAdvances() - before;
  }
  const SettingsSnapshot outputSettings(*this->Settings, SettingScope::Output);
  for (const auto& block : this->Blocks)
  {
    const int reached = block->Path->Step();
    if (block->FinishedStep != reached || block->FinishSettings != outputSettings)
    {
      block->FinishedStep = -1;
      block->Finished = RunResult();
      const bool onCells = this->Settings->DescribeModel().ResultOnCells;
      block->Outputs = this->Settings->Finish(
        { *block->Surface, block->Units, *block->Path, onCells ? block->Cells.get() : nullptr,
          this->Parallel, progress.Part(1.0, 1.0) },
        block->Finished);
      const std::vector<Output>& numbers = block->Result.Numbers;
      block->Outputs.insert(block->Outputs.end(), numbers.begin(), numbers.end());
      block->FinishedStep = reached;
      block->FinishSettings = outputSettings;
    }
  }
}

} // namespace SurfaceDiffusion
