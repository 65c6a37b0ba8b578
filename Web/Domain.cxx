// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Domain.h"

#include "Core/Surface/EdgeLengths.h"
#include "Core/Surface/EdgeRefinement.h"
#include "Core/Surface/Polygons.h"
#include "Run/InputSentences.h"
#include "Run/Surface.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace SurfaceDiffusion
{

Domain Domain::Of(const Files::SurfaceFile& file)
{
  constexpr auto most = static_cast<std::size_t>(std::numeric_limits<Index>::max());
  if (file.NumberOfPoints() > most || file.Corners.size() > most)
  {
    throw std::runtime_error("the surface has more points than this library can number");
  }
  Domain domain;
  domain.Points = Eigen::Map<const SurfaceDiffusion::Points>(
    file.Points.data(), static_cast<Eigen::Index>(file.NumberOfPoints()), 3);
  RequireFiniteCoordinates(domain.Points);
  domain.NumberOfCells = static_cast<Index>(file.NumberOfCells());
  std::vector<Index> corners;
  std::vector<Eigen::RowVector3d> polygon;
  corners.reserve(file.Corners.size());
  std::vector<Corners> triangles;
  for (std::size_t c = 0; c < file.NumberOfCells(); ++c)
  {
    const std::int64_t* const cell = file.Corners.data() + file.Begin[c];
    const std::size_t size = file.Begin[c + 1] - file.Begin[c];
    triangles.assign({ { { 0, 1, 2 } } });
    if (size != 3)
    {
      polygon.clear();
      for (std::size_t k = 0; k < size; ++k)
      {
        polygon.emplace_back(domain.Points.row(static_cast<Eigen::Index>(cell[k])));
      }
      triangles = CutPolygon(polygon);
    }
    for (const Corners& triangle : triangles)
    {
      for (const int corner : triangle)
      {
        corners.push_back(static_cast<Index>(cell[corner]));
      }
      domain.Cells.push_back(static_cast<Index>(c));
    }
  }
  domain.Triangles = Eigen::Map<const SurfaceDiffusion::Triangles>(
    corners.data(), static_cast<Eigen::Index>(corners.size() / 3), 3);
  return domain;
}

Domain Domain::Refined(double length, Index maximumTriangles, const ProgressMonitor& progress,
  std::vector<std::string>& warnings) const
{
  RefinedSurface refined =
    RefineEdges(this->Points, this->Triangles, length, maximumTriangles, progress);
  if (refined.LimitReached)
  {
    warnings.push_back(Say("Stopped", refined.LongestEdge, length, maximumTriangles).Text());
  }
  if (refined.Parents.empty())
  {
    return *this;
  }
  Domain fine;
  fine.Points = std::move(refined.Vertices);
  fine.Triangles = std::move(refined.Faces);
  fine.NumberOfCells = static_cast<Index>(fine.Triangles.rows());
  fine.Parents = std::move(refined.Parents);
  fine.IsRefined = true;
  for (const Index triangle : refined.InputTriangle)
  {
    fine.Cells.push_back(this->Cells[static_cast<std::size_t>(triangle)]);
  }
  return fine;
}

double Domain::MeanEdgeLength() const
{
  const EdgeLengths lengths = MeasureEdgeLengths(this->Points, this->Triangles);
  const auto number = static_cast<double>(lengths.Number);
  return number > 0.0 ? lengths.Sum / number : 0.0;
}

std::vector<Index> Domain::OwnCells() const
{
  std::vector<Index> cells = this->Cells;
  if (this->IsRefined)
  {
    std::iota(cells.begin(), cells.end(), 0);
  }
  return cells;
}

Files::FileArray Domain::Carry(Files::FileArray array, const std::string& input) const
{
  if (!this->IsRefined)
  {
    return array;
  }
  const std::size_t columns = array.Components;
  if (array.OnCells)
  {
    const std::vector<double> ofCells = std::move(array.Numbers);
    array.Numbers.clear();
    for (const Index cell : this->Cells)
    {
      const auto first =
        ofCells.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(cell) * columns);
      array.Numbers.insert(
        array.Numbers.end(), first, first + static_cast<std::ptrdiff_t>(columns));
    }
    return array;
  }
  const bool isMark =
    input == "fixed" || input == "seeds" || input == "sources" || input == "path_points";
  for (const std::array<Index, 2>& parents : this->Parents)
  {
    for (std::size_t k = 0; k < columns; ++k)
    {
      const double a = array.Numbers[static_cast<std::size_t>(parents[0]) * columns + k];
      const double b = array.Numbers[static_cast<std::size_t>(parents[1]) * columns + k];
      double between = isMark ? std::min(a, b) : 0.5 * a + 0.5 * b;
      if (input == "mask")
      {
        between = a == 0.0 ? b : a;
      }
      else if ((isMark || input == "fidelity" || input == "roi") && (a == 0.0 || b == 0.0))
      {
        between = 0.0;
      }
      array.Numbers.push_back(between);
    }
  }
  return array;
}

} // namespace SurfaceDiffusion
