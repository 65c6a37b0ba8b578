// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ShapeFunctions.h"

#include "Core/Geometry/Relief.h"
#include "Core/Surface/EdgeRefinement.h"
#include "InputData.h"
#include "PythonProgress.h"
#include "Run/ReliefRun.h"
#include "Threads.h"

#include <nanobind/ndarray.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace nb = nanobind;
using namespace nanobind::literals;

namespace SurfaceDiffusion
{

namespace
{

/// A numpy array of its own with rows x columns numbers.
template <typename T>
nb::object ToNumpy(const T* from, std::size_t rows, std::size_t columns)
{
  T* const numbers = new T[std::max<std::size_t>(1, rows * columns)];
  const nb::capsule owner(numbers, [](void* p) noexcept { delete[] static_cast<T*>(p); });
  std::copy(from, from + rows * columns, numbers);
  return nb::cast(nb::ndarray<nb::numpy, T>(numbers, { rows, columns }, owner));
}

template <typename Matrix>
nb::object ToNumpy(const Matrix& matrix)
{
  return ToNumpy(matrix.data(), static_cast<std::size_t>(matrix.rows()),
    static_cast<std::size_t>(matrix.cols()));
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
  nb::dict result;
  result["points"] = ToNumpy(refined.Vertices);
  result["triangles"] = ToNumpy(refined.Faces);
  result["faces"] = ToNumpy(refined.InputTriangle.data(), refined.InputTriangle.size(), 1);
  const Index* const parents = refined.Parents.empty() ? nullptr : refined.Parents[0].data();
  result["parents"] = ToNumpy(parents, refined.Parents.size(), 2);
  result["longest_edge"] = refined.LongestEdge;
  result["limit_reached"] = refined.LimitReached;
  return result;
}

Vector ToVector(const FactorArray& numbers)
{
  return Eigen::Map<const Vector>(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
}

nb::object FindHeights(const InputSurface& surface, const FactorArray& values, double height,
  double base, bool twoLevels, double threshold, double flank)
{
  const SurfaceArrays arrays = surface.Read({});
  return ToNumpy(ReliefHeights(arrays.Points, arrays.Triangles, ToVector(values),
    { height, base, twoLevels, threshold, flank }));
}

nb::object FindOverhangsOf(
  const InputSurface& surface, double x, double y, double z, double degrees)
{
  const SurfaceArrays arrays = surface.Read({});
  const std::vector<char> found =
    FindOverhangs(arrays.Points, arrays.Triangles, { x, y, z }, degrees);
  const std::vector<Index> flags(found.begin(), found.end());
  return ToNumpy(flags.data(), flags.size(), 1);
}

nb::dict MakeReliefOf(
  const InputSurface& surface, const FactorArray& heights, const nb::object& progress)
{
  Relief relief;
  const Vector wanted = ToVector(heights);
  PythonProgress(progress).Run(
    [&](const ProgressMonitor& monitor)
    {
      const SurfaceArrays arrays = surface.Read({});
      relief =
        MakeRelief(arrays.Points, arrays.Triangles, wanted, PythonThreads::Instance(), monitor);
    });
  nb::dict result;
  result["points"] = ToNumpy(relief.Places);
  result["triangles"] = ToNumpy(relief.Faces);
  result["heights"] = ToNumpy(relief.Heights);
  result["lowered_points"] = relief.LoweredVertices;
  result["open_edges"] = relief.OpenEdges;
  result["non_manifold_edges"] = relief.NonManifoldEdges;
  result["crossing_triangles_before"] = relief.CrossingTrianglesBefore;
  result["crossing_triangles"] = relief.CrossingTriangles;
  result["volume_change"] = relief.VolumeChange;
  result["smallest_wall"] = relief.SmallestWall;
  nb::list warnings;
  for (const Sentence& sentence : DescribeRelief(relief, wanted))
  {
    warnings.append(nb::str(sentence.Text().c_str()));
  }
  result["warnings"] = warnings;
  return result;
}

} // namespace

void BindShapeFunctions(nb::module_& m)
{
  m.def("refine", &Refine, "surface"_a, "length"_a, "maximum_triangles"_a, "progress"_a.none());
  m.def("relief_heights", &FindHeights, "surface"_a, "values"_a, "height"_a, "base"_a,
    "two_levels"_a, "threshold"_a, "flank"_a);
  m.def("relief_overhangs", &FindOverhangsOf, "surface"_a, "x"_a, "y"_a, "z"_a, "degrees"_a);
  m.def("relief", &MakeReliefOf, "surface"_a, "heights"_a, "progress"_a.none());
}

} // namespace SurfaceDiffusion
