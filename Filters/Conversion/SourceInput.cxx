// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Conversion/SourceInput.h"

#include "Conversion/PointInput.h"
#include "Distributed/CellFlags.h"
#include "Distributed/Processes.h"
#include "Run/InputSentences.h"

#include "vtkCellType.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointSet.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <string>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

/// The ends of the straight parts of lines, one after the other. hidden: of the points; those of
/// hidden lines are added.
std::vector<int> ReadSegments(vtkPointSet* points, std::vector<char>& hidden)
{
  std::vector<int> ends;
  vtkUnsignedCharArray* const flags = points->GetCellGhostArray();
  const bool hasFlags = flags && flags->GetNumberOfTuples() == points->GetNumberOfCells();
  const std::vector<char> hiddenPoints = hidden;
  vtkNew<vtkIdList> corners;
  for (vtkIdType c = 0; c < points->GetNumberOfCells(); ++c)
  {
    const int type = points->GetCellType(c);
    if (type != VTK_LINE && type != VTK_POLY_LINE)
    {
      continue;
    }
    points->GetCellPoints(c, corners);
    const bool isHidden =
      (hasFlags && (flags->GetValue(c) & vtkDataSetAttributes::HIDDENCELL) != 0) ||
      std::any_of(corners->begin(), corners->end(),
        [&](vtkIdType point) { return hiddenPoints[static_cast<std::size_t>(point)] != 0; });
    if (isHidden)
    {
      for (const vtkIdType point : *corners)
      {
        hidden[static_cast<std::size_t>(point)] = 1;
      }
      continue;
    }
    for (vtkIdType k = 1; k < corners->GetNumberOfIds(); ++k)
    {
      ends.push_back(static_cast<int>(corners->GetId(k - 1)));
      ends.push_back(static_cast<int>(corners->GetId(k)));
    }
  }
  for (const int end : ends) // also of a hidden line
  {
    hidden[static_cast<std::size_t>(end)] = 0;
  }
  return ends;
}

} // namespace

std::shared_ptr<const SourceShapes> ReadSources(
  vtkDataObject* data, const char* name, vtkMultiProcessController* controller, Problems& problems)
{
  const Processes processes(controller);
  vtkPointSet* const points = vtkPointSet::SafeDownCast(data);
  if (processes.Any(!points))
  {
    problems.push_back(Say("NoPointSet", std::string(name) + ", is", data->GetClassName()));
    return nullptr;
  }
  auto sources = std::make_shared<SourceShapes>();
  sources->Places = ReadPlaces(points);
  sources->Hidden = FindHiddenPoints(points);
  sources->Hidden.resize(static_cast<std::size_t>(points->GetNumberOfPoints()), 0);
  std::vector<int> ends = ReadSegments(points, sources->Hidden);
  if (processes.Count() > 1)
  {
    const Points& here = sources->Places;
    const std::vector<int> counts = processes.GatherAll({ static_cast<int>(here.rows()) });
    int first = 0;
    for (int rank = 0; rank < processes.Rank(); ++rank)
    {
      first += counts[static_cast<std::size_t>(rank)];
    }
    for (int& end : ends)
    {
      end += first;
    }
    const std::vector<double> places =
      processes.GatherAll(std::vector<double>(here.data(), here.data() + here.size()));
    sources->Places =
      Eigen::Map<const Points>(places.data(), static_cast<Eigen::Index>(places.size() / 3), 3);
    ends = processes.GatherAll(ends);
    sources->Hidden = processes.GatherAll(sources->Hidden);
  }
  const std::vector<char>& hidden = sources->Hidden;
  if (std::count(hidden.begin(), hidden.end(), 0) == 0)
  {
    problems.push_back(
      Say(hidden.empty() ? "NoPoints" : "HiddenPoints", name, hidden.size(), " points or lines"));
    return nullptr;
  }
  for (std::size_t k = 0; k + 1 < ends.size(); k += 2)
  {
    sources->Segments.push_back({ ends[k], ends[k + 1] });
  }
  return sources;
}

void AddSources(Fingerprint& fingerprint, const SourceShapes& sources)
{
  const auto places = static_cast<std::size_t>(sources.Places.size());
  fingerprint.AddNumber(std::uint64_t{ places });
  fingerprint.AddBytes(sources.Places.data(), places * sizeof(double));
  fingerprint.AddNumber(std::uint64_t{ sources.Segments.size() });
  fingerprint.AddBytes(
    sources.Segments.data(), sources.Segments.size() * sizeof(sources.Segments[0]));
  fingerprint.AddBytes(sources.Hidden.data(), sources.Hidden.size());
}

} // namespace SurfaceDiffusion
