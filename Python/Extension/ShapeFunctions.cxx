// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ShapeFunctions.h"

#include "Core/Surface/EdgeLengths.h"
#include "Core/Surface/EdgeRefinement.h"
#include "InputData.h"
#include "PythonProgress.h"
#include "Run/TextureRates.h"
#include "Run/TextureSettings.h"

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
  m.def("refine", &Refine, "surface"_a, "length"_a, "maximum_triangles"_a, "progress"_a.none());
}

} // namespace SurfaceDiffusion
