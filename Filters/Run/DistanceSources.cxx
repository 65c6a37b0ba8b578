// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/DistanceSources.h"

#include "Core/Foundation/DisjointSets.h"
#include "Run/Located.h"
#include "Run/Sentence.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace SurfaceDiffusion
{

std::vector<Index> SourceShapes::FindLabels() const
{
  const auto count = static_cast<Index>(this->Places.rows());
  DisjointSets sets(count);
  for (const auto& [first, second] : this->Segments)
  {
    sets.Join(first, second);
  }
  std::vector<Index> smallest;
  for (Index i = 0; i < count; ++i)
  {
    smallest.push_back(sets.Find(i));
  }
  return smallest;
}

SourceProjection::SourceProjection(SurfaceArrays arrays, const Surface& surface)
  : Arrays(std::move(arrays))
{
  RequireFiniteCoordinates(this->Arrays.Points);
  const TriangleMesh& mesh = surface.InputMesh();
  const Triangles all = this->Arrays.Triangles;
  std::vector<Index> ofInput(static_cast<std::size_t>(all.rows()), -1);
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const Index row = mesh.InputTriangle()[static_cast<std::size_t>(t)];
    ofInput[static_cast<std::size_t>(surface.InputTriangle(row))] = t;
  }
  Index kept = 0;
  for (Index row = 0; row < static_cast<Index>(all.rows()); ++row)
  {
    const Index t = ofInput[static_cast<std::size_t>(row)];
    bool isExcluded = IsSet(this->Arrays.ExcludedTriangles, static_cast<std::size_t>(row));
    for (int a = 0; a < 3; ++a)
    {
      isExcluded =
        isExcluded || IsSet(this->Arrays.Excluded, static_cast<std::size_t>(all(row, a)));
    }
    if (t >= 0 || isExcluded) // and not of zero area
    {
      this->Arrays.Triangles.row(kept++) = all.row(row);
      this->MeshTriangles.push_back(t);
    }
  }
  this->Arrays.Triangles.conservativeResize(kept, 3);
  this->EdgeLength = mesh.MeanEdgeLength() * mesh.LengthUnit();
  this->Nearest =
    std::make_unique<const NearestPoints>(this->Arrays.Points, this->Arrays.Triangles);
}

ProjectedSources SourceProjection::Project(const SourceShapes& shapes, double maximumDistance,
  const FrontShapes& triangles, const ProgressMonitor& progress) const
{
  const Finder find = [&](const Eigen::RowVector3d& x)
  {
    const NearestPoint nearest = this->Nearest->Find(x);
    Place place;
    if (nearest.Triangle < 0)
    {
      return place;
    }
    place.Distance = std::sqrt(nearest.SquaredDistance);
    place.IsFar = maximumDistance > 0.0 && !(place.Distance <= maximumDistance);
    place.Coordinates = nearest.Coordinates;
    const Index t = this->MeshTriangles[static_cast<std::size_t>(nearest.Triangle)];
    const bool isOpen = t >= 0 && !IsBarrier(triangles, t);
    place.Triangle = isOpen && !place.IsFar ? t : -1;
    return place;
  };
  ProjectedSources found;
  found.Places.resize(shapes.Places.rows(), 3);
  const std::vector<Index> labels = shapes.FindLabels();
  std::vector<char> isOnLine(labels.size(), 0);
  for (const auto& segment : shapes.Segments)
  {
    isOnLine[static_cast<std::size_t>(segment[0])] = 1;
    isOnLine[static_cast<std::size_t>(segment[1])] = 1;
  }
  for (Index i = 0; i < static_cast<Index>(shapes.Places.rows()); ++i)
  {
    if (!IsSet(shapes.Hidden, static_cast<std::size_t>(i)) && !shapes.Places.row(i).allFinite())
    {
      throw InputError(Sentence("a coordinate is not finite at point ")
        << i << " of " << shapes.Name << "; allowed: finite coordinates");
    }
  }
  constexpr std::size_t reportEvery = 256;
  const double all = static_cast<double>(labels.size() + shapes.Segments.size());
  for (std::size_t i = 0; i < labels.size(); ++i)
  {
    if (i % reportEvery == 0)
    {
      progress.Report(static_cast<double>(i) / all);
    }
    if (IsSet(shapes.Hidden, i))
    {
      continue;
    }
    const auto row = static_cast<Index>(i);
    const Place place = find(shapes.Places.row(row));
    found.Places.row(static_cast<Eigen::Index>(found.Distances.size())) = shapes.Places.row(row);
    found.Distances.push_back(place.Distance);
    if (isOnLine[i] != 0)
    {
      continue; // its segments count
    }
    ++(place.Triangle >= 0 ? found.Count : (place.IsFar ? found.TooFar : found.Outside));
    if (place.Triangle >= 0)
    {
      found.Pieces.push_back(
        { place.Triangle, place.Coordinates, place.Coordinates, row, row, labels[i] });
    }
  }
  for (std::size_t s = 0; s < shapes.Segments.size(); ++s)
  {
    progress.Report(static_cast<double>(labels.size() + s) / all);
    const std::array<Index, 2>& ends = shapes.Segments[s];
    this->ProjectSegment(shapes, ends, labels[static_cast<std::size_t>(ends[0])], find, found);
  }
  found.Places.conservativeResize(static_cast<Eigen::Index>(found.Distances.size()), 3);
  return found;
}

/// Samples that are near enough for no triangle between them to be missed, in most cases, and
/// pieces between those that are in one triangle. Where a line leaves a triangle, samples become
/// denser.
void SourceProjection::ProjectSegment(const SourceShapes& shapes, std::array<Index, 2> ends,
  Index label, const Finder& findPlace, ProjectedSources& found) const
{
  constexpr double samplesPerEdge = 4.0;
  constexpr double mostSamples = 65536.0;
  constexpr double resolved = 1e-6; // of the edges: gaps between pieces
  const Eigen::RowVector3d a = shapes.Places.row(ends[0]);
  const Eigen::RowVector3d b = shapes.Places.row(ends[1]);
  const double length = (b - a).norm();
  const double gap = length > 0.0 ? resolved * this->EdgeLength / length : 1.0;
  const int samples = 1 +
    static_cast<int>(std::min(mostSamples, std::ceil(samplesPerEdge * length / this->EdgeLength)));
  const auto find = [&](double share) { return findPlace((1.0 - share) * a + share * b); };
  const std::size_t before = found.Pieces.size();
  bool isFar = false;
  struct Part
  {
    double From, To;
    Place First, Last;
  };
  std::vector<Part> parts;
  Place last = find(0.0);
  for (int k = 0; k < samples; ++k)
  {
    const double from = static_cast<double>(k) / samples;
    const double to = static_cast<double>(k + 1) / samples;
    const Place next = find(to);
    parts.push_back({ from, to, last, next });
    while (!parts.empty())
    {
      const Part part = parts.back();
      parts.pop_back();
      isFar = isFar || part.First.IsFar;
      if (part.First.Triangle >= 0 && part.First.Triangle == part.Last.Triangle)
      {
        found.Pieces.push_back({ part.First.Triangle, part.First.Coordinates, part.Last.Coordinates,
          part.From == 0.0 ? ends[0] : -1, part.To == 1.0 ? ends[1] : -1, label });
      }
      else if (part.First.Triangle != part.Last.Triangle && part.To - part.From > gap)
      {
        const double middle = 0.5 * (part.From + part.To);
        const Place between = find(middle);
        parts.push_back({ middle, part.To, between, part.Last });
        parts.push_back({ part.From, middle, part.First, between });
      }
      // Both ends of what is left are on the edge between two triangles, up to the gap.
      else if (part.First.Triangle >= 0)
      {
        found.Pieces.push_back(
          { part.First.Triangle, part.First.Coordinates, part.First.Coordinates,
            part.From == 0.0 ? ends[0] : -1, part.From == 0.0 ? ends[0] : -1, label });
      }
    }
    last = next;
  }
  isFar = isFar || last.IsFar;
  ++(found.Pieces.size() > before ? found.Count : (isFar ? found.TooFar : found.Outside));
}

} // namespace SurfaceDiffusion
