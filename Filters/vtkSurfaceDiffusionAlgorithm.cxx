// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceDiffusionAlgorithm.h"

#include "Conversion/InputArrays.h"
#include "Conversion/MirroredEnum.h"
#include "Conversion/ResultWriter.h"
#include "Conversion/RunState.h"
#include "Conversion/SurfaceFilterInternals.h"
#include "Conversion/SurfaceReader.h"
#include "Distributed/DistributedSolver.h"

#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTable.h"

#include <algorithm>
#include <cmath>

using namespace SurfaceDiffusion;

using Self = vtkSurfaceDiffusionAlgorithm;
SURFACEDIFFUSION_MIRROR(Self::UNITS_NATURAL, UnitsMode::Natural);
SURFACEDIFFUSION_MIRROR(Self::UNITS_ABSOLUTE, UnitsMode::Absolute);
SURFACEDIFFUSION_MIRROR(Self::MASK_MODE_INPAINT, MaskMode::Inpaint);
SURFACEDIFFUSION_MIRROR(Self::MASK_MODE_EXCLUDE, MaskMode::Exclude);
SURFACEDIFFUSION_MIRROR(Self::TIME_INTEGRATOR_FIRST_ORDER, TimeIntegrator::FirstOrder);
SURFACEDIFFUSION_MIRROR(Self::TIME_INTEGRATOR_SECOND_ORDER, TimeIntegrator::SecondOrder);
SURFACEDIFFUSION_MIRROR(Self::TIME_INTEGRATOR_IMPLICIT, TimeIntegrator::Implicit);
SURFACEDIFFUSION_MIRROR(Self::SOLVER_AUTOMATIC, SolverMethod::Automatic);
SURFACEDIFFUSION_MIRROR(Self::SOLVER_DIRECT, SolverMethod::Direct);
SURFACEDIFFUSION_MIRROR(Self::SOLVER_CONJUGATE_GRADIENT, SolverMethod::ConjugateGradient);
SURFACEDIFFUSION_MIRROR(Self::SOLVER_MULTIGRID, SolverMethod::Multigrid);

namespace
{

using Pipeline = vtkStreamingDemandDrivenPipeline;

/// One process solves a surface with at most this many points as fast as several processes do, and
/// needs less than a GiB.
constexpr double MaxGatheredPoints = 1e6;

const std::vector<const char*> WordsOfPrecision = { "Input", "Single", "Double" };

} // namespace

vtkSurfaceDiffusionAlgorithm::vtkSurfaceDiffusionAlgorithm()
  : State(std::make_unique<RunState>())
{
  this->SetNumberOfOutputPorts(2);
  this->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::SCALARS);
}

vtkSurfaceDiffusionAlgorithm::~vtkSurfaceDiffusionAlgorithm() = default;

const char* vtkSurfaceDiffusionAlgorithm::FindSettingWord(const char* name) const
{
  return FindWord(*this->MakeSettings(), name);
}

const char* vtkSurfaceDiffusionAlgorithm::GetUnitsAsString()
{
  return this->FindSettingWord("Units");
}

const char* vtkSurfaceDiffusionAlgorithm::GetMaskModeAsString()
{
  return this->FindSettingWord("MaskMode");
}

const char* vtkSurfaceDiffusionAlgorithm::GetTimeIntegratorAsString()
{
  return this->FindSettingWord("TimeIntegrator");
}

const char* vtkSurfaceDiffusionAlgorithm::GetSolverAsString()
{
  return this->FindSettingWord("Solver");
}

const char* vtkSurfaceDiffusionAlgorithm::GetOutputPrecisionAsString()
{
  const bool known = this->OutputPrecision >= 0 && this->OutputPrecision < 3;
  return known ? WordsOfPrecision[this->OutputPrecision] : "Unknown";
}

void vtkSurfaceDiffusionAlgorithm::UsePaperScheme()
{
  this->SetTimeIntegratorToFirstOrder();
  this->SetIntrinsicDelaunay(false);
  this->SetMaskModeToInpaint();
}

double vtkSurfaceDiffusionAlgorithm::GetEffectiveTimeStep()
{
  return this->MakeSettings()->DescribeModel().TimeStep;
}

void vtkSurfaceDiffusionAlgorithm::CopyProperties(RunSettings& settings) const
{
  settings.TimeStep = this->TimeStep;
  settings.NumberOfTimeSteps = this->NumberOfTimeSteps;
  settings.Units = static_cast<UnitsMode>(this->Units);
  settings.GenerateTimeSteps = this->GenerateTimeSteps;
  settings.OutputInterval = this->OutputInterval;
  settings.MaskMode = static_cast<SurfaceDiffusion::MaskMode>(this->MaskMode);
  settings.RandomSeed = this->RandomSeed;
  settings.TimeIntegrator = static_cast<SurfaceDiffusion::TimeIntegrator>(this->TimeIntegrator);
  settings.Solver = static_cast<SolverMethod>(this->Solver);
  settings.Tolerance = this->Tolerance;
  settings.MaximumNumberOfIterations = this->MaximumNumberOfIterations;
  settings.IntrinsicDelaunay = this->IntrinsicDelaunay;
  settings.MergeCoincidentPoints = this->MergeCoincidentPoints;
  settings.MergeTolerance = this->MergeTolerance;
  settings.CheckpointMemoryLimit = this->CheckpointMemoryLimit;
}

bool vtkSurfaceDiffusionAlgorithm::FindFields(
  vtkPolyData* block, InputFields& fields, Problems& problems)
{
  const InputArrays inputs(this, block, problems);
  fields.Data = inputs.FindOnPoints(0, "InputArray", InputArrays::AnyNumberOfComponents);
  fields.Mask = inputs.FindOnPoints(1, "MaskArray", 1);
  fields.Direction = inputs.Find(2, "DirectionArray", 3, fields.DirectionOnCells);
  fields.Fixed = inputs.FindOnPoints(3, "FixedArray", 1);
  return fields.Data != nullptr;
}

//------------------------------------------------------------------------------------------------
int vtkSurfaceDiffusionAlgorithm::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkDataObject" : "vtkTable");
  return 1;
}

int vtkSurfaceDiffusionAlgorithm::RequestDataObject(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  if (!this->Superclass::RequestDataObject(request, inputs, outputs))
  {
    return 0;
  }
  if (!vtkTable::GetData(outputs, 1))
  {
    vtkNew<vtkTable> table;
    outputs->GetInformationObject(1)->Set(vtkDataObject::DATA_OBJECT(), table);
  }
  return 1;
}

int vtkSurfaceDiffusionAlgorithm::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  const auto settings = this->MakeSettings();
  Problems problems;
  settings->Check(nullptr, problems);
  if (!this->GenerateTimeSteps || !problems.empty())
  {
    return 1; // the input's own times pass through; problems are reported at update
  }
  const std::vector<double> times = settings->PublishedTimes();
  const double range[2] = { times.front(), times.back() };
  for (int port = 0; port < 2; ++port)
  {
    vtkInformation* info = outputs->GetInformationObject(port);
    info->Set(Pipeline::TIME_STEPS(), times.data(), static_cast<int>(times.size()));
    info->Set(Pipeline::TIME_RANGE(), range, 2);
  }
  return 1;
}

int vtkSurfaceDiffusionAlgorithm::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector*)
{
  if (this->GenerateTimeSteps)
  {
    // The requested time is a diffusion time, which has no meaning upstream.
    vtkInformation* info = inputs[0]->GetInformationObject(0);
    if (info->Has(Pipeline::TIME_STEPS()) && info->Length(Pipeline::TIME_STEPS()) > 0)
    {
      info->Set(Pipeline::UPDATE_TIME_STEP(), info->Get(Pipeline::TIME_STEPS())[0]);
    }
    else if (info->Has(Pipeline::TIME_RANGE()))
    {
      info->Set(Pipeline::UPDATE_TIME_STEP(), info->Get(Pipeline::TIME_RANGE())[0]);
    }
    else
    {
      info->Remove(Pipeline::UPDATE_TIME_STEP());
    }
  }
  return 1;
}

int vtkSurfaceDiffusionAlgorithm::RequestData(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkTable* const table = vtkTable::GetData(outputs, 1);
  table->Initialize();
  RunState& state = *this->State;
  state.Succeeded = false;
  Problems problems; // reported with those of the arrays
  this->MakeSettings()->Check(nullptr, problems);
  if (problems.empty())
  {
    state.Step = this->TakeTime(request, outputs);
  }
  const int result = this->Superclass::RequestData(request, inputs, outputs);
  if (state.Succeeded)
  {
    WriteHistory(state.History, table);
  }
  if (this->GenerateTimeSteps && problems.empty())
  {
    for (const int port : { 0, 1 })
    {
      vtkDataObject::GetData(outputs, port)
        ->GetInformation()
        ->Set(vtkDataObject::DATA_TIME_STEP(), state.Step * this->GetEffectiveTimeStep());
    }
  }
  return result;
}

/// The requested step.
int vtkSurfaceDiffusionAlgorithm::TakeTime(vtkInformation* request, vtkInformationVector* outputs)
{
  const auto settings = this->MakeSettings();
  const ModelTraits traits = settings->DescribeModel();
  int step = traits.NumberOfSteps;
  if (this->GenerateTimeSteps)
  {
    const int port = request->Has(vtkDemandDrivenPipeline::FROM_OUTPUT_PORT())
      ? std::max(0, request->Get(vtkDemandDrivenPipeline::FROM_OUTPUT_PORT()))
      : 0;
    vtkInformation* info = outputs->GetInformationObject(port);
    if (info->Has(Pipeline::UPDATE_TIME_STEP()))
    {
      step = settings->FindStep(info->Get(Pipeline::UPDATE_TIME_STEP()));
    }
  }
  return step;
}

bool vtkSurfaceDiffusionAlgorithm::SolvesInPieces(
  const std::vector<SurfaceBlock>& pieces, bool oneSurface, double points)
{
  const SharedProcessGroup group(this->GetController());
  if (!HasDistributedSolver(group.GetProcesses()) || this->Solver == SOLVER_DIRECT ||
    this->IntrinsicDelaunay || this->MergeCoincidentPoints ||
    group.Any(!this->CanSolveInPieces(pieces)))
  {
    return false;
  }
  return oneSurface && points > 0.0 &&
    (this->Solver != SOLVER_AUTOMATIC || points > MaxGatheredPoints);
}

bool vtkSurfaceDiffusionAlgorithm::CanSolveInPieces(const std::vector<SurfaceBlock>&)
{
  return this->MakeSettings()->DescribeModel().CanBeDistributed;
}

//------------------------------------------------------------------------------------------------
void vtkSurfaceDiffusionAlgorithm::ProcessSurfaces(
  const std::vector<SurfaceBlock>& blocks, const ProgressMonitor& progress)
{
  RunState& state = *this->State;
  const ProcessGroup& group = this->GetProcessGroup();
  std::shared_ptr<RunSettings> settings = this->MakeSettings();
  Problems problems;
  settings->Check(nullptr, problems);
  this->CheckSurfaceProperties(problems);
  Require(this->OutputPrecision >= 0 && this->OutputPrecision < 3, "OutputPrecision",
    this->OutputPrecision, ListChoices(WordsOfPrecision).c_str(), problems);

  std::vector<SurfaceBlock> surfaces;
  std::vector<InputFields> fields;
  this->FindAllFields(
    this->SelectSurfaces(blocks, problems), *settings, surfaces, fields, problems);
  if (this->ReportProblems(problems))
  {
    return;
  }
  try
  {
    state.Run.Update(this->MakeInputs(surfaces, fields), settings, group, progress.Part(0.0, 0.25));
    progress.Report(0.25);
    // If at most one step is left to do, writing the result is much of the work.
    const double written = state.Run.NumberOfStepsTo(state.Step) > 1 ? 0.95 : 0.7;
    state.Run.Seek(state.Step, progress.Part(0.25, written));
    progress.Report(written);
    this->BeginWriting();
    group.RunCollectively(
      [&]
      {
        for (std::size_t b = 0; b < surfaces.size(); ++b)
        {
          if (!group.IsShared() || surfaces[b].Input->GetNumberOfPoints() > 0)
          {
            this->WriteResult(b, fields[b], surfaces[b].Output);
          }
        }
      });
    for (std::size_t b = 0; group.IsShared() && b < surfaces.size(); ++b)
    {
      state.Decomposition->UpdateCopies(
        surfaces[b].Input->GetPointData(), surfaces[b].Output->GetPointData());
    }
  }
  catch (const Aborted&)
  {
    throw;
  }
  catch (...)
  {
    state.Run.Clear();
    throw;
  }
  state.History = state.Run.MakeHistory(state.Step);
  state.Succeeded = group.IsRoot();
  this->TakeResults();
  this->ReportWarnings(state.Run.FindWarnings(group));
}

/// The surfaces with data, their fields, and the problems of both. Blocks without data pass through
/// if at least one block has data.
void vtkSurfaceDiffusionAlgorithm::FindAllFields(const std::vector<SurfaceBlock>& blocks,
  RunSettings& settings, std::vector<SurfaceBlock>& surfaces, std::vector<InputFields>& fields,
  Problems& problems)
{
  Problems missingData;
  for (const SurfaceBlock& block : blocks)
  {
    InputFields found;
    if (this->GetProcessGroup().IsShared() && block.Input->GetNumberOfPoints() == 0)
    {
      surfaces.push_back(block); // it participates in collective calls
      fields.push_back(found);
      continue;
    }
    Problems here;
    const bool hasData = this->FindFields(block.Input, found, here);
    found.GlobalIds = block.Input->GetPointData()->GetGlobalIds();
    if (hasData)
    {
      const FieldSummary summary = found.Summarize();
      settings.Check(&summary, here);
    }
    Problems& all = hasData ? problems : missingData;
    all.insert(all.end(), here.begin(), here.end());
    if (hasData)
    {
      surfaces.push_back(block);
      fields.push_back(found);
    }
  }
  if (surfaces.empty())
  {
    problems.insert(problems.end(), missingData.begin(), missingData.end());
  }
}

std::vector<BlockInput> vtkSurfaceDiffusionAlgorithm::MakeInputs(
  const std::vector<SurfaceBlock>& surfaces, const std::vector<InputFields>& fields)
{
  RunState& state = *this->State;
  const bool shared = this->GetProcessGroup().IsShared();
  if (!shared)
  {
    state.Decomposition.reset();
  }
  else if (!state.Decomposition)
  {
    state.Decomposition =
      std::make_unique<PieceDecomposition>(this->GetController(), this->Private->AbortRequested);
  }
  state.Cells.resize(surfaces.size());
  state.Versions.resize(surfaces.size());
  std::vector<BlockInput> inputs(surfaces.size());
  for (std::size_t b = 0; b < surfaces.size(); ++b)
  {
    vtkPolyData* const data = surfaces[b].Input;
    const InputFields& arrays = fields[b];
    vtkDataArray* const excluded = this->MaskMode == MASK_MODE_EXCLUDE ? arrays.Mask : nullptr;
    std::vector<vtkIdType>& cells = state.Cells[b];
    BlockInput& input = inputs[b];
    RunState::Version& version = state.Versions[b];
    const InputStamp stamp(data, arrays.List());
    if (!(version.Stamp == stamp) || version.Excludes != (excluded != nullptr))
    {
      version = { stamp, excluded != nullptr, FingerprintSurface(data, excluded),
        FingerprintFields(arrays) };
    }
    input.SurfaceVersion = version.Surface;
    input.FieldsVersion = version.Fields;
    input.ReadSurface = [data, excluded, &cells] { return ReadSurface(data, excluded, cells); };
    input.ReadFields = [data, &arrays, &cells]
    {
      if (arrays.GlobalIds)
      {
        RequireTuples(arrays.GlobalIds, data->GetNumberOfPoints(), "point");
      }
      return ReadFields(arrays, cells);
    };
    if (shared)
    {
      state.Decomposition->SetPiece(data, this->SeamTolerance);
      input.SurfaceVersion.AddNumber(this->SeamTolerance);
      AddArray(input.SurfaceVersion, data->GetPointData()->GetGlobalIds());
      AddArray(input.SurfaceVersion,
        data->GetPointData()->GetArray(vtkDataSetAttributes::GhostArrayName()));
      input.Decomposition = state.Decomposition.get();
      input.ReadFields = [&arrays, &cells, decomposition = state.Decomposition.get()]
      {
        Fields read = ReadFields(arrays, cells);
        read.Ids = decomposition->PointIds();
        return read;
      };
    }
  }
  return inputs;
}

void vtkSurfaceDiffusionAlgorithm::WriteResult(
  std::size_t index, const InputFields& fields, vtkPolyData* output)
{
  const Run::Block& block = this->State->Run.GetBlock(index);
  vtkPointData* const data = output->GetPointData();
  const int array = data->AddArray(WritePointArray(*block.Surface, fields.Data, block.Path->State(),
    block.Units.ValueUnit, this->FindResultType(fields), this->FindResultName(fields)));
  data->SetActiveAttribute(array, vtkDataSetAttributes::SCALARS);
}

std::string vtkSurfaceDiffusionAlgorithm::FindResultName(const InputFields& fields) const
{
  if (!this->ResultArrayName.empty())
  {
    return this->ResultArrayName;
  }
  const char* name = fields.Data->GetName();
  return std::string(name ? name : "") + this->GetResultSuffix();
}

int vtkSurfaceDiffusionAlgorithm::FindResultType(const InputFields& fields) const
{
  const int inputType = fields.Data->GetDataType();
  if (this->OutputPrecision == OUTPUT_PRECISION_INPUT && inputType == VTK_UNSIGNED_CHAR)
  {
    return VTK_UNSIGNED_CHAR;
  }
  const bool single = this->OutputPrecision == OUTPUT_PRECISION_SINGLE ||
    (this->OutputPrecision == OUTPUT_PRECISION_INPUT && inputType == VTK_FLOAT);
  return single ? VTK_FLOAT : VTK_DOUBLE;
}

void vtkSurfaceDiffusionAlgorithm::TakeResults()
{
  const RunState& state = *this->State;
  this->TimeUnit = state.Run.TimeUnit();
  this->MeanEdgeLength = state.Run.Units().MeanEdgeLength;
  this->ValueRange = state.Run.Units().ValueRange;
  this->NumberOfIterations = static_cast<vtkIdType>(state.History.NumberOfIterations());
  this->Residual = state.History.LargestResidual();
  this->NumberOfStepsComputed = static_cast<vtkIdType>(state.Run.NumberOfStepsComputed());
}

void vtkSurfaceDiffusionAlgorithm::VisitReported(const std::function<void(double&)>& visit)
{
  this->Superclass::VisitReported(visit);
  visit(this->TimeUnit);
  visit(this->ValueRange);
  visit(this->Residual);
  for (vtkIdType* count : { &this->NumberOfIterations, &this->NumberOfStepsComputed })
  {
    auto number = static_cast<double>(*count);
    visit(number);
    *count = static_cast<vtkIdType>(number);
  }
}

void vtkSurfaceDiffusionAlgorithm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  std::ostringstream spaces;
  spaces << indent;
  os << Describe(*this->MakeSettings(), spaces.str());
  os << indent << "OutputPrecision: " << this->GetOutputPrecisionAsString() << "\n";
  os << indent << "TimeUnit: " << this->TimeUnit << "\n";
  os << indent << "ValueRange: " << this->ValueRange << "\n";
  os << indent << "NumberOfIterations: " << this->NumberOfIterations << "\n";
  os << indent << "Residual: " << this->Residual << "\n";
  os << indent << "NumberOfStepsComputed: " << this->NumberOfStepsComputed << "\n";
}
