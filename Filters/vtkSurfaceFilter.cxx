// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceFilter.h"

#include "Conversion/PointNormals.h"
#include "Conversion/RefineTogether.h"
#include "Conversion/ThreadScope.h"
#include "Core/Foundation/ProgressMonitor.h"
#include "Distributed/CellFlags.h"
#include "Distributed/PackedPiece.h"
#include "Distributed/PieceArrays.h"
#include "Distributed/SurfacePieces.h"
#include "Run/BlockSentences.h"
#include "Run/Collective.h"
#include "Run/InputSentences.h"
#include "Run/RunSettings.h"
#include "vtkSurfaceFilterInternals.h"

#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkVersionMacros.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <new>
#include <sstream>
#include <utility>

using namespace SurfaceDiffusion;

VTK_ABI_NAMESPACE_BEGIN
namespace
{

struct MergingSettings : Settings
{
  bool MergeCoincidentPoints = false;
  double MergeTolerance = 0.0;

  void Visit(SettingVisitor& visitor) override
  {
    VisitMerging(visitor, this->MergeCoincidentPoints, this->MergeTolerance);
  }
};

/// Whether polygons or strips take part, by their flags.
bool HasVisibleCells(vtkPolyData* data)
{
  constexpr unsigned char absent =
    vtkDataSetAttributes::DUPLICATECELL | vtkDataSetAttributes::HIDDENCELL;
  const std::vector<unsigned char> flags = FindCellFlags(data);
  return flags.empty() ||
    std::any_of(flags.begin() + data->GetNumberOfVerts() + data->GetNumberOfLines(), flags.end(),
      [](unsigned char flag) { return (flag & absent) == 0; });
}

/// What a filter reads of its inputs, of how many pieces it was asked for one, and when the filter and
/// others of its inputs were modified. (ParaView copies the input for each time.) own: the time of the
/// filter.
Fingerprint FindState(vtkAlgorithm* filter, vtkMTimeType own)
{
  Fingerprint state;
  state.AddNumber(static_cast<std::uint64_t>(own));
  for (int port = 0; port < filter->GetNumberOfInputPorts(); ++port)
  {
    vtkDataObject* const input = filter->GetInputDataObject(port, 0);
    const std::vector<int> surfaces = ListSurfaces(input);
    const std::vector<vtkDataObject*> leaves = ListLeaves(input);
    for (std::size_t i = 0; i < leaves.size(); ++i)
    {
      vtkPolyData* const surface = port == 0 ? vtkPolyData::SafeDownCast(leaves[i]) : nullptr;
      if (surface)
      {
        state.Add(FingerprintPiece(filter, { surfaces[i], surface, nullptr }));
      }
      else
      {
        state.AddNumber(static_cast<std::uint64_t>(leaves[i]->GetMTime()));
      }
    }
  }
  vtkInformation* const asked = filter->GetInputInformation(0, 0);
  state.AddNumber(static_cast<std::uint64_t>(
    asked ? asked->Get(vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_PIECES()) : 0));
  return state;
}

} // namespace

vtkSurfaceFilter::vtkSurfaceFilter()
  : vtkSurfaceFilter(OwnedSettings::Make<MergingSettings>())
{
}

vtkSurfaceFilter::vtkSurfaceFilter(OwnedSettings settings)
  : Private(std::make_unique<Internals>())
{
  this->Private->Properties = std::move(settings);
  this->DeclareNumber("MeanEdgeLength");
  this->SetController(vtkMultiProcessController::GetGlobalController());
  this->HasWholeSurface = false; // only if a user sets null
}

vtkSurfaceFilter::~vtkSurfaceFilter()
{
  this->SetController(nullptr);
}

void vtkSurfaceFilter::SetController(vtkMultiProcessController* controller)
{
  if (this->HasWholeSurface != !controller)
  {
    this->HasWholeSurface = !controller;
    this->Modified();
  }
  vtkSetObjectBodyMacro(Controller, vtkMultiProcessController, controller);
}

Settings& vtkSurfaceFilter::GetSettings() const
{
  return this->Private->Properties.Get();
}

void vtkSurfaceFilter::ShareLoopsFrom(int blocks)
{
  SMPParallelFor::Few = blocks;
}

template <typename T>
void vtkSurfaceFilter::WriteProperty(const char* name, T value)
{
  const SettingChange change = WriteSetting(this->GetSettings(), name, value);
  if (change == SettingChange::Unknown)
  {
    vtkErrorMacro(<< "no setting has the name and the type of the property " << name);
  }
  else if (change == SettingChange::Changed)
  {
    this->Modified();
  }
}

template <typename T>
void vtkSurfaceFilter::ReadProperty(const char* name, T& value) const
{
  if (!ReadSetting(this->GetSettings(), name, value))
  {
    vtkErrorMacro(<< "no setting has the name and the type of the property " << name);
  }
}

template VTKSURFACEDIFFUSION_EXPORT void vtkSurfaceFilter::WriteProperty(const char*, double);
template VTKSURFACEDIFFUSION_EXPORT void vtkSurfaceFilter::WriteProperty(const char*, int);
template VTKSURFACEDIFFUSION_EXPORT void vtkSurfaceFilter::WriteProperty(const char*, bool);
template VTKSURFACEDIFFUSION_EXPORT void vtkSurfaceFilter::ReadProperty(const char*, double&) const;
template VTKSURFACEDIFFUSION_EXPORT void vtkSurfaceFilter::ReadProperty(const char*, int&) const;
template VTKSURFACEDIFFUSION_EXPORT void vtkSurfaceFilter::ReadProperty(const char*, bool&) const;

const char* vtkSurfaceFilter::GetPropertyWord(const char* name) const
{
  return FindWord(this->GetSettings(), name);
}

void vtkSurfaceFilter::CheckSurfaceProperties(Problems& problems)
{
  SurfaceDiffusion::CheckSurfaceProperties(this->SeamTolerance, this->RefineTo,
    this->MayRefineAutomatically(), this->MaximumNumberOfTriangles, this->NumberOfThreads,
    problems);
}

bool vtkSurfaceFilter::SolvesInPieces(const std::vector<SurfaceBlock>&, bool, double)
{
  return false;
}

const Reduction& vtkSurfaceFilter::GetProcesses() const
{
  return this->Private->Processes ? *this->Private->Processes : Reduction::Serial();
}

std::vector<vtkSurfaceFilter::SurfaceBlock> vtkSurfaceFilter::SelectSurfaces(
  const std::vector<SurfaceBlock>& blocks, Problems& problems) const
{
  const Reduction& processes = this->GetProcesses();
  std::vector<SurfaceBlock> selected;
  BlockSentences hidden;
  bool anyPoint = false;
  bool anyPolygon = false;
  bool anyVisible = false;
  for (const SurfaceBlock& block : blocks)
  {
    vtkPolyData* const data = block.Input;
    anyPoint = anyPoint || data->GetNumberOfPoints() > 0;
    const bool polygons =
      data->GetNumberOfPoints() > 0 && data->GetNumberOfPolys() + data->GetNumberOfStrips() > 0;
    anyPolygon = anyPolygon || polygons;
    const bool isVisible = polygons && HasVisibleCells(data);
    anyVisible = anyVisible || isVisible;
    if (polygons && !isVisible)
    {
      hidden.Add(Say("Hidden"), block.Name);
    }
    if (polygons || !processes.IsSerial())
    {
      selected.push_back(block);
    }
  }
  anyPoint = processes.Any(anyPoint);
  anyPolygon = processes.Any(anyPolygon);
  this->Private->HiddenWarnings.clear();
  if (processes.IsSerial() || !processes.Any(anyVisible)) // the pieces are one surface
  {
    hidden.AppendTo(this->Private->HiddenWarnings, selected.size());
  }
  const InputDescription& input = this->Private->Input;
  if (!anyPoint && !input.OtherTypes.empty())
  {
    problems.push_back(
      Say("NoSurface", input.IsComposite ? "the blocks are" : "the input is", input.OtherTypes));
  }
  else if (!anyPolygon)
  {
    problems.push_back(Say(anyPoint ? "NoPolygons" : "Empty"));
  }
  return selected;
}

bool vtkSurfaceFilter::ReportProblems(Problems problems)
{
  std::sort(problems.begin(), problems.end());
  problems.erase(std::unique(problems.begin(), problems.end()), problems.end());
  const std::string text = FirstMessage(this->GetProcesses(), Join(problems).Text());
  if (text.empty())
  {
    return false;
  }
  this->ReportError(text);
  return true;
}

/// Process 0 reports for all.
void vtkSurfaceFilter::ReportError(const std::string& text)
{
  this->Private->HasFailed = true;
  if (this->GetProcesses().Rank() == 0)
  {
    vtkErrorMacro(<< text);
  }
}

void vtkSurfaceFilter::ReportWarnings(std::vector<Warning> warnings)
{
  for (const auto* const sentences :
    { &this->Private->RefinementWarnings, &this->Private->HiddenWarnings })
  {
    for (const Sentence& sentence : *sentences)
    {
      warnings.push_back({ sentence, Fingerprint() });
    }
  }
  const std::vector<Sentence> sentences = this->Private->Reported.Report(std::move(warnings));
  if (!sentences.empty() && this->GetProcesses().Rank() == 0)
  {
    vtkWarningMacro(<< Join(sentences));
  }
}

void vtkSurfaceFilter::BeginWriting()
{
  if (!this->GetProcesses().IsSerial() && this->GetProcesses().Any(*this->Private->AbortRequested))
  {
    throw Aborted();
  }
  if (this->Private->Watch)
  {
    this->Private->Watch->End();
  }
}

bool vtkSurfaceFilter::IsAborted()
{
  bool aborted = this->GetAbortExecute() != 0;
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 20220823)
  aborted = aborted || this->CheckAbort(); // containers and upstream filters, too
  this->SetAbortOutput(false); // the executive would empty the output
#endif
  return aborted;
}

//------------------------------------------------------------------------------------------------
int vtkSurfaceFilter::FillInputPortInformation(int, vtkInformation* info)
{
  // All blocks of composite data are needed: they share natural units or are pieces of a surface.
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  // Other data are an error, whose message says what to do. That of the executive does not.
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
  return 1;
}

int vtkSurfaceFilter::FillOutputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkDataObject");
  return 1;
}

vtkTypeBool vtkSurfaceFilter::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  if (request->Has(vtkDemandDrivenPipeline::REQUEST_DATA_OBJECT()))
  {
    return this->RequestDataObject(request, inputs, outputs);
  }
  return this->Superclass::ProcessRequest(request, inputs, outputs);
}

int vtkSurfaceFilter::RequestDataObject(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  return MakeOutputObject(inputs, outputs) ? 1 : 0;
}

int vtkSurfaceFilter::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  std::vector<SurfacePiece> pieces =
    CopyStructure(vtkDataObject::GetData(inputs[0]), vtkDataObject::GetData(outputs, 0));
  // Asked for another time or piece of the same input, the update would fail again.
  if (this->Private->HasFailed &&
    !Processes(this->Controller)
       .Any(this->Private->FailedWith != FindState(this, this->Superclass::GetMTime())))
  {
    return this->EndUpdate();
  }
  this->Private->HasFailed = false;
  this->Private->Numbers.Set({});
  const std::string alone = DescribeLonePiece(inputs, this->Controller, this->HasWholeSurface);
  if (!alone.empty())
  {
    this->ReportError(alone);
    return this->EndUpdate();
  }
  const Processes processes(this->Controller);
  const std::string disagreement = FindDisagreement(processes, this, pieces);
  if (!disagreement.empty())
  {
    this->Private->HasFailed = true;
    if (processes.Rank() == 0)
    {
      this->ReportError(disagreement);
    }
    return this->EndUpdate();
  }
  this->Private->Input = DescribeInput(vtkDataObject::GetData(inputs[0]));
  const auto toBlocks = [&names = this->Private->Input.SurfaceNames](
                          const std::vector<SurfacePiece>& surfaces)
  {
    std::vector<SurfaceBlock> blocks;
    for (const SurfacePiece& surface : surfaces)
    {
      const auto number = static_cast<std::size_t>(surface.Surface);
      blocks.push_back(
        { surface.Input, surface.Output, number < names.size() ? names[number] : std::string() });
    }
    return blocks;
  };
  if (!this->RefineSurfaces(pieces))
  {
    return this->EndUpdate();
  }
  const PieceSummary summary =
    processes.Count() > 1 ? SummarizePieces(processes, pieces) : PieceSummary();
  this->Private->Processes.reset();
  if (processes.Count() > 1 &&
    this->SolvesInPieces(toBlocks(pieces), summary.OneSurface, summary.NumberOfPoints))
  {
    this->Private->Gathered.reset();
    this->Private->Processes = std::make_unique<ProcessReduction>(this->Controller);
    vtkNew<vtkPolyData> nothing;
    vtkNew<vtkPolyData> noResult;
    std::vector<SurfaceBlock> blocks = toBlocks(pieces);
    if (blocks.empty())
    {
      blocks.push_back({ nothing, noResult });
    }
    this->ProcessGuarded(blocks);
    this->Private->Processes.reset();
  }
  else
  {
    UpdateOfPieces(
      this, processes, pieces, this->SeamTolerance, this->Private->Gathered,
      [&](const std::vector<SurfacePiece>& surfaces) { this->ProcessGuarded(toBlocks(surfaces)); },
      [&](const std::string& text) { this->ReportError(text); });
    for (const SurfaceBlock& piece : toBlocks(pieces))
    {
      if (piece.Output->GetPoints() != piece.Input->GetPoints())
      {
        DropNormals(piece.Input, piece.Output); // others than the active ones are not gathered
      }
      this->CompletePiece(piece);
    }
  }
  this->Private->Numbers.Share(processes);
  if (processes.Any(!this->Private->IsComplete))
  {
    this->Private->Refinement.Undo();
  }
  if (this->GetReleaseDataFlag() != 0 || vtkDataObject::GetGlobalReleaseDataFlag() != 0)
  {
    this->ReleaseCache();
  }
  this->Private->HasFailed = processes.Any(this->Private->HasFailed);
  return this->EndUpdate();
}

double vtkSurfaceFilter::FindRefinement(double, Sentence&) const
{
  return this->RefineTo > 0.0 && std::isfinite(this->RefineTo) ? this->RefineTo : 0.0;
}

/// Bisect long edges. False, in all processes: one was aborted or has failed.
bool vtkSurfaceFilter::RefineSurfaces(std::vector<SurfacePiece>& pieces)
{
  const ProgressMonitor::Callback report = [this](double)
  {
    this->UpdateProgress(0.0);
    return !this->IsAborted();
  };
  RefinementTask task;
  task.NeedsMeanEdgeLength =
    this->RefineTo == RefineAutomatically && this->MayRefineAutomatically();
  task.MaximumNumberOfTriangles = this->MaximumNumberOfTriangles;
  const auto nameAt = [this](int index) -> std::string
  {
    vtkInformation* const array = this->GetInputArrayInformation(index);
    return array->Has(vtkDataObject::FIELD_NAME()) ? array->Get(vtkDataObject::FIELD_NAME()) : "";
  };
  task.Rules = { nameAt(1), nameAt(5), {} };
  for (const int marks : this->ArraysOfMarks())
  {
    task.Rules.Marks.push_back(nameAt(marks));
  }
  task.FindLength = [this](double meanEdgeLength, Sentence& explanation)
  { return this->FindRefinement(meanEdgeLength, explanation); };
  task.Complete = [this](const std::function<void()>& step)
  { return this->CompleteTogether(step); };
  const Processes processes(this->Controller);
  this->Private->RefinementWarnings.clear();
  this->Private->IsComplete = true;
  const bool completed = RefineTogether(this->Private->Refinement, pieces, task, processes,
    ProgressMonitor(report), this->Private->RefinementWarnings);
  if (!completed)
  {
    this->Private->HasFailed = processes.Any(this->Private->HasFailed);
  }
  return completed;
}

/// Whether all processes have completed a step. An error is reported, an abort is none.
bool vtkSurfaceFilter::CompleteTogether(const std::function<void()>& step)
{
  bool completed = false;
  try
  {
    step();
    completed = true;
  }
  catch (const Aborted&)
  {
  }
  catch (const std::bad_alloc&)
  {
    this->ReportError(OutOfMemoryMessage);
  }
  catch (const std::exception& error)
  {
    this->ReportError(error.what());
  }
  return !Processes(this->Controller).Any(!completed);
}

/// The answer to the pipeline: 0 if the update has failed.
int vtkSurfaceFilter::EndUpdate()
{
  const bool failed = this->Private->HasFailed;
  this->SetErrorCode(failed ? vtkErrorCode::UserError : vtkErrorCode::NoError);
  if (failed)
  {
    this->Private->QuietExecutive(this->GetExecutive());
    this->Private->FailedWith = FindState(this, this->Superclass::GetMTime());
  }
  return failed ? 0 : 1;
}

vtkMTimeType vtkSurfaceFilter::GetMTime()
{
  vtkMTimeType time = this->Superclass::GetMTime();
  for (int port = 0; this->Private->HasFailed && port < this->GetNumberOfInputPorts(); ++port)
  {
    for (vtkDataObject* const data : ListLeaves(this->GetInputDataObject(port, 0)))
    {
      time = std::max(time, data->GetMTime());
    }
  }
  return time;
}

void vtkSurfaceFilter::ReleaseCache()
{
  this->Private->Gathered.reset();
  this->Private->Refinement = PieceRefinement();
}

void vtkSurfaceFilter::ProcessGuarded(const std::vector<SurfaceBlock>& blocks)
{
  double reported = 0.0;
  *this->Private->AbortRequested = false;
  const bool shared = !this->GetProcesses().IsSerial();
  const ProgressMonitor::Callback callback = [&](double fraction)
  {
    reported = std::max(reported, fraction);
    this->UpdateProgress(reported);
    *this->Private->AbortRequested = *this->Private->AbortRequested || this->IsAborted();
    return shared || !*this->Private->AbortRequested; // together with the others, or at once
  };
  LoopWatch watch([&] { return callback(reported); });
  this->Private->Watch = &watch;
  std::string failure;
  bool completed = false;
  try
  {
    const ThreadScope threads(this->NumberOfThreads, Processes(this->Controller).Count() > 1);
    this->ProcessSurfaces(blocks, ProgressMonitor(callback));
    this->UpdateProgress(1.0);
    completed = true;
  }
  catch (const Aborted&)
  {
    // The output is the unchanged input. Completed parts of the run are kept for the next update.
  }
  catch (const std::bad_alloc&)
  {
    failure = OutOfMemoryMessage;
  }
  catch (const std::exception& error)
  {
    failure = error.what();
  }
  this->Private->Watch = nullptr;
  this->Private->IsComplete = completed && !this->Private->HasFailed && failure.empty();
  if (!completed)
  {
    for (const SurfaceBlock& block : blocks) // some may have been written already
    {
      block.Output->ShallowCopy(block.Input);
    }
  }
  if (!failure.empty())
  {
    this->ReportError(failure);
  }
}

void vtkSurfaceFilter::CompletePiece(const SurfaceBlock&) {}

void vtkSurfaceFilter::DeclareNumber(const char* name, double byDefault)
{
  this->Private->Numbers.Declare(name, byDefault);
}

double vtkSurfaceFilter::FindNumber(const char* name, int row, int column) const
{
  return this->Private->Numbers.Find(name, row, column);
}

void vtkSurfaceFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  std::ostringstream spaces;
  spaces << indent;
  os << Describe(this->GetSettings(), spaces.str());
  os << indent << "SeamTolerance: " << this->SeamTolerance << "\n";
  os << indent << "RefineTo: " << this->RefineTo << "\n";
  os << indent << "MaximumNumberOfTriangles: " << this->MaximumNumberOfTriangles << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "Controller: " << this->Controller << "\n";
  os << indent << "ResultArrayName: " << this->ResultArrayName << "\n";
  for (const auto& [name, byDefault] : this->Private->Numbers.Declared())
  {
    os << indent << name << ": " << this->FindNumber(name.c_str()) << "\n";
  }
}
VTK_ABI_NAMESPACE_END
