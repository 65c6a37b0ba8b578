// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/PointIdentity.h"

#include "Core/Foundation/Random.h"
#include "Core/Surface/PointMatching.h"
#include "Distributed/InterfacePoints.h"

#include "vtkDataArray.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace SurfaceDiffusion
{

namespace
{

/// Default tolerance, in diagonals of the bounding box: the rounding of single precision.
constexpr double DefaultTolerance = 1e-6;

double ToleranceOf(const std::vector<PieceEntry>& list, double tolerance)
{
  if (tolerance >= 0.0 && std::isfinite(tolerance))
  {
    return tolerance;
  }
  vtkBoundingBox all;
  for (const PieceEntry& entry : list)
  {
    all.AddBox(entry.Box);
  }
  return all.IsValid() ? DefaultTolerance * all.GetDiagonalLength() : 0.0;
}

PointIdentity MakeIdentity(vtkPolyData* data, vtkIdType firstLabel, bool byId)
{
  PointIdentity identity;
  identity.FirstLabel = firstLabel;
  identity.IsById = byId;
  identity.Labels.resize(data->GetNumberOfPoints());
  std::iota(identity.Labels.begin(), identity.Labels.end(), firstLabel);
  return identity;
}

} // namespace

std::vector<std::int64_t> PointIdentity::MakeIds(vtkPolyData* piece) const
{
  const vtkIdType count = piece->GetNumberOfPoints();
  if (const auto ids = AsIdTypeArray(this->IsById ? FindGlobalPointIds(piece) : nullptr))
  {
    return std::vector<std::int64_t>(ids->GetPointer(0), ids->GetPointer(0) + count);
  }
  return IdsOfPlaces(static_cast<std::size_t>(count),
    [&](std::size_t i, double* x) { piece->GetPoint(static_cast<vtkIdType>(i), x); });
}

std::vector<PointIdentity> FindIdentity(
  const Processes& processes, const std::vector<SurfacePiece>& pieces, double tolerance)
{
  const std::vector<PieceEntry> list = ListPieces(processes, pieces);
  const auto first = static_cast<std::size_t>(
    std::find_if(list.begin(), list.end(),
      [&](const PieceEntry& entry) { return entry.Process == processes.Rank(); }) -
    list.begin());
  const bool byId = !processes.Any(std::any_of(pieces.begin(), pieces.end(),
    [](const SurfacePiece& piece)
    { return piece.Input->GetNumberOfPoints() > 0 && !FindGlobalPointIds(piece.Input); }));
  tolerance = ToleranceOf(list, tolerance);
  const double reach = ReachOfMatching * tolerance;
  const std::vector<int> neighbours = FindNeighbours(processes, list, reach);
  const std::vector<InterfacePoint> points =
    FindInterfacePoints(processes, neighbours, pieces, list, first, reach, byId);
  const std::vector<std::size_t> owners = MatchPoints(points, byId, tolerance);

  std::vector<PointIdentity> identities;
  for (std::size_t p = 0; p < pieces.size(); ++p)
  {
    identities.push_back(MakeIdentity(pieces[p].Input, list[first + p].FirstLabel, byId));
    identities.back().Neighbours = neighbours;
  }
  std::vector<char> isShared(points.size(), 0);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    if (owners[i] != i)
    {
      isShared[i] = isShared[owners[i]] = 1;
    }
  }
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const auto piece = static_cast<std::size_t>(points[i].Piece);
    if (piece >= first && piece < first + pieces.size())
    {
      PointIdentity& identity = identities[piece - first];
      const vtkIdType point = points[i].Label - identity.FirstLabel;
      identity.Labels[point] = points[owners[i]].Label;
      if (isShared[i])
      {
        identity.Shared.push_back(point);
      }
    }
  }
  return identities;
}

} // namespace SurfaceDiffusion
