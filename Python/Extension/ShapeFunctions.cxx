// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ShapeFunctions.h"

#include "Core/Geometry/Bodies.h"
#include "Core/Geometry/OpenEdges.h"
#include "Core/Geometry/Relief.h"
#include "Core/Geometry/ReliefSolids.h"
#include "Core/Geometry/Welding.h"
#include "Core/Surface/EdgeLengths.h"
#include "Core/Surface/EdgeRefinement.h"
#include "InputData.h"
#include "NewArrays.h"
#include "PythonProgress.h"
#include "Run/TextureRates.h"
#include "Run/TextureSettings.h"
#include "Threads.h"

#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace nb = nanobind;
using namespace nanobind::literals;

namespace SurfaceDiffusion
{

namespace
{

template <typename Matrix>
nb::object ToNumpy(const Matrix& matrix)
{
  return NewArray(
    std::vector<typename Matrix::Scalar>(matrix.data(), matrix.data() + matrix.size()),
    { static_cast<std::size_t>(matrix.rows()), static_cast<std::size_t>(matrix.cols()) });
}

nb::dict Refine(
  const InputSurface& surface, double length, Index maximumTriangles, const nb::object& progress)
{
  RefinedSurface refined;
  PythonProgress(progress).Run(
    [&](const ProgressMonitor& monitor)
    {
      const SurfaceArrays arrays = surface.Read({});
      refined = RefineEdges(arrays.Points, arrays.Triangles, length, maximumTriangles, monitor);
    });
  std::transform(refined.InputTriangle.begin(), refined.InputTriangle.end(),
    refined.InputTriangle.begin(), [&](Index t) { return static_cast<Index>(surface.FaceOf(t)); });
  std::vector<Index> parents;
  for (const auto& pair : refined.Parents)
  {
    parents.insert(parents.end(), pair.begin(), pair.end());
  }
  nb::dict result;
  result["points"] = ToNumpy(refined.Vertices);
  result["triangles"] = ToNumpy(refined.Faces);
  result["faces"] = NewArray(std::move(refined.InputTriangle));
  result["parents"] = NewArray(std::move(parents), { refined.Parents.size(), 2 });
  result["longest_edge"] = refined.LongestEdge;
  result["limit_reached"] = refined.LimitReached;
  return result;
}

/// The values at new points, whose parents are points of lower numbers, in rows below the given ones. type: of
/// the array that they are from.
nb::object InterpolateAtPoints(
  const nb::ndarray<const double, nb::ndim<2>, nb::device::cpu, nb::c_contig>& given,
  const nb::ndarray<const Index, nb::ndim<2>, nb::device::cpu, nb::c_contig>& parents,
  PointRole role, const std::string& type)
{
  const auto count = static_cast<Eigen::Index>(given.shape(0));
  const auto more = static_cast<Eigen::Index>(parents.shape(0));
  const bool areIntegers = type.front() != 'f';
  Values values(count + more, given.shape(1));
  std::copy(given.data(), given.data() + given.size(), values.data());
  for (Eigen::Index i = 0; i < more; ++i)
  {
    const Index* const pair = parents.data() + 2 * i;
    for (Eigen::Index k = 0; k < values.cols(); ++k)
    {
      const double between =
        ValueBetween(role, areIntegers, values.cols() == 1, values(pair[0], k), values(pair[1], k));
      // As points between new ones have it from their array
      values(count + i, k) = type == "float32" ? double(static_cast<float>(between)) : between;
    }
  }
  return ToNumpy(values);
}

/// tolerance: None for the default.
nb::dict Weld(const InputSurface& surface, std::optional<double> tolerance)
{
  WeldedSurface welded;
  PythonProgress(nb::none())
    .Run(
      [&](const ProgressMonitor&)
      {
        const SurfaceArrays arrays = surface.Read({});
        tolerance = tolerance ? *tolerance : DefaultWeldTolerance(arrays.Points, arrays.Triangles);
        welded = WeldSurface(arrays.Points, arrays.Triangles, *tolerance);
      });
  std::transform(welded.InputTriangle.begin(), welded.InputTriangle.end(),
    welded.InputTriangle.begin(), [&](Index t) { return static_cast<Index>(surface.FaceOf(t)); });
  nb::dict result;
  result["triangles"] = ToNumpy(welded.Faces);
  result["faces"] = NewArray(std::move(welded.InputTriangle));
  result["points"] = NewArray(std::move(welded.PointOf));
  result["tolerance"] = *tolerance;
  result["apart"] = welded.Apart;
  result["welded"] = welded.Welded;
  result["split"] = welded.Split;
  result["duplicates"] = welded.Duplicates;
  result["flat"] = welded.Flat;
  return result;
}

/// Per point the one that stands for it, and how far they are apart at most. tolerance: as above.
nb::tuple JoinEnds(const InputSurface& surface, std::optional<double> tolerance)
{
  const SurfaceArrays arrays = surface.Read({});
  std::vector<Index> points = JoinOpenEdges(arrays.Points, arrays.Triangles,
    tolerance ? *tolerance : DefaultWeldTolerance(arrays.Points, arrays.Triangles));
  double apart = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    apart = std::max(
      apart, (arrays.Points.row(static_cast<Index>(i)) - arrays.Points.row(points[i])).norm());
  }
  return nb::make_tuple(NewArray(std::move(points)), apart);
}

nb::dict ListBodies(const InputSurface& surface)
{
  Bodies bodies;
  PythonProgress(nb::none())
    .Run(
      [&](const ProgressMonitor&)
      {
        const SurfaceArrays arrays = surface.Read({});
        bodies = FindBodies(arrays.Points, arrays.Triangles, PythonThreads::Instance());
      });
  nb::list table;
  for (const Body& body : bodies.Table)
  {
    table.append(nb::make_tuple(body.Triangles, body.Area, body.Volume, body.IsClosed));
  }
  nb::dict result;
  result["table"] = table;
  result["of_triangle"] = NewArray(std::move(bodies.OfTriangle));
  result["inside"] =
    NewArray(std::vector<std::uint8_t>(bodies.IsInside.begin(), bodies.IsInside.end()));
  result["open_edges"] = bodies.Edges.Open;
  result["non_manifold_edges"] = bodies.Edges.NonManifold;
  result["misoriented_edges"] = bodies.Edges.Misoriented;
  result["overlaps"] = bodies.Overlaps;
  return result;
}

nb::object Heights(const InputSurface& surface, const FactorArray& values, double height,
  double base, bool twoLevels, double threshold, double flank)
{
  const SurfaceArrays arrays = surface.Read({});
  const Vector heights = ReliefHeights(arrays.Points, arrays.Triangles,
    Eigen::Map<const Vector>(values.data(), static_cast<Eigen::Index>(values.size())),
    { height, base, twoLevels, threshold, flank });
  return NewArray(std::vector<double>(heights.begin(), heights.end()));
}

/// surface: oriented, before the relief; after: its points.
nb::tuple Divide(const InputSurface& surface, const DoubleArray& after, const FactorArray& levels)
{
  ReliefSolids solids;
  PythonProgress(nb::none())
    .Run(
      [&](const ProgressMonitor&)
      {
        const SurfaceArrays arrays = surface.Read({});
        const auto rows = static_cast<Eigen::Index>(after.shape(0));
        solids = DivideRelief(arrays.Points, Eigen::Map<const Points>(after.data(), rows, 3),
          arrays.Triangles, Eigen::Map<const Vector>(levels.data(), rows));
      });
  return nb::make_tuple(ToNumpy(solids.Places), ToNumpy(solids.Faces),
    NewArray(std::vector<std::uint8_t>(solids.IsRaised.begin(), solids.IsRaised.end())));
}

} // namespace

void BindShapeFunctions(nb::module_& m)
{
  m.attr("edges_of_refinement") = TextureRates::EdgesOfRefinement;
  m.attr("edges_per_wavelength") = TextureRates::EdgesPerWavelength;
  m.def("sum_edges",
    [](const InputSurface& surface)
    {
      const EdgeLengths lengths =
        MeasureEdgeLengths(surface.Read({}).Points, surface.GetTriangles());
      return nb::make_tuple(lengths.Sum, lengths.Number);
    });
  m.def("edge_length_for_features",
    [](double featureSize, double meanEdgeLength)
    {
      TextureSettings settings;
      settings.FeatureSize = featureSize;
      return settings.EdgeLengthForFeatures(meanEdgeLength);
    });
  m.def("weld", &Weld, "surface"_a, "tolerance"_a.none());
  m.def("join_open_edges", &JoinEnds, "surface"_a, "tolerance"_a.none());
  m.def("find_bodies", &ListBodies, "surface"_a);
  m.def("turn_outwards",
    [](const InputSurface& surface)
    {
      const SurfaceArrays arrays = surface.Read({});
      Triangles triangles = arrays.Triangles;
      TurnOutwards(arrays.Points, triangles);
      return ToNumpy(triangles);
    });
  m.def("relief_heights", &Heights, "surface"_a, "values"_a, "height"_a, "base"_a, "two_levels"_a,
    "threshold"_a, "flank"_a);
  m.def("divide_relief", &Divide, "surface"_a, "after"_a, "levels"_a);
  m.def("refine", &Refine, "surface"_a, "length"_a, "maximum_triangles"_a, "progress"_a.none());
  nb::enum_<PointRole>(m, "PointRole")
    .value("Data", PointRole::Data)
    .value("Mask", PointRole::Mask)
    .value("Weight", PointRole::Weight)
    .value("Mark", PointRole::Mark);
  m.def("interpolate_at_points", &InterpolateAtPoints, "values"_a, "parents"_a, "role"_a, "type"_a);
}

} // namespace SurfaceDiffusion
