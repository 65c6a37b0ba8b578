// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Conversion/NewArray.h"

#include "vtkCellArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTypeInt64Array.h"

#include <algorithm>
#include <vector>

namespace SurfaceDiffusion
{

/// A copy of numbers as an array. Throws std::bad_alloc if there is not enough memory.
template <typename Array, typename Value>
vtkSmartPointer<Array> CopyToArray(
  const char* name, int components, const std::vector<Value>& numbers)
{
  auto array =
    NewArray<Array>(name, components, static_cast<vtkIdType>(numbers.size()) / components);
  std::copy(numbers.begin(), numbers.end(), array->GetPointer(0));
  return array;
}

/// Collects polylines. VTK's own arrays, if they grow, end the program where memory is short.
struct LineWriter
{
  std::vector<double> Coordinates; ///< three per point
  std::vector<vtkTypeInt64> Offsets{ 0 }, Connectivity;

  vtkTypeInt64 NumberOfPoints() const
  {
    return static_cast<vtkTypeInt64>(this->Coordinates.size() / 3);
  }
  void AddPoint(const double* x) { this->Coordinates.insert(this->Coordinates.end(), x, x + 3); }
  /// The points that Connectivity got since the last call are a line.
  void EndLine() { this->Offsets.push_back(static_cast<vtkTypeInt64>(this->Connectivity.size())); }

  void Write(vtkPolyData* output) const
  {
    vtkNew<vtkPoints> points;
    points->SetData(CopyToArray<vtkDoubleArray>("Points", 3, this->Coordinates));
    vtkNew<vtkCellArray> lines;
    lines->SetData(CopyToArray<vtkTypeInt64Array>("", 1, this->Offsets),
      CopyToArray<vtkTypeInt64Array>("", 1, this->Connectivity));
    output->SetPoints(points);
    output->SetLines(lines);
  }
};

} // namespace SurfaceDiffusion
