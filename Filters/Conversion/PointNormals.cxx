// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Conversion/PointNormals.h"

#include "Conversion/NewArray.h"

#include "vtkBoundingBox.h"
#include "vtkCellArray.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolygon.h"

#include <algorithm>
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

/// The sums of the normals of polygons at their points.
class NormalSums
{
public:
  explicit NormalSums(vtkPolyData* block)
    : Coordinates(block->GetPoints())
    , Sums(3 * static_cast<std::size_t>(block->GetNumberOfPoints()), 0.0)
  {
    this->AddCells(block->GetPolys(), false);
    this->AddCells(block->GetStrips(), true);
  }

  std::vector<double>& Get() { return this->Sums; }

private:
  void AddCells(vtkCellArray* cells, bool strips)
  {
    const vtkIdType count = cells ? cells->GetNumberOfCells() : 0;
    const vtkIdType points = this->Coordinates->GetNumberOfPoints();
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
        this->AddPolygon(size, ids);
      }
      for (vtkIdType i = 0; strips && i + 2 < size; ++i)
      {
        const vtkIdType corners[3] = { ids[i], ids[i + 1 + i % 2], ids[i + 2 - i % 2] };
        this->AddPolygon(3, corners);
      }
    }
  }

  void AddPolygon(vtkIdType size, const vtkIdType* ids)
  {
    double normal[3];
    vtkPolygon::ComputeNormal(this->Coordinates, static_cast<int>(size), ids, normal);
    for (vtkIdType i = 0; i < size; ++i)
    {
      for (int k = 0; k < 3; ++k)
      {
        this->Sums[3 * ids[i] + k] += normal[k];
      }
    }
  }

  vtkPoints* Coordinates;
  std::vector<double> Sums;
};

} // namespace

vtkSmartPointer<vtkDataArray> ComputePointNormals(vtkPolyData* block)
{
  const vtkSmartPointer<vtkPolyData> surface = WithModerateCoordinates(block);
  NormalSums normals(surface);
  const auto array = NewArray<vtkFloatArray>("Normals", 3, block->GetNumberOfPoints());
  for (vtkIdType i = 0; i < block->GetNumberOfPoints(); ++i)
  {
    double* normal = normals.Get().data() + 3 * i;
    vtkMath::Normalize(normal);
    array->SetTuple(i, normal);
  }
  return array;
}

} // namespace SurfaceDiffusion
