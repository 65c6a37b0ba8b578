// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceModelAlgorithm.h"

#include "Conversion/InputArrays.h"
#include "Conversion/NewArray.h"
#include "Conversion/PieceRefinement.h"
#include "Conversion/ResultWriter.h"
#include "Distributed/CellFlags.h"
#include "Run/BlockSentences.h"
#include "Run/Collective.h"
#include "Run/InputSentences.h"
#include "vtkSurfaceFilterInternals.h"
#include "vtkSurfaceModelAlgorithmInternals.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <map>
#include <utility>

using namespace SurfaceDiffusion;

VTK_ABI_NAMESPACE_BEGIN
namespace
{

/// A surface with at most this many points takes one process at most 25 ms more than several, which
/// gathering takes, and less if there are twenty steps or more (Filters/DISTRIBUTED.md). Its results
/// have the same bits for any pieces.
constexpr double MaxGatheredPoints = 1e4;

const std::vector<const char*> WordsOfPrecision = { "Single", "Double", "Input" };

constexpr int DirectionIndex = 2;

/// Where there is no direction, diffusion is isotropic.
void ReplaceAbsentDirections(InputFields& fields)
{
  if (std::any_of(fields.Absent.begin(), fields.Absent.end(),
        [](const AbsentArray& array) { return array.Index == DirectionIndex; }))
  {
    fields.NoDirection = NewArray<vtkDoubleArray>("", 3, fields.Surface->GetNumberOfPoints());
    fields.NoDirection->Fill(0.0);
    fields.Direction.Values = fields.NoDirection;
  }
}

} // namespace

vtkSurfaceModelAlgorithm::vtkSurfaceModelAlgorithm(OwnedSettings settings)
  : Superclass(std::move(settings))
  , State(std::make_unique<UpdateState>())
{
  this->SetNumberOfOutputPorts(2);
  for (const char* const name :
    { "ValueRange", "NumberOfIterations", "Residual", "NumberOfUnusedPoints" })
  {
    this->DeclareNumber(name);
  }
  this->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS_THEN_CELLS, vtkDataSetAttributes::SCALARS);
}

vtkSurfaceModelAlgorithm::~vtkSurfaceModelAlgorithm() = default;

RunSettings& vtkSurfaceModelAlgorithm::GetRunSettings() const
{
  return static_cast<RunSettings&>(this->GetSettings());
}

const char* vtkSurfaceModelAlgorithm::GetOutputPrecisionAsString()
{
  const bool known = this->OutputPrecision >= 0 && this->OutputPrecision < 3;
  return known ? WordsOfPrecision[this->OutputPrecision] : "Unknown";
}

bool vtkSurfaceModelAlgorithm::FindFields(
  vtkPolyData* block, InputFields& fields, Problems& problems)
{
  const InputArrays inputs(this, block, fields, problems);
  fields.Data = inputs.Find(0, "InputArray", InputArrays::AnyNumberOfComponents);
  fields.Mask = inputs.Find(1, "MaskArray", 1);
  fields.Direction = inputs.Find(2, "DirectionArray", 3);
  fields.Fixed = inputs.Find(3, "FixedArray", 1);
  return fields.Data.Values != nullptr;
}

//------------------------------------------------------------------------------------------------
int vtkSurfaceModelAlgorithm::FillOutputPortInformation(int port, vtkInformation* info)
{
  // The executive makes the objects of ports 1 and 2, and RequestDataObject() that of port 0.
  const char* const types[] = { "vtkDataObject", "vtkTable", "vtkPolyData" };
  info->Set(vtkDataObject::DATA_TYPE_NAME(), types[port]);
  return 1;
}

int vtkSurfaceModelAlgorithm::RequestData(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkTable* const table = vtkTable::GetData(outputs, 1);
  table->Initialize();
  vtkPolyData* const curves =
    this->GetNumberOfOutputPorts() > 2 ? vtkPolyData::GetData(outputs, 2) : nullptr;
  if (curves)
  {
    curves->Initialize();
  }
  UpdateState& state = *this->State;
  state.Settings = std::static_pointer_cast<RunSettings>(this->Private->Properties.Copy());
  state.SettingProblems.clear(); // reported with those of the arrays
  state.Settings->Check(nullptr, state.SettingProblems);
  const int result = this->Superclass::RequestData(request, inputs, outputs);
  if (state.Table) // the update has succeeded
  {
    table->ShallowCopy(state.Table);
    if (curves)
    {
      curves->ShallowCopy(state.Curves);
    }
  }
  state.Table = nullptr;
  state.Curves = nullptr;
  state.History = History();
  return result;
}

void vtkSurfaceModelAlgorithm::ReleaseCache()
{
  this->Superclass::ReleaseCache();
  UpdateState& state = *this->State;
  state.Run.Clear();
  state.Inputs = BlockInputs();
  state.Normals = {};
}

bool vtkSurfaceModelAlgorithm::SolvesInPieces(
  const std::vector<SurfaceBlock>&, bool oneSurface, double points)
{
  const RunSettings& settings = this->GetRunSettings();
  const ModelTraits traits = settings.DescribeModel();
  return traits.CanBeDistributed && !settings.IntrinsicDelaunay &&
    !settings.MergeCoincidentPoints && traits.Solver != SolverMethod::Direct && oneSurface &&
    points > 0.0 && (traits.Solver != SolverMethod::Automatic || points > MaxGatheredPoints);
}

//------------------------------------------------------------------------------------------------
void vtkSurfaceModelAlgorithm::ProcessSurfaces(
  const std::vector<SurfaceBlock>& blocks, const ProgressMonitor& progress)
{
  UpdateState& state = *this->State;
  const Reduction& processes = this->GetProcesses();
  Problems problems = state.SettingProblems;
  this->CheckSurfaceProperties(problems);
  Require(this->OutputPrecision >= 0 && this->OutputPrecision < 3, Word::Setting("OutputPrecision"),
    this->OutputPrecision, ListChoices("OutputPrecision", WordsOfPrecision), problems);

  std::vector<SurfaceBlock> surfaces;
  std::vector<InputFields> fields;
  this->FindAllFields(this->SelectSurfaces(blocks, problems), surfaces, fields, problems);
  if (this->ReportProblems(problems))
  {
    return;
  }
  try
  {
    NamingSettings(*state.Settings,
      [&]
      {
        state.Run.Update(
          this->MakeInputs(fields), state.Settings, processes, progress.Part(0.0, 0.25));
        progress.Report(0.25);
        double found = 0.25;
        state.Step = state.Settings->DescribeModel().NumberOfSteps;
        if (state.ChooseStep)
        {
          found = state.Settings->DescribeModel().MayEndEarly ? 0.65 : found;
          state.Step = state.ChooseStep(state.Run.FindLastStep(progress.Part(0.25, found)));
        }
        // If at most one step is left to do, writing the result is much of the work.
        const double written = state.Run.NumberOfStepsTo(state.Step) > 1 ? 0.95 : 0.7;
        state.Run.Seek(state.Step, progress.Part(found, written));
        progress.Report(written);
      });
    this->BeginWriting();
    this->WriteResults(surfaces, fields);
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
  RunCollectively(processes, [&] { this->MakeTables(); });
  this->TakeNumbers();
  state.ForgetUnusedNormals();
  std::vector<Warning> warnings = state.Run.FindWarnings(processes);
  if (!state.ReplacedArrays.empty())
  {
    warnings.push_back({ DescribeReplacement(state.ReplacedArrays), Fingerprint() });
  }
  for (const auto* const sentences : { &state.InputWarnings, &state.TimeWarnings })
  {
    for (const Sentence& sentence : *sentences)
    {
      warnings.push_back({ sentence, Fingerprint() });
    }
  }
  this->ReportWarnings(std::move(warnings));
}

/// The outputs beside the surface, in process 0.
void vtkSurfaceModelAlgorithm::MakeTables()
{
  if (this->GetProcesses().Rank() != 0)
  {
    return;
  }
  UpdateState& state = *this->State;
  std::vector<const OutputList*> outputs;
  for (std::size_t b = 0; b < state.Run.NumberOfBlocks(); ++b)
  {
    outputs.push_back(&state.Run.GetBlock(b).Outputs);
  }
  vtkNew<vtkTable> table;
  if (!WriteColumns(outputs, table))
  {
    WriteHistory(state.History, table);
  }
  vtkNew<vtkPolyData> curves;
  if (this->GetNumberOfOutputPorts() > 2)
  {
    WriteCurves(outputs, this->ResultArrayName, curves);
  }
  state.Table = table;
  state.Curves = curves;
}

void vtkSurfaceModelAlgorithm::WriteResults(
  const std::vector<SurfaceBlock>& surfaces, const std::vector<InputFields>& fields)
{
  UpdateState& state = *this->State;
  const Reduction& processes = this->GetProcesses();
  state.ReplacedArrays.clear();
  RunCollectively(processes,
    [&]
    {
      for (std::size_t b = 0; b < surfaces.size(); ++b)
      {
        if (processes.IsSerial() || surfaces[b].Input->GetNumberOfPoints() > 0)
        {
          this->WriteResult(b, fields[b], surfaces[b].Output);
        }
      }
    });
  this->WriteFidelityWeights(surfaces);
  for (std::size_t b = 0; !processes.IsSerial() && b < surfaces.size(); ++b)
  {
    state.Inputs.GetDecomposition()->UpdateCopies(
      surfaces[b].Input->GetPointData(), surfaces[b].Output->GetPointData());
  }
}

/// If blocks have different weights, which AutomaticFidelity finds, each has its own as field data.
void vtkSurfaceModelAlgorithm::WriteFidelityWeights(const std::vector<SurfaceBlock>& surfaces)
{
  const auto weightOf = [&](std::size_t b)
  {
    return SurfaceDiffusion::FindNumber(
      this->State->Run.GetBlock(b).Outputs, "EffectiveFidelityWeight");
  };
  bool differ = false;
  for (std::size_t b = 1; b < surfaces.size(); ++b)
  {
    differ = differ || weightOf(b) != weightOf(0);
  }
  const std::string name = this->ResultArrayName + "EffectiveFidelityWeight";
  for (std::size_t b = 0; differ && b < surfaces.size(); ++b)
  {
    vtkFieldData* const data = surfaces[b].Output->GetFieldData();
    if (data->HasArray(name.c_str()))
    {
      this->State->ReplacedArrays.push_back(name);
    }
    const auto weight = NewArray<vtkDoubleArray>(name, 1, 1);
    weight->SetValue(0, weightOf(b));
    data->AddArray(weight);
  }
}

/// The surfaces with data, their fields, and the problems of both. Blocks without data pass through
/// if at least one block has data.
void vtkSurfaceModelAlgorithm::FindAllFields(const std::vector<SurfaceBlock>& blocks,
  std::vector<SurfaceBlock>& surfaces, std::vector<InputFields>& fields, Problems& problems)
{
  BlockSentences problemsOfData, problemsOfBlocks;
  std::vector<Problems> found;
  for (const SurfaceBlock& block : blocks)
  {
    InputFields arrays;
    arrays.Surface = block.Input;
    arrays.Name = block.Name;
    Problems here;
    const bool takesPart = !this->GetProcesses().IsSerial() &&
      block.Input->GetNumberOfPoints() == 0; // in collective calls
    if (takesPart || this->FindFields(block.Input, arrays, here))
    {
      arrays.GlobalIds = block.Input->GetPointData()->GetGlobalIds();
      if (this->GetRefineTo() != 0.0)
      {
        arrays.Between = block.Input->GetPointData()->GetArray(PieceRefinement::BetweenName);
        arrays.GivenCells = block.Input->GetCellData()->GetArray(PieceRefinement::GivenCellsName);
      }
      surfaces.push_back(block);
      fields.push_back(arrays);
      found.push_back(here);
      continue;
    }
    for (const AbsentArray& array : arrays.Absent)
    {
      here.push_back(array.Problem);
    }
    problemsOfData.Add(here, block.Name);
  }
  std::vector<Sentence>& warnings = this->State->InputWarnings;
  warnings.clear();
  problemsOfData.AppendTo(warnings, blocks.size());
  if (surfaces.empty())
  {
    problems.insert(problems.end(), warnings.begin(), warnings.end());
    return;
  }
  for (Sentence& warning : warnings)
  {
    warning = Say("BlockPasses", warning);
  }
  const std::size_t before = problems.size();
  SettleAbsence(fields, problems, warnings);
  const bool allAreFound = problems.size() == before;
  for (std::size_t b = 0; b < surfaces.size(); ++b)
  {
    ReplaceAbsentDirections(fields[b]);
    // An array that is not found would be reported as not set, too.
    if (found[b].empty() && allAreFound && surfaces[b].Input->GetNumberOfPoints() > 0)
    {
      const FieldSummary summary = fields[b].Summarize();
      this->State->Settings->Check(&summary, found[b]);
    }
    problemsOfBlocks.Add(found[b], fields[b].Name);
  }
  problemsOfBlocks.AppendTo(problems, surfaces.size());
}

std::vector<BlockInput> vtkSurfaceModelAlgorithm::MakeInputs(
  const std::vector<InputFields>& surfaces)
{
  const bool excludes = this->GetMaskMode() == MASK_MODE_EXCLUDE;
  return !this->GetProcesses().IsSerial()
    ? this->State->Inputs.MakeOfPieces(surfaces, excludes, this->SeamTolerance,
        this->GetController(), this->Private->AbortRequested)
    : this->State->Inputs.Make(surfaces, excludes);
}

void vtkSurfaceModelAlgorithm::WriteResult(
  std::size_t index, const InputFields& fields, vtkPolyData* output)
{
  UpdateState& state = *this->State;
  const Run::Block& block = state.Run.GetBlock(index);
  OutputSource source{ *block.Surface, SMPParallelFor::Instance() };
  source.NumberOfCells = output->GetNumberOfCells();
  source.CellOf = [&cells = state.Inputs.CellsOf(index)](Index t)
  { return cells[static_cast<std::size_t>(t)]; };
  const int type = this->FindResultType(fields);
  if (vtkDataArray* const data = fields.Data.Values)
  {
    source.ReadData = [data] { return ReadValues(data); };
    source.DataAreFloats = data->GetDataType() == VTK_FLOAT || data->GetDataType() == VTK_DOUBLE;
    source.AsBytes = type == VTK_UNSIGNED_CHAR;
  }
  source.Block = &block;
  source.Traits = state.Settings->DescribeModel();
  WriteOutputs(block.Outputs, source,
    { output, fields, this->ResultArrayName, type, fields.Data.Values, state.ReplacedArrays });
}

/// Vertices, lines and hidden cells keep their value, as those of a surface in one piece do.
void vtkSurfaceModelAlgorithm::CompletePiece(const SurfaceBlock& piece)
{
  const auto isNew = [&](int array)
  {
    vtkAbstractArray* const after = piece.Output->GetCellData()->GetAbstractArray(array);
    return piece.Input->GetCellData()->GetAbstractArray(after->GetName()) != after;
  };
  bool hasNew = false;
  for (int a = 0; a < piece.Output->GetCellData()->GetNumberOfArrays(); ++a)
  {
    hasNew = hasNew || isNew(a);
  }
  InputFields fields;
  Problems reportedAlready;
  if (!hasNew || !this->FindFields(piece.Input, fields, reportedAlready) || !fields.Data.OnCells ||
    !this->GetRunSettings().DescribeModel().ResultOnCells)
  {
    return;
  }
  const char* const name = fields.Data.Values->GetName();
  const std::string resultName = this->ResultArrayName.empty()
    ? (name ? name : "") + std::string(this->GetRunSettings().DescribeModel().ResultSuffix)
    : this->ResultArrayName;
  vtkDataArray* const result = piece.Output->GetCellData()->GetArray(resultName.c_str());
  if (!result || result == fields.Data.Values)
  {
    return;
  }
  const std::vector<unsigned char> flags = FindCellFlags(piece.Input);
  const vtkIdType polygons = piece.Input->GetNumberOfVerts() + piece.Input->GetNumberOfLines();
  for (vtkIdType c = 0; c < result->GetNumberOfTuples(); ++c)
  {
    const bool isHidden = !flags.empty() &&
      (flags[static_cast<std::size_t>(c)] & vtkDataSetAttributes::HIDDENCELL) != 0;
    for (int k = 0; (c < polygons || isHidden) && k < result->GetNumberOfComponents(); ++k)
    {
      result->SetComponent(c, k, fields.Data.Values->GetComponent(c, k));
    }
  }
}

int vtkSurfaceModelAlgorithm::FindResultType(const InputFields& fields) const
{
  const bool likeData = this->OutputPrecision == OUTPUT_PRECISION_INPUT && fields.Data.Values;
  const int inputType = likeData ? fields.Data.Values->GetDataType() : VTK_DOUBLE;
  if (inputType == VTK_UNSIGNED_CHAR || inputType == VTK_FLOAT)
  {
    return inputType;
  }
  return this->OutputPrecision == OUTPUT_PRECISION_SINGLE ? VTK_FLOAT : VTK_DOUBLE;
}

void vtkSurfaceModelAlgorithm::TakeNumbers()
{
  const UpdateState& state = *this->State;
  this->Private->Numbers.Set(FindNumbers(state.Run, state.History, this->GetProcesses()));
}

void vtkSurfaceModelAlgorithm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "OutputPrecision: " << this->GetOutputPrecisionAsString() << "\n";
}
VTK_ABI_NAMESPACE_END
