// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceDiffusionAlgorithm.h"

#include "Conversion/EnumText.h"
#include "Conversion/Execution.h"
#include "Conversion/InputArrays.h"
#include "Conversion/PointArrays.h"
#include "Conversion/SurfaceRun.h"
#include "Distributed/DistributedSolver.h"
#include "Distributed/GatheredSurfaces.h"
#include "Distributed/Processes.h"
#include "Distributed/SurfacePieces.h"

#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTable.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

using namespace SurfaceDiffusion;

namespace
{

using Pipeline = vtkStreamingDemandDrivenPipeline;

/// The history has a row for each.
constexpr int LargestNumberOfTimeSteps = 1000000000;

/// More published times than this are a mistake: each is a number the whole pipeline carries.
constexpr double LargestNumberOfPublishedTimes = 1e6;

/// Surfaces of up to this many points one process solves as fast, in less than a GiB.
constexpr double FewPoints = 1e6;

} // namespace

vtkSurfaceDiffusionAlgorithm::vtkSurfaceDiffusionAlgorithm()
{
  this->SetNumberOfOutputPorts(2);
  this->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::SCALARS);
  this->SetController(vtkMultiProcessController::GetGlobalController());
  this->HasWholeSurface = false; // unless told so
}

vtkSurfaceDiffusionAlgorithm::~vtkSurfaceDiffusionAlgorithm()
{
  this->SetController(nullptr);
}

void vtkSurfaceDiffusionAlgorithm::SetController(vtkMultiProcessController* controller)
{
  if (this->HasWholeSurface != !controller)
  {
    this->HasWholeSurface = !controller;
    this->Modified();
  }
  vtkSetObjectBodyMacro(Controller, vtkMultiProcessController, controller);
}

const char* vtkSurfaceDiffusionAlgorithm::GetUnitsAsString()
{
  return EnumText(this->Units, { "Natural", "Absolute" });
}

const char* vtkSurfaceDiffusionAlgorithm::GetMaskModeAsString()
{
  return EnumText(this->MaskMode, { "Inpaint", "Exclude" });
}

const char* vtkSurfaceDiffusionAlgorithm::GetInitialFillAsString()
{
  return EnumText(this->InitialFill, { "Input", "Mean", "Noise" });
}

const char* vtkSurfaceDiffusionAlgorithm::GetTimeIntegratorAsString()
{
  return EnumText(this->TimeIntegrator, { "FirstOrder", "SecondOrder", "Implicit" });
}

const char* vtkSurfaceDiffusionAlgorithm::GetSolverAsString()
{
  return EnumText(this->Solver, { "Automatic", "Direct", "ConjugateGradient", "Multigrid" });
}

const char* vtkSurfaceDiffusionAlgorithm::GetOutputPrecisionAsString()
{
  return EnumText(this->OutputPrecision, { "Input", "Single", "Double" });
}

void vtkSurfaceDiffusionAlgorithm::UsePaperScheme()
{
  this->SetTimeIntegratorToFirstOrder();
  this->SetIntrinsicDelaunay(false);
  this->SetMaskModeToInpaint();
  this->SetHoldKnownValues(false);
  this->SetInitialFillToInput();
}

//------------------------------------------------------------------------------------------------
void vtkSurfaceDiffusionAlgorithm::Require(
  bool holds, const char* property, double value, const char* allowed, Problems& problems)
{
  if (!holds)
  {
    std::ostringstream text;
    text.precision(std::numeric_limits<double>::max_digits10 - 2);
    text << property << " is " << value << "; allowed: " << allowed;
    problems.push_back(text.str());
  }
}

void vtkSurfaceDiffusionAlgorithm::CheckProperties(Problems& problems)
{
  const auto positive = [](double x) { return std::isfinite(x) && x > 0.0; };
  const auto notNegative = [](double x) { return std::isfinite(x) && x >= 0.0; };
  const auto oneOf = [](int value, int count) { return value >= 0 && value < count; };
  const char* const finite = "finite numbers, 0 or more";
  Require(positive(this->TimeStep), "TimeStep", this->TimeStep, "finite numbers above 0", problems);
  Require(this->NumberOfTimeSteps >= 0 && this->NumberOfTimeSteps <= LargestNumberOfTimeSteps,
    "NumberOfTimeSteps", this->NumberOfTimeSteps, "0 to 1000000000", problems);
  Require(this->OutputInterval >= 1, "OutputInterval", this->OutputInterval, "1 or more", problems);
  if (this->GenerateTimeSteps && this->OutputInterval >= 1)
  {
    const double times =
      std::ceil(static_cast<double>(this->GetEffectiveNumberOfTimeSteps()) / this->OutputInterval);
    Require(times <= LargestNumberOfPublishedTimes, "NumberOfTimeSteps / OutputInterval", times,
      "up to 1000000 published times; raise OutputInterval", problems);
  }
  Require(
    notNegative(this->FidelityWeight), "FidelityWeight", this->FidelityWeight, finite, problems);
  Require(notNegative(this->AlongDiffusivity), "AlongDiffusivity", this->AlongDiffusivity, finite,
    problems);
  Require(notNegative(this->AcrossDiffusivity), "AcrossDiffusivity", this->AcrossDiffusivity,
    finite, problems);
  Require(this->Tolerance > 0.0 && this->Tolerance < 1.0, "Tolerance", this->Tolerance,
    "numbers between 0 and 1, ends excluded", problems);
  Require(this->MaximumNumberOfIterations >= 1, "MaximumNumberOfIterations",
    this->MaximumNumberOfIterations, "1 or more", problems);
  Require(
    notNegative(this->MergeTolerance), "MergeTolerance", this->MergeTolerance, finite, problems);
  Require(notNegative(this->SeamTolerance) || this->SeamTolerance == -1.0, "SeamTolerance",
    this->SeamTolerance, "finite numbers, 0 or more, or -1: 1e-6 of the bounding box", problems);
  Require(this->CheckpointMemoryLimit >= 0, "CheckpointMemoryLimit", this->CheckpointMemoryLimit,
    "0 or more MiB", problems);
  Require(oneOf(this->Units, 2), "Units", this->Units, "0 Natural, 1 Absolute", problems);
  Require(oneOf(this->MaskMode, 2), "MaskMode", this->MaskMode, "0 Inpaint, 1 Exclude", problems);
  Require(oneOf(this->InitialFill, 3), "InitialFill", this->InitialFill, "0 Input, 1 Mean, 2 Noise",
    problems);
  Require(oneOf(this->Solver, 4), "Solver", this->Solver,
    "0 Automatic, 1 Direct, 2 ConjugateGradient, 3 Multigrid", problems);
  Require(oneOf(this->OutputPrecision, 3), "OutputPrecision", this->OutputPrecision,
    "0 Input, 1 Single, 2 Double", problems);
}

bool vtkSurfaceDiffusionAlgorithm::FindArrays(
  vtkPolyData* block, BlockArrays& arrays, Problems& problems)
{
  const InputArrays inputs(this, block, problems);
  arrays.Data = inputs.FindOnPoints(0, "InputArray", InputArrays::AnyNumberOfComponents);
  arrays.Mask = inputs.FindOnPoints(1, "MaskArray", 1);
  arrays.Direction = inputs.Find(2, "DirectionArray", 3, arrays.DirectionOnCells);
  arrays.Fixed = inputs.FindOnPoints(3, "FixedArray", 1);
  if (!arrays.Direction && this->AlongDiffusivity != this->AcrossDiffusivity)
  {
    std::ostringstream text;
    text << "AlongDiffusivity is " << this->AlongDiffusivity << " and AcrossDiffusivity is "
         << this->AcrossDiffusivity << " but DirectionArray is not set; allowed: equal values, or "
         << "an array of directions";
    problems.push_back(text.str());
  }
  return arrays.Data != nullptr;
}

void vtkSurfaceDiffusionAlgorithm::WriteRunKey(std::ostream& key)
{
  key << std::hexfloat << this->GetEffectiveTimeStep() << ' '
      << this->GetEffectiveNumberOfTimeSteps() << ' ' << this->Units << ' '
      << this->GenerateTimeSteps << ' ' << this->FidelityWeight << ' ' << this->MaskMode << ' '
      << this->InitialFill << ' ' << this->HoldKnownValues << ' ' << this->RandomSeed << ' '
      << this->AlongDiffusivity << ' ' << this->AcrossDiffusivity << ' ' << this->TimeIntegrator
      << ' ' << this->Solver << ' ' << this->Tolerance << ' ' << this->MaximumNumberOfIterations
      << ' ' << this->CheckpointMemoryLimit << ' ';
}

void vtkSurfaceDiffusionAlgorithm::PrepareData(ModelInput& input)
{
  SurfaceDiffusion::FillMissing(*input.Surface.Mesh, input.Data,
    static_cast<SurfaceDiffusion::InitialFill>(this->InitialFill), this->RandomSeed, input.Ids);
}

void vtkSurfaceDiffusionAlgorithm::WriteResult(
  const SurfaceRun& run, const BlockArrays& arrays, vtkPolyData* output)
{
  vtkPointData* data = output->GetPointData();
  const int index = data->AddArray(WritePointArray(*run.Surface, arrays.Data, run.Path->State(),
    run.Units.ValueUnit, this->FindResultType(arrays), this->FindResultName(arrays)));
  data->SetActiveAttribute(index, vtkDataSetAttributes::SCALARS);
}

std::string vtkSurfaceDiffusionAlgorithm::FindResultName(const BlockArrays& arrays)
{
  if (!this->ResultArrayName.empty())
  {
    return this->ResultArrayName;
  }
  const char* name = arrays.Data->GetName();
  return std::string(name ? name : "") + this->GetResultSuffix();
}

int vtkSurfaceDiffusionAlgorithm::FindResultType(const BlockArrays& arrays)
{
  const int inputType = arrays.Data->GetDataType();
  if (this->OutputPrecision == OUTPUT_PRECISION_INPUT && inputType == VTK_UNSIGNED_CHAR)
  {
    return VTK_UNSIGNED_CHAR;
  }
  const bool single = this->OutputPrecision == OUTPUT_PRECISION_SINGLE ||
    (this->OutputPrecision == OUTPUT_PRECISION_INPUT && inputType == VTK_FLOAT);
  return single ? VTK_FLOAT : VTK_DOUBLE;
}

//------------------------------------------------------------------------------------------------
int vtkSurfaceDiffusionAlgorithm::FillInputPortInformation(int, vtkInformation* info)
{
  // Composite data come as a whole, not block by block: the blocks share their natural units.
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  return 1;
}

int vtkSurfaceDiffusionAlgorithm::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkDataObject" : "vtkTable");
  return 1;
}

vtkTypeBool vtkSurfaceDiffusionAlgorithm::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  if (request->Has(vtkDemandDrivenPipeline::REQUEST_DATA_OBJECT()))
  {
    return this->RequestDataObject(request, inputs, outputs);
  }
  return this->Superclass::ProcessRequest(request, inputs, outputs);
}

int vtkSurfaceDiffusionAlgorithm::RequestDataObject(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  if (!MakeOutputObject(inputs, outputs))
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

std::vector<double> vtkSurfaceDiffusionAlgorithm::PublishedTimes()
{
  std::vector<double> times;
  const int last = this->GetEffectiveNumberOfTimeSteps();
  for (vtkIdType step = 0; step < last; step += this->OutputInterval)
  {
    times.push_back(static_cast<double>(step) * this->GetEffectiveTimeStep());
  }
  times.push_back(last * this->GetEffectiveTimeStep());
  return times;
}

int vtkSurfaceDiffusionAlgorithm::StepAtTime(double time)
{
  const std::vector<double> times = this->PublishedTimes();
  // A time that went through another program's text or sums may have lost its last bits.
  const double slack = 1e-9 * this->GetEffectiveTimeStep();
  const auto after = std::upper_bound(times.begin(), times.end(), time + slack);
  const auto index = static_cast<vtkIdType>(std::max<std::ptrdiff_t>(after - times.begin() - 1, 0));
  return static_cast<int>(
    std::min<vtkIdType>(index * this->OutputInterval, this->GetEffectiveNumberOfTimeSteps()));
}

int vtkSurfaceDiffusionAlgorithm::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  Problems problems;
  this->CheckProperties(problems);
  if (!this->GenerateTimeSteps || !problems.empty())
  {
    return 1; // the input's own times pass through; problems are told at update
  }
  const std::vector<double> times = this->PublishedTimes();
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
    // The time asked for is a diffusion time: it means nothing upstream.
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
  vtkTable::GetData(outputs, 1)->Initialize();
  const std::vector<SurfacePiece> pieces =
    CopyStructure(vtkDataObject::GetData(inputs[0]), vtkDataObject::GetData(outputs, 0));
  if (IsLonePiece(this, inputs, this->Controller, this->HasWholeSurface))
  {
    return 1;
  }
  const Processes processes(this->Controller);
  Problems problems; // process 0 tells them
  this->CheckProperties(problems);
  if (processes.Rank() > 0 && problems.empty())
  {
    this->TakeTime(request, outputs);
  }
  if (processes.Count() > 1 && this->Distributes(processes, pieces))
  {
    this->Gathered.reset();
    vtkNew<vtkPolyData> nothing;
    vtkNew<vtkPolyData> noResult;
    const SurfacePiece none{ 0, nothing, noResult };
    this->Execute({ pieces.empty() ? none : pieces.front() }, &processes, request, outputs);
  }
  else
  {
    UpdateOfPieces(this, processes, pieces, this->SeamTolerance, this->Gathered,
      [&](const std::vector<SurfacePiece>& surfaces)
      { this->Execute(surfaces, nullptr, request, outputs); });
  }
  this->ShareReported();
  return 1;
}

bool vtkSurfaceDiffusionAlgorithm::Distributes(
  const Processes& processes, const std::vector<SurfacePiece>& pieces)
{
  if (!HasDistributedSolver(processes) || this->Solver == SOLVER_DIRECT ||
    this->IntrinsicDelaunay || this->MergeCoincidentPoints ||
    processes.Any(!this->CanBeDistributed(pieces)))
  {
    return false;
  }
  std::vector<double> mine; // surface and points of each piece
  for (const SurfacePiece& piece : pieces)
  {
    mine.push_back(piece.Surface);
    mine.push_back(static_cast<double>(piece.Input->GetNumberOfPoints()));
  }
  const std::vector<double> all = processes.GatherAll(mine);
  bool oneSurface = !processes.Any(pieces.size() > 1);
  double points = 0.0;
  for (std::size_t i = 0; i < all.size(); i += 2)
  {
    oneSurface = oneSurface && all[i] == all[0];
    points += all[i + 1];
  }
  return oneSurface && points > 0.0 && (this->Solver != SOLVER_AUTOMATIC || points > FewPoints);
}

void vtkSurfaceDiffusionAlgorithm::Execute(const std::vector<SurfacePiece>& surfaces,
  const Processes* processes, vtkInformation* request, vtkInformationVector* outputs)
{
  Execution execution(*this, surfaces, processes);
  if (!execution.Check())
  {
    return;
  }
  execution.Run(this->TakeTime(request, outputs), vtkTable::GetData(outputs, 1));
}

/// The step that is asked for; its time is that of the outputs.
int vtkSurfaceDiffusionAlgorithm::TakeTime(vtkInformation* request, vtkInformationVector* outputs)
{
  int step = this->GetEffectiveNumberOfTimeSteps();
  if (this->GenerateTimeSteps)
  {
    const int port = request->Has(vtkDemandDrivenPipeline::FROM_OUTPUT_PORT())
      ? std::max(0, request->Get(vtkDemandDrivenPipeline::FROM_OUTPUT_PORT()))
      : 0;
    vtkInformation* info = outputs->GetInformationObject(port);
    if (info->Has(Pipeline::UPDATE_TIME_STEP()))
    {
      step = this->StepAtTime(info->Get(Pipeline::UPDATE_TIME_STEP()));
    }
    for (const int p : { 0, 1 })
    {
      vtkDataObject::GetData(outputs, p)
        ->GetInformation()
        ->Set(vtkDataObject::DATA_TIME_STEP(), step * this->GetEffectiveTimeStep());
    }
  }
  return step;
}

void vtkSurfaceDiffusionAlgorithm::VisitReported(const std::function<void(double&)>& visit)
{
  visit(this->TimeUnit);
  visit(this->MeanEdgeLength);
  visit(this->ValueRange);
  visit(this->Residual);
  for (vtkIdType* count : { &this->NumberOfIterations, &this->NumberOfStepsComputed })
  {
    auto number = static_cast<double>(*count);
    visit(number);
    *count = static_cast<vtkIdType>(number);
  }
}

/// Give all processes the read-only properties of process 0.
void vtkSurfaceDiffusionAlgorithm::ShareReported()
{
  const Processes processes(this->Controller);
  if (processes.Count() > 1)
  {
    std::vector<double> values;
    this->VisitReported([&](double& value) { values.push_back(value); });
    processes.Broadcast(values.data(), static_cast<vtkIdType>(values.size()));
    auto next = values.begin();
    this->VisitReported([&](double& value) { value = *next++; });
  }
}

//------------------------------------------------------------------------------------------------
void vtkSurfaceDiffusionAlgorithm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "TimeStep: " << this->TimeStep << "\n";
  os << indent << "NumberOfTimeSteps: " << this->NumberOfTimeSteps << "\n";
  os << indent << "Units: " << this->GetUnitsAsString() << "\n";
  os << indent << "GenerateTimeSteps: " << (this->GenerateTimeSteps ? "On" : "Off") << "\n";
  os << indent << "OutputInterval: " << this->OutputInterval << "\n";
  os << indent << "FidelityWeight: " << this->FidelityWeight << "\n";
  os << indent << "MaskMode: " << this->GetMaskModeAsString() << "\n";
  os << indent << "InitialFill: " << this->GetInitialFillAsString() << "\n";
  os << indent << "HoldKnownValues: " << (this->HoldKnownValues ? "On" : "Off") << "\n";
  os << indent << "RandomSeed: " << this->RandomSeed << "\n";
  os << indent << "AlongDiffusivity: " << this->AlongDiffusivity << "\n";
  os << indent << "AcrossDiffusivity: " << this->AcrossDiffusivity << "\n";
  os << indent << "TimeIntegrator: " << this->GetTimeIntegratorAsString() << "\n";
  os << indent << "Solver: " << this->GetSolverAsString() << "\n";
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "MaximumNumberOfIterations: " << this->MaximumNumberOfIterations << "\n";
  os << indent << "IntrinsicDelaunay: " << (this->IntrinsicDelaunay ? "On" : "Off") << "\n";
  os << indent << "MergeCoincidentPoints: " << (this->MergeCoincidentPoints ? "On" : "Off") << "\n";
  os << indent << "MergeTolerance: " << this->MergeTolerance << "\n";
  os << indent << "SeamTolerance: " << this->SeamTolerance << "\n";
  os << indent << "Controller: " << this->Controller << "\n";
  os << indent << "ResultArrayName: " << this->ResultArrayName << "\n";
  os << indent << "OutputPrecision: " << this->GetOutputPrecisionAsString() << "\n";
  os << indent << "CheckpointMemoryLimit: " << this->CheckpointMemoryLimit << "\n";
  os << indent << "TimeUnit: " << this->TimeUnit << "\n";
  os << indent << "MeanEdgeLength: " << this->MeanEdgeLength << "\n";
  os << indent << "ValueRange: " << this->ValueRange << "\n";
  os << indent << "NumberOfIterations: " << this->NumberOfIterations << "\n";
  os << indent << "Residual: " << this->Residual << "\n";
  os << indent << "NumberOfStepsComputed: " << this->NumberOfStepsComputed << "\n";
}
