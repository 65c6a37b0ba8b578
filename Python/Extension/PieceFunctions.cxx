// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ShapeFunctions.h"

#include "Core/Foundation/Random.h"
#include "Core/Surface/PointMatching.h"
#include "InputData.h"
#include "NewArrays.h"
#include "OutputTable.h"
#include "Run/BlockSentences.h"
#include "Run/InputSentences.h"
#include "SettingsTable.h"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

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

/// The sentence of a name in the table of Run/InputSentences.cxx, of texts and numbers.
nb::list SayOf(const std::string& name, const nb::args& parts)
{
  std::vector<Sentence> given;
  for (const nb::handle part : parts)
  {
    given.push_back(nb::isinstance<nb::float_>(part)
        ? Sentence() << nb::cast<double>(part)
        : Sentence(nb::cast<std::string>(nb::str(part))));
  }
  return ListWords(FillSentence(name, given));
}

/// found: pairs of text and block.
std::vector<std::string> JoinOfBlocks(
  const std::vector<std::pair<std::string, std::string>>& found, std::size_t blocks)
{
  BlockSentences ofBlocks;
  for (const auto& [text, block] : found)
  {
    ofBlocks.Add(text, block);
  }
  std::vector<Sentence> sentences;
  ofBlocks.AppendTo(sentences, blocks);
  std::vector<std::string> texts;
  for (const Sentence& sentence : sentences)
  {
    texts.push_back(sentence.Text());
  }
  return texts;
}

} // namespace

void BindPieceFunctions(nb::module_& m)
{
  m.def("match_points", &Match, "surfaces"_a, "pieces"_a, "places"_a, "open"_a, "copies"_a,
    "ids"_a.none(), "tolerance"_a);
  m.def("number_places", &NumberPlaces, "places"_a);
  m.def("say", &SayOf, "name"_a, "parts"_a);
  m.def("say_absent",
    [](const std::string& label, const std::string& attribute, bool onPoints, bool onCells,
      bool isElsewhere)
    { return SayAbsent(label, attribute, onPoints, onCells, isElsewhere).Text(); });
  m.def("describe_array", &DescribeArray);
  m.def("list_blocks", &ListBlocks);
  m.def("join_sentences", &JoinOfBlocks);
  m.def("check_surface_properties",
    [](double seamTolerance, double refineTo, bool isAutomatic, int triangles, int threads)
    {
      Problems problems;
      CheckSurfaceProperties(seamTolerance, refineTo, isAutomatic, triangles, threads, problems);
      return ListSentences(problems);
    });
}

} // namespace SurfaceDiffusion
