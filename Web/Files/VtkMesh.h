// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Files/Content.h"

namespace SurfaceDiffusion::Files
{

/// A surface as VTK has it: vertices and lines, which are left out, polygons and strips, whose
/// triangles are polygons with the data of their strip.
class VtkMesh
{
public:
  /// Cells that are no faces.
  void SkipCells(std::size_t count) { this->NumberOfCells += count; }
  void AddPolygon(const std::vector<std::int64_t>& corners)
  {
    this->Surface.AddCell(corners);
    this->Origins.push_back(this->NumberOfCells++);
  }
  void AddStrip(const std::vector<std::int64_t>& corners);
  /// A cell of a grid, of VTK's types. Throws FileError on those that are no faces.
  void AddCellOfType(int type, std::vector<std::int64_t> corners);
  /// Cell c has the corners from offsets[c] to offsets[c + 1] - 1. Throws FileError on others.
  template <typename Add>
  static void VisitCells(
    const std::vector<double>& offsets, const std::vector<double>& connectivity, const Add& add)
  {
    std::vector<std::int64_t> corners;
    for (std::size_t c = 0; c + 1 < offsets.size(); ++c)
    {
      const double first = offsets[c];
      const double last = offsets[c + 1];
      if (!(first >= 0.0 && first <= last && last <= static_cast<double>(connectivity.size())))
      {
        throw FileError("the offsets of cells do not ascend to " +
          std::to_string(connectivity.size()) + ", the number of their corners");
      }
      corners.clear();
      for (auto k = static_cast<std::size_t>(first); k < static_cast<std::size_t>(last); ++k)
      {
        corners.push_back(ToIndex(connectivity[k]));
      }
      add(corners);
    }
  }
  /// An array of the points or of all cells; after all cells. Throws FileError on another size.
  void AddArray(FileArray array);
  std::size_t CountCells() const { return this->NumberOfCells; }

  SurfaceFile Surface;

private:
  std::size_t NumberOfCells = 0;
  std::vector<std::size_t> Origins; ///< the cell that each polygon is from
};

} // namespace SurfaceDiffusion::Files
