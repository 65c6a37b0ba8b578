// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

class vtkAlgorithm;
class vtkDataArray;
class vtkPolyData;

namespace SurfaceDiffusion
{

/// Finds the arrays that SetInputArrayToProcess() chose on one block, and lists their problems.
class InputArrays
{
public:
  static constexpr int AnyNumberOfComponents = 0;

  InputArrays(vtkAlgorithm* filter, vtkPolyData* block, std::vector<std::string>& problems);

  /// The array at `index`, called `property` in messages. Null if it is not set, and null with a
  /// problem reported if it is absent or not allowed. onCells: whether it is cell data.
  vtkDataArray* Find(int index, const char* property, int components, bool& onCells) const;

private:
  vtkAlgorithm* Filter;
  vtkPolyData* Block;
  std::vector<std::string>& Problems;
};

} // namespace SurfaceDiffusion
