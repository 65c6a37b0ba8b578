// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Conversion/PointArrays.h"

#include "Conversion/ConvertValue.h"
#include "Conversion/NewArray.h"
#include "Conversion/SMPParallelFor.h"

#include "vtkArrayDispatch.h"
#include "vtkDataArray.h"
#include "vtkDataArrayRange.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace SurfaceDiffusion
{

namespace
{

bool IsSet(vtkDataArray* flags, vtkIdType i)
{
  return flags && flags->GetComponent(i, 0) != 0.0;
}

bool HasNaN(const double* tuple, int components)
{
  return std::any_of(tuple, tuple + components, [](double x) { return std::isnan(x); });
}

/// Calls body(range) with a typed tuple range of the array.
template <typename Body>
void WithTuples(vtkDataArray* array, Body body)
{
  const auto work = [&](auto* typed) { body(vtk::DataArrayTupleRange(typed)); };
  using Dispatch = vtkArrayDispatch::DispatchByValueType<vtkArrayDispatch::AllTypes>;
  if (!Dispatch::Execute(array, work))
  {
    work(array);
  }
}

std::runtime_error PointError(const char* property, vtkDataArray* array, vtkIdType point,
  const char* found, const char* allowed)
{
  std::ostringstream text;
  text << property << " \"" << (array->GetName() ? array->GetName() : "") << "\" " << found
       << " at point " << point << "; " << allowed;
  return std::runtime_error(text.str());
}

/// Reads all values as doubles, n x data components.
Values ReadValues(vtkDataArray* array)
{
  const int components = NumberOfDataComponents(array);
  Values values(array->GetNumberOfTuples(), components);
  WithTuples(array,
    [&](const auto& tuples)
    {
      for (vtkIdType i = 0; i < static_cast<vtkIdType>(tuples.size()); ++i)
      {
        const auto tuple = tuples[i];
        for (int k = 0; k < components; ++k)
        {
          values(i, k) = static_cast<double>(tuple[k]);
        }
      }
    });
  return values;
}

} // namespace

int NumberOfDataComponents(vtkDataArray* array)
{
  const int components = array->GetNumberOfComponents();
  const bool hasAlpha =
    array->GetDataType() == VTK_UNSIGNED_CHAR && (components == 2 || components == 4);
  return hasAlpha ? components - 1 : components;
}

PointData ReadPointData(const PolyDataSurface& surface, vtkDataArray* array, vtkDataArray* mask,
  vtkDataArray* fixed, double unit)
{
  const Index n = surface.Mesh->NumberOfVertices();
  Values values = ReadValues(array);
  const int components = static_cast<int>(values.cols());
  PointData data;
  data.Given = Values::Zero(n, components);
  data.Missing = Flags::Constant(n, true);
  data.Fixed = Flags::Constant(n, false);
  Values damaged = Values::Zero(n, components); // what a vertex has where none of it is known
  std::vector<Index> known(n, 0);
  for (vtkIdType i = 0; i < static_cast<vtkIdType>(values.rows()); ++i)
  {
    const double* tuple = values.row(i).data();
    if (std::any_of(tuple, tuple + components, [](double x) { return std::isinf(x); }))
    {
      throw PointError("InputArray", array, i, "is infinite", "allowed: finite values and NaN");
    }
    const Index v = surface.PointToVertex[i];
    if (v < 0)
    {
      continue;
    }
    const bool isFixed = IsSet(fixed, i);
    const bool isNaN = HasNaN(tuple, components);
    if (isFixed && isNaN)
    {
      throw PointError(
        "InputArray", array, i, "is NaN where FixedArray holds it", "allowed there: finite values");
    }
    data.Fixed[v] = data.Fixed[v] || isFixed;
    damaged.row(v) = values.row(i) / unit;
    if (isFixed || !(isNaN || IsSet(mask, i)))
    {
      data.Given.row(v) += values.row(i) / unit;
      data.Missing[v] = false;
      ++known[v];
    }
  }
  for (Index v = 0; v < n; ++v)
  {
    if (known[v] == 0)
    {
      data.Given.row(v) = damaged.row(v);
    }
    else if (known[v] > 1)
    {
      data.Given.row(v) /= known[v];
    }
  }
  return data;
}

void ValueStatistics::Add(vtkDataArray* array, vtkDataArray* mask, vtkDataArray* fixed)
{
  const int components = NumberOfDataComponents(array);
  if (this->Low.empty())
  {
    this->Low.assign(components, std::numeric_limits<double>::infinity());
    this->High.assign(components, -std::numeric_limits<double>::infinity());
  }
  const Values values = ReadValues(array);
  const int shared = std::min(components, static_cast<int>(this->Low.size()));
  for (vtkIdType i = 0; i < static_cast<vtkIdType>(values.rows()); ++i)
  {
    if (!values.row(i).allFinite())
    {
      continue;
    }
    this->Magnitude = std::max(this->Magnitude, values.row(i).cwiseAbs().maxCoeff());
    if (IsSet(mask, i) && !IsSet(fixed, i))
    {
      continue;
    }
    for (int k = 0; k < shared; ++k)
    {
      this->Low[k] = std::min(this->Low[k], values(i, k));
      this->High[k] = std::max(this->High[k], values(i, k));
    }
  }
}

void ValueStatistics::Join(const Processes& processes)
{
  // Components, magnitude, low and high of each process; one without data has no components.
  std::vector<double> mine = { static_cast<double>(this->Low.size()), this->Magnitude };
  mine.insert(mine.end(), this->Low.begin(), this->Low.end());
  mine.insert(mine.end(), this->High.begin(), this->High.end());
  const std::vector<double> all = processes.GatherAll(mine);
  for (std::size_t i = 0; i < all.size();)
  {
    const auto components = static_cast<std::size_t>(all[i]);
    this->Magnitude = std::max(this->Magnitude, all[i + 1]);
    this->Low.resize(
      std::max(this->Low.size(), components), std::numeric_limits<double>::infinity());
    this->High.resize(this->Low.size(), -std::numeric_limits<double>::infinity());
    for (std::size_t k = 0; k < components; ++k)
    {
      this->Low[k] = std::min(this->Low[k], all[i + 2 + k]);
      this->High[k] = std::max(this->High[k], all[i + 2 + components + k]);
    }
    i += 2 + 2 * components;
  }
}

double ValueStatistics::Range() const
{
  double range = 0.0;
  for (std::size_t k = 0; k < this->Low.size(); ++k)
  {
    range = std::max(range, this->High[k] - this->Low[k]);
  }
  return range > 0.0 ? range : 1.0;
}

std::vector<std::int64_t> ReadVertexIds(const PolyDataSurface& surface, vtkPolyData* input)
{
  vtkDataArray* global = input->GetPointData()->GetGlobalIds();
  if (global)
  {
    RequireTuples(global, input->GetNumberOfPoints(), "point");
  }
  std::vector<std::int64_t> ids(surface.Mesh->NumberOfVertices());
  for (std::size_t v = 0; v < ids.size(); ++v)
  {
    const Index point = surface.Mesh->InputVertex()[v];
    ids[v] = global ? static_cast<std::int64_t>(global->GetComponent(point, 0)) : point;
  }
  return ids;
}

vtkSmartPointer<vtkDataArray> WritePointArray(const PolyDataSurface& surface, vtkDataArray* source,
  const Values& values, double unit, int type, const std::string& name)
{
  const int components = source->GetNumberOfComponents();
  const vtkIdType tuples = source->GetNumberOfTuples();
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
  const int dataComponents = static_cast<int>(values.cols());
  WithTuples(source,
    [&](const auto& from)
    {
      const auto write = [&](auto* typed)
      {
        auto to = vtk::DataArrayTupleRange(typed);
        using T = typename std::decay_t<decltype(to)>::ComponentType;
        ForEach(SMPParallelFor::Instance(), static_cast<Index>(tuples),
          [&](Index i)
          {
            auto tuple = to[i];
            const auto old = from[i];
            const Index v = surface.PointToVertex[i];
            for (int k = 0; k < components; ++k)
            {
              tuple[k] = v >= 0 && k < dataComponents
                ? ConvertValue<T>(values(v, k) * unit)
                : ConvertValue<T>(static_cast<double>(old[k]));
            }
          });
      };
      using Dispatch =
        vtkArrayDispatch::DispatchByArray<vtkTypeList::Create<vtkAOSDataArrayTemplate<double>,
          vtkAOSDataArrayTemplate<float>, vtkAOSDataArrayTemplate<unsigned char>>>;
      Dispatch::Execute(result.Get(), write);
    });
  return result;
}

} // namespace SurfaceDiffusion
