// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "RunInput.h"

#include "Run/CellFields.h"

#include <cstddef>
#include <functional>
#include <memory>
#include <numeric>
#include <vector>

namespace SurfaceDiffusion::Testing
{

/// One surface with data on its cells.
struct CellInput : RunInput
{
  /// cells: the cell of each triangle; empty: triangles are cells.
  explicit CellInput(const Surface& surface, std::vector<Index> cells = {})
    : RunInput(surface)
  {
    if (cells.empty())
    {
      cells.resize(static_cast<std::size_t>(surface.NumberOfTriangles()));
      std::iota(cells.begin(), cells.end(), 0);
    }
    this->Data.Data.OnCells = true;
    this->Data.NumberOfCells = cells.back() + 1;
    this->Data.Cells = std::move(cells);
    this->SetData(
      [](Index c, const Eigen::RowVector3d& x) { return x[2] + 0.1 * std::cos(7.0 * c); });
  }

  /// f(cell, mean of the corners of its triangles)
  void SetData(const std::function<double(Index, const Eigen::RowVector3d&)>& f)
  {
    this->Data.Data.Values.resize(this->Data.NumberOfCells, 1);
    const Points centres = this->Centres();
    for (Index c = 0; c < this->Data.NumberOfCells; ++c)
    {
      this->Data.Data.Values(c, 0) = f(c, centres.row(c));
    }
  }

  Points Centres() const
  {
    Points sums = Points::Zero(this->Data.NumberOfCells, 3);
    Vector counts = Vector::Zero(this->Data.NumberOfCells);
    for (Eigen::Index t = 0; t < this->Faces.rows(); ++t)
    {
      const Index cell = this->Data.Cells[static_cast<std::size_t>(t)];
      for (const Index corner : this->Faces.row(t))
      {
        sums.row(cell) += this->Vertices.row(corner);
        counts[cell] += 1.0;
      }
    }
    return counts.cwiseInverse().asDiagonal() * sums;
  }
};

/// The result on the cells at the last step.
template <typename ModelSettings>
Values CellResultOf(SurfaceDiffusion::Run& run, const CellInput& input,
  const ModelSettings& settings, bool keepDetail = true)
{
  const Values state = StateOf(run, { input.Block() }, settings);
  return MakeCellResult(*run.GetBlock(0).Cells, state, input.Data.Data.Values, keepDetail);
}

template <typename ModelSettings>
Values CellResultOf(const CellInput& input, const ModelSettings& settings, bool keepDetail = true)
{
  SurfaceDiffusion::Run run(SerialFor());
  return CellResultOf(run, input, settings, keepDetail);
}

/// The standard deviation of the rows, weighted by areas.
inline double Deviation(const Vector& areas, const Values& f)
{
  const double mean = areas.dot(f.col(0)) / areas.sum();
  return std::sqrt(areas.dot((f.col(0).array() - mean).square().matrix()) / areas.sum());
}

/// The cells of quads that are cut into two triangles that follow one another.
inline std::vector<Index> CellsOfQuads(const Surface& surface)
{
  std::vector<Index> cells(static_cast<std::size_t>(surface.NumberOfTriangles()));
  for (std::size_t t = 0; t < cells.size(); ++t)
  {
    cells[t] = static_cast<Index>(t / 2);
  }
  return cells;
}

} // namespace SurfaceDiffusion::Testing
