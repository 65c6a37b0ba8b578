// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ShapeFunctions.h"

#include "Core/Surface/EdgeLengths.h"
#include "Core/Surface/EdgeRefinement.h"
#include "InputData.h"
#include "NewArrays.h"
#include "PythonProgress.h"
#include "Run/TextureRates.h"
#include "Run/TextureSettings.h"

#include <nanobind/ndarray.h>

#include <algorithm>
#include <cstddef>
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
