// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/CellFields.h"
#include "Run/History.h"
#include "Run/Surface.h"

#include "vtkSmartPointer.h"

#include <string>
#include <vector>

class vtkDataArray;
class vtkDataSetAttributes;
class vtkPoints;
class vtkPolyData;
class vtkTable;

namespace SurfaceDiffusion
{

/// An array of `type` with the components of `source`, named `name`: values x unit at the points of
/// participating triangles (rounded and clamped for integer types). At other points and in alpha it
/// is a copy of the source, or, if that is on cells, 0 and opaque; NaN at undetermined points if the
/// source has floating-point values. Throws std::runtime_error if `type` cannot hold a value.
vtkSmartPointer<vtkDataArray> WritePointArray(const Surface& surface, vtkDataArray* source,
  bool sourceOnCells, const Values& values, double unit, int type, const std::string& name);

/// The same for an array on cells: one row of values per cell. Cells that take no part, and alpha,
/// are copied from the source, with the same exception.
vtkSmartPointer<vtkDataArray> WriteCellArray(const CellState& cells, vtkDataArray* source,
  const Values& values, int type, const std::string& name);

/// One value per point, single or double precision. Points of no participating triangle have that
/// component of `source`, or 0 without a source.
vtkSmartPointer<vtkDataArray> WriteScalars(const Surface& surface, const std::string& name,
  const Eigen::Ref<const Vector>& values, bool single, vtkDataArray* source, int component);

/// One row of `values` per tuple, single or double precision.
vtkSmartPointer<vtkDataArray> WriteRows(const std::string& name, const Values& values, bool single);

/// Points in single precision if those of `like` are, in double precision otherwise.
vtkSmartPointer<vtkPoints> WritePoints(const Points& points, vtkPoints* like);

/// An array of unit vectors for the cells of `input`. For a cell with several triangles it is the
/// main axis of the area-weighted sum of d d^T over their directions d. Zero if there is none.
vtkSmartPointer<vtkDataArray> WriteDirections(const Surface& surface,
  const std::vector<Index>& cells, vtkPolyData* input, const TangentVectors& directions,
  const std::string& name, const ParallelFor& parallel);

/// Add a result instead of an array of the same name, whose roles among the attributes are dropped,
/// since the result may have another number of components. Returns whether an array of the input
/// was replaced other than `expected`, the one that the user wants to be replaced; it may be null.
bool ReplaceArray(vtkDataArray* result, vtkDataArray* expected, vtkDataSetAttributes* attributes);

/// The warning about arrays of the input that results have replaced.
std::string DescribeReplacement(const std::vector<std::string>& names);

/// The columns of the history.
void WriteHistory(const History& history, vtkTable* table);

} // namespace SurfaceDiffusion
