// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/Surface.h"

#include "Core/Surface/MergePoints.h"
#include "Core/Surface/Seams.h"
#include "Run/Sentence.h"

#include <algorithm>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace SurfaceDiffusion
{

namespace
{

constexpr Eigen::Index LargestCount = std::numeric_limits<Index>::max() / 6; // 6 slots per corner

/// Surfaces with fewer points are made in less time than a thread takes to start.
constexpr Eigen::Index SmallSurface = 5000;

/// The parts of a surface that take long to make. The background task owns all that it touches.
struct Construction
{
  Points Coordinates;
  Triangles Corners;
  std::vector<double> AreaFactors;
  std::shared_ptr<TriangleMesh> Input;
  std::shared_ptr<const IntrinsicDelaunay> Delaunay;
  std::shared_ptr<const TriangleMesh> Working;
  std::shared_ptr<const Assembler> Operators;

  void Run(
    const SurfaceOptions& options, const ParallelFor& parallel, const ProgressMonitor& progress)
  {
    this->Input = std::make_shared<TriangleMesh>(
      this->Coordinates, this->Corners, parallel, progress.Part(0.0, 0.5), options.LengthUnit);
    if (!this->AreaFactors.empty())
    {
      this->Input->ScaleControlAreas(this->AreaFactors);
    }
    this->Working = this->Input;
    if (options.IntrinsicDelaunay)
    {
      this->Delaunay = std::make_shared<IntrinsicDelaunay>(
        this->Input, parallel, progress.Part(0.5, 0.6), options.Boundaries);
      this->Working = this->Delaunay->Mesh();
    }
    this->Operators = std::make_shared<Assembler>(this->Working, parallel, progress.Part(0.6, 1.0));
  }
};

/// The first i of [0, count) for which holds(i) is false, or count if there is none.
template <typename Holds>
Index FirstWithout(const ParallelFor& parallel, Index count, const Holds& holds)
{
  if (Max(parallel, count, [&](Index i) { return holds(i) ? 0.0 : 1.0; }) == 0.0)
  {
    return count;
  }
  Index i = 0;
  while (holds(i))
  {
    ++i;
  }
  return i;
}

void CheckArrays(
  const SurfaceArrays& arrays, const SurfaceOptions& options, const ParallelFor& parallel)
{
  if (arrays.Points.rows() > LargestCount)
  {
    throw std::runtime_error("the input has more points than this library can number");
  }
  if (arrays.Triangles.rows() > LargestCount)
  {
    throw std::runtime_error("the input has more triangles than this library can number");
  }
  RequireFiniteCoordinates(arrays.Points, parallel);
  if (options.IntrinsicDelaunay && !arrays.AreaFactors.empty())
  {
    throw InputError(Sentence(Word::Setting("IntrinsicDelaunay"))
      << " is " << Word::Switch(true) << "; allowed: " << Word::Switch(false)
      << " on surfaces with given areas");
  }
  const auto isPoint = [&](Index point) { return point >= 0 && point < arrays.Points.rows(); };
  const auto count = static_cast<Index>(arrays.Triangles.rows());
  const Index t = FirstWithout(parallel, count,
    [&](Index row)
    {
      const auto corners = arrays.Triangles.row(row);
      return isPoint(corners[0]) && isPoint(corners[1]) && isPoint(corners[2]);
    });
  for (int a = 0; t < count && a < 3; ++a)
  {
    const Index point = arrays.Triangles(t, a);
    if (!isPoint(point))
    {
      std::ostringstream text;
      text << "triangle " << t << " of the input refers to point " << point << ", but there are "
           << arrays.Points.rows() << " points";
      throw std::runtime_error(text.str());
    }
  }
}

} // namespace

void RequireFiniteCoordinates(const Points& points, const ParallelFor& parallel)
{
  const auto count = static_cast<Index>(points.rows());
  const Index i =
    FirstWithout(parallel, count, [&](Index row) { return points.row(row).allFinite(); });
  if (i < count)
  {
    throw InputError(Sentence("point ")
      << i
      << " of the input has coordinates that are not finite; allowed: finite ones, also of points "
         "that nothing uses (remove these, as ParaView's Clean, vtkCleanPolyData, does)");
  }
}

Surface::Surface(SurfaceArrays arrays, const SurfaceOptions& options, const ParallelFor& parallel,
  const ProgressMonitor& progress)
  : Arrays(std::move(arrays))
{
  CheckArrays(this->Arrays, options, parallel);
  this->SelectTriangles(options);
  const Index joined = options.JoinShortEdges ? this->JoinPoints(parallel) : 0;
  progress.Report(0.1);
  this->Build(options, parallel, progress.Part(0.1, 1.0));
  this->ReleaseTriangles();
  this->FindVertices();
  const bool isPoint = this->Working->NumberOfTriangles() == 0; // which is worth a warning
  this->Found.DegenerateTriangles =
    this->Working->Diagnostics().DegenerateTriangles - (isPoint ? 0 : joined);
  this->Found.NonManifoldEdges = this->Working->Diagnostics().NonManifoldEdges;
  this->Found.EdgesLeft = this->Flipped ? this->Flipped->NumberOfEdgesLeft() : 0;
  const Seams seams = FindSeams(*this->Input, this->Arrays.Points);
  this->Found.CoincidentBoundaryPoints = seams.NumberOfVertices;
  this->Found.CoincidenceDistance = seams.Distance;
  this->Found.MergesPoints = options.MergeCoincidentPoints;
}

/// Drop the triangles with an excluded corner, and replace merged points by their representatives.
void Surface::SelectTriangles(const SurfaceOptions& options)
{
  if (options.MergeCoincidentPoints)
  {
    this->Representative = MergePoints(this->Arrays.Points, options.MergeTolerance);
  }
  SurfaceDiffusion::Triangles& triangles = this->Arrays.Triangles;
  std::vector<char>& excluded = this->Arrays.Excluded;
  const std::vector<char>& ofTriangles = this->Arrays.ExcludedTriangles;
  const auto isExcluded = [&](Index point)
  {
    return (!excluded.empty() && excluded[static_cast<std::size_t>(point)] != 0) ||
      this->IsUndetermined(point);
  };
  std::vector<Index> pointsOfExcluded;
  Eigen::Index kept = 0;
  const bool selects =
    !excluded.empty() || !ofTriangles.empty() || !this->Arrays.Undetermined.empty();
  this->TriangleRows.reserve(selects ? static_cast<std::size_t>(triangles.rows()) : 0);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
  {
    if (isExcluded(triangles(t, 0)) || isExcluded(triangles(t, 1)) || isExcluded(triangles(t, 2)))
    {
      continue;
    }
    if (!ofTriangles.empty() && ofTriangles[static_cast<std::size_t>(t)] != 0)
    {
      pointsOfExcluded.insert(pointsOfExcluded.end(), &triangles(t, 0), &triangles(t, 0) + 3);
      continue;
    }
    for (int a = 0; a < 3; ++a)
    {
      const Index point = triangles(t, a);
      triangles(kept, a) = this->Representative.empty()
        ? point
        : this->Representative[static_cast<std::size_t>(point)];
    }
    if (selects)
    {
      this->TriangleRows.push_back(static_cast<Index>(t));
    }
    ++kept;
  }
  triangles.conservativeResize(kept, 3);
  if (!pointsOfExcluded.empty()) // those that no triangle is left to use are unused on purpose
  {
    excluded.resize(static_cast<std::size_t>(this->Arrays.Points.rows()), 0);
    for (const Index point : pointsOfExcluded)
    {
      excluded[static_cast<std::size_t>(point)] = 1;
    }
  }
}

/// The ends of short edges of the selected triangles become one point. Returns the number of
/// triangles that have lost their area by that.
Index Surface::JoinPoints(const ParallelFor& parallel)
{
  SurfaceDiffusion::Triangles& triangles = this->Arrays.Triangles;
  const std::vector<Index> joined = JoinShortEdges(this->Arrays.Points, triangles, parallel);
  if (joined.empty())
  {
    return 0;
  }
  const auto hasTwoEqual = [](const auto& corners)
  { return corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]; };
  const auto representativeOf = [&](Index point)
  { return joined[static_cast<std::size_t>(point)]; };
  Index lost = 0;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
  {
    auto corners = triangles.row(t);
    const bool hadTwoEqual = hasTwoEqual(corners);
    corners = corners.unaryExpr(representativeOf).eval();
    lost += hasTwoEqual(corners) && !hadTwoEqual;
  }
  if (this->Representative.empty())
  {
    this->Representative = joined;
    return lost;
  }
  for (Index& point : this->Representative)
  {
    point = representativeOf(point);
  }
  return lost;
}

void Surface::Build(
  const SurfaceOptions& options, const ParallelFor& parallel, const ProgressMonitor& progress)
{
  const auto construction = std::make_shared<Construction>();
  construction->Coordinates.swap(this->Arrays.Points);
  construction->Corners.swap(this->Arrays.Triangles);
  construction->AreaFactors = this->Arrays.AreaFactors;
  if (construction->Coordinates.rows() < SmallSurface)
  {
    construction->Run(options, parallel, progress);
  }
  else
  {
    RunInBackground(parallel.ForOtherThread([construction, options, &parallel]
                      { construction->Run(options, parallel, ProgressMonitor()); }),
      progress);
  }
  this->Arrays.Points.swap(construction->Coordinates);
  this->Arrays.Triangles.swap(construction->Corners);
  this->Input = std::move(construction->Input);
  this->Flipped = std::move(construction->Delaunay);
  this->Working = std::move(construction->Working);
  this->Operators = std::move(construction->Operators);
}

/// The mesh has the triangles, except those without an area.
void Surface::ReleaseTriangles()
{
  const SurfaceDiffusion::Triangles& triangles = this->Arrays.Triangles;
  this->TriangleCount = static_cast<Index>(triangles.rows());
  if (this->Input->NumberOfTriangles() < this->TriangleCount)
  {
    std::vector<bool> isInMesh(static_cast<std::size_t>(this->TriangleCount), false);
    for (const Index row : this->Input->InputTriangle())
    {
      isInMesh[static_cast<std::size_t>(row)] = true;
    }
    for (Index row = 0; row < this->TriangleCount; ++row)
    {
      if (!isInMesh[static_cast<std::size_t>(row)])
      {
        this->TrianglesWithoutArea.push_back(
          { row, triangles(row, 0), triangles(row, 1), triangles(row, 2) });
      }
    }
  }
  this->Arrays.Triangles = SurfaceDiffusion::Triangles();
}

Triangles Surface::MakeTriangles() const
{
  SurfaceDiffusion::Triangles triangles(this->TriangleCount, 3);
  const TriangleMesh& mesh = *this->Input;
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    for (int a = 0; a < 3; ++a)
    {
      triangles(mesh.InputTriangle()[t], a) = mesh.InputVertex()[mesh.TriangleVertices()(t, a)];
    }
  }
  for (const auto [row, first, second, third] : this->TrianglesWithoutArea)
  {
    triangles.row(row) << first, second, third;
  }
  return triangles;
}

void Surface::FindVertices()
{
  const auto count = static_cast<std::size_t>(this->Arrays.Points.rows());
  this->Vertices.assign(count, -1);
  for (Index v = 0; v < this->Working->NumberOfVertices(); ++v)
  {
    this->Vertices[static_cast<std::size_t>(this->Working->InputVertex()[v])] = v;
  }
  for (std::size_t i = 0; i < count; ++i)
  {
    if (!this->Representative.empty())
    {
      this->Vertices[i] = this->Vertices[static_cast<std::size_t>(this->Representative[i])];
    }
    const bool excluded = (!this->Arrays.Excluded.empty() && this->Arrays.Excluded[i] != 0) ||
      this->IsUndetermined(static_cast<Index>(i));
    this->Found.UnusedPoints += this->Vertices[i] < 0 && !excluded;
  }
}

Sentence SentenceOfCoincidence(const SurfaceDiagnostics& found, const char* consequence)
{
  const double distance = found.CoincidenceDistance;
  Sentence text = " boundary points coincide with others";
  text << consequence << " (to join them, set ";
  if (!found.MergesPoints)
  {
    text << Word::Setting("MergeCoincidentPoints") << (distance > 0.0 ? ", and " : "");
  }
  if (distance > 0.0)
  {
    text << Word::Setting("MergeTolerance") << " to " << distance;
  }
  return text << ")";
}

Points VertexPositions(const Surface& surface)
{
  const TriangleMesh& mesh = surface.InputMesh();
  Points positions(mesh.NumberOfVertices(), 3);
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    positions.row(i) = surface.Points().row(mesh.InputVertex()[i]) / mesh.LengthUnit();
  }
  return positions;
}

double DiagonalOf(const Points& points, const Reduction& processes)
{
  constexpr double none = std::numeric_limits<double>::lowest();
  std::array<double, 6> ends; // the largest coordinates, and minus the smallest
  ends.fill(none);
  for (Eigen::Index axis = 0; points.rows() > 0 && axis < 3; ++axis)
  {
    ends[static_cast<std::size_t>(axis)] = points.col(axis).maxCoeff();
    ends[static_cast<std::size_t>(axis) + 3] = -points.col(axis).minCoeff();
  }
  processes.Max(ends.data(), 6);
  return std::hypot(ends[0] + ends[3], ends[1] + ends[4], ends[2] + ends[5]);
}

TangentVectors TransportToMesh(const Surface& surface, const TangentVectors& vectors)
{
  return surface.Delaunay() ? surface.Delaunay()->Transport(vectors) : vectors;
}

} // namespace SurfaceDiffusion
