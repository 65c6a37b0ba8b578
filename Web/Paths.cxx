// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The shortest paths of distances, as a file of lines and for the page.
#include "Engine.h"

#include "Json.h"

namespace SurfaceDiffusion
{

Files::SurfaceFile PathsOf(const Solution& solution)
{
  Files::SurfaceFile file;
  file.AreLines = true;
  const auto found = solution.Curves.find("Paths");
  if (found == solution.Curves.end())
  {
    return file;
  }
  const Curves& curves = *found->second;
  file.Points.assign(curves.Points.data(), curves.Points.data() + curves.Points.size());
  file.Corners.assign(curves.Corners.begin(), curves.Corners.end());
  file.Begin.assign(curves.Begin.begin(), curves.Begin.end());
  for (const char* const name : { "Length", "PathPoint", "NearestSource" })
  {
    const Values& column = solution.Columns.at(name);
    Files::FileArray array{ name, true };
    array.Numbers.assign(column.data(), column.data() + column.size());
    file.Arrays.push_back(std::move(array));
  }
  return file;
}

std::string PathsAsJson(const Files::SurfaceFile& paths)
{
  std::string list;
  for (std::size_t k = 0; k < paths.NumberOfCells(); ++k)
  {
    std::vector<double> points;
    for (std::size_t c = paths.Begin[k]; c < paths.Begin[k + 1]; ++c)
    {
      const auto first = paths.Points.begin() + static_cast<std::ptrdiff_t>(3 * paths.Corners[c]);
      points.insert(points.end(), first, first + 3);
    }
    list += (k > 0 ? ",{\"length\":" : "{\"length\":") + Json::Number(paths.Arrays[0].Numbers[k]) +
      ",\"start\":" + Json::Number(paths.Arrays[1].Numbers[k]) +
      ",\"points\":" + Json::List(points) + "}";
  }
  return "[" + list + "]";
}

} // namespace SurfaceDiffusion
