// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/PackedPiece.h"

#include "Conversion/PieceRefinement.h"
#include "Distributed/CellFlags.h"
#include "Distributed/ContentHash.h"
#include "Distributed/PieceArrays.h"

#include "vtkAlgorithm.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
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
#include <string>
#include <vector>

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

/// Whether the user has selected the array as one of the filter's input arrays, or of those that are not
/// of flags.
bool IsSelected(vtkAlgorithm* filter, vtkAbstractArray* array, bool flagsCount = true)
{
  vtkInformationVector* const infos =
    filter->GetInformation()->Get(vtkAlgorithm::INPUT_ARRAYS_TO_PROCESS());
  for (int i = 0; infos && i < infos->GetNumberOfInformationObjects(); ++i)
  {
    vtkInformation* const info = infos->GetInformationObject(i);
    const char* const name =
      info->Has(vtkDataObject::FIELD_NAME()) ? info->Get(vtkDataObject::FIELD_NAME()) : nullptr;
    if ((flagsCount || !IsOfFlags(i)) && name && array->GetName() &&
      std::strcmp(name, array->GetName()) == 0)
    {
      return true;
    }
  }
  return false;
}

/// Whether refinement has made the array, for all filters.
bool IsOfRefinement(vtkAbstractArray* array)
{
  const std::string name = array->GetName() ? array->GetName() : "";
  return name == PieceRefinement::BetweenName || name == PieceRefinement::GivenCellsName;
}

bool IsActive(
  const std::vector<int>& types, vtkDataSetAttributes* attributes, vtkAbstractArray* array)
{
  return std::any_of(types.begin(), types.end(),
    [&](int type) { return attributes->GetAbstractAttribute(type) == array; });
}

/// An array that keeps its values on the way to process 0: the data objects that a controller
/// sends hold vtkIdType in 32 bits. Flags get one type, so that those of all pieces go together.
vtkSmartPointer<vtkAbstractArray> MakePackedArray(
  vtkAbstractArray* array, vtkIdType count, bool isOfFlags)
{
  vtkSmartPointer<vtkDataArray> made;
  if (isOfFlags && vtkDataArray::SafeDownCast(array))
  {
    made = vtkSmartPointer<vtkDoubleArray>::New();
  }
  else if (vtkIdTypeArray::SafeDownCast(array))
  {
    made = vtkSmartPointer<vtkTypeInt64Array>::New();
  }
  else
  {
    return MakeSimilarArray(array, count);
  }
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
    const bool isOfData = IsSelected(filter, array, false) || IsActive(types, from, array);
    if (!(isOfData || IsSelected(filter, array) || IsOfRefinement(array)) ||
      array->GetNumberOfTuples() < first + count)
    {
      continue;
    }
    const auto copy = MakePackedArray(array, count, !isOfData && !IsOfRefinement(array));
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
  packed->GetPointData()->AddArray(ids);
  if (identity.IsById)
  {
    packed->GetPointData()->SetGlobalIds(ids);
  }
  packed->GetFieldData()->AddArray(PackNames(PackedArrays::PointArrayNames, input->GetPointData()));
  packed->GetFieldData()->AddArray(PackNames(PackedArrays::CellArrayNames, input->GetCellData()));
  std::vector<unsigned char> flags = FindCellFlags(input);
  if (!flags.empty())
  {
    vtkNew<vtkUnsignedCharArray> ghosts;
    ghosts->SetArray(flags.data(), static_cast<vtkIdType>(flags.size()), 1); // not taken
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

Fingerprint FingerprintPiece(vtkAlgorithm* filter, const SurfacePiece& piece)
{
  Fingerprint fingerprint;
  vtkPolyData* const input = piece.Input;
  fingerprint.AddNumber(static_cast<std::uint64_t>(piece.Surface));
  fingerprint.AddNumber(
    static_cast<std::uint64_t>(input->GetNumberOfVerts() + input->GetNumberOfLines()));
  AddArray(fingerprint, input->GetPoints() ? input->GetPoints()->GetData() : nullptr);
  AddCells(fingerprint, input->GetPolys());
  AddCells(fingerprint, input->GetStrips());
  const std::vector<int> types = FindReadAttributes(filter);
  for (vtkDataSetAttributes* attributes :
    { static_cast<vtkDataSetAttributes*>(input->GetPointData()),
      static_cast<vtkDataSetAttributes*>(input->GetCellData()) })
  {
    AddArray(fingerprint, attributes->GetGlobalIds());
    AddArray(fingerprint, attributes->GetArray(vtkDataSetAttributes::GhostArrayName()));
    for (int a = 0; a < attributes->GetNumberOfArrays(); ++a)
    {
      vtkAbstractArray* const array = attributes->GetAbstractArray(a);
      const std::string name = array->GetName() ? array->GetName() : "";
      fingerprint.AddBytes(name.data(), name.size());
      for (const int type : types)
      {
        const bool isActive = attributes->GetAbstractAttribute(type) == array;
        fingerprint.AddNumber(std::uint64_t{ isActive ? 1u : 0u });
      }
      if (IsActive(types, attributes, array) || IsSelected(filter, array) || IsOfRefinement(array))
      {
        AddArray(fingerprint, vtkDataArray::SafeDownCast(array)); // others cannot be data
        fingerprint.AddNumber(static_cast<std::uint64_t>(array->GetDataType()));
        fingerprint.AddNumber(static_cast<std::uint64_t>(array->GetNumberOfTuples()));
      }
    }
  }
  return fingerprint;
}

} // namespace SurfaceDiffusion
