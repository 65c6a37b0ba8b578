// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/CellDetail.h"
#include "Core/Operators/CellTransfer.h"
#include "Run/Fields.h"
#include "Run/SolverStore.h"

#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// The cell of each row of surface.MakeTriangles().
std::vector<Index> CellsOfTriangles(const Surface& surface, const Fields& fields);

/// The transfer between the cells of fields.Cells and the vertices of the surface.
CellTransfer MakeCellTransfer(
  const Surface& surface, const Fields& fields, const ParallelFor& parallel);

/// Move marks to where the data are. With data on points, the points of a masked or fixed cell are
/// masked or fixed, and the fidelity factor of a point is the mean over its control cell. With data
/// on cells, a cell with a masked point is masked; marks of points that hold a vertex stay. Throws
/// std::runtime_error on fidelity factors that are negative or not finite. Collective.
void MoveMarksToData(
  const Surface& surface, Fields& fields, const Reduction& processes, const ParallelFor& parallel);

/// Mark the data whose fidelity factor is 0, or that of all corners of their cell: a minimum does not
/// depend on them, and no unit or estimate may.
void MarkWeightless(const Surface& surface, Fields& fields);

/// The data of a run that were given on cells.
struct CellState
{
  CellTransfer Transfer;
  ModelTraits Model; ///< that reads the data
  bool Inpaint = true; ///< a mask means missing
  double Unit = 1.0; ///< by which values are divided
  std::vector<char> Known = {}; ///< per cell
  bool HasUnknown = false; ///< among the cells that take part
  Values Start = {}; ///< u_0, the initial state at the vertices
  std::vector<Index> Seeds = {}; ///< per cell, as in Fields; empty if seeds are not on cells
  Values Factors = {}; ///< of the fidelity, per cell and column or of all in one; 0 where missing
  std::vector<char> Held = {}; ///< per cell: a fixed one, or one whose vertices are all fixed
  std::shared_ptr<const CellDetail> Detail = nullptr; ///< null if the result needs none
  std::vector<char> Undetermined = {}; ///< per cell, empty if none is; see there

  bool IsUndetermined(Index cell) const
  {
    return !this->Undetermined.empty() && this->Undetermined[static_cast<std::size_t>(cell)] != 0;
  }
};

/// The data at the vertices of data on cells. With w the fidelity factors and chi the indicator of
/// the known cells, the fidelity term lambda/2 sum over c and i of chi_c w_c m_ci (f_c - u_i)^2 of
/// triangles is, up to a constant, that of the vertices with
///
///     Given_i = sum over c of chi_c w_c m_ci f_c / sum over c of chi_c w_c m_ci,
///     FidelityFactors_i = sum over c of chi_c w_c m_ci / A_i.
///
/// Polygons have the equal shares of CellTransfer in the first line. Without fidelity, w = 1. A
/// vertex is missing if no cell around it is known. The vertices of a fixed cell are fixed to the
/// mean of the fixed cells around them. Lines are averaged as tensors u u^T. Writes cells.Known,
/// Factors and Held. Throws as MakePointData(). Collective.
PointData MakePointDataOfCells(
  const Surface& surface, const Fields& fields, CellState& cells, const Reduction& processes);

/// Multiply cells.Factors by those of the vertices of each cell; no entry: 1.
void ScaleFactors(const Values& ofVertices, CellState& cells);

/// Put the detail of the cells beside a model of their data, whose state is cells.Start. Returns a
/// model that does not diffuse as it is.
std::unique_ptr<Model> AddCellDetail(std::unique_ptr<Model> model, const Surface& surface,
  const Fields& fields, CellState& cells, double valueRange, SolverStore& solvers,
  const ParallelFor& parallel);

/// The result on the cells, in array units, one row per cell. With P* of CellTransfer and the
/// detail d = f - P* u_0 of CellDetail at the start, which diffuses too, it is
///
///     P* u + d = f + P*(u - u_0) + (d - d_0),
///     P* u if keepDetail is false,
///
/// with d_0 = 0 on missing cells, so that a model that changes nothing returns f with all its bits,
/// and totals are kept if the model keeps those of the vertices. Unit vectors are normalised, lines
/// are added as tensors.
/// given: f, one row per cell; cells that take no part keep it. state: u.
Values MakeCellResult(
  const CellState& cells, const Values& state, const Values& given, bool keepDetail);

/// The labels of cells, from the probabilities of the regions at the vertices: the seed of the
/// cell, otherwise the region of the largest mean probability; 0 at cells that take no part.
std::vector<Index> MakeCellLabels(const CellState& cells, const Values& probabilities);

} // namespace SurfaceDiffusion
