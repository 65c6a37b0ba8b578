// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/CellFields.h"

#include "Core/Models/UnitVectors.h"
#include "Run/LineTensors.h"

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

} // namespace

Values MakeCellResult(
  const CellState& cells, const Values& state, const Values& given, bool keepDetail)
{
  const CellReading& reading = cells.Reading;
  const bool lines = reading.Lines;
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
    const Eigen::RowVectorXd change = adds ? changes.row(c) : all.row(c);
    if (reading.UnitVectors)
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
      const double added = change[k] * reading.Unit;
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
