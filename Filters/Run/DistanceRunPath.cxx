// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The paths and disks of a DistanceRun.
#include "Run/DistanceRun.h"

#include "Core/Geodesics/GeodesicDisk.h"
#include "Run/FarPoints.h"

#include <algorithm>
#include <memory>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// A place of a triangle of the mesh in coordinates.
Eigen::RowVector3d InSpace(const Surface& surface, Index triangle, const std::array<double, 3>& at)
{
  const TriangleMesh& mesh = surface.InputMesh();
  Eigen::RowVector3d place(0.0, 0.0, 0.0);
  for (Eigen::Index a = 0; a < 3; ++a)
  {
    const auto vertex = static_cast<std::size_t>(mesh.TriangleVertices()(triangle, a));
    place += at[static_cast<std::size_t>(a)] * surface.Points().row(mesh.InputVertex()[vertex]);
  }
  return place;
}

Points AsPoints(const std::vector<Eigen::RowVector3d>& list)
{
  Points points(static_cast<Eigen::Index>(list.size()), 3);
  for (std::size_t k = 0; k < list.size(); ++k)
  {
    points.row(static_cast<Eigen::Index>(k)) = list[k];
  }
  return points;
}

} // namespace

/// The surface without speeds, and the places on its triangles.
std::vector<MeshPlace> DistanceRun::PreparePlaces(const BlockInput& input, Settings& given,
  const std::vector<SurfacePlace>& places, const ProgressMonitor& progress)
{
  auto& settings = static_cast<DistanceSettings&>(given);
  const BlockInput drawn = WithoutGivenAreas(input);
  this->FieldsVersion = {}; // the next update has another result
  this->PrepareSurface(drawn, settings, progress);
  this->TakeSpeeds(this->ReadFields(input), settings);
  this->Found = {};
  return this->FindPlaces(drawn, places, progress);
}

std::vector<MeshPlace> DistanceRun::FindPlaces(
  const BlockInput& drawn, const std::vector<SurfacePlace>& places, const ProgressMonitor& progress)
{
  // Of each kind together
  SourceShapes ofPoints, ofTriangles, inSpace;
  std::vector<std::size_t> rows[3];
  const auto append = [](Points& list, const Eigen::RowVector3d& row)
  {
    list.conservativeResize(list.rows() + 1, 3);
    list.row(list.rows() - 1) = row;
  };
  for (std::size_t k = 0; k < places.size(); ++k)
  {
    const SurfacePlace& place = places[k];
    const int kind = place.Point >= 0 ? 0 : place.Triangle >= 0 ? 1 : 2;
    rows[kind].push_back(k);
    if (kind == 0)
    {
      ofPoints.OfPoints.push_back(place.Point);
    }
    else if (kind == 1)
    {
      ofTriangles.OfTriangles.push_back(place.Triangle);
      append(ofTriangles.Places, place.Coordinates);
    }
    else
    {
      append(inSpace.Places, place.Coordinates);
    }
  }
  std::vector<MeshPlace> found(places.size(), { -1, { 0.0, 0.0, 0.0 } });
  const auto take = [&](const SourceSet& set, int kind)
  {
    for (const SourcePiece& piece : set.Pieces)
    {
      found[rows[kind][static_cast<std::size_t>(piece.Label)]] = { piece.Triangle, piece.From };
    }
  };
  take(this->FindPlaced(ofPoints), 0);
  take(this->FindPlaced(ofTriangles), 1);
  if (!rows[2].empty())
  {
    const Surface& surface = *this->Domain;
    if (!this->Projection)
    {
      this->Projection = std::make_unique<const SourceProjection>(drawn.ReadSurface(), surface);
    }
    SourceSet set;
    ProjectedSources projected = this->Projection->Project(inSpace, 0.0, {}, progress);
    set.Pieces = std::move(projected.Pieces);
    this->Found.Farness =
      DescribeFarPoints("that are given", projected.Places, projected.Distances, surface, false);
    take(set, 2);
  }
  for (std::size_t k = 0; k < places.size(); ++k)
  {
    if (found[k].Triangle < 0)
    {
      throw InputError(Sentence(places[k].Name)
        << " is on no triangle that takes part: no triangle uses it, or "
        << Word::Array("MaskArray") << " leaves it out; allowed: places on the other triangles");
    }
  }
  this->Found.Count = static_cast<Index>(places.size());
  return found;
}

GeodesicPath::Path DistanceRun::FindLeg(GeodesicPath& finder,
  const std::vector<SurfacePlace>& places, const std::vector<MeshPlace>& stops, std::size_t from,
  std::size_t to, const ProgressMonitor& progress) const
{
  GeodesicPath::Path leg = finder.Find(stops[from], stops[to], progress);
  if (!(leg.Length < Never))
  {
    throw InputError(Sentence("no path leads from ")
      << places[from].Name << " to " << places[to].Name
      << ": they are on parts of the surface that are not connected; allowed: places on one part, "
         "or "
      << Word::Setting("MergeCoincidentPoints") << " where parts meet at points that coincide");
  }
  if (!leg.IsFollowed)
  {
    throw InputError(Sentence("the path from ")
      << places[from].Name << " to " << places[to].Name
      << " is lost in round-off among triangles that are nearly without area; allowed: a surface "
         "without "
         "such triangles");
  }
  return leg;
}

SurfacePath DistanceRun::FindPath(const BlockInput& input, Settings& given,
  const std::vector<SurfacePlace>& places, bool isClosed, const ProgressMonitor& progress)
{
  const std::vector<MeshPlace> stops =
    this->PreparePlaces(input, given, places, progress.Part(0.0, 0.1));
  const Surface& surface = *this->Domain;
  const TriangleMesh& mesh = *this->MeshOfSolvers;
  GeodesicPath finder(mesh, this->TakeExact().GetFrames());
  SurfacePath path;
  std::vector<Eigen::RowVector3d> points{ InSpace(
    surface, stops.front().Triangle, stops.front().At) };
  const std::size_t legs = isClosed ? stops.size() : stops.size() - 1;
  for (std::size_t k = 0; k < legs; ++k)
  {
    const std::size_t next = (k + 1) % stops.size();
    const double first = 0.1 + 0.9 * static_cast<double>(k) / static_cast<double>(legs);
    const GeodesicPath::Path leg = this->FindLeg(finder, places, stops, k, next,
      progress.Part(first, first + 0.9 / static_cast<double>(legs)));
    for (const PathSegment& segment : leg.Segments)
    {
      points.push_back(InSpace(surface, segment.Triangle, segment.To));
      const Index row = mesh.InputTriangle()[static_cast<std::size_t>(segment.Triangle)];
      path.Triangles.push_back(surface.InputTriangle(row));
    }
    path.Length += leg.Length * mesh.LengthUnit();
  }
  path.Points = AsPoints(points);
  return path;
}

/// The paths from places nearest to points to the nearest source.
void DistanceRun::AddPaths(const BlockInput& drawn, const SourceShapes& from,
  const SourceSet& sources, const ProgressMonitor& progress)
{
  const Surface& surface = *this->Domain;
  const double unit = this->MeshOfSolvers->LengthUnit();
  SourceShapes points = from;
  points.Segments.clear();
  points.Name = "the path points";
  SourceSet starts = this->FindProjected(drawn, points, 0.0, true, progress.Part(0.0, 0.1));
  std::vector<MeshPlace> places;
  for (const SourcePiece& piece : starts.Pieces)
  {
    places.push_back({ piece.Triangle, piece.From });
  }
  GeodesicPath finder(*this->MeshOfSolvers, this->TakeExact().GetFrames());
  const std::vector<GeodesicPath::Path> paths =
    finder.FindAll(places, sources.Pieces, progress.Part(0.1, 1.0));
  Curves curves;
  std::vector<Eigen::RowVector3d> corners;
  std::vector<double> lengths, numbers, names;
  for (std::size_t k = 0; k < paths.size(); ++k)
  {
    if (!paths[k].IsFollowed)
    {
      continue;
    }
    corners.push_back(InSpace(surface, places[k].Triangle, places[k].At));
    for (const PathSegment& segment : paths[k].Segments)
    {
      corners.push_back(InSpace(surface, segment.Triangle, segment.To));
    }
    lengths.push_back(paths[k].Length * unit);
    numbers.push_back(starts.Names[k]);
    names.push_back(sources.Names[static_cast<std::size_t>(paths[k].Piece)]);
    while (curves.Corners.size() < corners.size())
    {
      curves.Corners.push_back(static_cast<Index>(curves.Corners.size()));
    }
    curves.Begin.push_back(static_cast<Index>(corners.size()));
  }
  const auto without = starts.Given - static_cast<Index>(lengths.size());
  if (without > 0)
  {
    this->OfPaths
      << without
      << " path points have no path: no source is on their part of the surface, or they "
         "are on no triangle that takes part";
  }
  else if (!starts.Farness.Words().empty())
  {
    this->OfPaths = starts.Farness;
  }
  curves.Points = AsPoints(corners);
  this->Results.push_back(Output::OfCurves("Paths", std::move(curves)));
  const auto add = [this](const char* name, OutputType type, const std::vector<double>& values)
  {
    this->Results.push_back({ name, Place::PerCurve, type,
      Eigen::Map<const Vector>(values.data(), static_cast<Eigen::Index>(values.size())) });
  };
  add("Length", OutputType::Double, lengths);
  add("PathPoint", OutputType::Integer, numbers);
  add("NearestSource", sources.TypeOfNames(), names);
}

SurfaceDisk DistanceRun::FindDisk(const BlockInput& input, Settings& given,
  const SurfacePlace& center, double radius, const ProgressMonitor& progress)
{
  const MeshPlace at =
    this->PreparePlaces(input, given, { center }, progress.Part(0.0, 0.1)).front();
  const Surface& surface = *this->Domain;
  const double unit = this->MeshOfSolvers->LengthUnit();
  const GeodesicDisk disk(*this->MeshOfSolvers, this->TakeExact().GetFrames(), at, radius / unit,
    progress.Part(0.1, 1.0));
  SurfaceDisk found;
  found.Area = disk.Area() * unit * unit;
  for (const std::vector<MeshPlace>& curve : disk.Boundary())
  {
    std::vector<Eigen::RowVector3d> points;
    points.reserve(curve.size());
    for (const MeshPlace& place : curve)
    {
      points.push_back(InSpace(surface, place.Triangle, place.At));
    }
    found.Boundary.push_back(AsPoints(points));
  }
  return found;
}

} // namespace SurfaceDiffusion
