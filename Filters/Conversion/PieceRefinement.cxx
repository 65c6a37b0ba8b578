// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Conversion/PieceRefinement.h"

#include "Conversion/NewArray.h"
#include "Conversion/ResultWriter.h"
#include "Conversion/SurfaceReader.h"
#include "Core/Surface/EdgeLengths.h"
#include "Core/Surface/EdgeRefinement.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkTypeInt64Array.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

bool IsInteger(vtkDataArray* array)
{
  return array->GetDataType() != VTK_FLOAT && array->GetDataType() != VTK_DOUBLE;
}

/// The array with a tuple more for each pair of parents.
vtkSmartPointer<vtkAbstractArray> Interpolate(
  vtkAbstractArray* from, const std::vector<std::array<Index, 2>>& parents, PointRole role)
{
  const vtkIdType count = from->GetNumberOfTuples();
  const auto more = static_cast<vtkIdType>(parents.size());
  auto to = vtkSmartPointer<vtkAbstractArray>::Take(from->NewInstance());
  to->SetName(from->GetName());
  to->SetNumberOfComponents(from->GetNumberOfComponents());
  to->CopyComponentNames(from);
  to->SetNumberOfTuples(count + more);
  to->InsertTuples(0, count, 0, from);
  auto* const numbers = vtkDataArray::SafeDownCast(to);
  const int components = from->GetNumberOfComponents();
  const bool areIntegers = numbers && IsInteger(numbers);
  for (vtkIdType i = 0; i < more; ++i)
  {
    const auto& [a, b] = parents[static_cast<std::size_t>(i)];
    if (!numbers)
    {
      to->InsertTuple(count + i, std::min(a, b), to);
      continue;
    }
    for (int k = 0; k < components; ++k)
    {
      numbers->SetComponent(count + i, k,
        ValueBetween(role, areIntegers, components == 1, numbers->GetComponent(a, k),
          numbers->GetComponent(b, k)));
    }
  }
  return to;
}

/// Arrays that do not have a tuple per point are left out. points: their number.
void InterpolatePointData(vtkPointData* from, vtkIdType points, vtkPointData* to,
  const std::vector<std::array<Index, 2>>& parents, const RefinementRules& rules)
{
  const auto hasName = [](vtkAbstractArray* array, const std::string& name)
  { return !name.empty() && array->GetName() && name == array->GetName(); };
  for (int n = 0; n < from->GetNumberOfArrays(); ++n)
  {
    vtkAbstractArray* const array = from->GetAbstractArray(n);
    const int attribute = from->IsArrayAnAttribute(n);
    if (attribute == vtkDataSetAttributes::GLOBALIDS || array->GetNumberOfTuples() != points)
    {
      continue;
    }
    const bool isMark = std::any_of(rules.Marks.begin(), rules.Marks.end(),
      [&](const std::string& name) { return hasName(array, name); });
    const PointRole role = hasName(array, rules.Mask) ? PointRole::Mask
      : hasName(array, rules.Weights)                 ? PointRole::Weight
      : isMark                                        ? PointRole::Mark
                                                      : PointRole::Data;
    const int added = to->AddArray(Interpolate(array, parents, role));
    if (attribute >= 0)
    {
      to->SetActiveAttribute(added, attribute);
    }
  }
}

} // namespace

PieceRefinement::Piece& PieceRefinement::Find(std::size_t number, vtkPolyData* input)
{
  this->Pieces.resize(std::max(this->Pieces.size(), number + 1));
  Piece& piece = this->Pieces[number];
  const Fingerprint version = FingerprintSurface(input);
  if (piece.Version != version)
  {
    piece = Piece();
    piece.Version = version;
  }
  return piece;
}

PieceRefinement::EdgeSum PieceRefinement::SumEdges(const std::vector<SurfacePiece>& pieces)
{
  EdgeSum sum;
  for (std::size_t p = 0; p < pieces.size(); ++p)
  {
    Piece& piece = this->Find(p, pieces[p].Input);
    if (piece.SumOfEdges < 0.0)
    {
      TriangleCells cells;
      const SurfaceArrays arrays = ReadSurface(pieces[p].Input, nullptr, false, cells);
      const EdgeLengths counted = MeasureEdgeLengths(arrays.Points, arrays.Triangles);
      piece.SumOfEdges = counted.Sum;
      piece.NumberOfEdges = counted.Number;
    }
    sum.Length += piece.SumOfEdges;
    sum.Number += piece.NumberOfEdges;
  }
  return sum;
}

void PieceRefinement::Bisect(Piece& piece, vtkPolyData* input, double length,
  Index maximumTriangles, const ProgressMonitor& progress)
{
  TriangleCells cells;
  const SurfaceArrays arrays = ReadSurface(input, nullptr, false, cells);
  RequireFiniteCoordinates(arrays.Points);
  const RefinedSurface refined =
    RefineEdges(arrays.Points, arrays.Triangles, length, maximumTriangles, progress);
  piece.Points = nullptr;
  if (!refined.Parents.empty())
  {
    piece.Points = WritePoints(refined.Vertices, input->GetPoints());
    const auto count = static_cast<vtkIdType>(refined.Faces.rows());
    const auto offsets = NewArray<vtkTypeInt64Array>("", 1, count + 1);
    const auto corners = NewArray<vtkTypeInt64Array>("", 1, 3 * count);
    for (vtkIdType t = 0; t <= count; ++t)
    {
      offsets->SetValue(t, 3 * t);
    }
    std::copy(
      refined.Faces.data(), refined.Faces.data() + refined.Faces.size(), corners->GetPointer(0));
    piece.Triangles = vtkSmartPointer<vtkCellArray>::New();
    piece.Triangles->SetData(offsets, corners);
    piece.CellOf.clear();
    for (const Index t : refined.InputTriangle)
    {
      piece.CellOf.push_back(cells[static_cast<std::size_t>(t)]);
    }
    piece.Parents = refined.Parents;
  }
  piece.LongestEdge = refined.LongestEdge;
  piece.LimitReached = refined.LimitReached;
  piece.Length = length;
  piece.MaximumTriangles = maximumTriangles;
}

vtkSmartPointer<vtkPolyData> PieceRefinement::MakeSurface(
  const Piece& piece, vtkPolyData* input, const RefinementRules& rules)
{
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  surface->SetPoints(piece.Points);
  surface->SetVerts(input->GetVerts());
  surface->SetLines(input->GetLines());
  surface->SetPolys(piece.Triangles);
  surface->GetFieldData()->ShallowCopy(input->GetFieldData());
  InterpolatePointData(input->GetPointData(), input->GetNumberOfPoints(), surface->GetPointData(),
    piece.Parents, rules);
  const vtkIdType others = input->GetNumberOfVerts() + input->GetNumberOfLines();
  const auto ids =
    NewArray<vtkIdTypeArray>(IdsName, 1, others + static_cast<vtkIdType>(piece.CellOf.size()));
  vtkNew<vtkIdList> from, to;
  for (vtkIdType c = 0; c < ids->GetNumberOfTuples(); ++c)
  {
    ids->SetValue(c, c < others ? c : piece.CellOf[static_cast<std::size_t>(c - others)]);
    from->InsertNextId(ids->GetValue(c));
    to->InsertNextId(c);
  }
  vtkCellData* const cells = surface->GetCellData();
  cells->CopyGlobalIdsOff();
  cells->CopyAllocate(input->GetCellData(), ids->GetNumberOfTuples());
  cells->CopyData(input->GetCellData(), from, to);
  cells->AddArray(ids);
  return surface;
}

/// points: the number of those of the input.
void PieceRefinement::MarkMeasured(const Piece& piece, vtkIdType points, vtkPolyData* surface)
{
  const auto between = NewArray<vtkUnsignedCharArray>(BetweenName, 1, surface->GetNumberOfPoints());
  for (vtkIdType i = 0; i < between->GetNumberOfTuples(); ++i)
  {
    between->SetValue(i, i < points ? 0 : 1);
  }
  surface->GetPointData()->AddArray(between);
  const auto given = NewArray<vtkIdTypeArray>(GivenCellsName, 1, surface->GetNumberOfCells());
  const vtkIdType others = surface->GetNumberOfVerts() + surface->GetNumberOfLines();
  for (vtkIdType c = 0; c < given->GetNumberOfTuples(); ++c)
  {
    given->SetValue(
      c, piece.Points && c >= others ? piece.CellOf[static_cast<std::size_t>(c - others)] : c);
  }
  surface->GetCellData()->AddArray(given);
}

double PieceRefinement::Bisect(const std::vector<SurfacePiece>& pieces, double length,
  Index maximumTriangles, const ProgressMonitor& progress)
{
  this->Pieces.resize(pieces.size()); // no others are kept
  double longest = 0.0;
  for (std::size_t p = 0; p < pieces.size(); ++p)
  {
    vtkPolyData* const input = pieces[p].Input;
    Piece& piece = this->Find(p, input);
    if (piece.Length != length || piece.MaximumTriangles != maximumTriangles)
    {
      Bisect(piece, input, length, maximumTriangles, progress);
    }
    longest = std::max(longest, piece.LimitReached ? piece.LongestEdge : 0.0);
  }
  return longest;
}

Index PieceRefinement::Replace(std::vector<SurfacePiece>& pieces, const RefinementRules& rules)
{
  Index triangles = 0;
  for (std::size_t p = 0; p < pieces.size(); ++p)
  {
    const Piece& piece = this->Pieces[p];
    vtkPolyData* const input = pieces[p].Input;
    auto surface = vtkSmartPointer<vtkPolyData>::New();
    if (piece.Points)
    {
      surface = MakeSurface(piece, input, rules);
      pieces[p].Output->ShallowCopy(surface);
      triangles += static_cast<Index>(piece.CellOf.size());
    }
    else
    {
      surface->ShallowCopy(input);
    }
    this->Replaced.push_back({ input, surface, pieces[p].Output });
    MarkMeasured(piece, input->GetNumberOfPoints(), surface);
    pieces[p].Input = surface;
  }
  return triangles;
}

void PieceRefinement::Undo()
{
  for (const Replacement& replacement : this->Replaced)
  {
    replacement.Output->ShallowCopy(replacement.Before);
  }
}

} // namespace SurfaceDiffusion
