// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Conversion/FieldReader.h"
#include "vtkSurfaceDiffusionNamespace.h"

#include <string>
#include <vector>

VTK_ABI_NAMESPACE_BEGIN
class vtkAlgorithm;
class vtkDataArray;
class vtkPolyData;
VTK_ABI_NAMESPACE_END

namespace SurfaceDiffusion
{

/// Finds the arrays that SetInputArrayToProcess() chose on one block, and lists their problems. An
/// array that the block does not have, or that is not numeric, is added to the absent ones of
/// `fields`.
class InputArrays
{
public:
  static constexpr int AnyNumberOfComponents = 0;

  InputArrays(vtkAlgorithm* filter, vtkPolyData* block, InputFields& fields, Problems& problems);

  /// The array at `index`, called `property` in messages. Null if it is not set or absent, and null
  /// with a problem reported if it is not allowed.
  LocatedArray Find(int index, const char* property, int components) const;

private:
  vtkAlgorithm* Filter;
  vtkPolyData* Block;
  InputFields& Fields;
  SurfaceDiffusion::Problems& Problems;
};

/// The numeric array at `index`, of any size, with null values if the block has none or none
/// was chosen.
LocatedArray FindChosenArray(vtkAlgorithm* filter, int index, vtkPolyData* block);

/// Decides about the absent arrays of all blocks. One that no block has is a problem. One that
/// another block has counts as not set, with a sentence in `warnings`.
void SettleAbsence(
  const std::vector<InputFields>& blocks, Problems& problems, std::vector<Sentence>& warnings);

} // namespace SurfaceDiffusion
