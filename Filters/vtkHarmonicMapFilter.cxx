// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkHarmonicMapFilter.h"

#include "Conversion/PointNormals.h"
#include "Conversion/SurfaceReader.h"
#include "Run/HarmonicMapSettings.h"
#include "Run/InputSentences.h"
#include "vtkSurfaceModelAlgorithmInternals.h"

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

VTK_ABI_NAMESPACE_BEGIN
vtkObjectFactoryNewMacro(vtkHarmonicMapFilter);

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

} // namespace

vtkHarmonicMapFilter::vtkHarmonicMapFilter()
  : Superclass(OwnedSettings::Make<HarmonicMapSettings>())
{
  this->DeclareNumber("MeanDisplacement");
  this->DeclareNumber("MaximumDisplacement");
  this->DeclareNumber("VolumeBefore");
  this->DeclareNumber("VolumeAfter");
  this->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::NORMALS);
}

vtkHarmonicMapFilter::~vtkHarmonicMapFilter() = default;

void vtkHarmonicMapFilter::UsePaperScheme()
{
  this->Superclass::UsePaperScheme();
  this->SetTimeIntegratorToFirstOrder();
  this->SetSchemeToExplicitReaction();
  this->SetConsistentReaction(false);
  this->SetProjectToSphere(true);
  this->SetLineField(false);
  this->SetTangentToToNone();
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
  vtkDataArray* const data = fields.Data.Values;
  return fields.DataAreComputed || data == block->GetPointData()->GetNormals() ||
    data == block->GetCellData()->GetNormals();
}

/// The normals of a block without any, computed again only if its surface has changed.
vtkDataArray* vtkHarmonicMapFilter::FindComputedNormals(vtkPolyData* block)
{
  auto& known = this->State->Normals;
  const Fingerprint version = FingerprintSurface(block, nullptr);
  auto found = std::find_if(known.begin(), known.end(),
    [&](const UpdateState::ComputedNormals& normals) { return normals.SurfaceVersion == version; });
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
  fields.ResultIsNormals = this->UseAsNormals && this->IsNormals(fields, block);
  const char* const name = fields.Data.Values->GetName();
  if (this->GetMoveVertices() && !this->IsNormals(fields, block))
  {
    problems.push_back(Say("NoNormals", name ? name : ""));
  }
  return true;
}

/// Moving vertices and computing normals need the whole surface, and so do line fields with missing
/// values, whose initial values depend on the order of their neighbours.
bool vtkHarmonicMapFilter::NeedsWholeSurface(const std::vector<SurfaceBlock>& pieces)
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
      return true;
    }
    InputFields fields;
    Problems reportedLater;
    if (this->GetLineField() && this->FindFields(block, fields, reportedLater) &&
      ((fields.Mask.Values && this->GetMaskMode() == MASK_MODE_INPAINT) ||
        HasZeroOrNaN(fields.Data.Values)))
    {
      return true;
    }
  }
  return false;
}

bool vtkHarmonicMapFilter::SolvesInPieces(
  const std::vector<SurfaceBlock>& pieces, bool oneSurface, double points)
{
  return this->Superclass::SolvesInPieces(pieces, oneSurface, points) &&
    !Processes(this->GetController()).Any(this->NeedsWholeSurface(pieces));
}

void vtkHarmonicMapFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "UseAsNormals: " << (this->UseAsNormals ? "On" : "Off") << "\n";
}
VTK_ABI_NAMESPACE_END
