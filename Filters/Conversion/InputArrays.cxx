// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Conversion/InputArrays.h"

#include "Run/BlockSentences.h"
#include "Run/InputSentences.h"

#include "vtkAlgorithm.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <map>

namespace SurfaceDiffusion
{

namespace
{

/// The array that SetInputArrayToProcess() chose: by its name or as an active attribute.
struct Choice
{
  const char* Name = nullptr; ///< null or empty: by attribute
  int Attribute = vtkDataSetAttributes::SCALARS;
  int Association = vtkDataObject::FIELD_ASSOCIATION_POINTS;
  bool IsSet = true;

  explicit Choice(vtkInformation* info)
  {
    this->Name =
      info->Has(vtkDataObject::FIELD_NAME()) ? info->Get(vtkDataObject::FIELD_NAME()) : nullptr;
    const bool byAttribute = !this->Name && info->Has(vtkDataObject::FIELD_ATTRIBUTE_TYPE());
    this->IsSet = byAttribute || this->HasName();
    if (byAttribute)
    {
      this->Attribute = info->Get(vtkDataObject::FIELD_ATTRIBUTE_TYPE());
    }
    if (info->Has(vtkDataObject::FIELD_ASSOCIATION()))
    {
      this->Association = info->Get(vtkDataObject::FIELD_ASSOCIATION());
    }
  }

  bool HasName() const { return this->Name && *this->Name; }
  bool MayBeOnPoints() const { return this->Association != vtkDataObject::FIELD_ASSOCIATION_CELLS; }
  bool MayBeOnCells() const { return this->Association != vtkDataObject::FIELD_ASSOCIATION_POINTS; }
  bool IsKnownAssociation() const
  {
    return this->Association == vtkDataObject::FIELD_ASSOCIATION_POINTS ||
      this->Association == vtkDataObject::FIELD_ASSOCIATION_CELLS ||
      this->Association == vtkDataObject::FIELD_ASSOCIATION_POINTS_THEN_CELLS;
  }
  vtkAbstractArray* FindIn(vtkDataSetAttributes* attributes) const
  {
    return this->HasName() ? attributes->GetAbstractArray(this->Name)
                           : attributes->GetAbstractAttribute(this->Attribute);
  }
  Located<vtkAbstractArray*> FindIn(vtkPolyData* block) const
  {
    vtkAbstractArray* const ofPoints =
      this->MayBeOnPoints() ? this->FindIn(block->GetPointData()) : nullptr;
    const bool isOnCells = !ofPoints && this->MayBeOnCells();
    return { isOnCells ? this->FindIn(block->GetCellData()) : ofPoints, isOnCells };
  }
};

/// The sentence of an array that is not there.
Sentence DescribeAbsence(const Choice& choice, const std::string& label, vtkPolyData* block)
{
  const bool onPoints = choice.MayBeOnPoints();
  vtkDataSetAttributes* const others =
    block->GetAttributes(onPoints ? vtkDataObject::CELL : vtkDataObject::POINT);
  return SayAbsent(label,
    choice.HasName() ? "" : vtkDataSetAttributes::GetAttributeTypeAsString(choice.Attribute),
    onPoints, choice.MayBeOnCells(), choice.HasName() && others->HasArray(choice.Name));
}

} // namespace

InputArrays::InputArrays(vtkAlgorithm* filter, vtkPolyData* block, InputFields& fields,
  SurfaceDiffusion::Problems& problems)
  : Filter(filter)
  , Block(block)
  , Fields(fields)
  , Problems(problems)
{
}

LocatedArray InputArrays::Find(int index, const char* property, int components) const
{
  const Choice choice(this->Filter->GetInputArrayInformation(index));
  if (!choice.IsSet && index != 0)
  {
    return {};
  }
  const std::string label = ArrayLabel(property, choice.HasName() ? choice.Name : "");
  const auto report = [&](const Sentence& problem)
  {
    this->Problems.push_back(problem);
    return LocatedArray();
  };
  if (!choice.IsKnownAssociation())
  {
    return report(Say("Association", label, choice.Association));
  }

  const auto [found, isOnCells] = choice.FindIn(this->Block);
  if (!found)
  {
    this->Fields.Absent.push_back(
      { index, label, DescribeAbsence(choice, label, this->Block).Text() });
    return {};
  }
  vtkDataArray* array = vtkDataArray::SafeDownCast(found);
  if (!array)
  {
    this->Fields.Absent.push_back(
      { index, label, Say("Class", label, found->GetClassName()).Text() });
    return {};
  }
  const vtkIdType tuples =
    isOnCells ? this->Block->GetNumberOfCells() : this->Block->GetNumberOfPoints();
  if (array->GetNumberOfTuples() != tuples)
  {
    return report(
      Say("Tuples", label, array->GetNumberOfTuples(), tuples, isOnCells ? "cell" : "point"));
  }
  const int size = array->GetNumberOfComponents();
  if (components == AnyNumberOfComponents ? size < 1 : size != components)
  {
    const char* const name = array->GetName();
    const std::string active = label + " is not set, and the active array";
    return report(Say("Components", choice.HasName() ? label : ArrayLabel(active, name ? name : ""),
      size, components == AnyNumberOfComponents ? "1 or more" : std::to_string(components)));
  }
  return { array, isOnCells };
}

LocatedArray FindChosenArray(vtkAlgorithm* filter, int index, vtkPolyData* block)
{
  const Choice choice(filter->GetInputArrayInformation(index));
  if (!choice.IsSet)
  {
    return {};
  }
  const Located<vtkAbstractArray*> found = choice.FindIn(block);
  return { vtkDataArray::SafeDownCast(found.Values), found.OnCells };
}

void SettleAbsence(
  const std::vector<InputFields>& blocks, Problems& problems, std::vector<Sentence>& warnings)
{
  struct Absence
  {
    AbsentArray Array;
    std::vector<std::string> Blocks;
  };
  std::map<int, Absence> absences;
  for (const InputFields& block : blocks)
  {
    for (const AbsentArray& array : block.Absent)
    {
      const auto entry = absences.insert({ array.Index, { array, {} } }).first;
      entry->second.Blocks.push_back(block.Name);
    }
  }
  for (const auto& [index, absence] : absences)
  {
    if (absence.Blocks.size() == blocks.size())
    {
      problems.push_back(absence.Array.Problem);
    }
    else
    {
      warnings.push_back(Say("SomeBlocks", absence.Array.Label, ListBlocks(absence.Blocks)));
    }
  }
}

} // namespace SurfaceDiffusion
