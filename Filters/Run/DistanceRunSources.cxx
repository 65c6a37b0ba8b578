// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The sources and speeds of a DistanceRun.
#include "Run/DistanceRun.h"

#include "Run/CellFields.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

double SpeedOfTriangle(const Fields& fields, Index row, const Triangles& triangles, Index t)
{
  const std::vector<double>& speeds = fields.Speeds.Values;
  if (fields.Speeds.OnCells)
  {
    return speeds[static_cast<std::size_t>(fields.Cells[static_cast<std::size_t>(row)])];
  }
  double sum = 0.0;
  for (int a = 0; a < 3; ++a)
  {
    sum += speeds[static_cast<std::size_t>(triangles(t, a))];
  }
  return sum / 3.0;
}

/// Throws InputError unless the numbers that count are finite and, if `nonNegative`, 0 or more.
void RequireFinite(const std::vector<double>& numbers, const char* name, bool onCells,
  bool nonNegative, const std::vector<char>& counts)
{
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    const bool isAllowed = std::isfinite(numbers[i]) && (!nonNegative || numbers[i] >= 0.0);
    if (!isAllowed && counts[i] != 0)
    {
      throw ErrorAt(Word::Array(name), Sentence("is ") << numbers[i], onCells,
        static_cast<Eigen::Index>(i),
        nonNegative ? "allowed: finite numbers, 0 or more" : "allowed: finite numbers");
    }
  }
}

/// 1 / speed per triangle of InputMesh(); empty without speeds.
std::vector<double> MakeSlowness(const Surface& surface, const Fields& fields)
{
  std::vector<double> slowness;
  if (fields.Speeds.Values.empty())
  {
    return slowness;
  }
  const TriangleMesh& mesh = surface.InputMesh();
  const Triangles triangles = surface.MakeTriangles();
  std::vector<char> counts(fields.Speeds.Values.size(), 0);
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const Index row = mesh.InputTriangle()[static_cast<std::size_t>(t)];
    const Index ofInput = surface.InputTriangle(row);
    for (int a = 0; a < 3 && !fields.Speeds.OnCells; ++a)
    {
      counts[static_cast<std::size_t>(triangles(row, a))] = 1;
    }
    if (fields.Speeds.OnCells)
    {
      counts[static_cast<std::size_t>(fields.Cells[static_cast<std::size_t>(ofInput)])] = 1;
    }
    slowness.push_back(1.0 / SpeedOfTriangle(fields, ofInput, triangles, row));
  }
  RequireFinite(fields.Speeds.Values, "SpeedArray", fields.Speeds.OnCells, true, counts);
  return slowness;
}

} // namespace

/// Of InputMesh(); empty without speeds.
FrontShapes DistanceRun::MakeShapes(const Fields& fields, const DistanceSettings& settings) const
{
  if (fields.Speeds.Values.empty() && !settings.HasSpeed())
  {
    return {};
  }
  const TangentVectors directions = settings.IsDirected()
    ? MakeInputDirections(*this->Domain, fields, this->Parallel)
    : TangentVectors(0, 2);
  return MakeFrontShapes(this->Domain->InputMesh(), MakeSlowness(*this->Domain, fields), directions,
    settings.AlongSpeed, settings.AcrossSpeed);
}

/// The nonzero points of the data, with the label of their value.
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
  std::vector<char> counts(starts.size(), 0);
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
    if (surface.VertexOf(static_cast<Index>(i)) < 0)
    {
      ++set.Outside;
      continue;
    }
    ++set.Count;
    set.NameOfLabel.push_back(mark);
    if (!starts.empty())
    {
      counts[static_cast<std::size_t>(i)] = 1;
    }
  }
  RequireFinite(starts, "SourceTimes", false, false, counts);
  std::vector<double>& names = set.NameOfLabel;
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  const double unit = surface.InputMesh().LengthUnit();
  for (Eigen::Index i = 0; i < marks.rows(); ++i)
  {
    const auto point = static_cast<Index>(i);
    const Index vertex = surface.VertexOf(point);
    if (vertex < 0 || marks(i, 0) == 0.0 || std::isnan(marks(i, 0)))
    {
      continue;
    }
    const double start = starts.empty() ? 0.0 : starts[static_cast<std::size_t>(i)] / unit;
    const auto label = std::lower_bound(names.begin(), names.end(), marks(i, 0)) - names.begin();
    set.Fronts.push_back({ vertex, start, static_cast<Index>(label), point, start });
    set.Heat.push_back({ vertex });
  }
  return set;
}

DistanceRun::SourceSet DistanceRun::FindProjected(const BlockInput& input,
  const SourceShapes& shapes, const FrontShapes& triangles, double maximumDistance,
  const ProgressMonitor& progress)
{
  const Surface& surface = *this->Domain;
  if (!this->Projection || this->ProjectionVersion != this->SurfaceVersion)
  {
    this->Projection = std::make_unique<const SourceProjection>(input.ReadSurface(), surface);
    this->ProjectionVersion = this->SurfaceVersion;
  }
  const ProjectedSources found =
    this->Projection->Project(shapes, maximumDistance, triangles, progress);
  SourceSet set;
  set.AreShapes = true;
  set.Count = found.Count;
  set.TooFar = found.TooFar;
  set.Outside = found.Outside;
  set.Given = found.Count + found.TooFar + found.Outside;
  if (maximumDistance == 0.0)
  {
    set.Farness = DescribeFarPoints("points of the sources", found.MedianDistance,
      DiagonalOf(surface.Points(), Reduction::Serial()));
  }
  auto nextPoint = static_cast<Index>(shapes.Places.rows());
  for (const SourcePiece& piece : found.Pieces)
  {
    AppendFronts(surface.InputMesh(), triangles, piece, nextPoint, set.Fronts);
    AppendHeat(surface.InputMesh(), piece, set.Heat);
  }
  // Labels that count, in their order.
  std::vector<double>& names = set.NameOfLabel;
  for (const FrontSource& front : set.Fronts)
  {
    names.push_back(front.Label);
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  for (FrontSource& front : set.Fronts)
  {
    front.Label = static_cast<Index>(
      std::lower_bound(names.begin(), names.end(), static_cast<double>(front.Label)) -
      names.begin());
  }
  return set;
}

DistanceRun::SourceSet DistanceRun::FindSources(const BlockInput& input, const Fields& fields,
  const FrontShapes& triangles, double maximumDistance, const ProgressMonitor& progress)
{
  return fields.Sources
    ? this->FindProjected(input, *fields.Sources, triangles, maximumDistance, progress)
    : this->FindMarked(fields);
}

} // namespace SurfaceDiffusion
