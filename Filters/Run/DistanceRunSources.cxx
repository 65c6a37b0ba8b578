// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The sources and speeds of a DistanceRun.
#include "Run/DistanceRun.h"

#include "Core/Foundation/DisjointSets.h"
#include "Run/CellFields.h"
#include "Run/FarPoints.h"
#include "Run/FieldChecks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// Of a triangle of the input, whose corners are those of row t.
double FactorOfTriangle(const Fields& fields, const Located<std::vector<double>>& factors,
  Index row, const Triangles& triangles, Index t)
{
  if (factors.OnCells)
  {
    return factors.Values[static_cast<std::size_t>(fields.Cells[static_cast<std::size_t>(row)])];
  }
  double sum = 0.0;
  for (int a = 0; a < 3; ++a)
  {
    sum += factors.Values[static_cast<std::size_t>(triangles(t, a))];
  }
  return sum / 3.0;
}

/// Times ofAll, per triangle of InputMesh(), or ofAll for all. Throws InputError on those that are negative
/// or not finite where they count.
std::vector<double> FactorsOfTriangles(const Surface& surface, const Fields& fields,
  const Located<std::vector<double>>& factors, const char* name, double ofAll)
{
  if (factors.Values.empty())
  {
    return { ofAll };
  }
  std::vector<double> found;
  const TriangleMesh& mesh = surface.InputMesh();
  const Triangles triangles = surface.MakeTriangles();
  std::vector<char> counts(factors.Values.size(), 0);
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const Index row = mesh.InputTriangle()[static_cast<std::size_t>(t)];
    const Index ofInput = surface.InputTriangle(row);
    for (int a = 0; a < 3 && !factors.OnCells; ++a)
    {
      counts[static_cast<std::size_t>(triangles(row, a))] = 1;
    }
    if (factors.OnCells)
    {
      counts[static_cast<std::size_t>(fields.Cells[static_cast<std::size_t>(ofInput)])] = 1;
    }
    found.push_back(ofAll * FactorOfTriangle(fields, factors, ofInput, triangles, row));
  }
  for (std::size_t i = 0; i < counts.size(); ++i)
  {
    const double factor = factors.Values[i];
    if (counts[i] && !(std::isfinite(factor) && factor >= 0.0))
    {
      throw ErrorOfFactor(Word::Array(name), factor, factors.OnCells, static_cast<Eigen::Index>(i));
    }
  }
  return found;
}

/// Neighbours of one name get one label: their front is plane, as speeds that change across it want it.
void JoinNeighbours(
  const TriangleMesh& mesh, const std::vector<double>& names, std::vector<SourcePiece>& pieces)
{
  std::multimap<Index, Index> pieceAt; // vertices
  for (std::size_t k = 0; k < pieces.size(); ++k)
  {
    const auto corner = std::find(pieces[k].From.begin(), pieces[k].From.end(), 1.0);
    if (corner != pieces[k].From.end())
    {
      const auto a = static_cast<Eigen::Index>(corner - pieces[k].From.begin());
      pieceAt.emplace(mesh.TriangleVertices()(pieces[k].Triangle, a), static_cast<Index>(k));
    }
  }
  DisjointSets sets(static_cast<Index>(pieces.size()));
  for (const auto& [vertex, k] : pieceAt)
  {
    const auto v = static_cast<std::size_t>(vertex);
    const auto joinAt = [&, piece = k](Index other)
    {
      const auto [begin, end] = pieceAt.equal_range(other);
      for (auto found = begin; found != end; ++found)
      {
        if (names[static_cast<std::size_t>(found->second)] ==
          names[static_cast<std::size_t>(piece)])
        {
          sets.Join(piece, found->second);
        }
      }
    };
    joinAt(vertex);
    for (Index c = mesh.VertexCornersBegin()[v]; c < mesh.VertexCornersBegin()[v + 1]; ++c)
    {
      const Index corner = mesh.VertexCorners()[static_cast<std::size_t>(c)];
      for (const int step : { 1, 2 })
      {
        joinAt(mesh.OtherCorner(corner, step));
      }
    }
  }
  for (std::size_t k = 0; k < pieces.size(); ++k)
  {
    pieces[k].Label = sets.Find(static_cast<Index>(k));
  }
}

} // namespace

/// Of InputMesh(); empty without speeds.
FrontShapes DistanceRun::MakeShapes(const Fields& fields, const DistanceSettings& settings) const
{
  if (!fields.HasSpeeds() && !settings.HasSpeed())
  {
    return {};
  }
  const TangentVectors directions = fields.HasDirectedSpeeds() || settings.IsDirected()
    ? MakeInputDirections(*this->Domain, fields, this->Parallel)
    : TangentVectors(0, 2);
  const auto find = [&](const Located<std::vector<double>>& factors, const char* name, double ofAll)
  { return FactorsOfTriangles(*this->Domain, fields, factors, name, ofAll); };
  std::vector<double> slowness = find(fields.Speeds, "SpeedArray", 1.0);
  std::transform(
    slowness.begin(), slowness.end(), slowness.begin(), [](double speed) { return 1.0 / speed; });
  return MakeFrontShapes(this->Domain->InputMesh(), slowness, directions,
    find(fields.AlongSpeeds, "AlongSpeedArray", settings.AlongSpeed),
    find(fields.AcrossSpeeds, "AcrossSpeedArray", settings.AcrossSpeed));
}

/// A corner at a point of a triangle that fronts cross; -1: there is none.
Index DistanceRun::CornerOf(Index point) const
{
  const TriangleMesh& mesh = *this->MeshOfSolvers;
  const Index vertex = this->Domain->VertexOf(point);
  for (Index c = vertex < 0 ? 0 : mesh.VertexCornersBegin()[vertex];
       vertex >= 0 && c < mesh.VertexCornersBegin()[vertex + 1]; ++c)
  {
    const Index corner = mesh.VertexCorners()[static_cast<std::size_t>(c)];
    if (!IsBarrier(this->Shapes, corner / 3))
    {
      return corner;
    }
  }
  return -1;
}

/// A corner of a triangle as a source of this number.
SourcePiece DistanceRun::PieceAt(Index corner, Index number)
{
  std::array<double, 3> place = { 0.0, 0.0, 0.0 };
  place[static_cast<std::size_t>(corner % 3)] = 1.0;
  return { corner / 3, place, place, number, number, number };
}

/// The nonzero points of the data.
DistanceRun::SourceSet DistanceRun::FindMarked(const Fields& fields) const
{
  if (fields.Data.OnCells)
  {
    throw InputError(Sentence(Word::Array("SourceArray"))
      << " is on " << Word::Cells() << "; allowed: an array on points");
  }
  const Surface& surface = *this->Domain;
  const Values& marks = fields.Data.Values;
  const std::vector<double>& starts = fields.StartTimes;
  SourceSet set;
  for (Eigen::Index i = 0; i < marks.rows(); ++i)
  {
    const double mark = marks(i, 0);
    if (std::isinf(mark))
    {
      throw ErrorAt(Word::Array("SourceArray"), "is infinite", false, i,
        "allowed: finite values, and NaN, which is no source");
    }
    if (mark == 0.0 || std::isnan(mark))
    {
      continue;
    }
    ++set.Given;
    const Index corner = this->CornerOf(static_cast<Index>(i));
    ++(corner < 0 ? set.Outside : set.Count);
    if (corner < 0)
    {
      continue;
    }
    set.Pieces.push_back(this->PieceAt(corner, static_cast<Index>(i)));
    set.Names.push_back(mark);
    if (!starts.empty())
    {
      const auto row = static_cast<std::size_t>(i);
      if (!std::isfinite(starts[row]))
      {
        throw ErrorAt(Word::Array("SourceTimes"), Sentence("is ") << starts[row], false, i,
          "allowed: finite numbers");
      }
      set.Starts.push_back(starts[row] / surface.InputMesh().LengthUnit());
    }
  }
  return set;
}

/// Places that are given on the surface.
DistanceRun::SourceSet DistanceRun::FindPlaced(const SourceShapes& shapes) const
{
  const Surface& surface = *this->Domain;
  const TriangleMesh& mesh = surface.InputMesh();
  std::map<Index, Index> meshTriangles; // of those of the input that are wanted
  for (const Index row : shapes.OfTriangles)
  {
    meshTriangles[row] = -1;
  }
  for (Index t = 0; !meshTriangles.empty() && t < mesh.NumberOfTriangles(); ++t)
  {
    const Index row = surface.InputTriangle(mesh.InputTriangle()[static_cast<std::size_t>(t)]);
    const auto wanted = meshTriangles.find(row);
    if (wanted != meshTriangles.end() && !IsBarrier(this->Shapes, t))
    {
      wanted->second = t;
    }
  }
  SourceSet set;
  set.AreShapes = true;
  set.Given = static_cast<Index>(shapes.OfPoints.size() + shapes.OfTriangles.size());
  for (Index k = 0; k < set.Given; ++k)
  {
    const auto row = static_cast<std::size_t>(k);
    const bool isPoint = !shapes.OfPoints.empty();
    const Index at =
      isPoint ? this->CornerOf(shapes.OfPoints[row]) : meshTriangles.at(shapes.OfTriangles[row]);
    ++(at < 0 ? set.Outside : set.Count);
    if (at < 0)
    {
      continue;
    }
    SourcePiece piece{ at, {}, {}, k, k, k };
    for (Eigen::Index a = 0; a < 3 && !isPoint; ++a)
    {
      piece.From[static_cast<std::size_t>(a)] = shapes.Places(k, a);
    }
    piece.To = piece.From;
    set.Pieces.push_back(isPoint ? this->PieceAt(at, k) : piece);
    set.Names.push_back(k);
    if (!shapes.StartTimes.empty())
    {
      set.Starts.push_back(shapes.StartTimes[row] / mesh.LengthUnit());
    }
  }
  return set;
}

DistanceRun::SourceSet DistanceRun::FindProjected(const BlockInput& input,
  const SourceShapes& shapes, double maximumDistance, bool arePathPoints,
  const ProgressMonitor& progress)
{
  const Surface& surface = *this->Domain;
  if (!this->Projection)
  {
    this->Projection = std::make_unique<const SourceProjection>(input.ReadSurface(), surface);
  }
  ProjectedSources found =
    this->Projection->Project(shapes, maximumDistance, this->Shapes, progress);
  SourceSet set;
  set.AreShapes = true;
  set.Count = found.Count;
  set.TooFar = found.TooFar;
  set.Outside = found.Outside;
  set.Given = found.Count + found.TooFar + found.Outside;
  if (maximumDistance == 0.0)
  {
    set.Farness = DescribeFarPoints(arePathPoints ? "that paths lead from" : "of the sources",
      found.Places, found.Distances, surface, !arePathPoints);
  }
  for (const SourcePiece& piece : found.Pieces)
  {
    set.Names.push_back(piece.Label);
    if (!shapes.StartTimes.empty())
    {
      set.Starts.push_back(shapes.StartTimes[static_cast<std::size_t>(piece.Label)] /
        surface.InputMesh().LengthUnit());
    }
  }
  set.Pieces = std::move(found.Pieces);
  return set;
}

DistanceRun::SourceSet DistanceRun::FindSources(const BlockInput& input, const Fields& fields,
  double maximumDistance, const ProgressMonitor& progress)
{
  const SourceShapes* const shapes = fields.Sources.get();
  if (shapes && shapes->OfPoints.empty() && shapes->OfTriangles.empty())
  {
    return this->FindProjected(input, *shapes, maximumDistance, false, progress);
  }
  SourceSet set = shapes ? this->FindPlaced(*shapes) : this->FindMarked(fields);
  if (!this->Shapes.empty())
  {
    JoinNeighbours(
      *this->MeshOfSolvers, shapes ? std::vector<double>(set.Names.size()) : set.Names, set.Pieces);
  }
  return set;
}

} // namespace SurfaceDiffusion
