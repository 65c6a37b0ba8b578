// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

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

/// An array of `type` with the shape of `source`, named `name`: values x unit at the points of
/// participating triangles (rounded and clamped for integer types), a copy of the source at other
/// points and in alpha. Throws std::runtime_error if `type` cannot hold a value.
vtkSmartPointer<vtkDataArray> WritePointArray(const Surface& surface, vtkDataArray* source,
  const Values& values, double unit, int type, const std::string& name);

/// One value per point, single or double precision. Points of no participating triangle have that
/// component of `source`, or 0 without a source.
vtkSmartPointer<vtkDataArray> WriteScalars(const Surface& surface, const std::string& name,
  const Eigen::Ref<const Vector>& values, bool single, vtkDataArray* source, int component);

/// Points in single precision if those of `like` are, in double precision otherwise.
vtkSmartPointer<vtkPoints> WritePoints(const Points& points, vtkPoints* like);

/// An array of unit vectors for the cells of `input`. For a cell with several triangles it is the
/// main axis of the area-weighted sum of d d^T over their directions d. Zero if there is none.
vtkSmartPointer<vtkDataArray> WriteDirections(const Surface& surface,
  const std::vector<vtkIdType>& cells, vtkPolyData* input, const TangentVectors& directions,
  const std::string& name, const ParallelFor& parallel);

/// Add a result instead of an array of the same name, whose roles among the attributes are dropped,
/// since the result may have another number of components. Returns whether that array was another
/// one than `data`, the array that the result was computed from.
bool ReplaceArray(vtkDataArray* result, vtkDataArray* data, vtkDataSetAttributes* attributes);

/// The warning about arrays of the input that results have replaced.
std::string DescribeReplacement(const std::vector<std::string>& names);

/// The columns of the history.
void WriteHistory(const History& history, vtkTable* table);

} // namespace SurfaceDiffusion
