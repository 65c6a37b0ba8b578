// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Conversion/PointNormals.h"

#include "Conversion/NewArray.h"
#include "Distributed/CellFlags.h"

#include "vtkBoundingBox.h"
#include "vtkCellArray.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolygon.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

/// Coordinates beyond these make single precision or squares overflow.
constexpr double LargestExtent = 1e15;
constexpr double SmallestExtent = 1e-15;

/// The block, in coordinates whose squares a float can hold.
vtkSmartPointer<vtkPolyData> WithModerateCoordinates(vtkPolyData* block)
{
  auto result = vtkSmartPointer<vtkPolyData>::New();
  result->SetPoints(block->GetPoints());
  result->SetPolys(block->GetPolys());
  result->SetStrips(block->GetStrips());
  const vtkBoundingBox box(result->GetBounds());
  const double extent = box.GetMaxLength();
  if (extent > 0.0 && (extent > LargestExtent || extent < SmallestExtent))
  {
    vtkNew<vtkPoints> points;
    points->SetData(NewArray<vtkDoubleArray>("Points", 3, block->GetNumberOfPoints()));
    for (vtkIdType i = 0; i < block->GetNumberOfPoints(); ++i)
    {
      double x[3];
      block->GetPoint(i, x);
      for (int k = 0; k < 3; ++k)
      {
        x[k] = x[k] / extent - box.GetBound(2 * k) / extent;
      }
      points->SetPoint(i, x);
    }
    result->SetPoints(points);
  }
  return result;
}

/// Calls visit(cell, ids, size, normal) for each polygon and each triangle of a strip, with the
/// number of its cell among the polygons and strips and its unit normal, zero if it has none.
template <typename Visit>
void VisitPolygons(vtkPolyData* surface, const Visit& visit)
{
  vtkPoints* const coordinates = surface->GetPoints();
  const vtkIdType points = coordinates->GetNumberOfPoints();
  vtkIdType first = 0;
  const auto visitPolygon = [&](vtkIdType cell, const vtkIdType* ids, vtkIdType size)
  {
    double normal[3];
    vtkPolygon::ComputeNormal(coordinates, static_cast<int>(size), ids, normal);
    visit(cell, ids, size, normal);
  };
  const auto visitCells = [&](vtkCellArray* cells, bool strips)
  {
    const vtkIdType count = cells ? cells->GetNumberOfCells() : 0;
    for (vtkIdType c = 0; c < count; ++c)
    {
      vtkIdType size = 0;
      const vtkIdType* ids = nullptr;
      cells->GetCellAtId(c, size, ids);
      if (size < 3 ||
        std::any_of(ids, ids + size, [&](vtkIdType id) { return id < 0 || id >= points; }))
      {
        continue; // an error, reported later with others of its kind
      }
      if (!strips)
      {
        visitPolygon(first + c, ids, size);
      }
      for (vtkIdType i = 0; strips && i + 2 < size; ++i)
      {
        const vtkIdType corners[3] = { ids[i], ids[i + 1 + i % 2], ids[i + 2 - i % 2] };
        visitPolygon(first + c, corners, 3);
      }
    }
    first += count;
  };
  visitCells(surface->GetPolys(), false);
  visitCells(surface->GetStrips(), true);
}

void AddTo(std::vector<double>& sums, vtkIdType tuple, const double normal[3])
{
  for (int k = 0; k < 3; ++k)
  {
    sums[static_cast<std::size_t>(3 * tuple + k)] += normal[k];
  }
}

std::vector<double> Normalized(std::vector<double> vectors)
{
  for (std::size_t i = 0; i + 2 < vectors.size(); i += 3)
  {
    vtkMath::Normalize(&vectors[i]);
  }
  return vectors;
}

/// Of the points, three components each. Hidden cells do not count.
std::vector<double> NormalsOfPoints(vtkPolyData* block)
{
  std::vector<double> sums(3 * static_cast<std::size_t>(block->GetNumberOfPoints()), 0.0);
  const std::vector<unsigned char> flags = FindCellFlags(block);
  const vtkIdType first = block->GetNumberOfVerts() + block->GetNumberOfLines();
  VisitPolygons(WithModerateCoordinates(block),
    [&](vtkIdType cell, const vtkIdType* ids, vtkIdType size, const double normal[3])
    {
      const bool isHidden = !flags.empty() &&
        (flags[static_cast<std::size_t>(first + cell)] & vtkDataSetAttributes::HIDDENCELL) != 0;
      for (vtkIdType i = 0; !isHidden && i < size; ++i)
      {
        AddTo(sums, ids[i], normal);
      }
    });
  return Normalized(std::move(sums));
}

/// Of all cells; zero for those that are no polygons.
std::vector<double> NormalsOfCells(vtkPolyData* block)
{
  std::vector<double> sums(3 * static_cast<std::size_t>(block->GetNumberOfCells()), 0.0);
  const vtkIdType first = block->GetNumberOfVerts() + block->GetNumberOfLines();
  VisitPolygons(WithModerateCoordinates(block),
    [&](vtkIdType cell, const vtkIdType*, vtkIdType, const double normal[3])
    { AddTo(sums, first + cell, normal); });
  return Normalized(std::move(sums));
}

/// The normals of the moved surface, in the type of `given`. They point to the same side, and
/// tuples that have no normal are copied.
vtkSmartPointer<vtkDataArray> MakeMovedNormals(
  vtkDataArray* given, const std::vector<double>& before, const std::vector<double>& after)
{
  auto moved = vtkSmartPointer<vtkDataArray>::Take(given->NewInstance());
  moved->DeepCopy(given);
  double agreement = 0.0;
  double normal[3];
  for (vtkIdType i = 0; i < given->GetNumberOfTuples(); ++i)
  {
    given->GetTuple(i, normal);
    agreement += vtkMath::Dot(normal, &before[static_cast<std::size_t>(3 * i)]);
  }
  const double side = agreement < 0.0 ? -1.0 : 1.0;
  for (vtkIdType i = 0; i < given->GetNumberOfTuples(); ++i)
  {
    const double* const n = &after[static_cast<std::size_t>(3 * i)];
    if (vtkMath::Norm(n) > 0.0)
    {
      moved->SetTuple3(i, side * n[0], side * n[1], side * n[2]);
    }
  }
  return moved;
}

enum class Kind
{
  Other,
  Normals,
  Tangents
};

Kind FindKind(vtkAbstractArray* array, vtkDataSetAttributes* attributes)
{
  const std::string name = array->GetName() ? array->GetName() : "";
  const auto is = [&](int role, const char* usual)
  { return array == attributes->GetAbstractAttribute(role) || name == usual; };
  return is(vtkDataSetAttributes::NORMALS, "Normals") ? Kind::Normals
    : is(vtkDataSetAttributes::TANGENTS, "Tangents")  ? Kind::Tangents
                                                      : Kind::Other;
}

/// The arrays of `after` that are normals or tangents of the surface `before`.
std::vector<vtkAbstractArray*> FindNormalsOf(
  vtkDataSetAttributes* before, vtkDataSetAttributes* after)
{
  std::vector<vtkAbstractArray*> found;
  for (int a = 0; a < before->GetNumberOfArrays(); ++a)
  {
    vtkAbstractArray* const array = before->GetAbstractArray(a);
    bool isThere = false;
    for (int b = 0; b < after->GetNumberOfArrays(); ++b)
    {
      isThere = isThere || after->GetAbstractArray(b) == array;
    }
    if (isThere && FindKind(array, before) != Kind::Other)
    {
      found.push_back(array);
    }
  }
  return found;
}

void Remove(vtkAbstractArray* array, vtkDataSetAttributes* attributes)
{
  for (int a = attributes->GetNumberOfArrays() - 1; a >= 0; --a)
  {
    if (attributes->GetAbstractArray(a) == array)
    {
      attributes->RemoveArray(a);
    }
  }
}

} // namespace

vtkSmartPointer<vtkDataArray> ComputePointNormals(vtkPolyData* block)
{
  const std::vector<double> normals = NormalsOfPoints(block);
  const auto array = NewArray<vtkFloatArray>("Normals", 3, block->GetNumberOfPoints());
  for (vtkIdType i = 0; i < block->GetNumberOfPoints(); ++i)
  {
    array->SetTuple(i, &normals[static_cast<std::size_t>(3 * i)]);
  }
  return array;
}

void UpdateNormals(vtkPolyData* before, vtkPolyData* after)
{
  for (const int type : { vtkDataObject::POINT, vtkDataObject::CELL })
  {
    vtkDataSetAttributes* const given = before->GetAttributes(type);
    vtkDataSetAttributes* const made = after->GetAttributes(type);
    const bool onPoints = type == vtkDataObject::POINT;
    const auto normalsOf = [&](vtkPolyData* surface)
    { return onPoints ? NormalsOfPoints(surface) : NormalsOfCells(surface); };
    for (vtkAbstractArray* const array : FindNormalsOf(given, made))
    {
      const bool isActive = made->GetNormals() == array;
      auto* const normals = vtkDataArray::SafeDownCast(array);
      const vtkIdType tuples = onPoints ? after->GetNumberOfPoints() : after->GetNumberOfCells();
      const bool isKept = normals && FindKind(array, given) == Kind::Normals &&
        normals->GetNumberOfComponents() == 3 && normals->GetNumberOfTuples() == tuples;
      const auto moved =
        isKept ? MakeMovedNormals(normals, normalsOf(before), normalsOf(after)) : nullptr;
      Remove(array, made);
      if (moved)
      {
        const int index = made->AddArray(moved);
        if (isActive)
        {
          made->SetActiveAttribute(index, vtkDataSetAttributes::NORMALS);
        }
      }
    }
  }
}

void DropNormals(vtkPolyData* before, vtkPolyData* after)
{
  for (const int type : { vtkDataObject::POINT, vtkDataObject::CELL })
  {
    for (vtkAbstractArray* const array :
      FindNormalsOf(before->GetAttributes(type), after->GetAttributes(type)))
    {
      Remove(array, after->GetAttributes(type));
    }
  }
}

} // namespace SurfaceDiffusion
