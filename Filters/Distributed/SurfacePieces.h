// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

class vtkAlgorithm;
class vtkDataObject;
class vtkInformation;
class vtkInformationVector;
class vtkMultiProcessController;
class vtkPolyData;

namespace SurfaceDiffusion
{

class Processes;

/// A vtkPolyData of the input, and its copy in the output.
struct SurfacePiece
{
  int Surface; ///< pieces with one number, in all processes, are pieces of one surface
  vtkPolyData* Input;
  vtkPolyData* Output;
};

/// Make the output objects of a filter that takes polydata and composite data: port 0 of the
/// input's type. False without input.
bool MakeOutputObject(vtkInformationVector** inputs, vtkInformationVector* outputs);

/// Make the output a shallow copy of the input, down to the blocks, and list the polydata. Blocks
/// of multi-block data and members of collections are surfaces of their own, the partitions of a
/// vtkPartitionedDataSet and the pieces of a vtkMultiPieceDataSet are pieces of one.
std::vector<SurfacePiece> CopyStructure(vtkDataObject* input, vtkDataObject* output);

/// Whether the input is one of several pieces of which this process can see no other; tells the
/// error then. whole: the user says that each is a surface.
bool IsLonePiece(vtkAlgorithm* filter, vtkInformationVector** inputs,
  vtkMultiProcessController* controller, bool whole);

/// The pieces of all processes together.
struct PieceSummary
{
  bool OneSurface = true; ///< all belong to one surface, and no process has several
  double NumberOfPoints = 0.0;
};

/// Collective.
PieceSummary SummarizePieces(const Processes& processes, const std::vector<SurfacePiece>& pieces);

bool HasPoints(const std::vector<SurfacePiece>& pieces);

/// Whether points of several pieces belong to one surface.
bool HasSurfaceInPieces(const std::vector<SurfacePiece>& pieces);

} // namespace SurfaceDiffusion
