// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Conversion/Execution.h"

#include "Conversion/DirectionArrays.h"
#include "Conversion/NewArray.h"
#include "Conversion/PointArrays.h"
#include "Conversion/SMPParallelFor.h"
#include "Core/Surface/IntrinsicDelaunay.h"
#include "Distributed/DistributedSolver.h"
#include "Distributed/PiecePartition.h"

#include "vtkBoundingBox.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkIntArray.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkVersionMacros.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <numeric>
#include <sstream>

using namespace SurfaceDiffusion;

namespace
{

const char* const NotEnoughMemory = "not enough memory";

std::string Join(const std::vector<std::string>& sentences)
{
  std::string text;
  for (const std::string& sentence : sentences)
  {
    text += (text.empty() ? "" : "; ") + sentence;
  }
  return text;
}

/// A power of two near the size of the surface that the processes have pieces of.
double FindLengthUnit(const Processes& processes, vtkPolyData* piece)
{
  std::vector<double> bounds(6);
  piece->GetBounds(bounds.data());
  bounds = processes.GatherAll(bounds);
  vtkBoundingBox box;
  for (std::size_t b = 0; b < bounds.size(); b += 6)
  {
    box.AddBounds(&bounds[b]);
  }
  const double extent = box.IsValid() ? box.GetMaxLength() : 0.0;
  return extent > 0.0 && std::isfinite(extent) ? std::exp2(std::ilogb(extent)) : 1.0;
}

template <typename Array, typename Value>
void AddColumn(vtkTable* table, const std::string& name, int rows, const Value& value)
{
  const auto column = NewArray<Array>(name, 1, rows);
  for (int row = 0; row < rows; ++row)
  {
    column->SetValue(row, value(row));
  }
  table->AddColumn(column);
}

/// The frames of the triangles that the models work on; no row without a direction array.
TangentVectors MakeFrames(
  const PolyDataSurface& surface, const BlockArrays& arrays, const ParallelFor& parallel)
{
  if (!arrays.Direction)
  {
    return TangentVectors(0, 2);
  }
  TangentVectors frames = ReadFrames(surface, arrays.Direction, arrays.DirectionOnCells, parallel);
  if (surface.Mesh != surface.InputMesh)
  {
    IntrinsicDelaunay(*surface.InputMesh, &frames, parallel); // the same flips again
  }
  return frames;
}

} // namespace

vtkSurfaceDiffusionAlgorithm::Execution::Execution(vtkSurfaceDiffusionAlgorithm& filter,
  const std::vector<SurfacePiece>& surfaces, const Processes* processes)
  : Filter(filter)
  , Group(processes)
{
  for (const SurfacePiece& surface : surfaces)
  {
    vtkPolyData* const data = surface.Input;
    this->AnyPoint = this->AnyPoint || data->GetNumberOfPoints() > 0;
    const bool polygons =
      data->GetNumberOfPoints() > 0 && data->GetNumberOfPolys() + data->GetNumberOfStrips() > 0;
    this->AnyPolygon = this->AnyPolygon || polygons;
    if (polygons || this->Group)
    {
      this->Blocks.push_back({ data, surface.Output, BlockArrays() });
    }
  }
  this->AnyPoint = this->Any(this->AnyPoint);
  this->AnyPolygon = this->Any(this->AnyPolygon);
}

double vtkSurfaceDiffusionAlgorithm::Execution::Sum(double here) const
{
  if (!this->Group)
  {
    return here;
  }
  const std::vector<double> all = this->Group->GatherAll({ here });
  return std::accumulate(all.begin(), all.end(), 0.0);
}

template <typename Work>
void vtkSurfaceDiffusionAlgorithm::Execution::Agree(const Work& work)
{
  if (!this->Group)
  {
    work();
    return;
  }
  std::string failure;
  try
  {
    work();
  }
  catch (const std::bad_alloc&)
  {
    failure = NotEnoughMemory;
  }
  catch (const std::exception& error)
  {
    failure = error.what();
  }
  failure = this->Group->FirstMessage(failure);
  if (!failure.empty())
  {
    throw std::runtime_error(failure);
  }
}

bool vtkSurfaceDiffusionAlgorithm::Execution::Check()
{
  Problems problems;
  try
  {
    this->FindProblems(problems);
  }
  catch (const std::bad_alloc&)
  {
    problems.emplace_back(NotEnoughMemory);
  }
  std::sort(problems.begin(), problems.end());
  problems.erase(std::unique(problems.begin(), problems.end()), problems.end());
  std::string text = Join(problems);
  if (this->Group)
  {
    text = this->Group->FirstMessage(text);
  }
  this->Tell(text);
  return text.empty();
}

void vtkSurfaceDiffusionAlgorithm::Execution::FindProblems(Problems& problems)
{
  this->Filter.CheckProperties(problems);
  if (!this->AnyPoint)
  {
    problems.emplace_back("the input is empty; a surface of polygons or strips is needed");
  }
  else if (!this->AnyPolygon)
  {
    problems.emplace_back("the input has no polygons or strips; a surface is needed");
  }
  Problems ofBlocksWithoutData;
  std::vector<Block> withData;
  for (Block& block : this->Blocks)
  {
    Problems ofArrays;
    if (this->Group && block.Input->GetNumberOfPoints() == 0)
    {
      withData.push_back(block); // with nothing to do but to go along
      continue;
    }
    const bool hasData = this->Filter.FindArrays(block.Input, block.Arrays, ofArrays);
    Problems& found = hasData ? problems : ofBlocksWithoutData;
    found.insert(found.end(), ofArrays.begin(), ofArrays.end());
    if (hasData)
    {
      withData.push_back(block);
    }
  }
  // Blocks without data pass through as long as one has them.
  if (withData.empty())
  {
    problems.insert(problems.end(), ofBlocksWithoutData.begin(), ofBlocksWithoutData.end());
  }
  this->Blocks.swap(withData);
}

void vtkSurfaceDiffusionAlgorithm::Execution::Run(int step, vtkTable* history)
{
  double reported = 0.0;
  const ProgressMonitor::Callback callback = [&](double fraction)
  {
    reported = std::max(reported, fraction);
    this->Filter.UpdateProgress(reported);
    *this->AbortAsked = *this->AbortAsked || this->IsAborted();
    return this->Group || !*this->AbortAsked; // together with the others, or at once
  };
  const ProgressMonitor progress(callback);
  LoopWatch watch([&] { return callback(reported); });
  try
  {
    this->MakeSurfaces(progress.Part(0.0, 0.15));
    progress.Report(0.15);
    this->MeasureUnits();
    this->MakeRuns(progress.Part(0.15, 0.25));
    progress.Report(0.25);
    // Where at most one step is left to do, to write the result is much of the work.
    const double written = this->NumberOfStepsTo(step) > 1 ? 0.95 : 0.7;
    this->Seek(step, progress.Part(0.25, written));
    for (const Block& block : this->Blocks)
    {
      this->Filter.PrepareResult(*block.Run, progress.Part(written, written));
    }
    progress.Report(written);
    if (this->Group && this->Any(*this->AbortAsked))
    {
      throw Aborted(); // the last chance: from here on the output changes
    }
    watch.End();
    this->Agree(
      [&]
      {
        for (const Block& block : this->Blocks)
        {
          if (!this->Group || block.Input->GetNumberOfPoints() > 0)
          {
            this->Filter.WriteResult(*block.Run, block.Arrays, block.Output);
          }
        }
      });
    this->FillCopies();
    this->WriteHistory(step, history);
    if (this->Group && this->Group->Rank() > 0)
    {
      history->Initialize(); // the same everywhere: it is told once
    }
    this->Filter.UpdateProgress(1.0);
    if (this->MadeAnything) // playing time tells nothing anew
    {
      this->Warn();
    }
  }
  catch (const Aborted&)
  {
    // The output is the unchanged input; what was made so far is kept for the next update.
  }
  catch (const std::bad_alloc&)
  {
    this->Fail(NotEnoughMemory, history);
  }
  catch (const std::exception& error)
  {
    this->Fail(error.what(), history);
  }
}

void vtkSurfaceDiffusionAlgorithm::Execution::Fail(const std::string& what, vtkTable* history)
{
  for (const Block& block : this->Blocks) // some may have been written already
  {
    block.Output->ShallowCopy(block.Input);
  }
  history->Initialize();
  this->Filter.Runs.clear();
  this->Tell(what);
}

/// An error, unless empty. Process 0 speaks for all.
void vtkSurfaceDiffusionAlgorithm::Execution::Tell(const std::string& what)
{
  if (!what.empty() && (!this->Group || this->Group->Rank() == 0))
  {
    vtkErrorWithObjectMacro(&this->Filter, << what);
  }
}

/// Copies in this process of points that others own get what has been written there.
void vtkSurfaceDiffusionAlgorithm::Execution::FillCopies()
{
  for (const Block& block : this->Blocks)
  {
    vtkPointData* const before = block.Input->GetPointData();
    vtkPointData* const after = block.Output->GetPointData();
    for (int a = 0; block.Run->Partition && a < after->GetNumberOfArrays(); ++a)
    {
      vtkDataArray* const array = after->GetArray(a);
      if (array && before->GetArray(array->GetName()) != array)
      {
        block.Run->Partition->FillCopies(array);
      }
    }
  }
}

bool vtkSurfaceDiffusionAlgorithm::Execution::IsAborted()
{
  bool aborted = this->Filter.GetAbortExecute() != 0;
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 20220823)
  aborted = aborted || this->Filter.CheckAbort(); // asks containers and the filters upstream too
  this->Filter.SetAbortOutput(false); // the executive would empty the output
#endif
  return aborted;
}

void vtkSurfaceDiffusionAlgorithm::Execution::MakeSurfaces(const ProgressMonitor& progress)
{
  auto& runs = this->Filter.Runs;
  runs.resize(this->Blocks.size());
  for (std::size_t b = 0; b < runs.size(); ++b)
  {
    if (!runs[b])
    {
      runs[b] = std::make_unique<SurfaceRun>();
    }
    Block& block = this->Blocks[b];
    block.Run = runs[b].get();
    PolyDataSurface::Options options;
    options.MergeCoincidentPoints = this->Filter.MergeCoincidentPoints;
    options.MergeTolerance = this->Filter.MergeTolerance;
    options.IntrinsicDelaunay = this->Filter.IntrinsicDelaunay;
    options.Excluded = this->Filter.MaskMode == MASK_MODE_EXCLUDE ? block.Arrays.Mask : nullptr;
    const std::string key = this->SurfaceKey(block, options);
    if (this->Any(key != block.Run->SurfaceKey || !block.Run->Surface))
    {
      *block.Run = SurfaceRun(); // frees the old one first
      const double count = static_cast<double>(runs.size());
      this->MakeSurface(block, options, progress.Part(b / count, (b + 1) / count));
      block.Run->SurfaceKey = key;
      this->MadeAnything = true;
    }
    if (block.Run->Partition)
    {
      block.Run->Partition->ObeyAbort(this->AbortAsked);
    }
  }
}

std::string vtkSurfaceDiffusionAlgorithm::Execution::SurfaceKey(
  const Block& block, const PolyDataSurface::Options& options) const
{
  std::ostringstream key;
  key << PolyDataSurface::Key(block.Input, options);
  if (this->Group)
  {
    vtkPointData* const points = block.Input->GetPointData();
    key << " piece " << this->Filter.SeamTolerance;
    for (vtkAbstractArray* array : { static_cast<vtkAbstractArray*>(points->GetGlobalIds()),
           points->GetAbstractArray(vtkDataSetAttributes::GhostArrayName()) })
    {
      key << ' ' << array << ' ' << (array ? array->GetMTime() : 0);
    }
  }
  return key.str();
}

void vtkSurfaceDiffusionAlgorithm::Execution::MakeSurface(
  Block& block, PolyDataSurface::Options options, const ProgressMonitor& progress)
{
  SurfaceRun& run = *block.Run;
  if (this->Group)
  {
    const std::vector<SurfacePiece> piece = { { 0, block.Input, block.Output } };
    run.Identity = FindIdentity(*this->Group, piece, this->Filter.SeamTolerance).front();
    options.LengthUnit = FindLengthUnit(*this->Group, block.Input);
  }
  this->Agree(
    [&] { run.Surface = std::make_unique<PolyDataSurface>(block.Input, options, progress); });
  if (this->Group)
  {
    run.Partition = std::make_shared<PiecePartition>(*this->Group, *run.Surface, run.Identity);
    run.Surface->SetReduction(run.Partition);
  }
}

/// h and R of all blocks together.
void vtkSurfaceDiffusionAlgorithm::Execution::MeasureUnits()
{
  double length = 0.0;
  double edges = 0.0;
  ValueStatistics statistics;
  for (const Block& block : this->Blocks)
  {
    const TriangleMesh& mesh = *block.Run->Surface->Mesh;
    edges += mesh.NumberOfEdges();
    length += mesh.TotalEdgeLength() * mesh.LengthUnit();
    if (block.Run->Partition)
    {
      edges = this->Sum(edges - block.Run->Partition->SharedEdges());
      length = this->Sum(length - block.Run->Partition->SharedEdgeLength() * mesh.LengthUnit());
    }
    if (block.Arrays.Data)
    {
      const bool inpaint = this->Filter.MaskMode == MASK_MODE_INPAINT;
      statistics.Add(block.Arrays.Data, inpaint ? block.Arrays.Mask : nullptr, block.Arrays.Fixed);
    }
  }
  if (this->Group)
  {
    statistics.Join(*this->Group);
  }
  UnitSystem units;
  units.Natural = this->Filter.Units == UNITS_NATURAL;
  units.MeanEdgeLength = edges > 0.0 ? length / edges : 1.0;
  const Dimension time = this->Filter.GetTimeDimension();
  units.ValueRange = this->Filter.HasValueRange() ? statistics.Range() : 1.0;
  if (!std::isfinite(units.ValueRange) || !std::isfinite(units.MeanEdgeLength))
  {
    throw std::runtime_error(
      "the range of the coordinates or of the values is larger than a double can hold");
  }
  // A power of two changes no bit; only values whose squares overflow or vanish need one.
  const double magnitude = this->Filter.HasValueRange() ? statistics.Magnitude : 0.0;
  if (magnitude > 0.0 && (magnitude > 1e100 || magnitude < 1e-100))
  {
    units.ValueUnit = std::exp2(std::ilogb(magnitude));
  }
  this->Filter.MeanEdgeLength = units.MeanEdgeLength;
  this->Filter.ValueRange = units.ValueRange;
  this->Filter.TimeUnit = this->Filter.GetTimeIsAbsolute()
    ? 1.0
    : std::pow(units.MeanEdgeLength, time.Length) * std::pow(units.ValueRange, time.Value) *
      this->Filter.GetTimeFactor();
  for (const Block& block : this->Blocks)
  {
    units.LengthUnit = block.Run->Surface->Mesh->LengthUnit();
    block.Run->Units = units;
  }
}

void vtkSurfaceDiffusionAlgorithm::Execution::MakeRuns(const ProgressMonitor& progress)
{
  const double count = static_cast<double>(this->Blocks.size());
  for (std::size_t b = 0; b < this->Blocks.size(); ++b)
  {
    Block& block = this->Blocks[b];
    std::ostringstream key;
    this->Filter.WriteRunKey(key);
    key << this->Blocks.size() << ' ' << block.Run->Units.MeanEdgeLength << ' '
        << block.Run->Units.ValueRange << ' ' << block.Run->Units.ValueUnit << ' '
        << block.Arrays.DirectionOnCells;
    vtkDataArray* const ids = block.Input->GetPointData()->GetGlobalIds();
    for (vtkDataArray* array : { block.Arrays.Data, block.Arrays.Mask, block.Arrays.Direction,
           block.Arrays.Fixed, block.Arrays.Rates, ids })
    {
      key << ' ' << array << ' ' << (array ? array->GetMTime() : 0);
    }
    if (this->Any(block.Run->RunKey != key.str() || !block.Run->Path))
    {
      block.Run->RunKey.clear(); // an abort may leave a path that has none yet
      block.Run->Path.reset();
      this->MakeRun(block, progress.Part(b / count, (b + 1) / count));
      block.Run->RunKey = key.str();
      this->MadeAnything = true;
    }
  }
  const auto hasMissing = [](const Block& block) { return block.Run->HasMissing; };
  if (this->Filter.HoldKnownValues &&
    !this->Any(std::any_of(this->Blocks.begin(), this->Blocks.end(), hasMissing)))
  {
    throw std::runtime_error("HoldKnownValues is on but nothing is missing, so nothing would "
                             "change; allowed: on with a mask in mode Inpaint or with NaN");
  }
}

void vtkSurfaceDiffusionAlgorithm::Execution::MakeRun(Block& block, const ProgressMonitor& progress)
{
  SurfaceRun& run = *block.Run;
  const ParallelFor& parallel = SMPParallelFor::Instance();
  TangentVectors frames;
  this->Agree([&] { frames = MakeFrames(*run.Surface, block.Arrays, parallel); });
  std::vector<std::int64_t> ids = ReadVertexIds(*run.Surface, block.Input);
  for (std::size_t v = 0; run.Partition && v < ids.size(); ++v)
  {
    ids[v] = run.Identity.Ids[run.Surface->Mesh->InputVertex()[v]];
  }
  ModelInput input{ block.Input, block.Arrays, *run.Surface, run.Units, PointData(),
    std::move(frames), std::move(ids), parallel, progress.Part(0.2, 1.0),
    [this, &run](const std::string& name, const SolverTask& task)
    { return this->FindSolver(run, name, task); },
    [this](const std::function<void()>& work) { this->Agree(work); }, run.Warnings };
  run.Warnings.clear();
  run.HasMissing = false;
  if (this->Any(block.Arrays.Data))
  {
    input.Data = this->ReadData(block);
    this->Filter.PrepareData(input);
    run.HasMissing = input.Data.Missing.any();
    if (this->Filter.HoldKnownValues)
    {
      input.Data.Fixed = input.Data.Fixed || !input.Data.Missing;
    }
  }
  progress.Report(0.2);
  const int steps = this->Filter.GetEffectiveNumberOfTimeSteps();
  std::unique_ptr<Model> model = this->Filter.MakeModel(input, steps);
  const std::size_t limit = this->CheckpointMemory(*model);
  run.Path = std::make_unique<Trajectory>(run.Surface->Mesh, std::move(model), limit, parallel);
  run.Path->Reserve(steps);
  progress.Report(1.0);
}

/// The data of the vertices; of those that several processes have, their owner's.
PointData vtkSurfaceDiffusionAlgorithm::Execution::ReadData(const Block& block)
{
  const SurfaceRun& run = *block.Run;
  vtkDataArray* const mask =
    this->Filter.MaskMode == MASK_MODE_INPAINT ? block.Arrays.Mask : nullptr;
  PointData data;
  this->Agree(
    [&]
    {
      if (block.Arrays.Data)
      {
        data = ReadPointData(
          *run.Surface, block.Arrays.Data, mask, block.Arrays.Fixed, run.Units.ValueUnit);
      }
    });
  if (run.Partition)
  {
    double components = static_cast<double>(data.Given.cols());
    run.Partition->Max(&components, 1);
    const auto columns = static_cast<Eigen::Index>(components);
    const Eigen::Index n = run.Surface->Mesh->NumberOfVertices();
    Values all = Values::Zero(n, columns + 2);
    if (n > 0)
    {
      all << data.Given, data.Missing.cast<double>(), data.Fixed.cast<double>();
    }
    run.Partition->UpdateFromOwners(all);
    data.Given = all.leftCols(columns);
    data.Missing = all.col(columns).array() != 0.0;
    data.Fixed = all.col(columns + 1).array() != 0.0;
  }
  return data;
}

/// For checkpoints of this block; all processes keep the same ones.
std::size_t vtkSurfaceDiffusionAlgorithm::Execution::CheckpointMemory(const Model& model) const
{
  if (!this->Filter.GenerateTimeSteps)
  {
    return 0;
  }
  const std::size_t limit = static_cast<std::size_t>(this->Filter.CheckpointMemoryLimit) * 1024 *
    1024 / this->Blocks.size();
  if (!this->Group)
  {
    return limit;
  }
  const std::size_t mine = std::max<std::size_t>(model.CheckpointSize(), 1) * sizeof(double);
  const std::vector<double> sizes = this->Group->GatherAll({ static_cast<double>(mine) });
  const auto largest = static_cast<std::size_t>(*std::max_element(sizes.begin(), sizes.end()));
  return std::max<std::size_t>(limit / largest, 1) * mine;
}

std::shared_ptr<LinearSolver> vtkSurfaceDiffusionAlgorithm::Execution::FindSolver(
  SurfaceRun& run, const std::string& name, SolverTask task)
{
  task.Tolerance = this->Filter.Tolerance;
  IterationLimits limits;
  limits.Tolerance = this->Filter.Tolerance;
  limits.MaximumNumberOfIterations = this->Filter.MaximumNumberOfIterations;
  const auto method = static_cast<SolverMethod>(this->Filter.Solver);
  if (run.Partition)
  {
    std::shared_ptr<LinearSolver> solver =
      MakeDistributedSolver(run.Partition, PreferDistributedMultigrid(method, task));
    solver->SetLimits(limits);
    return solver;
  }
  const SolverChoice choice = ChooseSolver(method, task);
  const std::string prefix = name + ' ';
  const std::string key = prefix + (choice.FallsBack ? "automatic " : "") +
    std::to_string(static_cast<int>(choice.Method));
  std::shared_ptr<LinearSolver> solver = run.Solvers[key];
  if (!solver)
  {
    solver = MakeSolver(choice, SMPParallelFor::Instance());
  }
  // One solver per name: a factor that is no longer used would hold much memory.
  for (auto it = run.Solvers.begin(); it != run.Solvers.end();)
  {
    it = it->first.compare(0, prefix.size(), prefix) == 0 ? run.Solvers.erase(it) : std::next(it);
  }
  run.Solvers[key] = solver;
  solver->SetLimits(limits);
  return solver;
}

Index vtkSurfaceDiffusionAlgorithm::Execution::NumberOfStepsTo(int step) const
{
  Index most = 0;
  for (const Block& block : this->Blocks)
  {
    most = std::max(most, block.Run->Path->NumberOfStepsTo(step));
  }
  return most;
}

void vtkSurfaceDiffusionAlgorithm::Execution::Seek(int step, const ProgressMonitor& progress)
{
  double all = 0.0;
  for (const Block& block : this->Blocks)
  {
    all += block.Run->Surface->Mesh->NumberOfTriangles();
  }
  double done = 0.0;
  for (const Block& block : this->Blocks)
  {
    const double size = block.Run->Surface->Mesh->NumberOfTriangles();
    const ProgressMonitor part =
      all > 0.0 ? progress.Part(done / all, (done + size) / all) : progress;
    done += size;
    const Index before = block.Run->Path->NumberOfAdvances();
    block.Run->Path->Seek(step, part);
    this->Filter.NumberOfStepsComputed += block.Run->Path->NumberOfAdvances() - before;
  }
}

void vtkSurfaceDiffusionAlgorithm::Execution::WriteHistory(int step, vtkTable* history)
{
  // A run that has ended by itself has no rows after its last step.
  int rows = 0;
  for (const Block& block : this->Blocks)
  {
    const int recorded = static_cast<int>(block.Run->Path->Records().size());
    rows = std::max(rows, std::min(step + 1, recorded));
  }
  std::vector<StepRecord> sums(rows);
  Eigen::Index components = 0;
  const Dimension energy = this->Filter.GetEnergyDimension();
  for (const Block& block : this->Blocks)
  {
    components = std::max(components, block.Run->Path->State().cols());
    const double energyUnit = block.Run->Units.FromCore(1.0, energy.Length, energy.Value);
    const std::vector<StepRecord>& records = block.Run->Path->Records();
    for (int row = 0; row < rows; ++row)
    {
      const bool ended = row >= static_cast<int>(records.size());
      const StepRecord& record = ended ? records.back() : records[row];
      sums[row].Energy += record.Energy * energyUnit;
      sums[row].Clamped += record.Clamped;
      if (ended)
      {
        continue;
      }
      sums[row].Iterations += record.Iterations;
      sums[row].Residual = std::max(sums[row].Residual, record.Residual);
      sums[row].Seconds += record.Seconds;
    }
  }
  const double timeStep = this->Filter.GetEffectiveTimeStep();
  AddColumn<vtkIntArray>(history, "Step", rows, [](int row) { return row; });
  AddColumn<vtkDoubleArray>(history, "Time", rows, [&](int row) { return row * timeStep; });
  for (Eigen::Index k = 0; k < components; ++k)
  {
    AddColumn<vtkDoubleArray>(history, "Total_" + std::to_string(k), rows,
      [&](int row)
      {
        double total = 0.0;
        for (const Block& block : this->Blocks)
        {
          const Trajectory& path = *block.Run->Path;
          const Index last = static_cast<Index>(path.Records().size()) - 1;
          if (k < path.State().cols())
          {
            total += block.Run->Units.FromCore(
              path.TotalAt(std::min(row, last), static_cast<Index>(k)), 2.0, 1.0);
          }
        }
        return total;
      });
  }
  AddColumn<vtkDoubleArray>(history, "Energy", rows, [&](int row) { return sums[row].Energy; });
  AddColumn<vtkIntArray>(
    history, "Iterations", rows, [&](int row) { return sums[row].Iterations; });
  AddColumn<vtkDoubleArray>(history, "Residual", rows, [&](int row) { return sums[row].Residual; });
  AddColumn<vtkDoubleArray>(history, "Seconds", rows, [&](int row) { return sums[row].Seconds; });
  if (this->Filter.CountsClamped())
  {
    AddColumn<vtkIntArray>(history, "Clamped", rows, [&](int row) { return sums[row].Clamped; });
  }
  this->Filter.NumberOfIterations = 0;
  this->Filter.Residual = 0.0;
  for (const StepRecord& sum : sums)
  {
    this->Filter.NumberOfIterations += sum.Iterations;
    this->Filter.Residual = std::max(this->Filter.Residual, sum.Residual);
  }
}

bool vtkSurfaceDiffusionAlgorithm::Execution::MaskChangesNothing() const
{
  bool anyMask = false;
  bool anyMasked = false;
  bool anyData = false;
  for (const Block& block : this->Blocks)
  {
    vtkDataArray* mask = block.Arrays.Mask;
    anyMask = anyMask || mask;
    anyData = anyData || block.Arrays.Data;
    for (vtkIdType i = 0; mask && !anyMasked && i < mask->GetNumberOfTuples(); ++i)
    {
      anyMasked = mask->GetComponent(i, 0) != 0.0;
    }
  }
  anyMask = this->Any(anyMask);
  anyMasked = this->Any(anyMasked);
  anyData = this->Any(anyData);
  const bool filling = this->Filter.InitialFill != INITIAL_FILL_INPUT ||
    this->Filter.UsesFidelity() || this->Filter.HoldKnownValues;
  const bool inert = this->Filter.MaskMode == MASK_MODE_INPAINT && !(anyData && filling);
  return anyMask && (!anyMasked || inert);
}

void vtkSurfaceDiffusionAlgorithm::Execution::Warn()
{
  PolyDataSurface::Findings sum;
  for (const Block& block : this->Blocks)
  {
    const PolyDataSurface::Findings& found = block.Run->Surface->Found;
    sum.DegenerateTriangles += found.DegenerateTriangles;
    sum.UnusedPoints += found.UnusedPoints;
    if (block.Run->Partition)
    {
      sum.UnusedPoints -= block.Run->Partition->NumberOfCopies();
    }
    sum.NonManifoldEdges += found.NonManifoldEdges;
    sum.CoincidentBoundaryPoints += found.CoincidentBoundaryPoints;
  }
  std::vector<std::string> sentences;
  const auto tell = [&](vtkIdType here, const char* what)
  {
    const auto count = static_cast<vtkIdType>(this->Sum(static_cast<double>(here)));
    if (count > 0)
    {
      sentences.push_back(std::to_string(count) + what);
    }
  };
  tell(sum.DegenerateTriangles, " triangles of zero area were left out");
  tell(sum.UnusedPoints, " points that no triangle uses keep their values");
  tell(sum.NonManifoldEdges, " edges have three or more triangles, which all exchange over them");
  tell(sum.CoincidentBoundaryPoints,
    " boundary points coincide with others and nothing flows between them (to join them, set "
    "MergeCoincidentPoints)");
  for (const Block& block : this->Blocks)
  {
    for (const std::string& sentence : block.Run->Warnings)
    {
      if (std::find(sentences.begin(), sentences.end(), sentence) == sentences.end())
      {
        sentences.push_back(sentence);
      }
    }
  }
  if (this->MaskChangesNothing())
  {
    sentences.emplace_back("the mask changes nothing with these settings");
  }
  if (!sentences.empty() && (!this->Group || this->Group->Rank() == 0))
  {
    vtkWarningWithObjectMacro(&this->Filter, << Join(sentences));
  }
}
