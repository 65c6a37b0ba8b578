// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Conversion/ResultWriter.h"

#include "Conversion/NewArray.h"
#include "Conversion/SMPParallelFor.h"
#include "Conversion/TupleRange.h"
#include "Run/CellDirections.h"
#include "Run/ConvertValue.h"

#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkIntArray.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkUnsignedCharArray.h"

#include <cstdint>

#include <algorithm>
#include <limits>

namespace SurfaceDiffusion
{

namespace
{

constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

/// Whether values that nothing determines are NaN, rather than those of the source.
bool HoldsNaN(vtkDataArray* source)
{
  return source->GetDataType() == VTK_FLOAT || source->GetDataType() == VTK_DOUBLE;
}

template <typename Array>
vtkSmartPointer<vtkDataArray> MakeScalars(const Surface& surface, const std::string& name,
  const Eigen::Ref<const Vector>& values, vtkDataArray* source, int component)
{
  const auto count = static_cast<vtkIdType>(surface.Points().rows());
  auto array = NewArray<Array>(name, 1, count);
  for (vtkIdType i = 0; i < count; ++i)
  {
    const Index v = surface.VertexOf(static_cast<Index>(i));
    const double elsewhere = source ? source->GetComponent(i, component) : 0.0;
    array->SetValue(i, ConvertValue<typename Array::ValueType>(v >= 0 ? values[v] : elsewhere));
  }
  return array;
}

vtkSmartPointer<vtkDataArray> NewArrayLike(
  vtkDataArray* source, vtkIdType tuples, int type, const std::string& name)
{
  const int components = source->GetNumberOfComponents();
  vtkSmartPointer<vtkDataArray> result;
  switch (type)
  {
    case VTK_UNSIGNED_CHAR:
      result = NewArray<vtkUnsignedCharArray>(name, components, tuples);
      break;
    case VTK_FLOAT:
      result = NewArray<vtkFloatArray>(name, components, tuples);
      break;
    default:
      result = NewArray<vtkDoubleArray>(name, components, tuples);
      break;
  }
  result->CopyComponentNames(source);
  return result;
}

/// Tuple i becomes row rowOf(i) of values x unit; other(i, k) in components that `values` has not,
/// and in all of them if the row is negative.
template <typename RowOf, typename Other>
void WriteTuples(
  vtkDataArray* result, const Values& values, double unit, const RowOf& rowOf, const Other& other)
{
  const int components = result->GetNumberOfComponents();
  const int dataComponents = static_cast<int>(values.cols());
  const auto tuples = static_cast<Index>(result->GetNumberOfTuples());
  const auto write = [&](auto* typed)
  {
    auto to = vtk::DataArrayTupleRange(typed);
    using T = typename std::decay_t<decltype(to)>::ComponentType;
    ForEach(SMPParallelFor::Instance(), tuples,
      [&](Index i)
      {
        auto tuple = to[i];
        const Index row = rowOf(i);
        for (int k = 0; k < components; ++k)
        {
          tuple[k] =
            ConvertValue<T>(row >= 0 && k < dataComponents ? values(row, k) * unit : other(i, k));
        }
      });
  };
  using Dispatch =
    vtkArrayDispatch::DispatchByArray<vtkTypeList::Create<vtkAOSDataArrayTemplate<double>,
      vtkAOSDataArrayTemplate<float>, vtkAOSDataArrayTemplate<unsigned char>>>;
  Dispatch::Execute(result, write);
}

template <typename Array>
vtkSmartPointer<vtkDataArray> MakeRows(const std::string& name, const Values& values)
{
  const auto tuples = static_cast<vtkIdType>(values.rows());
  const int components = static_cast<int>(values.cols());
  auto array = NewArray<Array>(name, components, tuples);
  for (vtkIdType i = 0; i < tuples; ++i)
  {
    for (int k = 0; k < components; ++k)
    {
      array->SetTypedComponent(i, k, ConvertValue<typename Array::ValueType>(values(i, k)));
    }
  }
  return array;
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

vtkSmartPointer<vtkDataArray> WritePointArray(const Surface& surface, vtkDataArray* source,
  bool sourceOnCells, const Values& values, double unit, int type, const std::string& name)
{
  const auto points = static_cast<vtkIdType>(surface.Points().rows());
  auto result = NewArrayLike(source, points, type, name);
  const auto rowOf = [&](Index i) { return surface.VertexOf(i); };
  const bool holdsNaN = HoldsNaN(source);
  if (sourceOnCells)
  {
    const auto alpha = static_cast<int>(values.cols());
    WriteTuples(result, values, unit, rowOf,
      [&](Index i, int k)
      {
        const double nothing = holdsNaN && surface.IsUndetermined(i) ? NaN : 0.0;
        return k < alpha ? nothing : static_cast<double>(VTK_UNSIGNED_CHAR_MAX);
      });
    return result;
  }
  VisitTuples(source,
    [&](const auto& from)
    {
      WriteTuples(result, values, unit, rowOf,
        [&](Index i, int k)
        { return holdsNaN && surface.IsUndetermined(i) ? NaN : static_cast<double>(from[i][k]); });
    });
  return result;
}

vtkSmartPointer<vtkDataArray> WriteCellArray(const CellState& cells, vtkDataArray* source,
  const Values& values, int type, const std::string& name)
{
  auto result = NewArrayLike(source, source->GetNumberOfTuples(), type, name);
  const bool holdsNaN = HoldsNaN(source);
  VisitTuples(source,
    [&](const auto& from)
    {
      WriteTuples(
        result, values, 1.0, [&](Index i) { return cells.Transfer.Participates(i) ? i : -1; },
        [&](Index i, int k)
        { return holdsNaN && cells.IsUndetermined(i) ? NaN : static_cast<double>(from[i][k]); });
    });
  return result;
}

vtkSmartPointer<vtkDataArray> WriteScalars(const Surface& surface, const std::string& name,
  const Eigen::Ref<const Vector>& values, bool single, vtkDataArray* source, int component)
{
  return single ? MakeScalars<vtkFloatArray>(surface, name, values, source, component)
                : MakeScalars<vtkDoubleArray>(surface, name, values, source, component);
}

vtkSmartPointer<vtkDataArray> WriteRows(const std::string& name, const Values& values, bool single)
{
  return single ? MakeRows<vtkFloatArray>(name, values) : MakeRows<vtkDoubleArray>(name, values);
}

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

vtkSmartPointer<vtkDataArray> WriteDirections(const Surface& surface,
  const std::vector<Index>& cells, vtkPolyData* input, const TangentVectors& directions,
  const std::string& name, const ParallelFor& parallel)
{
  const Points vectors = DirectionsOfCells(
    surface, directions, input->GetNumberOfCells(),
    [&](Index t) { return static_cast<std::int64_t>(cells[static_cast<std::size_t>(t)]); },
    parallel);
  auto array = NewArray<vtkDoubleArray>(name, 3, input->GetNumberOfCells());
  for (vtkIdType cell = 0; cell < input->GetNumberOfCells(); ++cell)
  {
    array->SetTuple(cell, vectors.row(cell).data());
  }
  return array;
}

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

std::string DescribeReplacement(const std::vector<std::string>& names)
{
  std::vector<std::string> distinct = names; // blocks share their names
  std::sort(distinct.begin(), distinct.end());
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  std::string list;
  for (const std::string& name : distinct)
  {
    list += (list.empty() ? "\"" : ", \"") + name + "\"";
  }
  return "results replace arrays of the input: " + list +
    "; to keep these, set another ResultArrayName";
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
