// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Operators/Assembler.h"
#include "Core/Surface/IntrinsicDelaunay.h"

#include "vtkType.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

class vtkDataArray;
class vtkPolyData;

namespace SurfaceDiffusion
{

/// Throws std::runtime_error where the array has not one tuple for each of `count`.
void RequireTuples(vtkDataArray* array, vtkIdType count, const char* what);

/// The surface that the numerics work on, made from a vtkPolyData, and the way back to its points.
struct PolyDataSurface
{
  /// What it is made from, beside the polydata itself.
  struct Options
  {
    bool MergeCoincidentPoints = false;
    double MergeTolerance = 0.0;
    bool IntrinsicDelaunay = false;
    double LengthUnit = 0.0; ///< of the meshes; 0: chosen by the surface's size
    vtkDataArray* Excluded = nullptr; ///< per point; triangles with a nonzero corner take no part
  };

  /// What was left out or looks unintended, to be told to the user.
  struct Findings
  {
    vtkIdType DegenerateTriangles = 0;
    vtkIdType UnusedPoints = 0; ///< of no participating triangle, excluded ones not counted
    vtkIdType NonManifoldEdges = 0;
    vtkIdType CoincidentBoundaryPoints = 0; ///< where merging is off
  };

  /// Throws std::runtime_error on coordinates that are not finite and on more points or triangles
  /// than 32-bit numbers count; Aborted.
  PolyDataSurface(vtkPolyData* input, const Options& options, const ProgressMonitor& progress);

  /// Declare this surface a process's part of one. Only without IntrinsicDelaunay.
  void SetPartition(std::shared_ptr<const Partition> partition)
  {
    this->InputMesh->SetPartition(std::move(partition));
  }

  /// A text that differs whenever another surface would come out.
  static std::string Key(vtkPolyData* input, const Options& options);

  SurfaceDiffusion::Points Points; ///< per input point
  SurfaceDiffusion::Triangles Triangles; ///< rows of Points; merged points are one of them
  std::vector<vtkIdType> TriangleCells; ///< the input's cell of each row of Triangles
  std::shared_ptr<TriangleMesh> InputMesh; ///< of rows of Triangles
  std::shared_ptr<const SurfaceDiffusion::IntrinsicDelaunay> Delaunay; ///< null if not asked for
  /// What the models work on: InputMesh, or Delaunay->Mesh(), which has the same vertices.
  std::shared_ptr<const TriangleMesh> Mesh;
  std::shared_ptr<const Assembler> Operators;
  std::vector<Index> PointToVertex; ///< -1 where a point takes no part
  Findings Found;
};

} // namespace SurfaceDiffusion
