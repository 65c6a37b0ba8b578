// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "AllFilters.h"

#include "KindsOfRun.h"
#include "Properties.h"

#include <map>

using namespace SurfaceDiffusion::Testing;

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
    SetByText(SettingsOf(filter), name, value); // of a new filter
  }
}

FilterKind MakeKind(const KindLine& line)
{
  FilterKind kind;
  kind.Name = line.Words.at(0);
  kind.Result = line.Words.at(2);
  kind.IsSlow = line.Words.size() > 3 && line.Words[3] == "slow";
  kind.Make = [className = line.Words[1], values = line.Values]
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
    for (const KindLine& line : ReadKindsOfRun(SURFACEDIFFUSION_KINDS_OF_RUN, false))
    {
      kinds.push_back(MakeKind(line));
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
