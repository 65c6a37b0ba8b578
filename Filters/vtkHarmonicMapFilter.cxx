// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkHarmonicMapFilter.h"

#include "Conversion/PointNormals.h"
#include "Conversion/ResultWriter.h"
#include "Conversion/RunState.h"
#include "Conversion/SurfaceReader.h"
#include "Run/HarmonicMapSettings.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>

using namespace SurfaceDiffusion;

vtkStandardNewMacro(vtkHarmonicMapFilter);

namespace
{

/// Whether a vector has no direction.
bool HasZeroOrNaN(vtkDataArray* vectors)
{
  std::vector<double> tuple(vectors->GetNumberOfComponents());
  for (vtkIdType i = 0; i < vectors->GetNumberOfTuples(); ++i)
  {
    vectors->GetTuple(i, tuple.data());
    double sum = 0.0;
    for (const double x : tuple)
    {
      sum += std::abs(x);
    }
    if (!(sum > 0.0))
    {
      return true;
    }
  }
  return false;
}

/// The lengths of the input's vectors, per vertex or per cell.
Vector FindBrightness(const Run::Block& block, const InputFields& fields, bool ofCells)
{
  Fields colours;
  colours.Data = ReadValues(fields.Data);
  if (!fields.DataOnCells)
  {
    return MakePointData(*block.Surface, colours, false, 1.0).Given.rowwise().norm();
  }
  const Vector lengths = colours.Data.rowwise().norm();
  return ofCells
    ? lengths
    : Vector(block.Cells->Transfer.ToVertices(lengths, Vector::Ones(lengths.size())).Of);
}

} // namespace

vtkHarmonicMapFilter::vtkHarmonicMapFilter()
  : Superclass(OwnedSettings::Make<HarmonicMapSettings>())
{
  this->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::NORMALS);
}

vtkHarmonicMapFilter::~vtkHarmonicMapFilter() = default;

void vtkHarmonicMapFilter::UsePaperScheme()
{
  this->Superclass::UsePaperScheme();
  this->SetSchemeToExplicitReaction();
  this->SetConsistentReaction(false);
  this->SetProjectToSphere(true);
  this->SetLineField(false);
  this->SetMoveVertices(false);
}

bool vtkHarmonicMapFilter::UsesNormals()
{
  vtkInformation* asked = this->GetInputArrayInformation(0);
  const char* name =
    asked->Has(vtkDataObject::FIELD_NAME()) ? asked->Get(vtkDataObject::FIELD_NAME()) : nullptr;
  const bool byName = name && *name;
  const bool byOtherAttribute = !name && asked->Has(vtkDataObject::FIELD_ATTRIBUTE_TYPE()) &&
    asked->Get(vtkDataObject::FIELD_ATTRIBUTE_TYPE()) != vtkDataSetAttributes::NORMALS;
  const bool onCells = asked->Has(vtkDataObject::FIELD_ASSOCIATION()) &&
    asked->Get(vtkDataObject::FIELD_ASSOCIATION()) == vtkDataObject::FIELD_ASSOCIATION_CELLS;
  return !byName && !byOtherAttribute && !onCells;
}

bool vtkHarmonicMapFilter::IsNormals(const InputFields& fields, vtkPolyData* block) const
{
  return fields.DataAreComputed || fields.Data == block->GetPointData()->GetNormals() ||
    fields.Data == block->GetCellData()->GetNormals();
}

/// The normals of a block without any, computed again only if its surface has changed.
vtkDataArray* vtkHarmonicMapFilter::FindComputedNormals(vtkPolyData* block)
{
  auto& known = this->State->Normals;
  const Fingerprint version = FingerprintSurface(block, nullptr);
  auto found = std::find_if(known.begin(), known.end(),
    [&](const RunState::ComputedNormals& normals) { return normals.SurfaceVersion == version; });
  if (found == known.end())
  {
    known.push_back({ version, ComputePointNormals(block), true });
    found = known.end() - 1;
  }
  found->Used = true;
  return found->Array;
}

bool vtkHarmonicMapFilter::FindFields(vtkPolyData* block, InputFields& fields, Problems& problems)
{
  // If no other array is requested, the block is read as if it had normals in any case.
  vtkNew<vtkPolyData> withNormals;
  withNormals->ShallowCopy(block);
  vtkSmartPointer<vtkDataArray> normals = block->GetPointData()->GetNormals();
  if (this->UsesNormals())
  {
    fields.DataAreComputed = !normals;
    if (!normals)
    {
      normals = this->FindComputedNormals(block);
    }
    withNormals->GetPointData()->SetNormals(normals);
    withNormals->GetPointData()->SetScalars(normals); // the meaning of an empty name
  }
  if (!this->Superclass::FindFields(withNormals, fields, problems))
  {
    return false;
  }
  const std::string label =
    std::string("InputArray \"") + (fields.Data->GetName() ? fields.Data->GetName() : "") + "\"";
  if (NumberOfDataComponents(fields.Data) < 2)
  {
    problems.push_back(label + " has " + std::to_string(fields.Data->GetNumberOfComponents()) +
      " components; allowed: 2 or more, alpha of colours not counted");
  }
  if (this->GetMoveVertices() && !this->IsNormals(fields, block))
  {
    problems.push_back("MoveVertices is on but " + label +
      " is not the surface's normals; allowed: off, or the active normals of points or cells, or "
      "none, as InputArray");
  }
  return true;
}

/// Moving vertices and computing normals need the whole surface, and so do line fields with missing
/// values, whose initial values depend on the order of their neighbours.
bool vtkHarmonicMapFilter::CanSolveInPieces(const std::vector<SurfaceBlock>& pieces)
{
  for (const SurfaceBlock& piece : pieces)
  {
    vtkPolyData* const block = piece.Input;
    if (block->GetNumberOfPoints() == 0)
    {
      continue;
    }
    if (this->UsesNormals() && !block->GetPointData()->GetNormals())
    {
      return false;
    }
    InputFields fields;
    Problems reportedLater;
    if (this->GetLineField() && this->FindFields(block, fields, reportedLater) &&
      ((fields.Mask && this->GetMaskMode() == MASK_MODE_INPAINT) || HasZeroOrNaN(fields.Data)))
    {
      return false;
    }
  }
  return this->Superclass::CanSolveInPieces(pieces);
}

//------------------------------------------------------------------------------------------------
void vtkHarmonicMapFilter::WriteResult(
  std::size_t index, const InputFields& fields, vtkPolyData* output)
{
  const Run::Block& block = this->State->Run.GetBlock(index);
  vtkNew<vtkPolyData> given;
  given->ShallowCopy(output);
  vtkDataSetAttributes* const data = this->FindResultAttributes(fields, output);
  const bool isNormals = this->IsNormals(fields, output);
  const bool isColour = fields.Data->GetDataType() == VTK_UNSIGNED_CHAR;
  const int type = this->FindResultType(fields);
  const bool onCells = this->HasResultOnCells(fields);
  Values vectors = onCells ? MakeCellResult(*block.Cells, block.Path->State(),
                               ReadValues(fields.Data), this->GetKeepCellDetail())
                           : block.Path->State();
  if (type == VTK_UNSIGNED_CHAR)
  {
    vectors.array().colwise() *= FindBrightness(block, fields, onCells).array();
  }
  const std::string name = this->FindResultName(fields);
  this->AddResult(onCells
      ? WriteCellArray(*block.Cells, fields.Data, vectors, type, name)
      : WritePointArray(*block.Surface, fields.Data, fields.DataOnCells, vectors, 1.0, type, name),
    fields, data);
  const bool isVector = fields.Data->GetNumberOfComponents() == 3 && !isColour;
  int attribute = isVector ? vtkDataSetAttributes::VECTORS : vtkDataSetAttributes::SCALARS;
  if (isNormals && this->UseAsNormals)
  {
    attribute = vtkDataSetAttributes::NORMALS; // only these: ParaView shades with no vectors
  }
  data->SetActiveAttribute(name.c_str(), attribute);
  if (block.Result.MovedPoints.rows() > 0)
  {
    output->SetPoints(WritePoints(block.Result.MovedPoints, output->GetPoints()));
    UpdateNormals(given, output);
  }
}

/// Other normals than the active ones are not gathered.
void vtkHarmonicMapFilter::CompletePiece(const SurfaceBlock& piece)
{
  this->Superclass::CompletePiece(piece);
  if (piece.Output->GetPoints() != piece.Input->GetPoints())
  {
    DropNormals(piece.Input, piece.Output);
  }
}

void vtkHarmonicMapFilter::TakeResults()
{
  this->Superclass::TakeResults();
  auto& normals = this->State->Normals;
  normals.erase(std::remove_if(normals.begin(), normals.end(),
                  [](const RunState::ComputedNormals& computed) { return !computed.Used; }),
    normals.end());
  for (RunState::ComputedNormals& computed : normals)
  {
    computed.Used = false; // until the next update
  }
  VertexMotion all;
  double allAreas = 0.0;
  for (std::size_t b = 0; b < this->State->Run.NumberOfBlocks(); ++b)
  {
    const Run::Block& block = this->State->Run.GetBlock(b);
    const VertexMotion& motion = block.Result.Motion;
    const TriangleMesh& mesh = block.Surface->InputMesh();
    const double area = mesh.ControlAreas().sum() * mesh.LengthUnit() * mesh.LengthUnit();
    allAreas += area;
    if (allAreas > 0.0)
    {
      all.MeanDisplacement += (motion.MeanDisplacement - all.MeanDisplacement) * (area / allAreas);
    }
    all.MaximumDisplacement = std::max(all.MaximumDisplacement, motion.MaximumDisplacement);
    all.VolumeBefore += motion.VolumeBefore;
    all.VolumeAfter += motion.VolumeAfter;
  }
  this->MeanDisplacement = all.MeanDisplacement;
  this->MaximumDisplacement = all.MaximumDisplacement;
  this->VolumeBefore = all.VolumeBefore;
  this->VolumeAfter = all.VolumeAfter;
}

void vtkHarmonicMapFilter::VisitReported(const std::function<void(double&)>& visit)
{
  this->Superclass::VisitReported(visit);
  visit(this->MeanDisplacement);
  visit(this->MaximumDisplacement);
  visit(this->VolumeBefore);
  visit(this->VolumeAfter);
}

void vtkHarmonicMapFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "UseAsNormals: " << (this->UseAsNormals ? "On" : "Off") << "\n";
  os << indent << "MeanDisplacement: " << this->MeanDisplacement << "\n";
  os << indent << "MaximumDisplacement: " << this->MaximumDisplacement << "\n";
  os << indent << "VolumeBefore: " << this->VolumeBefore << "\n";
  os << indent << "VolumeAfter: " << this->VolumeAfter << "\n";
}
