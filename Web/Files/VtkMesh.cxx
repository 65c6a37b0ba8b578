// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Files/VtkMesh.h"

#include <algorithm>
#include <utility>

namespace SurfaceDiffusion::Files
{

void VtkMesh::AddStrip(const std::vector<std::int64_t>& corners)
{
  for (std::size_t k = 0; k + 2 < corners.size(); ++k)
  {
    this->Surface.AddCell({ corners[k + k % 2], corners[k + 1 - k % 2], corners[k + 2] });
    this->Origins.push_back(this->NumberOfCells);
  }
  ++this->NumberOfCells;
}

void VtkMesh::AddCellOfType(int type, std::vector<std::int64_t> corners)
{
  constexpr int strip = 6;
  constexpr int pixel = 8;
  if (type == pixel && corners.size() == 4)
  {
    std::swap(corners[2], corners[3]);
  }
  if (type == 5 || type == 7 || type == pixel || type == 9)
  {
    this->AddPolygon(corners);
  }
  else if (type == strip)
  {
    this->AddStrip(corners);
  }
  else if ((type >= 0 && type <= 4) || type == 21) // points and lines
  {
    this->SkipCells(1);
  }
  else
  {
    throw FileError("cells of VTK's type " + std::to_string(type) +
      "; allowed: triangles (5), polygons (7), pixels (8) and quadrilaterals (9)");
  }
}

void VtkMesh::AddArray(FileArray array)
{
  const std::size_t rows = array.OnCells ? this->NumberOfCells : this->Surface.NumberOfPoints();
  if (array.Components == 0 || array.Numbers.size() != rows * array.Components)
  {
    throw FileError("the array " + Quote(array.Name) + " has " +
      std::to_string(array.Numbers.size()) +
      " numbers; allowed: " + std::to_string(array.Components) + " for each of " +
      std::to_string(rows) + (array.OnCells ? " cells" : " points"));
  }
  if (array.OnCells)
  {
    const std::vector<double> all = std::move(array.Numbers);
    array.Numbers.clear();
    for (const std::size_t origin : this->Origins)
    {
      const auto first = all.begin() + static_cast<std::ptrdiff_t>(origin * array.Components);
      array.Numbers.insert(
        array.Numbers.end(), first, first + static_cast<std::ptrdiff_t>(array.Components));
    }
  }
  if (!array.Numbers.empty())
  {
    this->Surface.Arrays.push_back(std::move(array));
  }
}

} // namespace SurfaceDiffusion::Files
