// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/InputSentences.h"

#include <map>

namespace SurfaceDiffusion
{

namespace
{

/// {} is a part, and {Name} a setting.
const std::map<std::string, const char*> Table = {
  { "Class", "{} is a {}; allowed: numeric arrays" },
  { "Tuples", "{} has {} tuples; allowed: {}, one per {}" },
  { "Components", "{} has {} components; allowed: {}" },
  { "Association", "{} has association {}; allowed: points (0) or cells (1)" },
  { "NotActive", "{} is not set and the input has no active {} {}; choose a {} array" },
  { "NotAmong", "{} is not among the {} arrays of the input; choose one of them" },
  { "OtherPlace", ", or association {} for the {} array of this name" },
  { "SomeBlocks", "{} counts as not set on {}, without such a numeric array" },
  { "BlockPasses", "{} (without data, a block passes through)" },
  { "CellArray", "{} is a cell array; allowed: point arrays of 1 component" },
  { "PointRates", "DiffusionRateArray is a point array; allowed: arrays of 4 components per cell" },
  { "Unlike",
    "the pieces of the input have different arrays, {} and {}; allowed: one name, type, number of "
    "components and place in all pieces" },
  { "NoPointSet",
    "{} a {}; allowed: a vtkPointSet, such as vtkPolyData (for a table, apply Table To Points, "
    "which is vtkTableToPolyData)" },
  { "NoPoints", "{}, has {} points; allowed: 1 or more{}" },
  { "HiddenPoints", "{}, has {} hidden points; allowed: 1 or more{} that are not hidden" },
  { "NotAmongPoints",
    "{} is not among the point arrays of the points with values; choose one of them" },
  { "NoScalarsOfPoints",
    "{} is not set and the points with values have no active scalars; choose an array" },
  { "NoSurface",
    "{} {}; a surface of polygons or strips is needed (for the surface of a grid, apply Extract "
    "Surface, which is vtkDataSetSurfaceFilter)" },
  { "Empty", "the input is empty; a surface of polygons or strips is needed" },
  { "NoPolygons", "the input has no polygons or strips; a surface is needed" },
  { "Hidden", "all polygons are hidden or ghost cells: nothing is computed" },
  { "CellPoint", "cell {} of the input refers to point {}, but there are {} points" },
  { "NoNormals",
    "MoveVertices is on but InputArray \"{}\" is not the surface's normals; allowed: off, or the "
    "active normals of points or cells, or none, as InputArray" },
  { "NoName", "ResultArrayName is empty; allowed: any name" },
  { "Replaced",
    "results replace arrays of the input: {}; to keep these, set another ResultArrayName" },
  { "Region", "the region of a Mean is {}; allowed: 1 to NumberOfRegions {}" },
  { "Component",
    "the component of a Mean is {}; allowed: 0 to {}, the last component of InputArray" },
  { "Times",
    "{GenerateTimeSteps} is on and the input has times from {} to {}: all results are of the input "
    "at {}; to follow its times, set {GenerateTimeSteps} to off" },
  { "Stopped",
    "refinement stopped at edges of {}, longer than {}, because {MaximumNumberOfTriangles} is {}" },
  { "Bisected", "edges were bisected, to {} triangles, because {}" },
  { "Unresolved", "{} is {}, below two mean edges of {}, which the mesh does not resolve" },
  { "Missed", "the linear solver missed its tolerance; the largest relative residual is {}" },
  { "Features",
    "{FeatureSize} is {}, only {} mean edge lengths (to keep the edges, set {RefineTo} to 0)" },
};

} // namespace

Sentence FillSentence(const std::string& name, const std::vector<Sentence>& parts)
{
  const std::string text = Table.at(name);
  Sentence sentence;
  std::size_t at = 0;
  std::size_t number = 0;
  for (std::size_t open = text.find('{'); open != std::string::npos; open = text.find('{', at))
  {
    const std::size_t close = text.find('}', open);
    const std::string setting = text.substr(open + 1, close - open - 1);
    sentence << text.substr(at, open - at)
             << (setting.empty() ? parts.at(number++) : Sentence(Word::Setting(setting)));
    at = close + 1;
  }
  return sentence << text.substr(at);
}

std::string ArrayLabel(const std::string& property, const std::string& name)
{
  return property + (name.empty() ? "" : " \"" + name + "\"");
}

Sentence SayAbsent(const std::string& label, const std::string& attribute, bool onPoints,
  bool onCells, bool isElsewhere)
{
  const char* const kind = onPoints && onCells ? "point or cell" : (onCells ? "cell" : "point");
  if (!attribute.empty())
  {
    return Say("NotActive", label, kind, attribute, kind);
  }
  Sentence sentence = Say("NotAmong", label, kind);
  return isElsewhere && onPoints != onCells
    ? sentence << Say("OtherPlace", onPoints ? 1 : 0, onPoints ? "cell" : "point")
    : sentence;
}

std::string DescribeArray(
  const std::string& name, const std::string& type, int components, bool onCells)
{
  return "\"" + name + "\" (" + type + (type.empty() ? "" : ", ") + std::to_string(components) +
    (components == 1 ? " component" : " components") + ", on " + (onCells ? "cells" : "points") +
    ")";
}

void CheckSurfaceProperties(double seamTolerance, double refineTo, bool isAutomatic,
  int maximumNumberOfTriangles, int numberOfThreads, Problems& problems)
{
  const SettingRange seam =
    SettingRange::NonNegativeOr(-1.0, "finite numbers, 0 or more, or -1: 1e-6 of the bounding box");
  const SettingRange length = isAutomatic
    ? SettingRange::NonNegativeOr(-1.0, "finite numbers, 0 or more, or -1: automatic")
    : SettingRange::NonNegative();
  Require(seam.Contains(seamTolerance), Word::Setting("SeamTolerance"), seamTolerance, seam.Text,
    problems);
  Require(length.Contains(refineTo), Word::Setting("RefineTo"), refineTo, length.Text, problems);
  Require(maximumNumberOfTriangles > 0, Word::Setting("MaximumNumberOfTriangles"),
    maximumNumberOfTriangles, "integers, 1 or more", problems);
  Require(numberOfThreads >= 0, Word::Setting("NumberOfThreads"), numberOfThreads,
    "integers, 0 or more; 0: all", problems);
}

} // namespace SurfaceDiffusion
