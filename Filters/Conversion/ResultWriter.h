// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Conversion/FieldReader.h"
#include "Run/History.h"
#include "Run/Outputs.h"
#include "vtkSurfaceDiffusionNamespace.h"

#include "vtkSmartPointer.h"

#include <string>
#include <vector>

VTK_ABI_NAMESPACE_BEGIN
class vtkDataArray;
class vtkPoints;
class vtkPolyData;
class vtkTable;
VTK_ABI_NAMESPACE_END

namespace SurfaceDiffusion
{

/// Points in single precision if those of `like` are, in double precision otherwise.
vtkSmartPointer<vtkPoints> WritePoints(const Points& points, vtkPoints* like);

/// The surface that outputs are added to.
struct OutputTarget
{
  vtkPolyData* Surface; ///< a shallow copy of the input
  const InputFields& Fields;
  const std::string& ResultArrayName;
  int DataType; ///< of the result of the data
  /// The array that a result of the name ResultArrayName may replace; null: none.
  vtkDataArray* Expected;
  std::vector<std::string>& Replaced; ///< the names of arrays of the input that are replaced
};

/// Add the outputs that are arrays or points to a surface, with their roles. Arrays of the same
/// name are replaced with their roles among the attributes, since the result may have another
/// number of components. Throws std::runtime_error if a type cannot hold a value.
void WriteOutputs(
  const OutputList& outputs, const OutputSource& source, const OutputTarget& target);

/// Write the columns of the outputs of all surfaces, their rows one after the other. Returns
/// whether there are any.
bool WriteColumns(const std::vector<const OutputList*>& surfaces, vtkTable* table);

/// Write the curves of all surfaces as polylines. prefix: of the names of the arrays of points.
void WriteCurves(
  const std::vector<const OutputList*>& surfaces, const std::string& prefix, vtkPolyData* curves);

/// The warning about arrays of the input that results have replaced.
Sentence DescribeReplacement(const std::vector<std::string>& names);

/// The columns of the history.
void WriteHistory(const History& history, vtkTable* table);

} // namespace SurfaceDiffusion
