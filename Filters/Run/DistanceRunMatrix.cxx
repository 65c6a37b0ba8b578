// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The matrix of distances of a DistanceRun.
#include "Core/Foundation/LoopWatch.h"
#include "Run/DistanceRun.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <utility>

namespace SurfaceDiffusion
{

DistanceRun::Matrix DistanceRun::FindEach(const BlockInput& input, Settings& given,
  const std::vector<Index>& points, double cutoff, const ProgressMonitor& progress)
{
  auto& settings = static_cast<DistanceSettings&>(given);
  Problems problems;
  Require(settings.Method != DistanceMethod::Heat, Word::Setting("Method"),
    Word::Number("Method", settings.Method), Sentence("other methods than the heat method"),
    problems);
  ThrowProblems(std::move(problems));
  this->FieldsVersion = {}; // the next update has another result
  this->PrepareSurface(WithoutGivenAreas(input), settings, progress.Part(0.0, 0.1));
  this->TakeSpeeds(this->ReadFields(input), settings);
  const Surface& surface = *this->Domain;
  const TriangleMesh& mesh = *this->MeshOfSolvers;
  const auto all = static_cast<Index>(surface.Points().rows());
  const Index count = points.empty() ? all : static_cast<Index>(points.size());
  const auto cornerOf = [&](Index k)
  { return this->CornerOf(points.empty() ? k : points[static_cast<std::size_t>(k)]); };
  this->Found = {};
  this->Found.AreShapes = true;
  for (Index k = 0; k < count; ++k)
  {
    ++this->Found.Given;
    ++(cornerOf(k) >= 0 ? this->Found.Count : this->Found.Outside);
  }
  this->Found.Outside = points.empty() ? 0 : this->Found.Outside;
  const double unit = mesh.LengthUnit();
  const double reach = cutoff / unit;
  double area = 0.0;
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    area += mesh.Shapes()[static_cast<std::size_t>(t)].Area();
  }
  constexpr double ofSetUp = 0.01; // of the time of a whole surface, however near the cutoff is
  const double share = std::clamp(std::acos(-1.0) * reach * reach / area, ofSetUp, 1.0);
  const bool isExact = this->FindMethod(settings.Method, !this->Shapes.empty(), share * count) ==
    DistanceMethod::Exact;
  const ExactDistance* const exact = isExact ? &this->TakeExact() : nullptr;
  const EikonalDistance* const eikonal =
    isExact ? nullptr : &this->TakeEikonal(progress.Part(0.1, 0.2));
  // The points of vertices that have more than one.
  std::multimap<Index, Index> copies;
  for (Index point = 0; point < all; ++point)
  {
    const Index i = surface.VertexOf(point);
    if (i >= 0 && mesh.InputVertex()[static_cast<std::size_t>(i)] != point)
    {
      copies.emplace(i, point);
    }
  }
  constexpr Index panel = 64; // rows that are found beside each other
  std::vector<std::vector<std::pair<Index, double>>> rows(static_cast<std::size_t>(panel));
  std::vector<GeodesicDistance::Memory> memories(
    static_cast<std::size_t>(isExact ? 0 : std::min(panel, count)),
    GeodesicDistance::Memory(isExact ? 0 : eikonal->NumberOfVertices()));
  ExactDistance::Memories windows;
  // Threads beside the one that is watched stop with it.
  std::atomic<bool> stopped{ false };
  const ProgressMonitor::Callback goOn = [&stopped](double)
  {
    LoopWatch* const watch = LoopWatch::OfThisThread();
    try
    {
      if (watch)
      {
        watch->Ask();
      }
    }
    catch (const Aborted&)
    {
      stopped = true;
    }
    return !stopped;
  };
  const ProgressMonitor ofTasks(goOn);
  Matrix matrix;
  for (Index first = 0; first < count; first += panel)
  {
    const Index size = std::min(panel, count - first);
    ForEachTask(this->Parallel, size,
      [&](Index k)
      {
        auto& row = rows[static_cast<std::size_t>(k)];
        row.clear();
        const Index corner = cornerOf(first + k);
        if (corner < 0)
        {
          return;
        }
        const auto near = isExact
          ? exact->FindNear(this->PieceAt(corner, 0), reach, windows, ofTasks)
          : eikonal->FindNear(mesh.TriangleVertices().data()[corner], reach,
              memories[static_cast<std::size_t>(k)], ofTasks);
        for (const auto& [i, time] : near)
        {
          row.emplace_back(mesh.InputVertex()[static_cast<std::size_t>(i)], time * unit);
          const auto [copy, end] = copies.equal_range(i);
          for (auto entry = copy; entry != end; ++entry)
          {
            row.emplace_back(entry->second, time * unit);
          }
        }
        std::sort(row.begin(), row.end());
      });
    for (Index k = 0; k < size; ++k)
    {
      for (const auto& [column, time] : rows[static_cast<std::size_t>(k)])
      {
        matrix.Columns.push_back(column);
        matrix.Data.push_back(time);
      }
      matrix.Begin.push_back(static_cast<std::int64_t>(matrix.Data.size()));
    }
    progress.Report(0.2 + 0.8 * static_cast<double>(first + size) / count);
  }
  return matrix;
}

} // namespace SurfaceDiffusion
