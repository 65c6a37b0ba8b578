// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/InterfacePoints.h"

#include "Distributed/CellFlags.h"

#include "vtkCellArray.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// Finds the points that the cells of a piece use, ghost cells not counted, and those on edges of
/// one triangle.
class OpenPoints
{
public:
  /// candidates: the points that matter.
  OpenPoints(vtkPolyData* data, const std::vector<char>& candidates)
    : Candidates(candidates)
    , Used(candidates.size(), 0)
    , OnEdge(candidates.size(), 0)
  {
    const std::vector<unsigned char> ghosts = FindCellFlags(data);
    const unsigned char* const flags = ghosts.empty() ? nullptr : ghosts.data();
    vtkIdType cell = data->GetNumberOfVerts() + data->GetNumberOfLines();
    this->AddCells(data->GetPolys(), flags ? flags + cell : nullptr, false);
    cell += data->GetNumberOfPolys();
    this->AddCells(data->GetStrips(), flags ? flags + cell : nullptr, true);
    std::sort(this->Edges.begin(), this->Edges.end());
    for (std::size_t begin = 0, end = 0; begin < this->Edges.size(); begin = end)
    {
      while (end < this->Edges.size() && this->Edges[end] == this->Edges[begin])
      {
        ++end;
      }
      if (end == begin + 1)
      {
        this->OnEdge[this->Edges[begin].first] = this->OnEdge[this->Edges[begin].second] = 1;
      }
    }
  }

  bool IsUsed(vtkIdType point) const { return this->Used[point] != 0; }
  bool IsOnEdge(vtkIdType point) const { return this->OnEdge[point] != 0; }

private:
  void AddCells(vtkCellArray* cells, const unsigned char* ghosts, bool strips)
  {
    constexpr unsigned char ignored =
      vtkDataSetAttributes::DUPLICATECELL | vtkDataSetAttributes::HIDDENCELL;
    const vtkIdType count = cells ? cells->GetNumberOfCells() : 0;
    const auto points = static_cast<vtkIdType>(this->Candidates.size());
    for (vtkIdType c = 0; c < count; ++c)
    {
      vtkIdType size = 0;
      const vtkIdType* ids = nullptr;
      cells->GetCellAtId(c, size, ids);
      if ((ghosts && (ghosts[c] & ignored)) ||
        std::any_of(ids, ids + size, [&](vtkIdType id) { return id < 0 || id >= points; }))
      {
        continue; // the filter reports point ids out of range later
      }
      for (vtkIdType i = 0; i < size; ++i)
      {
        this->Used[ids[i]] = 1;
      }
      for (vtkIdType i = 0; strips && i + 2 < size; ++i)
      {
        const vtkIdType corners[3] = { ids[i], ids[i + 1], ids[i + 2] };
        this->AddPolygon(3, corners);
      }
      if (!strips)
      {
        this->AddPolygon(size, ids);
      }
    }
  }

  void AddPolygon(vtkIdType size, const vtkIdType* ids)
  {
    for (vtkIdType i = 0; i < size; ++i)
    {
      const vtkIdType a = ids[i];
      const vtkIdType b = ids[(i + 1) % size];
      if (this->Candidates[a] || this->Candidates[b])
      {
        this->Edges.emplace_back(std::min(a, b), std::max(a, b));
      }
    }
  }

  const std::vector<char>& Candidates;
  std::vector<char> Used, OnEdge;
  std::vector<std::pair<vtkIdType, vtkIdType>> Edges;
};

bool Meet(const PieceEntry& a, const PieceEntry& b, double reach)
{
  if (a.Surface != b.Surface || !a.Box.IsValid() || !b.Box.IsValid())
  {
    return false;
  }
  vtkBoundingBox first = a.Box;
  vtkBoundingBox second = b.Box;
  first.Inflate(reach);
  second.Inflate(reach);
  return first.Intersects(second) != 0;
}

/// Per process with another piece of the surface nearby, this one included: for each point of the
/// piece whether it lies inside the bounding box of such a piece.
std::map<int, std::vector<char>> FindCandidates(
  const SurfacePiece& piece, std::size_t number, const std::vector<PieceEntry>& list, double reach)
{
  const vtkIdType count = piece.Input->GetNumberOfPoints();
  std::map<int, std::vector<char>> candidates;
  for (std::size_t other = 0; other < list.size(); ++other)
  {
    if (other == number || !Meet(list[number], list[other], reach))
    {
      continue;
    }
    vtkBoundingBox box = list[other].Box;
    box.Inflate(reach);
    std::vector<char>& inside = candidates[list[other].Process];
    inside.resize(count, 0);
    for (vtkIdType i = 0; i < count; ++i)
    {
      double x[3];
      piece.Input->GetPoint(i, x);
      const bool finite = std::all_of(x, x + 3, [](double value) { return std::isfinite(value); });
      inside[i] = inside[i] || (finite && box.ContainsPoint(x));
    }
  }
  return candidates;
}

constexpr vtkIdType OpenFlag = 1;
constexpr vtkIdType CopyFlag = 2;
constexpr std::size_t IntegersPerPoint = 3; // piece, label, flags

/// Interface points as they are sent: integers of all, then of each the id or the coordinates.
struct Message
{
  std::map<int, std::vector<vtkIdType>> Integers, GlobalIds; ///< by process
  std::map<int, std::vector<double>> Coordinates;
};

/// Adds the points of a piece to the messages to other processes, and to that to this one those
/// near any other piece.
void AppendPoints(const SurfacePiece& piece, std::size_t number,
  const std::vector<PieceEntry>& list, double reach, bool byId, Message& message)
{
  vtkPolyData* const data = piece.Input;
  const vtkIdType count = data->GetNumberOfPoints();
  std::map<int, std::vector<char>> candidates = FindCandidates(piece, number, list, reach);
  std::vector<char>& all = candidates[list[number].Process];
  all.resize(count, 0);
  for (const auto& near : candidates)
  {
    std::transform(all.begin(), all.end(), near.second.begin(), all.begin(), std::bit_or<>());
  }
  const OpenPoints open(data, all);
  vtkUnsignedCharArray* const ghosts = data->GetPointGhostArray();
  const auto ids = AsIdTypeArray(byId ? FindGlobalPointIds(data) : nullptr);
  for (const auto& [process, inside] : candidates)
  {
    for (vtkIdType i = 0; i < count; ++i)
    {
      if (!inside[i])
      {
        continue;
      }
      const bool isDuplicate = ghosts && ghosts->GetNumberOfTuples() == count &&
        (ghosts->GetValue(i) & vtkDataSetAttributes::DUPLICATEPOINT);
      const bool isUsed = open.IsUsed(i);
      const vtkIdType flags =
        (!isUsed || open.IsOnEdge(i) ? OpenFlag : 0) | (!isUsed || isDuplicate ? CopyFlag : 0);
      std::vector<vtkIdType>& integers = message.Integers[process];
      integers.insert(
        integers.end(), { static_cast<vtkIdType>(number), list[number].FirstLabel + i, flags });
      if (ids)
      {
        message.GlobalIds[process].push_back(ids->GetValue(i));
        continue;
      }
      for (int k = 0; k < 3; ++k)
      {
        message.Coordinates[process].push_back(data->GetPoint(i)[k] + 0.0); // -0 becomes 0
      }
    }
  }
}

/// The points of a message from or to one process.
void ReadPoints(const std::vector<PieceEntry>& list, const std::vector<vtkIdType>& integers,
  const std::vector<vtkIdType>& ids, const std::vector<double>& coordinates,
  std::vector<InterfacePoint>& points)
{
  for (std::size_t i = 0; i < integers.size() / IntegersPerPoint; ++i)
  {
    const vtkIdType* const values = &integers[IntegersPerPoint * i];
    InterfacePoint point;
    point.Piece = static_cast<int>(values[0]);
    point.Surface = list[point.Piece].Surface;
    point.Label = values[1];
    point.IsOpen = (values[2] & OpenFlag) != 0;
    point.IsCopy = (values[2] & CopyFlag) != 0;
    point.GlobalId = ids.empty() ? 0 : ids[i];
    point.Coordinates = { 0.0, 0.0, 0.0 };
    if (ids.empty())
    {
      std::copy_n(&coordinates[3 * i], 3, point.Coordinates.begin());
    }
    points.push_back(point);
  }
}

} // namespace

vtkSmartPointer<vtkIdTypeArray> AsIdTypeArray(vtkDataArray* ids)
{
  vtkSmartPointer<vtkIdTypeArray> array = vtkIdTypeArray::SafeDownCast(ids);
  if (ids && !array)
  {
    array = vtkSmartPointer<vtkIdTypeArray>::New();
    array->DeepCopy(ids);
  }
  return array;
}

vtkDataArray* FindGlobalPointIds(vtkPolyData* data)
{
  vtkDataArray* ids = data->GetPointData()->GetGlobalIds();
  const bool isUsable = ids && ids->GetNumberOfComponents() == 1 &&
    ids->GetNumberOfTuples() == data->GetNumberOfPoints();
  return isUsable ? ids : nullptr;
}

std::vector<PieceEntry> ListPieces(
  const Processes& processes, const std::vector<SurfacePiece>& pieces)
{
  constexpr std::size_t width = 3; // process, surface, points
  std::vector<vtkIdType> integers;
  std::vector<double> bounds;
  for (const SurfacePiece& piece : pieces)
  {
    integers.insert(
      integers.end(), { processes.Rank(), piece.Surface, piece.Input->GetNumberOfPoints() });
    const double* const box = piece.Input->GetBounds();
    bounds.insert(bounds.end(), box, box + 6);
  }
  integers = processes.GatherAll(integers);
  bounds = processes.GatherAll(bounds);
  std::vector<PieceEntry> list;
  vtkIdType label = 0;
  for (std::size_t p = 0; p < integers.size() / width; ++p)
  {
    const vtkIdType* const entry = &integers[width * p];
    list.push_back({ static_cast<int>(entry[0]), static_cast<int>(entry[1]), label,
      vtkBoundingBox(&bounds[6 * p]) });
    label += entry[2];
  }
  return list;
}

std::vector<int> FindNeighbours(
  const Processes& processes, const std::vector<PieceEntry>& list, double reach)
{
  std::set<int> neighbours;
  for (const PieceEntry& own : list)
  {
    for (const PieceEntry& other : list)
    {
      if (own.Process == processes.Rank() && other.Process != own.Process &&
        Meet(own, other, reach))
      {
        neighbours.insert(other.Process);
      }
    }
  }
  return { neighbours.begin(), neighbours.end() };
}

std::vector<InterfacePoint> FindInterfacePoints(const Processes& processes,
  const std::vector<int>& neighbours, const std::vector<SurfacePiece>& pieces,
  const std::vector<PieceEntry>& list, std::size_t first, double reach, bool byId)
{
  Message sent;
  for (std::size_t p = 0; p < pieces.size(); ++p)
  {
    AppendPoints(pieces[p], first + p, list, reach, byId, sent);
  }
  Message received;
  received.Integers = processes.Exchange(neighbours, sent.Integers);
  received.GlobalIds = processes.Exchange(neighbours, sent.GlobalIds);
  received.Coordinates = processes.Exchange(neighbours, sent.Coordinates);
  const int rank = processes.Rank();
  received.Integers[rank] = std::move(sent.Integers[rank]);
  received.GlobalIds[rank] = std::move(sent.GlobalIds[rank]);
  received.Coordinates[rank] = std::move(sent.Coordinates[rank]);
  std::vector<InterfacePoint> points;
  for (const auto& [process, integers] : received.Integers)
  {
    ReadPoints(list, integers, received.GlobalIds[process], received.Coordinates[process], points);
  }
  std::sort(points.begin(), points.end(),
    [](const InterfacePoint& a, const InterfacePoint& b) { return a.Label < b.Label; });
  return points;
}

} // namespace SurfaceDiffusion
