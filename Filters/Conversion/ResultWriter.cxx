// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Conversion/ResultWriter.h"

#include "Conversion/NewArray.h"
#include "Conversion/PointNormals.h"
#include "Conversion/SMPParallelFor.h"
#include "Conversion/TupleRange.h"
#include "Run/InputSentences.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkTypeInt64Array.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <limits>

namespace SurfaceDiffusion
{

namespace
{

constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

vtkSmartPointer<vtkDataArray> NewArrayOfType(
  int type, const std::string& name, int components, vtkIdType tuples)
{
  switch (type)
  {
    case VTK_UNSIGNED_CHAR:
      return NewArray<vtkUnsignedCharArray>(name, components, tuples);
    case VTK_INT:
      return NewArray<vtkIntArray>(name, components, tuples);
    case VTK_FLOAT:
      return NewArray<vtkFloatArray>(name, components, tuples);
    default:
      return NewArray<vtkDoubleArray>(name, components, tuples);
  }
}

int TypeOf(OutputType type, int dataType)
{
  switch (type)
  {
    case OutputType::Data:
      return dataType;
    case OutputType::Real:
      return dataType == VTK_FLOAT ? VTK_FLOAT : VTK_DOUBLE;
    case OutputType::Integer:
      return VTK_INT;
    case OutputType::Byte:
      return VTK_UNSIGNED_CHAR;
    default:
      return VTK_DOUBLE;
  }
}

vtkSmartPointer<vtkDataArray> WriteMatrix(const Values& rows, int type, const std::string& name)
{
  const auto array =
    NewArrayOfType(type, name, static_cast<int>(rows.cols()), static_cast<vtkIdType>(rows.rows()));
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
  {
    for (Eigen::Index k = 0; k < rows.cols(); ++k)
    {
      array->SetComponent(i, static_cast<int>(k), rows(i, k));
    }
  }
  return array;
}

vtkSmartPointer<vtkDataArray> WriteArray(
  const OutputRows& rows, bool likeData, vtkDataArray* data, int type, const std::string& name)
{
  const int components =
    likeData ? data->GetNumberOfComponents() : static_cast<int>(rows.Columns());
  const auto array = NewArrayOfType(type, name, components, rows.Count());
  if (likeData)
  {
    array->CopyComponentNames(data);
  }
  const auto write = [&](const auto& given)
  {
    const auto writeTyped = [&](auto* typed)
    { rows.Write(typed->GetPointer(0), components, -1, given, SMPParallelFor::Instance()); };
    using Dispatch = vtkArrayDispatch::DispatchByArray<
      vtkTypeList::Create<vtkAOSDataArrayTemplate<double>, vtkAOSDataArrayTemplate<float>,
        vtkAOSDataArrayTemplate<int>, vtkAOSDataArrayTemplate<unsigned char>>>;
    Dispatch::Execute(array, writeTyped);
  };
  if (rows.TakesGiven())
  {
    VisitTuples(data,
      [&](const auto& from)
      {
        write([&](Index i, Eigen::Index k)
          { return static_cast<double>(from[i][static_cast<int>(k)]); });
      });
  }
  else
  {
    write([](Index, Eigen::Index) { return 0.0; });
  }
  return array;
}

/// The vectors of a result are vectors in space, which colours and pairs are not.
int AttributeOf(const Output& output, const InputFields& fields, vtkDataArray* array)
{
  if (output.Active == Role::Scalars)
  {
    return vtkDataSetAttributes::SCALARS;
  }
  if (fields.ResultIsNormals)
  {
    return vtkDataSetAttributes::NORMALS; // only these: ParaView shades with no vectors
  }
  vtkDataArray* const data = fields.Data.Values;
  const bool isColor =
    data && output.Type == OutputType::Data && data->GetDataType() == VTK_UNSIGNED_CHAR;
  const bool inSpace = array->GetNumberOfComponents() == 3 && !isColor;
  return inSpace ? vtkDataSetAttributes::VECTORS : vtkDataSetAttributes::SCALARS;
}

/// A copy of numbers as an array.
template <typename Array, typename Value>
vtkSmartPointer<Array> CopyToArray(const char* name, int components, const std::vector<Value>& from)
{
  auto array = NewArray<Array>(name, components, static_cast<vtkIdType>(from.size()) / components);
  std::copy(from.begin(), from.end(), array->GetPointer(0));
  return array;
}

/// The numbers of an output of all surfaces, one after the other.
struct JoinedColumn
{
  const Output* First;
  std::vector<double> Numbers;

  vtkSmartPointer<vtkDataArray> Write(const std::string& name) const
  {
    const Eigen::Index components = this->First->Rows.cols();
    const auto rows = static_cast<Eigen::Index>(this->Numbers.size()) / components;
    return WriteMatrix(Eigen::Map<const Values>(this->Numbers.data(), rows, components),
      TypeOf(this->First->Type, VTK_DOUBLE), name);
  }
};

/// Those of one place, in the order of their first appearance, and the numbers of their surfaces.
/// Where a surface has no output of a name it has NaN.
std::vector<JoinedColumn> Join(
  const std::vector<const OutputList*>& surfaces, Place where, std::vector<int>& surfaceOfRows)
{
  std::vector<JoinedColumn> columns;
  for (std::size_t s = 0; s < surfaces.size(); ++s)
  {
    const std::size_t before = surfaceOfRows.size();
    for (const Output& output : *surfaces[s])
    {
      if (output.Where != where || output.Lines)
      {
        continue;
      }
      surfaceOfRows.resize(
        before + static_cast<std::size_t>(output.Rows.rows()), static_cast<int>(s));
      auto column = std::find_if(columns.begin(), columns.end(),
        [&](const JoinedColumn& other) { return other.First->Name == output.Name; });
      const auto width = static_cast<std::size_t>(output.Rows.cols());
      if (column == columns.end())
      {
        columns.push_back({ &output, std::vector<double>(before * width, NaN) });
        column = columns.end() - 1;
      }
      column->Numbers.insert(
        column->Numbers.end(), output.Rows.data(), output.Rows.data() + output.Rows.size());
    }
    for (JoinedColumn& column : columns)
    {
      column.Numbers.resize(
        surfaceOfRows.size() * static_cast<std::size_t>(column.First->Rows.cols()), NaN);
    }
  }
  return columns;
}

/// Whether an array of the input was replaced other than `expected`; it may be null.
bool ReplaceArray(vtkDataArray* result, vtkDataArray* expected, vtkDataSetAttributes* attributes)
{
  vtkAbstractArray* const former = attributes->GetAbstractArray(result->GetName());
  const bool isAnother = former && former != expected;
  if (former)
  {
    attributes->RemoveArray(result->GetName());
  }
  attributes->AddArray(result);
  return isAnother;
}

template <typename Array, typename Value>
void AddColumn(vtkTable* table, const std::string& name, int rows, const Value& value)
{
  const auto column = NewArray<Array>(name, 1, rows);
  for (int row = 0; row < rows; ++row)
  {
    column->SetValue(row, value(row));
  }
  table->AddColumn(column);
}

} // namespace

vtkSmartPointer<vtkPoints> WritePoints(const Points& points, vtkPoints* like)
{
  const auto count = static_cast<vtkIdType>(points.rows());
  auto result = vtkSmartPointer<vtkPoints>::New();
  if (like->GetDataType() == VTK_FLOAT)
  {
    result->SetData(NewArray<vtkFloatArray>("Points", 3, count));
  }
  else
  {
    result->SetData(NewArray<vtkDoubleArray>("Points", 3, count));
  }
  for (vtkIdType i = 0; i < count; ++i)
  {
    result->SetPoint(i, points.row(i).data());
  }
  return result;
}

void WriteOutputs(const OutputList& outputs, const OutputSource& source, const OutputTarget& target)
{
  vtkNew<vtkPolyData> input;
  input->ShallowCopy(target.Surface);
  vtkDataArray* const data = target.Fields.Data.Values;
  const std::string& given = target.ResultArrayName;
  for (const Output& output : outputs)
  {
    if (output.Where > Place::PerTriangle || (!output.IsState && output.Rows.cols() == 0))
    {
      continue;
    }
    if (output.Active == Role::Coordinates)
    {
      target.Surface->SetPoints(WritePoints(output.Rows, input->GetPoints()));
      UpdateNormals(input, target.Surface);
      continue;
    }
    const bool ofData = output.IsResult || (output.IsBesideResult && given.empty());
    const std::string nameOfData = data && data->GetName() ? data->GetName() : output.DataName;
    const std::string name =
      output.IsResult && !given.empty() ? given : (ofData ? nameOfData : given) + output.Name;
    const OutputRows rows(output, source);
    const auto array = WriteArray(
      rows, output.Type == OutputType::Data, data, TypeOf(output.Type, target.DataType), name);
    vtkDataSetAttributes* attributes = target.Surface->GetPointData();
    if (rows.OnCells())
    {
      attributes = target.Surface->GetCellData();
    }
    if (ReplaceArray(array, name == given ? target.Expected : nullptr, attributes))
    {
      target.Replaced.push_back(name);
    }
    if (output.Active != Role::None)
    {
      attributes->SetActiveAttribute(name.c_str(), AttributeOf(output, target.Fields, array));
    }
  }
}

bool WriteColumns(const std::vector<const OutputList*>& surfaces, vtkTable* table)
{
  std::vector<int> blocks;
  const std::vector<JoinedColumn> columns = Join(surfaces, Place::Column, blocks);
  if (columns.empty())
  {
    return false;
  }
  table->AddColumn(CopyToArray<vtkIntArray>("Block", 1, blocks));
  for (const JoinedColumn& column : columns)
  {
    table->AddColumn(column.Write(column.First->Name));
  }
  return true;
}

void WriteCurves(
  const std::vector<const OutputList*>& surfaces, const std::string& prefix, vtkPolyData* curves)
{
  std::vector<double> coordinates;
  std::vector<vtkTypeInt64> offsets{ 0 }, connectivity;
  for (const OutputList* const surface : surfaces)
  {
    for (const Output& output : *surface)
    {
      if (!output.Lines)
      {
        continue;
      }
      const Curves& lines = *output.Lines;
      const auto first = static_cast<vtkTypeInt64>(coordinates.size() / 3);
      const auto corners = static_cast<vtkTypeInt64>(connectivity.size());
      coordinates.insert(
        coordinates.end(), lines.Points.data(), lines.Points.data() + lines.Points.size());
      for (const Index corner : lines.Corners)
      {
        connectivity.push_back(first + corner);
      }
      for (auto end = lines.Begin.begin() + 1; end != lines.Begin.end(); ++end)
      {
        offsets.push_back(corners + *end);
      }
    }
  }
  vtkNew<vtkPoints> points;
  points->SetData(CopyToArray<vtkDoubleArray>("Points", 3, coordinates));
  vtkNew<vtkCellArray> lines;
  lines->SetData(CopyToArray<vtkTypeInt64Array>("", 1, offsets),
    CopyToArray<vtkTypeInt64Array>("", 1, connectivity));
  curves->SetPoints(points);
  curves->SetLines(lines);
  std::vector<int> blocksOfPoints, blocks;
  for (const JoinedColumn& column : Join(surfaces, Place::PerCurvePoint, blocksOfPoints))
  {
    curves->GetPointData()->AddArray(column.Write(prefix + column.First->Name));
  }
  for (const JoinedColumn& column : Join(surfaces, Place::PerCurve, blocks))
  {
    curves->GetCellData()->AddArray(column.Write(column.First->Name));
  }
  curves->GetCellData()->AddArray(CopyToArray<vtkIntArray>("Block", 1, blocks));
}

Sentence DescribeReplacement(const std::vector<std::string>& names)
{
  std::vector<std::string> distinct = names; // blocks share their names
  std::sort(distinct.begin(), distinct.end());
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  std::string list;
  for (const std::string& name : distinct)
  {
    list += (list.empty() ? "\"" : ", \"") + name + "\"";
  }
  return Say("Replaced", list);
}

void WriteHistory(const History& history, vtkTable* table)
{
  const std::vector<StepRecord>& records = history.Records;
  const int rows = static_cast<int>(records.size());
  AddColumn<vtkIntArray>(table, "Step", rows, [](int row) { return row; });
  AddColumn<vtkDoubleArray>(table, "Time", rows, [&](int row) { return history.Time[row]; });
  for (std::size_t k = 0; k < history.Totals.size(); ++k)
  {
    AddColumn<vtkDoubleArray>(
      table, "Total_" + std::to_string(k), rows, [&](int row) { return history.Totals[k][row]; });
  }
  AddColumn<vtkDoubleArray>(table, "Energy", rows, [&](int row) { return records[row].Energy; });
  AddColumn<vtkIntArray>(
    table, "Iterations", rows, [&](int row) { return records[row].Iterations; });
  AddColumn<vtkDoubleArray>(
    table, "Residual", rows, [&](int row) { return records[row].Residual; });
  AddColumn<vtkDoubleArray>(table, "Seconds", rows, [&](int row) { return records[row].Seconds; });
  if (history.BoundsError)
  {
    AddColumn<vtkDoubleArray>(
      table, "ErrorBound", rows, [&](int row) { return records[row].ErrorBound; });
  }
  if (history.CountsClamped)
  {
    AddColumn<vtkIntArray>(table, "Clamped", rows, [&](int row) { return records[row].Clamped; });
  }
}

} // namespace SurfaceDiffusion
