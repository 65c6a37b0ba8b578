// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Conversion/PolyDataSurface.h"
#include "Core/Models/Model.h"
#include "Distributed/Processes.h"

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <cstdint>
#include <string>
#include <vector>

class vtkDataArray;
class vtkPolyData;

namespace SurfaceDiffusion
{

/// Conversions between VTK's arrays and the values on a mesh.

/// How many components of an array are data: the last of 2 or 4 unsigned chars is alpha.
int NumberOfDataComponents(vtkDataArray* array);

/// Given, Missing and Fixed of the mesh's vertices from the point arrays; mask and fixed may be
/// null. Points merged into one vertex give it the mean of the known ones. Values are divided by
/// `unit`. Throws std::runtime_error on infinite values and on points fixed at NaN.
PointData ReadPointData(const PolyDataSurface& surface, vtkDataArray* array, vtkDataArray* mask,
  vtkDataArray* fixed, double unit);

/// Largest over the data components of max - min of the known, finite values, and the largest
/// magnitude; adds to what is there, so that several blocks can share it.
struct ValueStatistics
{
  std::vector<double> Low, High;
  double Magnitude = 0.0;
  void Add(vtkDataArray* array, vtkDataArray* mask, vtkDataArray* fixed);
  void Join(const Processes& processes); ///< with those of other processes
  double Range() const; ///< 1 where nothing differs
};

/// One number per vertex that stays the same when points are renumbered or split over processes:
/// the global id where the input has them, the index of the point otherwise.
std::vector<std::int64_t> ReadVertexIds(const PolyDataSurface& surface, vtkPolyData* input);

/// An array of `type` with the shape of `source`, named `name`: values x unit at the points of the
/// mesh (rounded and clamped for integer types), a copy of the source elsewhere and in alpha.
vtkSmartPointer<vtkDataArray> WritePointArray(const PolyDataSurface& surface, vtkDataArray* source,
  const Values& values, double unit, int type, const std::string& name);

} // namespace SurfaceDiffusion
