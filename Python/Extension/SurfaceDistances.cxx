// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceDistances.h"

#include "NewArrays.h"
#include "PythonProgress.h"
#include "Run/DistanceSources.h"
#include "Threads.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace nb = nanobind;

namespace SurfaceDiffusion
{

namespace
{

/// 1 / speed per triangle of the mesh; empty without speeds.
std::vector<double> SlownessOf(const TriangleMesh& mesh, const InputSurface& input,
  const Surface& surface, const std::optional<FactorArray>& ofFaces)
{
  std::vector<double> slowness;
  for (Index t = 0; ofFaces && t < mesh.NumberOfTriangles(); ++t)
  {
    const Index row = surface.InputTriangle(mesh.InputTriangle()[static_cast<std::size_t>(t)]);
    slowness.push_back(ofFaces->data()[input.FaceOf(row)]);
  }
  return slowness;
}

} // namespace

SurfaceDistances::SurfaceDistances(std::shared_ptr<const InputSurface> surface,
  const std::optional<FlagArray>& mask, bool maskOnFaces,
  const std::optional<FactorArray>& slowness, const std::optional<DoubleArray>& directions,
  bool directionsOnFaces, double along, double across, const nb::object& progress)
  : Input(std::move(surface))
  , Mask{ mask, maskOnFaces }
{
  const bool hasSpeed = slowness || along != 1.0 || across != 1.0;
  SurfaceOptions options;
  options.IntrinsicDelaunay = !hasSpeed;
  Fields fields;
  if (directions)
  {
    InputFields given;
    given.Surface = this->Input;
    given.Directions = { directions, directionsOnFaces };
    fields = given.Read();
  }
  PythonProgress(progress).Run(
    [&](const ProgressMonitor& monitor)
    {
      SurfaceArrays arrays = this->Input->Read(this->Mask);
      arrays.AreaFactors.clear(); // lengths do not depend on them
      this->Built = std::make_unique<const SurfaceDiffusion::Surface>(
        std::move(arrays), options, PythonThreads::Instance(), monitor);
      const TriangleMesh& mesh = this->Built->InputMesh();
      this->MeshTriangles.assign(this->Input->GetTriangles().rows(), -1);
      for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
      {
        this->MeshTriangles[this->Built->InputTriangle(mesh.InputTriangle()[t])] = t;
      }
      if (hasSpeed)
      {
        const TangentVectors ofMesh =
          MakeInputDirections(*this->Built, fields, PythonThreads::Instance());
        this->Shapes = MakeFrontShapes(mesh, SlownessOf(mesh, *this->Input, *this->Built, slowness),
          along != across ? ofMesh : TangentVectors(0, 2), along, across);
      }
      this->Fronts = std::make_unique<const GeodesicDistance>(
        hasSpeed ? this->Built->SharedInputMesh() : this->Built->SharedMesh(), this->Shapes);
    });
}

bool SurfaceDistances::HasTriangle(std::int64_t row) const
{
  const Index t = this->MeshTriangles[static_cast<std::size_t>(row)];
  return t >= 0 && !IsBarrier(this->Shapes, t);
}

nb::tuple SurfaceDistances::Project(const DoubleArray& points, const nb::object& progress) const
{
  const std::size_t count = points.shape(0);
  std::vector<std::int64_t> rows(count, -1);
  std::vector<double> barycentric(3 * count, 0.0);
  std::string farness;
  PythonProgress(progress).Run(
    [&](const ProgressMonitor& monitor)
    {
      SourceShapes shapes;
      shapes.Places = Eigen::Map<const Points>(points.data(), static_cast<Eigen::Index>(count), 3);
      const SourceProjection projection(this->Input->Read(this->Mask), *this->Built);
      const ProjectedSources found = projection.Project(shapes, 0.0, this->Shapes, monitor);
      farness = DescribeFarPoints("sources", found.MedianDistance,
        DiagonalOf(this->Built->Points(), Reduction::Serial()))
                  .Text();
      const TriangleMesh& mesh = this->Built->InputMesh();
      for (const SourcePiece& piece : found.Pieces)
      {
        const auto k = static_cast<std::size_t>(piece.FromPoint);
        rows[k] = this->Built->InputTriangle(mesh.InputTriangle()[piece.Triangle]);
        std::copy(piece.From.begin(), piece.From.end(), barycentric.begin() + 3 * k);
      }
    });
  return nb::make_tuple(NewArray(std::move(rows)), NewArray(std::move(barycentric)), farness.c_str());
}

/// Source k as a piece whose label is its number.
SourcePiece SurfaceDistances::PieceOf(
  const LongArray& rows, const DoubleArray& barycentric, std::size_t k) const
{
  const double* const at = barycentric.data() + 3 * k;
  const auto number = static_cast<Index>(k);
  const std::array<double, 3> place = { at[0], at[1], at[2] };
  const Index t = this->MeshTriangles[static_cast<std::size_t>(rows.data()[k])];
  return { t, place, place, number, number, number };
}

nb::tuple SurfaceDistances::FromAll(const LongArray& rows,
  const std::optional<DoubleArray>& barycentric, const FactorArray& starts, bool apart,
  const nb::object& progress) const
{
  const TriangleMesh& mesh = this->Built->InputMesh();
  const double unit = mesh.LengthUnit();
  const std::size_t n = this->Input->NumberOfPoints();
  std::vector<double> times(n, std::numeric_limits<double>::infinity());
  std::vector<Index> nearest(n, -1);
  PythonProgress(progress).Run(
    [&](const ProgressMonitor& monitor)
    {
      std::vector<FrontSource> fronts;
      std::vector<Index> sourceOf;
      auto nextPoint = static_cast<Index>(rows.size());
      for (std::size_t k = 0; k < rows.size(); ++k)
      {
        if (barycentric)
        {
          AppendFronts(mesh, this->Shapes, this->PieceOf(rows, *barycentric, k), nextPoint, fronts);
        }
        else
        {
          const Index vertex = this->Built->VertexOf(static_cast<Index>(rows.data()[k]));
          fronts.push_back({ vertex, 0.0, 0, static_cast<Index>(k), 0.0 });
        }
        const double start = starts.data()[k] / unit;
        for (; sourceOf.size() < fronts.size(); sourceOf.push_back(static_cast<Index>(k)))
        {
          FrontSource& front = fronts[sourceOf.size()];
          front.Time += start;
          front.Start = start;
          front.Label = apart ? static_cast<Index>(k) : 0;
        }
      }
      const GeodesicDistance::Arrival arrival = apart
        ? this->Fronts->FindNearest(fronts, monitor)
        : this->Fronts->Find(fronts, std::numeric_limits<double>::infinity(), monitor);
      for (std::size_t point = 0; point < times.size(); ++point)
      {
        const Index i = this->Built->VertexOf(static_cast<Index>(point));
        if (i >= 0)
        {
          const Index front = arrival.Sources[static_cast<std::size_t>(i)];
          times[point] = arrival.Times[static_cast<std::size_t>(i)] * unit;
          nearest[point] = front < 0 ? -1 : sourceOf[static_cast<std::size_t>(front)];
        }
      }
    });
  return nb::make_tuple(NewArray(std::move(times)), NewArray(std::move(nearest)));
}

nb::object SurfaceDistances::ByHeat(
  const LongArray& rows, const std::optional<DoubleArray>& barycentric, const nb::object& progress)
{
  const TriangleMesh& mesh = this->Built->InputMesh();
  std::vector<double> found(this->Input->NumberOfPoints(), std::numeric_limits<double>::infinity());
  PythonProgress(progress).Run(
    [&](const ProgressMonitor& monitor)
    {
      if (!this->Heat)
      {
        this->Heat = std::make_unique<const HeatDistance>(this->Built->SharedAssembler(),
          HeatDistance::UsualStep, PythonThreads::Instance(), monitor.Part(0.0, 0.7));
      }
      std::vector<HeatSource> sources;
      for (std::size_t k = 0; k < rows.size(); ++k)
      {
        if (barycentric)
        {
          AppendHeat(mesh, this->PieceOf(rows, *barycentric, k), sources);
        }
        else
        {
          sources.push_back({ this->Built->VertexOf(static_cast<Index>(rows.data()[k])) });
        }
      }
      const Values distances = this->Heat->Find({ sources }, monitor.Part(0.7, 1.0));
      for (std::size_t point = 0; point < found.size(); ++point)
      {
        const Index i = this->Built->VertexOf(static_cast<Index>(point));
        found[point] = i < 0 ? found[point] : distances(i, 0) * mesh.LengthUnit();
      }
    });
  return NewArray(std::move(found));
}

nb::tuple SurfaceDistances::FromEach(
  const LongArray& points, double cutoff, const nb::object& progress) const
{
  const TriangleMesh& mesh = this->Built->Mesh();
  const double unit = mesh.LengthUnit();
  const auto count = static_cast<Index>(points.size());
  using Row = std::vector<std::pair<Index, double>>;
  std::vector<double> data;
  std::vector<Index> columns;
  std::vector<std::int64_t> begin = { 0 };
  // The points of vertices that have more than one.
  std::multimap<Index, Index> copies;
  for (Index point = 0; point < static_cast<Index>(this->Input->NumberOfPoints()); ++point)
  {
    const Index i = this->Built->VertexOf(point);
    if (i >= 0 && mesh.InputVertex()[i] != point)
    {
      copies.emplace(i, point);
    }
  }
  PythonProgress(progress).Run(
    [&](const ProgressMonitor& monitor)
    {
      constexpr Index panel = 64; // rows that are found beside each other
      std::vector<Row> rows(static_cast<std::size_t>(panel));
      const auto n = static_cast<std::size_t>(mesh.NumberOfVertices());
      constexpr double never = std::numeric_limits<double>::infinity();
      std::vector<GeodesicDistance::Arrival> arrivals(
        static_cast<std::size_t>(std::min(panel, count)),
        { std::vector<double>(n, never), std::vector<Index>(n, -1) });
      for (Index first = 0; first < count; first += panel)
      {
        const Index size = std::min(panel, count - first);
        ForEachTask(PythonThreads::Instance(), size,
          [&](Index k)
          {
            const Index vertex =
              this->Built->VertexOf(static_cast<Index>(points.data()[first + k]));
            GeodesicDistance::Arrival& arrival = arrivals[static_cast<std::size_t>(k)];
            Row& row = rows[static_cast<std::size_t>(k)];
            row.clear();
            for (const Index i :
              this->Fronts->FindNear({ vertex, 0.0, 0, 0, 0.0 }, cutoff / unit, arrival))
            {
              double& time = arrival.Times[static_cast<std::size_t>(i)];
              row.emplace_back(mesh.InputVertex()[i], time * unit);
              const auto [copy, end] = copies.equal_range(i);
              std::transform(copy, end, std::back_inserter(row),
                [&](const auto& entry) { return std::make_pair(entry.second, time * unit); });
              time = never;
              arrival.Sources[static_cast<std::size_t>(i)] = -1;
            }
            std::sort(row.begin(), row.end());
          });
        for (Index k = 0; k < size; ++k)
        {
          for (const auto& [column, time] : rows[static_cast<std::size_t>(k)])
          {
            columns.push_back(column);
            data.push_back(time);
          }
          begin.push_back(static_cast<std::int64_t>(data.size()));
        }
        monitor.Report(static_cast<double>(first + size) / count);
      }
    });
  return nb::make_tuple(
    NewArray(std::move(data)), NewArray(std::move(columns)), NewArray(std::move(begin)));
}

} // namespace SurfaceDiffusion
