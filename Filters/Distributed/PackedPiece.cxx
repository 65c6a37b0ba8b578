// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/PackedPiece.h"

#include "vtkAlgorithm.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkTypeInt64Array.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cstring>
#include <tuple>

namespace SurfaceDiffusion
{

namespace
{

/// The active attributes that the filter reads: those of its defaults, and those that the user has
/// selected as input arrays.
std::vector<int> FindReadAttributes(vtkAlgorithm* filter)
{
  std::vector<int> types = { vtkDataSetAttributes::SCALARS, vtkDataSetAttributes::VECTORS,
    vtkDataSetAttributes::NORMALS };
  vtkInformationVector* const infos =
    filter->GetInformation()->Get(vtkAlgorithm::INPUT_ARRAYS_TO_PROCESS());
  for (int i = 0; infos && i < infos->GetNumberOfInformationObjects(); ++i)
  {
    vtkInformation* const info = infos->GetInformationObject(i);
    const int type = info->Has(vtkDataObject::FIELD_ATTRIBUTE_TYPE())
      ? info->Get(vtkDataObject::FIELD_ATTRIBUTE_TYPE())
      : types.front();
    if (std::find(types.begin(), types.end(), type) == types.end())
    {
      types.push_back(type);
    }
  }
  return types;
}

/// Whether the user has selected the array as one of the filter's input arrays.
bool IsSelected(vtkAlgorithm* filter, vtkAbstractArray* array)
{
  vtkInformationVector* const infos =
    filter->GetInformation()->Get(vtkAlgorithm::INPUT_ARRAYS_TO_PROCESS());
  for (int i = 0; infos && i < infos->GetNumberOfInformationObjects(); ++i)
  {
    vtkInformation* const info = infos->GetInformationObject(i);
    const char* const name =
      info->Has(vtkDataObject::FIELD_NAME()) ? info->Get(vtkDataObject::FIELD_NAME()) : nullptr;
    if (name && array->GetName() && std::strcmp(name, array->GetName()) == 0)
    {
      return true;
    }
  }
  return false;
}

bool IsActive(
  const std::vector<int>& types, vtkDataSetAttributes* attributes, vtkAbstractArray* array)
{
  return std::any_of(types.begin(), types.end(),
    [&](int type) { return attributes->GetAbstractAttribute(type) == array; });
}

/// An array that keeps its values on the way to process 0: the data objects that a controller
/// sends hold vtkIdType in 32 bits.
vtkSmartPointer<vtkAbstractArray> MakePackedArray(vtkAbstractArray* array, vtkIdType count)
{
  if (!vtkIdTypeArray::SafeDownCast(array))
  {
    return MakeSimilarArray(array, count);
  }
  auto made = vtkSmartPointer<vtkTypeInt64Array>::New();
  made->SetName(array->GetName());
  made->SetNumberOfComponents(array->GetNumberOfComponents());
  made->SetNumberOfTuples(count);
  return made;
}

/// Tuples first .. first + count of the arrays that the filter reads.
void PackAttributes(vtkAlgorithm* filter, vtkDataSetAttributes* from, vtkIdType first,
  vtkIdType count, vtkDataSetAttributes* to)
{
  const std::vector<int> types = FindReadAttributes(filter);
  for (int a = 0; a < from->GetNumberOfArrays(); ++a)
  {
    vtkAbstractArray* const array = from->GetAbstractArray(a);
    if ((!IsSelected(filter, array) && !IsActive(types, from, array)) ||
      array->GetNumberOfTuples() < first + count)
    {
      continue;
    }
    const auto copy = MakePackedArray(array, count);
    copy->InsertTuples(0, count, first, array);
    const int index = to->AddArray(copy);
    for (const int type : types)
    {
      if (from->GetAbstractAttribute(type) == array)
      {
        to->SetActiveAttribute(index, type);
      }
    }
  }
}

/// The names of all arrays that results may replace. The surface has no flags of ghosts.
vtkSmartPointer<vtkStringArray> PackNames(const char* name, vtkDataSetAttributes* attributes)
{
  auto names = vtkSmartPointer<vtkStringArray>::New();
  names->SetName(name);
  for (int a = 0; a < attributes->GetNumberOfArrays(); ++a)
  {
    const char* const arrayName = attributes->GetAbstractArray(a)->GetName();
    if (arrayName && strcmp(arrayName, vtkDataSetAttributes::GhostArrayName()) != 0)
    {
      names->InsertNextValue(arrayName);
    }
  }
  return names;
}

template <typename Array>
void PackCellArray(const char* name, vtkDataArray* array, vtkIdType first, vtkPolyData* packed)
{
  vtkNew<Array> part;
  part->SetName(name);
  part->InsertTuples(0, packed->GetNumberOfCells(), first, array);
  packed->GetCellData()->AddArray(part);
}

} // namespace

vtkSmartPointer<vtkPolyData> PackPiece(
  vtkAlgorithm* filter, vtkPolyData* input, const PointIdentity& identity)
{
  auto packed = vtkSmartPointer<vtkPolyData>::New();
  packed->SetPoints(input->GetPoints());
  packed->SetPolys(input->GetPolys());
  packed->SetStrips(input->GetStrips());
  const vtkIdType points = input->GetNumberOfPoints();
  const vtkIdType first = input->GetNumberOfVerts() + input->GetNumberOfLines();
  PackAttributes(filter, input->GetPointData(), 0, points, packed->GetPointData());
  PackAttributes(
    filter, input->GetCellData(), first, packed->GetNumberOfCells(), packed->GetCellData());
  vtkNew<vtkTypeInt64Array> labels, ids;
  labels->SetName(PackedArrays::Labels);
  labels->SetNumberOfTuples(points);
  ids->SetName(PackedArrays::PointIds);
  ids->SetNumberOfTuples(points);
  std::copy(identity.Labels.begin(), identity.Labels.end(), labels->GetPointer(0));
  const std::vector<std::int64_t> made = identity.MakeIds(input);
  std::copy(made.begin(), made.end(), ids->GetPointer(0));
  packed->GetPointData()->AddArray(labels);
  packed->GetPointData()->SetGlobalIds(ids);
  packed->GetFieldData()->AddArray(PackNames(PackedArrays::PointArrayNames, input->GetPointData()));
  packed->GetFieldData()->AddArray(PackNames(PackedArrays::CellArrayNames, input->GetCellData()));
  vtkUnsignedCharArray* const ghosts = input->GetCellGhostArray();
  if (ghosts && ghosts->GetNumberOfTuples() == input->GetNumberOfCells())
  {
    PackCellArray<vtkUnsignedCharArray>(
      vtkDataSetAttributes::GhostArrayName(), ghosts, first, packed);
  }
  vtkDataArray* const cellIds = input->GetCellData()->GetGlobalIds();
  if (cellIds && cellIds->GetNumberOfTuples() == input->GetNumberOfCells())
  {
    PackCellArray<vtkTypeInt64Array>(PackedArrays::CellIds, cellIds, first, packed);
  }
  return packed;
}

PieceVersion::PieceVersion(vtkAlgorithm* filter, const SurfacePiece& piece)
  : Surface(piece.Surface)
  , FirstCell(piece.Input->GetNumberOfVerts() + piece.Input->GetNumberOfLines())
{
  const std::vector<int> types = FindReadAttributes(filter);
  this->Append(piece.Input); // an array that was edited in place may not be marked itself
  this->Append(piece.Input->GetPoints());
  for (vtkCellArray* const cells : { piece.Input->GetPolys(), piece.Input->GetStrips() })
  {
    this->Append(cells);
    this->Append(cells ? cells->GetOffsetsArray() : nullptr);
    this->Append(cells ? cells->GetConnectivityArray() : nullptr);
  }
  for (vtkDataSetAttributes* attributes :
    { static_cast<vtkDataSetAttributes*>(piece.Input->GetPointData()),
      static_cast<vtkDataSetAttributes*>(piece.Input->GetCellData()) })
  {
    this->Append(attributes->GetGlobalIds());
    this->Append(attributes->GetAbstractArray(vtkDataSetAttributes::GhostArrayName()));
    for (int a = 0; a < attributes->GetNumberOfArrays(); ++a)
    {
      vtkAbstractArray* const array = attributes->GetAbstractArray(a);
      const bool isActive = SurfaceDiffusion::IsActive(types, attributes, array);
      if (isActive || IsSelected(filter, array))
      {
        this->Append(array, isActive);
      }
    }
  }
}

void PieceVersion::Append(vtkObject* object, bool isActive)
{
  this->Objects.push_back({ object, object ? object->GetMTime() : 0, isActive });
}

bool PieceVersion::operator==(const PieceVersion& other) const
{
  return std::tie(this->Surface, this->FirstCell, this->Objects) ==
    std::tie(other.Surface, other.FirstCell, other.Objects);
}

bool PieceVersion::ObjectVersion::operator==(const ObjectVersion& other) const
{
  return std::tie(this->Object, this->Time, this->IsActive) ==
    std::tie(other.Object, other.Time, other.IsActive);
}

} // namespace SurfaceDiffusion
