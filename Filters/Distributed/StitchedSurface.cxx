// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/StitchedSurface.h"

#include "Conversion/PieceRefinement.h"
#include "Distributed/PackedPiece.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkFieldData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkTypeInt64Array.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <map>
#include <string>
#include <tuple>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

vtkTypeInt64Array* GetIds(vtkDataSetAttributes* attributes, const char* name)
{
  return vtkTypeInt64Array::SafeDownCast(attributes->GetAbstractArray(name));
}

/// Arrays of the pieces that the surface does not have become arrays without tuples, so that a
/// result that replaces one is noticed.
void KeepNames(vtkFieldData* fields, const char* list, vtkDataSetAttributes* attributes)
{
  auto* const names = vtkStringArray::SafeDownCast(fields->GetAbstractArray(list));
  for (vtkIdType i = 0; names && i < names->GetNumberOfValues(); ++i)
  {
    const std::string name = names->GetValue(i);
    if (!attributes->HasArray(name.c_str()))
    {
      vtkNew<vtkUnsignedCharArray> placeholder;
      placeholder->SetName(name.c_str());
      attributes->AddArray(placeholder);
    }
  }
}

} // namespace

struct StitchedSurface::Cell
{
  bool IsStrip;
  vtkIdType Id; ///< 0 without global ids
  std::vector<vtkIdType> Points;
  Source From;

  bool operator<(const Cell& other) const
  {
    return std::tie(this->IsStrip, this->Id, this->Points) <
      std::tie(other.IsStrip, other.Id, other.Points);
  }
  std::vector<vtkIdType> SortedPoints() const
  {
    std::vector<vtkIdType> sorted = this->Points;
    std::sort(sorted.begin(), sorted.end());
    return sorted;
  }
};

void StitchedSurface::StitchPieces()
{
  vtkNew<vtkPolyData> surface;
  this->StitchPoints(surface);
  this->StitchCells(surface);
  for (const GatheredPiece& piece : this->Pieces)
  {
    vtkFieldData* const fields = piece.Data->GetFieldData();
    KeepNames(fields, PackedArrays::PointArrayNames, surface->GetPointData());
    KeepNames(fields, PackedArrays::CellArrayNames, surface->GetCellData());
  }
  this->Data = surface;
  for (GatheredPiece& piece : this->Pieces)
  {
    piece.Data = nullptr;
  }
}

/// The points that have their own label, ordered by id.
std::vector<StitchedSurface::Source> StitchedSurface::FindOwnedPoints() const
{
  struct Owned
  {
    vtkIdType Id;
    Source From;
  };
  std::vector<Owned> owned;
  for (std::size_t p = 0; p < this->Pieces.size(); ++p)
  {
    const GatheredPiece& piece = this->Pieces[p];
    vtkTypeInt64Array* const labels = GetIds(piece.Data->GetPointData(), PackedArrays::Labels);
    vtkTypeInt64Array* const ids = GetIds(piece.Data->GetPointData(), PackedArrays::PointIds);
    for (vtkIdType i = 0; i < piece.NumberOfPoints; ++i)
    {
      if (labels->GetValue(i) == piece.FirstLabel + i)
      {
        owned.push_back({ ids->GetValue(i), { p, i } });
      }
    }
  }
  std::stable_sort(
    owned.begin(), owned.end(), [](const Owned& a, const Owned& b) { return a.Id < b.Id; });
  std::vector<Source> sources;
  sources.reserve(owned.size());
  for (const Owned& point : owned)
  {
    sources.push_back(point.From);
  }
  return sources;
}

void StitchedSurface::StitchPoints(vtkPolyData* surface)
{
  const std::vector<Source> sources = this->FindOwnedPoints();
  const bool anyDouble = std::any_of(this->Pieces.begin(), this->Pieces.end(),
    [](const GatheredPiece& piece)
    { return piece.NumberOfPoints > 0 && piece.Data->GetPoints()->GetDataType() == VTK_DOUBLE; });
  vtkNew<vtkPoints> points;
  points->SetDataType(anyDouble ? VTK_DOUBLE : VTK_FLOAT);
  points->SetNumberOfPoints(static_cast<vtkIdType>(sources.size()));
  std::vector<vtkIdType> pointOfLabel(this->NumberOfLabels, -1);
  for (std::size_t i = 0; i < sources.size(); ++i)
  {
    const GatheredPiece& piece = this->Pieces[sources[i].Piece];
    points->SetPoint(static_cast<vtkIdType>(i), piece.Data->GetPoint(sources[i].Index));
    pointOfLabel[piece.FirstLabel + sources[i].Index] = static_cast<vtkIdType>(i);
  }
  surface->SetPoints(points);
  for (GatheredPiece& piece : this->Pieces)
  {
    vtkTypeInt64Array* const labels = GetIds(piece.Data->GetPointData(), PackedArrays::Labels);
    piece.SurfacePoints.resize(piece.NumberOfPoints);
    for (vtkIdType i = 0; i < piece.NumberOfPoints; ++i)
    {
      piece.SurfacePoints[i] = pointOfLabel[labels->GetValue(i)];
    }
  }
  this->MergeArrays(sources, false, surface->GetPointData());
  if (!surface->GetPointData()->GetGlobalIds())
  {
    surface->GetPointData()->RemoveArray(PackedArrays::PointIds); // of places, for the order alone
  }
}

/// The cells of all pieces, with points of the surface, apart from ghost cells.
void StitchedSurface::ReadCells(std::vector<Cell>& cells, std::vector<Cell>& ghosts) const
{
  constexpr unsigned char ignored =
    vtkDataSetAttributes::DUPLICATECELL | vtkDataSetAttributes::HIDDENCELL;
  const bool haveIds = std::all_of(this->Pieces.begin(), this->Pieces.end(),
    [](const GatheredPiece& piece)
    {
      return piece.Data->GetNumberOfCells() == 0 ||
        GetIds(piece.Data->GetCellData(), PackedArrays::CellIds);
    });
  for (std::size_t p = 0; p < this->Pieces.size(); ++p)
  {
    const GatheredPiece& piece = this->Pieces[p];
    vtkUnsignedCharArray* const flags = piece.Data->GetCellGhostArray();
    vtkTypeInt64Array* const cellIds =
      haveIds ? GetIds(piece.Data->GetCellData(), PackedArrays::CellIds) : nullptr;
    vtkIdType index = 0;
    for (vtkCellArray* array : { piece.Data->GetPolys(), piece.Data->GetStrips() })
    {
      const bool isStrip = array == piece.Data->GetStrips();
      const vtkIdType count = array ? array->GetNumberOfCells() : 0;
      for (vtkIdType c = 0; c < count; ++c, ++index)
      {
        vtkIdType size = 0;
        const vtkIdType* ids = nullptr;
        array->GetCellAtId(c, size, ids);
        Cell cell{ isStrip, cellIds ? cellIds->GetValue(index) : 0, {}, { p, index } };
        for (vtkIdType i = 0; i < size; ++i)
        {
          // Ids out of range stay so, for the filter to report.
          const bool isGood = ids[i] >= 0 && ids[i] < piece.NumberOfPoints;
          cell.Points.push_back(isGood ? piece.SurfacePoints[ids[i]] : -1);
        }
        const bool isGhost = flags && (flags->GetValue(index) & ignored);
        (isGhost ? ghosts : cells).push_back(std::move(cell));
      }
    }
  }
}

void StitchedSurface::StitchCells(vtkPolyData* surface)
{
  std::vector<Cell> cells, ghosts;
  this->ReadCells(cells, ghosts);
  std::stable_sort(cells.begin(), cells.end()); // cells may be equal
  for (GatheredPiece& piece : this->Pieces)
  {
    piece.SurfaceCells.assign(piece.Data->GetNumberOfCells(), -1);
  }
  vtkNew<vtkCellArray> polygons, strips;
  std::vector<Source> sources;
  for (const Cell& cell : cells)
  {
    (cell.IsStrip ? strips : polygons)
      ->InsertNextCell(static_cast<vtkIdType>(cell.Points.size()), cell.Points.data());
    this->Pieces[cell.From.Piece].SurfaceCells[cell.From.Index] =
      static_cast<vtkIdType>(sources.size());
    sources.push_back(cell.From);
  }
  surface->SetPolys(polygons);
  surface->SetStrips(strips);
  this->MergeArrays(sources, true, surface->GetCellData());
  if (vtkDataArray* const given = surface->GetCellData()->GetArray(PieceRefinement::GivenCellsName))
  {
    TellPiecesApart(sources, given);
  }
  this->FindOriginals(cells, ghosts);
}

/// Each piece has numbered its cells by itself.
void StitchedSurface::TellPiecesApart(const std::vector<Source>& sources, vtkDataArray* numbers)
{
  std::map<std::pair<std::size_t, double>, std::size_t> found;
  for (std::size_t i = 0; i < sources.size(); ++i)
  {
    const auto cell = static_cast<vtkIdType>(i);
    const auto inserted =
      found.insert({ { sources[i].Piece, numbers->GetComponent(cell, 0) }, found.size() });
    numbers->SetComponent(cell, 0, static_cast<double>(inserted.first->second));
  }
}

/// A ghost cell gets the results of the cell with the same corners.
void StitchedSurface::FindOriginals(const std::vector<Cell>& cells, const std::vector<Cell>& ghosts)
{
  std::map<std::vector<vtkIdType>, vtkIdType> cellOfCorners;
  for (std::size_t c = 0; !ghosts.empty() && c < cells.size(); ++c)
  {
    cellOfCorners.emplace(cells[c].SortedPoints(), static_cast<vtkIdType>(c));
  }
  for (const Cell& ghost : ghosts)
  {
    const auto original = cellOfCorners.find(ghost.SortedPoints());
    if (original != cellOfCorners.end())
    {
      this->Pieces[ghost.From.Piece].SurfaceCells[ghost.From.Index] = original->second;
    }
  }
}

/// The arrays that all pieces with points, or cells, have, each tuple from its source.
void StitchedSurface::MergeArrays(
  const std::vector<Source>& sources, bool fromCells, vtkDataSetAttributes* merged) const
{
  const auto attributesOf = [&](const GatheredPiece& piece) -> vtkDataSetAttributes*
  {
    return fromCells ? static_cast<vtkDataSetAttributes*>(piece.Data->GetCellData())
                     : piece.Data->GetPointData();
  };
  vtkDataSetAttributes::FieldList fields;
  std::vector<int> inputOf(this->Pieces.size(), -1);
  int inputs = 0;
  for (std::size_t p = 0; p < this->Pieces.size(); ++p)
  {
    const GatheredPiece& piece = this->Pieces[p];
    if (fromCells ? piece.Data->GetNumberOfCells() > 0 : piece.NumberOfPoints > 0)
    {
      fields.IntersectFieldList(attributesOf(piece));
      inputOf[p] = inputs++;
    }
  }
  const auto count = static_cast<vtkIdType>(sources.size());
  merged->CopyAllOn();
  for (const char* const name :
    { PackedArrays::Labels, PackedArrays::CellIds, vtkDataSetAttributes::GhostArrayName() })
  {
    merged->CopyFieldOff(name);
  }
  if (inputs > 0)
  {
    fields.CopyAllocate(merged, vtkDataSetAttributes::COPYTUPLE, count, 0);
    merged->SetNumberOfTuples(count);
  }
  for (std::size_t i = 0; i < sources.size(); ++i)
  {
    const std::size_t p = sources[i].Piece;
    fields.CopyData(inputOf[p], attributesOf(this->Pieces[p]), sources[i].Index, merged,
      static_cast<vtkIdType>(i));
  }
}

} // namespace SurfaceDiffusion
