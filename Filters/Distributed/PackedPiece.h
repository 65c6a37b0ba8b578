// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/PointIdentity.h"
#include "Run/Fingerprint.h"
#include "vtkSurfaceDiffusionNamespace.h"

#include "vtkSmartPointer.h"
#include "vtkType.h"

VTK_ABI_NAMESPACE_BEGIN
class vtkAlgorithm;
class vtkPolyData;
VTK_ABI_NAMESPACE_END

namespace SurfaceDiffusion
{

/// The parts of a piece that a filter reads, as it is sent to process 0: points, polygons, strips,
/// the arrays and active attributes that the filter processes, cell ghosts, and as arrays of these
/// names labels, ids, and (as field data) the names of all arrays of points and of cells.
vtkSmartPointer<vtkPolyData> PackPiece(
  vtkAlgorithm* filter, vtkPolyData* input, const PointIdentity& identity);

namespace PackedArrays
{
constexpr const char* Labels = "surface diffusion label"; ///< of points
constexpr const char* PointIds = "surface diffusion point id";
constexpr const char* CellIds = "surface diffusion cell id"; ///< absent without global cell ids
constexpr const char* PointArrayNames = "surface diffusion point arrays";
constexpr const char* CellArrayNames = "surface diffusion cell arrays";
}

/// An array with the type, name and component names of another, and `count` tuples.
template <typename Array>
vtkSmartPointer<Array> MakeSimilarArray(Array* array, vtkIdType count)
{
  auto made = vtkSmartPointer<Array>::Take(array->NewInstance());
  made->SetName(array->GetName());
  made->SetNumberOfComponents(array->GetNumberOfComponents());
  made->CopyComponentNames(array);
  made->SetNumberOfTuples(count);
  return made;
}

/// The hash of everything that PackPiece() reads: if two are equal, it would make the same.
Fingerprint FingerprintPiece(vtkAlgorithm* filter, const SurfacePiece& piece);

} // namespace SurfaceDiffusion
