// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PieceFunctions.h"

#include "Core/Foundation/Random.h"
#include "Core/Surface/PointMatching.h"
#include "InputData.h"
#include "NewArrays.h"

#include <nanobind/stl/optional.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

namespace nb = nanobind;
using namespace nanobind::literals;

namespace SurfaceDiffusion
{

namespace
{

/// Per point, the row of the point that owns it. ids: of points that are matched by these.
nb::object Match(const LongArray& surfaces, const LongArray& pieces, const DoubleArray& places,
  const FlagArray& open, const FlagArray& copies, const std::optional<LongArray>& ids,
  double tolerance)
{
  const std::size_t count = surfaces.size();
  if (pieces.size() != count || places.shape(0) != count || open.size() != count ||
    copies.size() != count || (ids && ids->size() != count))
  {
    throw std::invalid_argument("arrays of different lengths");
  }
  std::vector<InterfacePoint> points(count);
  for (std::size_t i = 0; i < count; ++i)
  {
    InterfacePoint& point = points[i];
    point.Surface = static_cast<int>(surfaces.data()[i]);
    point.Piece = static_cast<int>(pieces.data()[i]);
    point.Label = static_cast<std::int64_t>(i);
    point.IsOpen = open.data()[i] != 0;
    point.IsCopy = copies.data()[i] != 0;
    point.GlobalId = ids ? ids->data()[i] : 0;
    point.Coordinates = { 0.0, 0.0, 0.0 };
    for (std::size_t k = 0; !ids && k < 3; ++k)
    {
      point.Coordinates[k] = places.data()[3 * i + k] + 0.0; // -0 becomes 0
    }
  }
  const std::vector<std::size_t> owners =
    MatchPoints(std::move(points), ids.has_value(), tolerance);
  return NewArray(std::vector<std::int64_t>(owners.begin(), owners.end()));
}

nb::object NumberPlaces(const DoubleArray& places)
{
  return NewArray(IdsOfPlaces(
    places.shape(0), [&](std::size_t i, double* x) { std::copy_n(places.data() + 3 * i, 3, x); }));
}

} // namespace

void BindPieceFunctions(nb::module_& m)
{
  m.def("match_points", &Match, "surfaces"_a, "pieces"_a, "places"_a, "open"_a, "copies"_a,
    "ids"_a.none(), "tolerance"_a);
  m.def("number_places", &NumberPlaces, "places"_a);
}

} // namespace SurfaceDiffusion
