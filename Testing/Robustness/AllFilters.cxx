// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "AllFilters.h"

#include "Properties.h"

#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace FilterTest
{
namespace
{

/// The index of the input array of a name in ParaView's panels.
const std::map<std::string, int> ArrayIndices = { { "InputArray", 0 }, { "SourceArray", 0 },
  { "MaskArray", 1 }, { "DirectionArray", 2 }, { "FidelityArray", 5 }, { "CreaseArray", 6 },
  { "SpeedArray", 8 }, { "SlopeErrorArray", 10 }, { "AlongSpeedArray", 11 },
  { "AcrossSpeedArray", 12 } };

void SetByName(vtkPolyDataAlgorithm* filter, const std::string& name, const std::string& value)
{
  const auto index = ArrayIndices.find(name);
  if (index != ArrayIndices.end())
  {
    const std::size_t at = value.find("@cells");
    SetInputArray(filter, index->second, value.substr(0, at).c_str(), at != std::string::npos);
  }
  else if (name == "PathPoints")
  {
    filter->SetInputData(2, Sphere(0)); // paths lead from its points
  }
  else if (name == "UseAsNormals") // no setting of the run
  {
    vtkHarmonicMapFilter::SafeDownCast(filter)->SetUseAsNormals(value == "1");
  }
  else
  {
    const std::vector<Property> all = PropertiesOf(filter);
    const auto found = std::find_if(
      all.begin(), all.end(), [&](const Property& property) { return property.Name == name; });
    if (found == all.end())
    {
      throw std::invalid_argument(filter->GetClassName() + (" has no property " + name));
    }
    found->Set(filter, value);
  }
}

/// The kind of a line.
FilterKind ReadKind(const std::string& line)
{
  std::istringstream words(line);
  FilterKind kind;
  std::string className;
  std::vector<std::pair<std::string, std::string>> values;
  words >> kind.Name >> className >> kind.Result;
  for (std::string word; words >> word;)
  {
    const std::size_t sign = word.find('=');
    kind.IsSlow = kind.IsSlow || word == "slow";
    if (sign != std::string::npos)
    {
      values.emplace_back(word.substr(0, sign), word.substr(sign + 1));
    }
  }
  kind.Make = [className, values]
  {
    auto filter = MakeFilter(className);
    for (const auto& [name, value] : values)
    {
      SetByName(filter, name, value);
    }
    return filter;
  };
  return kind;
}

} // namespace

const std::vector<FilterKind>& AllFilters()
{
  static const std::vector<FilterKind> all = []
  {
    std::vector<FilterKind> kinds;
    std::ifstream file(SURFACEDIFFUSION_KINDS_OF_RUN);
    for (std::string line; std::getline(file, line);)
    {
      if (!line.empty() && line[0] != '#' && line.rfind("model ", 0) != 0)
      {
        kinds.push_back(ReadKind(line));
      }
    }
    return kinds;
  }();
  return all;
}

void AddArraysOfAllFilters(vtkPolyData* surface)
{
  surface->GetCellData()->AddArray(MakeArray(VTK_DOUBLE, "c", surface->GetNumberOfCells(), 1,
    [](vtkIdType i, int k) { return 2.0 + Rough(i, k); }));
  AddPointArray(
    surface, "rgb", 3, [](vtkIdType i, int k) { return 120.0 + 100.0 * Rough(i, k); },
    VTK_UNSIGNED_CHAR);
  AddPointArray(surface, "mask", 1, [](vtkIdType i, int) { return i % 17 == 3; });
  const auto weight = [](vtkIdType i, int) { return WeightOf(i); };
  AddPointArray(surface, "weights", 1, weight);
  surface->GetCellData()->AddArray(
    MakeArray(VTK_DOUBLE, "weights", surface->GetNumberOfCells(), 1, weight));
  AddPointArray(surface, "e1", 3, [](vtkIdType i, int k) { return k + 0.3 * Rough(i, k); });
  // One of them is a corner of the largest triangle, which takes part.
  vtkIdType largest = 0;
  double area = 0.0;
  for (vtkIdType c = 0; c < surface->GetNumberOfCells(); ++c)
  {
    vtkNew<vtkIdList> corners;
    surface->GetCellPoints(c, corners);
    double p[3][3];
    for (vtkIdType a = 0; a < 3; ++a)
    {
      surface->GetPoint(corners->GetId(a), p[a]);
    }
    const double found = vtkTriangle::TriangleArea(p[0], p[1], p[2]);
    largest = found > area ? corners->GetId(0) : largest;
    area = std::max(area, found);
  }
  AddPointArray(surface, "sources", 1,
    [&](vtkIdType i, int) { return i == largest || i % 17 == 3 ? 1 + i % 3 : 0; });
}

} // namespace FilterTest
