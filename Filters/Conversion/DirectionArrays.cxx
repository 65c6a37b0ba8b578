// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Conversion/DirectionArrays.h"

#include "Conversion/NewArray.h"
#include "Core/Surface/TangentVectors.h"

#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkPolyData.h"

#include <Eigen/Eigenvalues>

#include <sstream>
#include <stdexcept>

namespace SurfaceDiffusion
{

namespace
{

/// One vector per row.
Points ReadDirections(vtkDataArray* array)
{
  Points vectors(array->GetNumberOfTuples(), 3);
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    array->GetTuple(i, vectors.row(i).data());
    if (vectors.row(i).array().isInf().any())
    {
      std::ostringstream text;
      text << "DirectionArray \"" << (array->GetName() ? array->GetName() : "")
           << "\" is infinite at tuple " << i << "; allowed: finite values and NaN";
      throw std::runtime_error(text.str());
    }
  }
  return vectors;
}

} // namespace

TangentVectors ReadFrames(
  const PolyDataSurface& surface, vtkDataArray* array, bool onCells, const ParallelFor& parallel)
{
  const Points vectors = ReadDirections(array);
  if (!onCells)
  {
    return TangentVectorsFromPointVectors(
      *surface.InputMesh, surface.Points, surface.Triangles, vectors, parallel);
  }
  Points ofTriangles(surface.Triangles.rows(), 3);
  for (Eigen::Index t = 0; t < ofTriangles.rows(); ++t)
  {
    ofTriangles.row(t) = vectors.row(surface.TriangleCells[t]);
  }
  return TangentVectorsFromTriangleVectors(
    *surface.InputMesh, surface.Points, surface.Triangles, ofTriangles, parallel);
}

vtkSmartPointer<vtkDataArray> WriteFrames(const PolyDataSurface& surface, vtkPolyData* input,
  const TangentVectors& frames, const std::string& name, const ParallelFor& parallel)
{
  const TriangleMesh& mesh = *surface.InputMesh;
  const Points vectors = VectorsInSpace(mesh, surface.Points, surface.Triangles, frames, parallel);
  auto array = NewArray<vtkDoubleArray>(name, 3, input->GetNumberOfCells());
  array->Fill(0.0);

  Vector areas = Vector::Zero(surface.Triangles.rows());
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    areas[mesh.InputTriangle()[t]] = mesh.Shapes()[t].Area();
  }
  // The triangles of a cell follow one another.
  for (Eigen::Index begin = 0, end = 0; begin < vectors.rows(); begin = end)
  {
    const vtkIdType cell = surface.TriangleCells[begin];
    Eigen::Matrix3d tensor = Eigen::Matrix3d::Zero();
    for (end = begin; end < vectors.rows() && surface.TriangleCells[end] == cell; ++end)
    {
      tensor += areas[end] * vectors.row(end).transpose() * vectors.row(end);
    }
    Eigen::Vector3d direction = vectors.row(begin);
    if (end - begin > 1)
    {
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(tensor);
      direction = axes.eigenvalues()[2] > 0.0 ? Eigen::Vector3d(axes.eigenvectors().col(2))
                                              : Eigen::Vector3d(Eigen::Vector3d::Zero());
    }
    array->SetTuple(cell, direction.data());
  }
  return array;
}

} // namespace SurfaceDiffusion
