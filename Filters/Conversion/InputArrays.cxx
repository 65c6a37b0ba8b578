// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Conversion/InputArrays.h"

#include "vtkAlgorithm.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

#include <sstream>

namespace SurfaceDiffusion
{

InputArrays::InputArrays(
  vtkAlgorithm* filter, vtkPolyData* block, std::vector<std::string>& problems)
  : Filter(filter)
  , Block(block)
  , Problems(problems)
{
}

vtkDataArray* InputArrays::Find(
  int index, const char* property, int components, bool& onCells) const
{
  return this->FindAs(index, property, components, true, onCells);
}

vtkDataArray* InputArrays::FindOnPoints(int index, const char* property, int components) const
{
  bool onCells = false;
  return this->FindAs(index, property, components, false, onCells);
}

vtkDataArray* InputArrays::FindAs(
  int index, const char* property, int components, bool allowCells, bool& onCells) const
{
  vtkInformation* info = this->Filter->GetInputArrayInformation(index);
  const char* name =
    info->Has(vtkDataObject::FIELD_NAME()) ? info->Get(vtkDataObject::FIELD_NAME()) : nullptr;
  const bool byAttribute = !name && info->Has(vtkDataObject::FIELD_ATTRIBUTE_TYPE());
  if (!byAttribute && (!name || !*name))
  {
    if (index != 0)
    {
      return nullptr;
    }
  }
  const auto report = [&](const std::string& what)
  {
    std::ostringstream text;
    text << property;
    if (name && *name)
    {
      text << " \"" << name << "\"";
    }
    text << ' ' << what;
    this->Problems.push_back(text.str());
    return nullptr;
  };

  const int association = info->Has(vtkDataObject::FIELD_ASSOCIATION())
    ? info->Get(vtkDataObject::FIELD_ASSOCIATION())
    : static_cast<int>(vtkDataObject::FIELD_ASSOCIATION_POINTS);
  onCells = allowCells && association == vtkDataObject::FIELD_ASSOCIATION_CELLS;
  if (!onCells && association != vtkDataObject::FIELD_ASSOCIATION_POINTS &&
    association != vtkDataObject::FIELD_ASSOCIATION_POINTS_THEN_CELLS)
  {
    return report("has association " + std::to_string(association) + "; allowed: points (0)" +
      (allowCells ? " or cells (1)" : ""));
  }
  vtkDataSetAttributes* attributes = this->Block->GetPointData();
  if (onCells)
  {
    attributes = this->Block->GetCellData();
  }

  vtkAbstractArray* found = nullptr;
  if (name && *name)
  {
    found = attributes->GetAbstractArray(name);
    if (!found)
    {
      return report(std::string("is not among the ") + (onCells ? "cell" : "point") +
        " arrays of the input; choose one of them");
    }
  }
  else
  {
    const int type = byAttribute ? info->Get(vtkDataObject::FIELD_ATTRIBUTE_TYPE())
                                 : static_cast<int>(vtkDataSetAttributes::SCALARS);
    found = attributes->GetAbstractAttribute(type);
    if (!found)
    {
      return report(std::string("is not set and the input has no active point ") +
        vtkDataSetAttributes::GetAttributeTypeAsString(type) + "; choose a point array");
    }
  }

  vtkDataArray* array = vtkDataArray::SafeDownCast(found);
  if (!array)
  {
    return report(std::string("is a ") + found->GetClassName() + "; allowed: numeric arrays");
  }
  const vtkIdType tuples =
    onCells ? this->Block->GetNumberOfCells() : this->Block->GetNumberOfPoints();
  if (array->GetNumberOfTuples() != tuples)
  {
    return report("has " + std::to_string(array->GetNumberOfTuples()) +
      " tuples; allowed: " + std::to_string(tuples) + ", one per " + (onCells ? "cell" : "point"));
  }
  const int size = array->GetNumberOfComponents();
  if (components == AnyNumberOfComponents ? size < 1 : size != components)
  {
    return report("has " + std::to_string(size) + " components; allowed: " +
      (components == AnyNumberOfComponents ? std::string("1 or more")
                                           : std::to_string(components)));
  }
  return array;
}

} // namespace SurfaceDiffusion
