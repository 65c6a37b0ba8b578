// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceDistances.h"

#include "NewArrays.h"
#include "PythonProgress.h"
#include "Threads.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace nb = nanobind;

namespace SurfaceDiffusion
{

SurfaceDistances::SurfaceDistances(std::shared_ptr<const InputSurface> surface,
  const std::optional<FlagArray>& mask, bool maskOnFaces,
  const std::optional<FactorArray>& slowness, const nb::object& progress)
  : Input(std::move(surface))
{
  SurfaceOptions options;
  options.IntrinsicDelaunay = !slowness;
  PythonProgress(progress).Run(
    [&](const ProgressMonitor& monitor)
    {
      SurfaceArrays arrays = this->Input->Read({ mask, maskOnFaces });
      arrays.AreaFactors.clear(); // lengths do not depend on them
      this->Built = std::make_unique<const SurfaceDiffusion::Surface>(
        std::move(arrays), options, PythonThreads::Instance(), monitor);
      const TriangleMesh& mesh = this->Built->Mesh();
      std::vector<double> ofMesh;
      for (Index t = 0; slowness && t < mesh.NumberOfTriangles(); ++t)
      {
        const Index row = this->Built->InputTriangle(mesh.InputTriangle()[t]);
        ofMesh.push_back(slowness->data()[this->Input->FaceOf(row)]);
      }
      this->Fronts =
        std::make_unique<const GeodesicDistance>(this->Built->SharedMesh(), std::move(ofMesh));
    });
}

nb::tuple SurfaceDistances::FromAll(
  const LongArray& points, const FactorArray& starts, bool apart, const nb::object& progress) const
{
  const TriangleMesh& mesh = this->Built->Mesh();
  const double unit = mesh.LengthUnit();
  const std::size_t n = this->Input->NumberOfPoints();
  std::vector<double> times(n, std::numeric_limits<double>::infinity());
  std::vector<Index> rows(n, -1);
  PythonProgress(progress).Run(
    [&](const ProgressMonitor& monitor)
    {
      std::vector<FrontSource> sources;
      for (std::size_t k = 0; k < points.size(); ++k)
      {
        const Index vertex = this->Built->VertexOf(static_cast<Index>(points.data()[k]));
        const auto number = static_cast<Index>(k);
        const double start = starts.data()[k] / unit;
        sources.push_back({ vertex, start, apart ? number : 0, number, start });
      }
      const GeodesicDistance::Arrival arrival = apart
        ? this->Fronts->FindNearest(sources, monitor)
        : this->Fronts->Find(sources, std::numeric_limits<double>::infinity(), monitor);
      for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
      {
        const auto point = static_cast<std::size_t>(mesh.InputVertex()[i]);
        times[point] = arrival.Times[static_cast<std::size_t>(i)] * unit;
        rows[point] = arrival.Sources[static_cast<std::size_t>(i)];
      }
    });
  return nb::make_tuple(NewArray(std::move(times)), NewArray(std::move(rows)));
}

nb::object SurfaceDistances::ByHeat(const LongArray& points, double m, const nb::object& progress)
{
  const TriangleMesh& mesh = this->Built->Mesh();
  std::vector<double> found(this->Input->NumberOfPoints(), std::numeric_limits<double>::infinity());
  PythonProgress(progress).Run(
    [&](const ProgressMonitor& monitor)
    {
      if (!this->Heat)
      {
        this->Heat = std::make_unique<const HeatDistance>(
          this->Built->SharedAssembler(), m, PythonThreads::Instance(), monitor.Part(0.0, 0.7));
      }
      std::vector<HeatSource> sources;
      for (std::size_t k = 0; k < points.size(); ++k)
      {
        sources.push_back({ this->Built->VertexOf(static_cast<Index>(points.data()[k])) });
      }
      const Values distances = this->Heat->Find({ sources }, monitor.Part(0.7, 1.0));
      for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
      {
        found[static_cast<std::size_t>(mesh.InputVertex()[i])] =
          distances(i, 0) * mesh.LengthUnit();
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
  PythonProgress(progress).Run(
    [&](const ProgressMonitor& monitor)
    {
      constexpr Index panel = 64; // rows that are found beside each other
      std::vector<Row> rows(static_cast<std::size_t>(panel));
      for (Index first = 0; first < count; first += panel)
      {
        const Index size = std::min(panel, count - first);
        ForEachTask(PythonThreads::Instance(), size,
          [&](Index k)
          {
            const Index vertex =
              this->Built->VertexOf(static_cast<Index>(points.data()[first + k]));
            const GeodesicDistance::Arrival arrival =
              this->Fronts->Find({ { vertex, 0.0, 0, 0, 0.0 } }, cutoff / unit);
            Row& row = rows[static_cast<std::size_t>(k)];
            row.clear();
            for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
            {
              const double time = arrival.Times[static_cast<std::size_t>(i)];
              if (std::isfinite(time))
              {
                row.emplace_back(mesh.InputVertex()[i], time * unit);
              }
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
