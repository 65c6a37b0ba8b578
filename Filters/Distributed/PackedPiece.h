// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/PointIdentity.h"

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <vector>

class vtkAbstractArray;
class vtkAlgorithm;
class vtkDataSetAttributes;
class vtkObject;
class vtkPolyData;

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

/// The state of everything that PackPiece() reads: if two are equal, it would make the same.
struct PieceVersion
{
  PieceVersion(vtkAlgorithm* filter, const SurfacePiece& piece);
  bool operator==(const PieceVersion& other) const;

private:
  /// Times are unique: an object that has the address of a former one has a later time.
  struct ObjectVersion
  {
    const vtkObject* Object;
    vtkMTimeType Time;
    bool IsActive; ///< among the active attributes
    bool operator==(const ObjectVersion& other) const;
  };

  void Append(vtkObject* object, bool isActive = false);

  int Surface;
  vtkIdType FirstCell; ///< number of vertices and lines
  std::vector<ObjectVersion> Objects;
};

} // namespace SurfaceDiffusion
