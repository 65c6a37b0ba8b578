// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/CellFields.h"

#include "Core/Models/Harmonic/UnitVectors.h"
#include "Run/Collective.h"
#include "Run/LineTensors.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// Call f(cell, vertex) for the corners of the participating triangles.
template <typename F>
void ForEachCorner(const Surface& surface, const Fields& fields, const F& f)
{
  const TriangleMesh& mesh = surface.InputMesh();
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const Index row = mesh.InputTriangle()[static_cast<std::size_t>(t)];
    const Index cell = fields.Cells[static_cast<std::size_t>(surface.InputTriangle(row))];
    for (int a = 0; a < 3; ++a)
    {
      f(cell, mesh.TriangleVertices()(t, a));
    }
  }
}

/// The vertices of marked cells, those of other processes included.
Flags MarkVertices(const Surface& surface, const Fields& fields, const std::vector<char>& ofCells)
{
  Vector marks = Vector::Zero(surface.InputMesh().NumberOfVertices());
  ForEachCorner(surface, fields,
    [&](Index cell, Index vertex) { marks[vertex] += IsSet(ofCells, cell) ? 1.0 : 0.0; });
  surface.InputMesh().GetReduction().Accumulate(marks);
  return marks.array() > 0.0;
}

/// Per point the value of its vertex; `elsewhere` at other points.
template <typename T, typename OfVertices>
std::vector<T> SpreadToPoints(const Surface& surface, const OfVertices& ofVertices, T elsewhere)
{
  std::vector<T> ofPoints(static_cast<std::size_t>(surface.Points().rows()), elsewhere);
  for (std::size_t i = 0; i < ofPoints.size(); ++i)
  {
    const Index v = surface.VertexOf(static_cast<Index>(i));
    if (v >= 0)
    {
      ofPoints[i] = static_cast<T>(ofVertices[v]);
    }
  }
  return ofPoints;
}

/// The cells with a marked point.
std::vector<char> MarkCells(
  const Surface& surface, const Fields& fields, const std::vector<char>& ofPoints)
{
  Vector ofVertices = Vector::Zero(surface.InputMesh().NumberOfVertices());
  for (std::size_t i = 0; i < ofPoints.size(); ++i)
  {
    const Index v = surface.VertexOf(static_cast<Index>(i));
    if (v >= 0 && ofPoints[i] != 0)
    {
      ofVertices[v] = 1.0;
    }
  }
  std::vector<char> marks(static_cast<std::size_t>(fields.NumberOfCells), 0);
  ForEachCorner(surface, fields,
    [&](Index cell, Index vertex)
    { marks[static_cast<std::size_t>(cell)] |= static_cast<char>(ofVertices[vertex] > 0.0); });
  return marks;
}

/// One factor per cell, 1 where none is given.
Vector ReadCellFactors(const Fields& fields)
{
  Vector factors = Vector::Ones(fields.NumberOfCells);
  if (fields.FidelityFactors.OnCells && !fields.FidelityFactors.Values.empty())
  {
    CheckFidelityFactors(fields);
    factors = Eigen::Map<const Vector>(fields.FidelityFactors.Values.data(), factors.size());
  }
  return factors;
}

/// The sums of weights of cells over the areas that they have in common with each control cell.
/// Divided by those of weights of 1, they are means within the bounds of the weights, unlike
/// VertexMeans::Of of polygons.
Vector SumsAround(const CellTransfer& transfer, const Vector& weights)
{
  return transfer.ToVertices(Values(weights.size(), 0), weights).Weights;
}

/// CellTransfer::ToVertices() of values or of lines.
VertexMeans Average(const CellState& cells, const Values& ofCells, const Vector& weights)
{
  if (!cells.Model.StateIsLines)
  {
    return cells.Transfer.ToVertices(ofCells, weights);
  }
  const VertexMeans tensors = cells.Transfer.ToVertices(AsTensors(ofCells), weights);
  VertexMeans means{ Values::Zero(tensors.Of.rows(), ofCells.cols()), tensors.Weights };
  for (Eigen::Index i = 0; i < means.Of.rows(); ++i)
  {
    if (means.Weights[i] > 0.0)
    {
      means.Of.row(i) = MainAxis(tensors.Of.row(i), ofCells.cols());
    }
  }
  return means;
}

/// The data as the model reads them, and per cell 1 or 0: known, and not known but finite.
struct CellData
{
  Values Of;
  Vector Known, Damaged;
  bool HasUnknown = false; ///< a cell that takes part
};

CellData ReadCells(const Surface& surface, const Fields& fields, const CellState& cells)
{
  CellData data{ fields.Data.Values / cells.Unit, Vector::Zero(fields.NumberOfCells),
    Vector::Zero(fields.NumberOfCells) };
  const std::vector<char> participates = FindParticipatingRows(surface, fields);
  for (Index c = 0; c < static_cast<Index>(fields.Data.Values.rows()); ++c)
  {
    if (!IsSet(participates, c))
    {
      continue;
    }
    if (fields.Data.Values.row(c).array().isInf().any())
    {
      throw ErrorAt(fields.DataName, "is infinite", true, c, "allowed: finite values and NaN");
    }
    const bool finite = !IsSet(fields.Missing, c) && !fields.Data.Values.row(c).hasNaN() &&
      (!cells.Model.StateIsUnitVectors || Normalize(data.Of.row(c)));
    const bool isFixed = fields.Fixed.OnCells && IsSet(fields.Fixed.Values, c);
    if (isFixed && !finite)
    {
      throw ErrorAt(fields.DataName,
        Sentence(cells.Model.StateIsUnitVectors ? "has no direction" : "is NaN")
          << " where " << Word::Array("FixedArray") << " holds it",
        true, c, "allowed there: finite values");
    }
    const bool known = finite && (isFixed || !fields.IsLeftOut(c, cells.Inpaint));
    data.HasUnknown = data.HasUnknown || !known;
    data.Known[c] = known ? 1.0 : 0.0;
    data.Damaged[c] = finite && !known ? 1.0 : 0.0;
  }
  return data;
}

/// Given and FidelityFactors of data with fidelity factors or missing cells.
void WeightFidelity(const Surface& surface, const Fields& fields, CellState& cells,
  const CellData& given, const Reduction& processes, PointData& data)
{
  Vector ofCells;
  Vector ofVertices = Vector::Ones(data.Missing.size());
  RunCollectively(processes,
    [&]
    {
      ofCells = ReadCellFactors(fields);
      if (!fields.FidelityFactors.OnCells && !fields.FidelityFactors.Values.empty())
      {
        ofVertices = MakeFidelityFactors(surface, fields);
      }
    });
  const Vector weights = given.Known.cwiseProduct(ofCells);
  const VertexMeans weighted = Average(cells, given.Of, weights);
  data.FidelityFactors =
    weighted.Weights.cwiseQuotient(SumsAround(cells.Transfer, Vector::Ones(weights.size())))
      .cwiseProduct(ofVertices);
  cells.Factors = weights.cwiseProduct(Vector(cells.Transfer.ToCells(ofVertices).col(0)));
  for (Eigen::Index v = 0; v < weighted.Of.rows(); ++v)
  {
    if (cells.Model.UsesFidelity && weighted.Weights[v] > 0.0)
    {
      data.Given.row(v) = weighted.Of.row(v);
    }
  }
}

/// Fix the vertices of fixed cells and of fixed points.
void FixVertices(const Surface& surface, const Fields& fields, const CellState& cells,
  const CellData& given, const VertexMeans& damaged, const Reduction& processes, PointData& data)
{
  if (processes.Any(fields.Fixed.OnCells))
  {
    Vector weights = Vector::Zero(fields.NumberOfCells);
    for (Index c = 0; c < fields.NumberOfCells; ++c)
    {
      weights[c] = IsSet(fields.Fixed.Values, c) ? given.Known[c] : 0.0;
    }
    const VertexMeans fixed = Average(cells, given.Of, weights);
    for (Eigen::Index v = 0; v < fixed.Of.rows(); ++v)
    {
      if (fixed.Weights[v] > 0.0)
      {
        data.Fixed[v] = true;
        data.Given.row(v) = fixed.Of.row(v);
      }
    }
    return;
  }
  const auto fix = [&](Index point)
  {
    const Index v = surface.VertexOf(point);
    if (v < 0 || !IsSet(fields.Fixed.Values, point))
    {
      return;
    }
    data.Fixed[v] = true;
    if (data.Missing[v] && !(damaged.Weights[v] > 0.0))
    {
      throw InputError(Sentence(fields.DataName)
        << " is NaN at all " << Word::Cells() << " around point " << point << " where "
        << Word::Array("FixedArray") << " holds it; allowed there: finite values");
    }
    data.Missing[v] = false;
  };
  RunCollectively(processes,
    [&]
    {
      for (std::size_t i = 0; i < fields.Fixed.Values.size(); ++i)
      {
        fix(static_cast<Index>(i));
      }
    });
}

/// The fixed cells, or with fixed points those whose vertices are all fixed.
std::vector<char> FindHeldCells(
  const Surface& surface, const Fields& fields, const Flags& fixed, const Reduction& processes)
{
  const auto count = static_cast<std::size_t>(fields.NumberOfCells);
  std::vector<char> held(count, 0);
  if (processes.Any(fields.Fixed.OnCells))
  {
    for (std::size_t c = 0; c < count; ++c)
    {
      held[c] = static_cast<char>(IsSet(fields.Fixed.Values, static_cast<Index>(c)));
    }
    return held;
  }
  ForEachCorner(
    surface, fields, [&](Index cell, Index) { held[static_cast<std::size_t>(cell)] = 1; });
  ForEachCorner(surface, fields,
    [&](Index cell, Index vertex)
    { held[static_cast<std::size_t>(cell)] &= static_cast<char>(fixed[vertex]); });
  return held;
}

} // namespace

std::vector<Index> CellsOfTriangles(const Surface& surface, const Fields& fields)
{
  std::vector<Index> cells(static_cast<std::size_t>(surface.NumberOfTriangles()));
  for (std::size_t row = 0; row < cells.size(); ++row)
  {
    cells[row] =
      fields.Cells[static_cast<std::size_t>(surface.InputTriangle(static_cast<Index>(row)))];
  }
  return cells;
}

CellTransfer MakeCellTransfer(
  const Surface& surface, const Fields& fields, const ParallelFor& parallel)
{
  return CellTransfer(
    surface.InputMesh(), CellsOfTriangles(surface, fields), fields.NumberOfCells, parallel);
}

void MoveMarksToData(
  const Surface& surface, Fields& fields, const Reduction& processes, const ParallelFor& parallel)
{
  if (processes.Any(fields.Data.OnCells))
  {
    if (!fields.Mask.Values.empty() && !fields.Mask.OnCells)
    {
      fields.Mask.Values = MarkCells(surface, fields, fields.Mask.Values);
    }
    fields.Mask.OnCells = true;
    return;
  }
  if (processes.Any(fields.Mask.OnCells))
  {
    fields.Mask.Values =
      SpreadToPoints<char>(surface, MarkVertices(surface, fields, fields.Mask.Values), 0);
  }
  if (processes.Any(fields.Fixed.OnCells))
  {
    fields.Fixed.Values =
      SpreadToPoints<char>(surface, MarkVertices(surface, fields, fields.Fixed.Values), 0);
  }
  if (processes.Any(fields.FidelityFactors.OnCells))
  {
    Vector factors;
    RunCollectively(processes, [&] { factors = ReadCellFactors(fields); });
    const CellTransfer transfer = MakeCellTransfer(surface, fields, parallel);
    const Vector areas = SumsAround(transfer, Vector::Ones(factors.size()));
    fields.FidelityFactors.Values = SpreadToPoints<double>(
      surface, Vector(SumsAround(transfer, factors).cwiseQuotient(areas)), 1.0);
  }
  fields.Mask.OnCells = fields.Fixed.OnCells = fields.FidelityFactors.OnCells = false;
}

void MarkWeightless(const Surface& surface, Fields& fields)
{
  std::vector<char> hasWeight;
  for (const double factor : fields.FidelityFactors.Values)
  {
    hasWeight.push_back(static_cast<char>(factor != 0.0));
  }
  if (fields.Data.OnCells && !fields.FidelityFactors.OnCells && !hasWeight.empty())
  {
    hasWeight = MarkCells(surface, fields, hasWeight);
  }
  for (char& flag : hasWeight)
  {
    flag = static_cast<char>(flag == 0);
  }
  fields.Weightless = std::move(hasWeight);
}

PointData MakePointDataOfCells(
  const Surface& surface, const Fields& fields, CellState& cells, const Reduction& processes)
{
  CellData given;
  RunCollectively(processes, [&] { given = ReadCells(surface, fields, cells); });
  double components = static_cast<double>(given.Of.cols());
  surface.InputMesh().GetReduction().Max(&components, 1);
  given.Of.conservativeResize(given.Of.rows(), static_cast<Eigen::Index>(components));

  const VertexMeans known = Average(cells, given.Of, given.Known);
  const VertexMeans damaged = Average(cells, given.Of, given.Damaged);
  PointData data;
  data.Given = known.Of;
  data.Missing = known.Weights.array() <= 0.0;
  data.Fixed = Flags::Constant(data.Missing.size(), false);
  for (Eigen::Index v = 0; v < data.Missing.size(); ++v)
  {
    if (data.Missing[v])
    {
      data.Given.row(v) = damaged.Of.row(v);
    }
  }
  cells.Factors = given.Known;
  const bool hasUnknown = cells.Model.UsesFidelity && given.HasUnknown;
  if (processes.Any(hasUnknown || !fields.FidelityFactors.Values.empty()))
  {
    WeightFidelity(surface, fields, cells, given, processes, data);
  }
  FixVertices(surface, fields, cells, given, damaged, processes, data);
  cells.Held = FindHeldCells(surface, fields, data.Fixed, processes);
  cells.HasUnknown = given.HasUnknown;
  cells.Known.assign(static_cast<std::size_t>(fields.NumberOfCells), 0);
  for (std::size_t c = 0; c < cells.Known.size(); ++c)
  {
    cells.Known[c] = given.Known[static_cast<Index>(c)] > 0.0;
    cells.Held[c] |= static_cast<char>(cells.Model.HoldsKnownValues && cells.Known[c] != 0);
  }
  return data;
}

} // namespace SurfaceDiffusion
