// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/CellFields.h"

#include "Core/Models/Harmonic/UnitVectors.h"
#include "Core/Models/ModelWithCellDetail.h"
#include "Run/LineTensors.h"

#include <algorithm>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// The result of a line: the main axis of its tensor plus the change, with the sign of the line.
Eigen::RowVectorXd AddToLine(
  const Eigen::RowVectorXd& line, const Eigen::RowVectorXd& change, bool isKnown)
{
  const Eigen::Index m = line.size();
  if (isKnown && change.isZero(0.0))
  {
    return line;
  }
  Eigen::RowVectorXd tensor = change;
  if (isKnown)
  {
    tensor += AsTensors(line).row(0);
  }
  const Eigen::RowVectorXd axis = MainAxis(tensor, m);
  return line.hasNaN() || axis.dot(line) >= 0.0 ? axis : Eigen::RowVectorXd(-axis);
}

/// The distance in L1 is rounded below this part of the range of the values.
constexpr double L1Rounding = 1e-3;

/// d_0.
Values FirstDetail(const Fields& fields, const CellState& cells)
{
  Values detail =
    -cells.Transfer.ToCells(cells.Model.StateIsLines ? AsTensors(cells.Start) : cells.Start);
  for (Index c = 0; c < cells.Transfer.NumberOfCells(); ++c)
  {
    if (cells.Known[static_cast<std::size_t>(c)] == 0)
    {
      detail.row(c).setZero();
      continue;
    }
    Values given = fields.Data.Values.row(c) / cells.Unit;
    if (cells.Model.StateIsUnitVectors)
    {
      Normalize(given.row(0));
    }
    detail.row(c) += cells.Model.StateIsLines ? AsTensors(given).row(0) : given.row(0);
  }
  return detail;
}

} // namespace

void ScaleFactors(const Values& ofVertices, CellState& cells)
{
  if (ofVertices.size() > 0)
  {
    const Values ofCells = cells.Transfer.ToCells(ofVertices); // 0 where cells take no part
    cells.Factors = (cells.Factors.col(0).asDiagonal() * ofCells).eval();
  }
}

std::unique_ptr<Model> AddCellDetail(std::unique_ptr<Model> model, const Surface& surface,
  const Fields& fields, CellState& cells, double valueRange, SolverStore& solvers,
  const ParallelFor& parallel)
{
  if (!(model->Diffusion().TimeStep > 0.0))
  {
    return model;
  }
  auto fluxes = std::make_unique<CellFluxes>(surface.InputMesh(), surface.Points(),
    CellsOfTriangles(surface, fields), fields.NumberOfCells, parallel);
  CellDetail::Data data{ FirstDetail(fields, cells), cells.Factors, cells.Held,
    L1Rounding * valueRange, !cells.Model.StateIsUnitVectors };
  SolverTask task;
  task.NumberOfVertices = fields.NumberOfCells;
  task.NumberOfColumns = static_cast<int>(std::max(fields.AllColumns, data.Start.cols()));
  const auto findSolver = [&solvers, task, overProcesses = fluxes->GetReduction()](
                            double diffusionNumber, bool isConstant) mutable
  {
    if (!overProcesses->IsSerial())
    {
      return solvers.Make(overProcesses);
    }
    task.DiffusionNumber = diffusionNumber;
    if (diffusionNumber == InfiniteTime)
    {
      task.DiffusionNumber.reset();
    }
    task.AllowMultigrid = isConstant;
    return solvers.Find(SolverPurpose::Detail, task, isConstant ? 1.0 : 0.0);
  };
  auto detail = std::make_shared<CellDetail>(surface.InputMesh(), surface.Mesh(), cells.Transfer,
    std::move(fluxes), cells.Start, std::move(data), findSolver, parallel);
  cells.Detail = detail;
  return std::make_unique<ModelWithCellDetail>(std::move(model), std::move(detail));
}

Values MakeCellResult(
  const CellState& cells, const Values& state, const Values& given, bool keepDetail)
{
  const bool lines = cells.Model.StateIsLines;
  const auto toCells = [&](const Values& u)
  { return cells.Transfer.ToCells(lines ? AsTensors(u) : u); };
  Values all = toCells(state);
  Values changes;
  if (keepDetail)
  {
    changes = lines ? cells.Transfer.ToCells(AsTensors(state) - AsTensors(cells.Start))
                    : cells.Transfer.ToCells(state - cells.Start);
  }
  Values result = given;
  for (Index c = 0; c < cells.Transfer.NumberOfCells(); ++c)
  {
    if (!cells.Transfer.Participates(c))
    {
      continue;
    }
    const bool adds = keepDetail && cells.Known[static_cast<std::size_t>(c)] != 0;
    Eigen::RowVectorXd change = adds ? changes.row(c) : all.row(c);
    if (keepDetail && cells.Detail)
    {
      change += cells.Detail->Change(c);
    }
    if (cells.Model.StateIsUnitVectors)
    {
      Eigen::RowVectorXd vector = given.row(c);
      Normalize(vector);
      result.row(c) = lines ? AddToLine(vector, change, adds)
                            : Eigen::RowVectorXd(adds ? vector + change : change);
      Normalize(result.row(c));
      continue;
    }
    for (Eigen::Index k = 0; k < result.cols(); ++k)
    {
      const double added = change[k] * cells.Unit;
      result(c, k) = adds ? (added == 0.0 ? given(c, k) : given(c, k) + added) : added;
    }
  }
  return result;
}

std::vector<Index> MakeCellLabels(const CellState& cells, const Values& probabilities)
{
  const Values ofCells = cells.Transfer.ToCells(probabilities);
  std::vector<Index> labels(static_cast<std::size_t>(ofCells.rows()), 0);
  for (Index c = 0; c < cells.Transfer.NumberOfCells(); ++c)
  {
    if (!cells.Transfer.Participates(c))
    {
      continue;
    }
    Eigen::Index largest = 0;
    ofCells.row(c).maxCoeff(&largest);
    const Index seed = cells.Seeds.empty() ? 0 : cells.Seeds[static_cast<std::size_t>(c)];
    labels[static_cast<std::size_t>(c)] = seed > 0 ? seed : static_cast<Index>(largest) + 1;
  }
  return labels;
}

} // namespace SurfaceDiffusion
