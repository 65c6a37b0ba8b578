// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkSurfaceDiffusionNamespace.h"

#include "vtkType.h"

#include <string>
#include <vector>

VTK_ABI_NAMESPACE_BEGIN
class vtkDataObject;
class vtkInformation;
class vtkInformationVector;
class vtkMultiProcessController;
class vtkPolyData;
VTK_ABI_NAMESPACE_END

namespace SurfaceDiffusion
{

class Processes;

/// A vtkPolyData of the input and its copy in the output.
struct SurfacePiece
{
  int Surface; ///< pieces with the same number, in all processes, belong to one surface
  vtkPolyData* Input;
  vtkPolyData* Output;
};

/// Makes the output object at port 0 of a filter that accepts polydata and composite data: one of
/// the input's type. False without input.
bool MakeOutputObject(vtkInformationVector** inputs, vtkInformationVector* outputs);

/// Makes the output a shallow copy of the input, blocks included, and lists the polydata. Blocks of
/// multi-block data and members of collections are separate surfaces. The partitions of a
/// vtkPartitionedDataSet and the pieces of a vtkMultiPieceDataSet are pieces of one surface.
std::vector<SurfacePiece> CopyStructure(vtkDataObject* input, vtkDataObject* output);

/// The data without blocks that composite data consist of, or the data themselves. Null gives none.
std::vector<vtkDataObject*> ListLeaves(vtkDataObject* data);

/// The surface that each of them is a piece of, see SurfacePiece.
std::vector<int> ListSurfaces(vtkDataObject* data);

/// What messages say about the parts of an input.
struct InputDescription
{
  /// Of composite data, by the number of a surface: the name of the block in quotation marks, or
  /// its indices, as 0/2. Otherwise empty.
  std::vector<std::string> SurfaceNames;
  std::string OtherTypes; ///< the classes of the leaves that are no polydata
  bool IsComposite = false;
};
InputDescription DescribeInput(vtkDataObject* input);

/// The error if the input is one of several pieces and the controller gives no access to the
/// others; otherwise empty. whole: the user states that each piece is a separate surface.
std::string DescribeLonePiece(
  vtkInformationVector** inputs, vtkMultiProcessController* controller, bool whole);

/// The pieces of all processes together.
struct PieceSummary
{
  bool OneSurface = true; ///< all belong to one surface, and no process has several
  vtkIdType NumberOfPoints = 0;
};

/// Collective.
PieceSummary SummarizePieces(const Processes& processes, const std::vector<SurfacePiece>& pieces);

bool HasPoints(const std::vector<SurfacePiece>& pieces);

/// Whether one of the surfaces has several pieces with points.
bool HasSurfaceInPieces(const std::vector<SurfacePiece>& pieces);

} // namespace SurfaceDiffusion
