// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "AllFilters.h"
#include "RandomProperties.h"

#include "vtkFieldData.h"
#include "vtkVariant.h"

#include <cmath>
#include <string>
#include <vector>

/// A filter is compared with its twin: a new filter with the same settings.
namespace FilterTest
{

/// Gives a filter the input array of another at an index.
inline void CopyInputArray(vtkPolyDataAlgorithm* from, vtkPolyDataAlgorithm* to, int index)
{
  vtkNew<vtkInformation> copy;
  copy->Copy(from->GetInputArrayInformation(index), 1);
  to->SetInputArrayToProcess(index, copy);
}

/// A new filter with the same properties and arrays.
inline vtkSmartPointer<vtkPolyDataAlgorithm> Twin(
  const FilterClass& kind, vtkPolyDataAlgorithm* filter)
{
  const auto twin = kind.Make();
  for (const RandomProperty& property : kind.Properties)
  {
    property.Copy(filter, twin);
  }
  for (int index = 0; index < 11; ++index)
  {
    CopyInputArray(filter, twin, index);
  }
  return twin;
}

/// The same bits, or both not a number.
inline bool SameValues(vtkDataArray* a, vtkDataArray* b)
{
  bool same = a && b && a->GetDataType() == b->GetDataType() &&
    a->GetNumberOfComponents() == b->GetNumberOfComponents() &&
    a->GetNumberOfTuples() == b->GetNumberOfTuples();
  for (vtkIdType i = 0; same && i < a->GetNumberOfValues(); ++i)
  {
    const double x = a->GetVariantValue(i).ToDouble();
    const double y = b->GetVariantValue(i).ToDouble();
    same = x == y || (std::isnan(x) && std::isnan(y));
  }
  return same;
}

/// The names of the arrays that differ.
inline std::string DifferentArrays(vtkFieldData* a, vtkFieldData* b)
{
  std::string different = a->GetNumberOfArrays() == b->GetNumberOfArrays() ? "" : "their number ";
  for (int i = 0; i < a->GetNumberOfArrays(); ++i)
  {
    const char* const name = a->GetArrayName(i);
    different += SameValues(a->GetArray(i), b->GetArray(name)) ? "" : std::string(name) + " ";
  }
  return different;
}

inline std::string ActiveName(vtkDataSetAttributes* data, int type)
{
  vtkAbstractArray* const array = data->GetAbstractAttribute(type);
  return array && array->GetName() ? array->GetName() : "";
}

/// The names of the differences between surfaces, data and histories; empty if there are none.
inline std::string Difference(vtkPolyDataAlgorithm* a, vtkPolyDataAlgorithm* b)
{
  vtkPolyData* const x = a->GetOutput();
  vtkPolyData* const y = b->GetOutput();
  std::string different =
    SameValues(x->GetPoints()->GetData(), y->GetPoints()->GetData()) ? "" : "points ";
  different += DifferentArrays(x->GetPointData(), y->GetPointData());
  different += DifferentArrays(x->GetCellData(), y->GetCellData());
  for (int type = 0; type < vtkDataSetAttributes::NUM_ATTRIBUTES; ++type)
  {
    const bool same = ActiveName(x->GetPointData(), type) == ActiveName(y->GetPointData(), type) &&
      ActiveName(x->GetCellData(), type) == ActiveName(y->GetCellData(), type);
    different += same ? "" : "active arrays ";
  }
  if (a->GetNumberOfOutputPorts() > 1 && History(a))
  {
    for (vtkPolyDataAlgorithm* const either : { a, b })
    {
      History(either)->GetRowData()->RemoveArray("Seconds");
    }
    different += DifferentArrays(History(a)->GetRowData(), History(b)->GetRowData());
  }
  const int last = a->GetNumberOfOutputPorts() - 1;
  if (last > 0 && vtkPolyData::SafeDownCast(a->GetOutputDataObject(last)))
  {
    vtkPolyData* const lines = vtkPolyData::SafeDownCast(a->GetOutputDataObject(last));
    vtkPolyData* const others = vtkPolyData::SafeDownCast(b->GetOutputDataObject(last));
    const bool same = lines->GetNumberOfPoints() == others->GetNumberOfPoints() &&
      (lines->GetNumberOfPoints() == 0 ||
        SameValues(lines->GetPoints()->GetData(), others->GetPoints()->GetData()));
    different += same ? "" : "curves ";
    different += DifferentArrays(lines->GetCellData(), others->GetCellData());
  }
  return different;
}

/// The errors without the object's address.
inline std::vector<std::string> Sentences(const Messages& messages)
{
  std::vector<std::string> sentences;
  for (const std::string& error : messages.Errors)
  {
    sentences.push_back(error.substr(error.find("): ") + 3));
  }
  return sentences;
}

} // namespace FilterTest
