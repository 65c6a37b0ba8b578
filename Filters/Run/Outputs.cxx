// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/Outputs.h"

#include "Run/CellDirections.h"

#include <set>

namespace SurfaceDiffusion
{

namespace
{

/// The lengths of the data's vectors, per vertex or per cell.
Vector FindBrightness(const OutputSource& source, bool ofCells)
{
  Fields colors;
  colors.Data.Values = source.ReadData();
  const CellState* const cells = source.Block->Cells.get();
  if (!cells)
  {
    return MakePointData(source.Surface, colors, false, 1.0).Given.rowwise().norm();
  }
  const Vector lengths = colors.Data.Values.rowwise().norm();
  return ofCells ? lengths
                 : Vector(cells->Transfer.ToVertices(lengths, Vector::Ones(lengths.size())).Of);
}

/// The means of rows per triangle of the mesh over the cells, weighted by area. Cells without
/// triangles have `elsewhere`, one row, or 0 if it has none.
Values MeansOfCells(const Values& ofTriangles, const Values& elsewhere, const OutputSource& source)
{
  const TriangleMesh& mesh = source.Surface.InputMesh();
  Values means = Values::Zero(static_cast<Eigen::Index>(source.NumberOfCells), ofTriangles.cols());
  Vector areas = Vector::Zero(means.rows());
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const auto cell = static_cast<Eigen::Index>(
      source.CellOf(source.Surface.InputTriangle(mesh.InputTriangle()[t])));
    const double area = mesh.Shapes()[t].Area();
    means.row(cell) += area * ofTriangles.row(t);
    areas[cell] += area;
  }
  for (Eigen::Index cell = 0; cell < means.rows(); ++cell)
  {
    if (areas[cell] > 0.0)
    {
      means.row(cell) /= areas[cell];
    }
    else if (elsewhere.rows() > 0)
    {
      means.row(cell) = elsewhere;
    }
  }
  return means;
}

} // namespace

bool IsOnCells(const Output& output, const Run::Block* block, const ModelTraits& traits)
{
  return output.Where == Place::PerCell || output.Where == Place::MeansOfTriangles ||
    output.Where == Place::PerTriangle ||
    (output.Where == Place::PerVertex && block && block->Cells && traits.ResultOnCells);
}

Eigen::Index CountColumns(const Output& output, const Run::Block* block)
{
  if (output.Where == Place::PerTriangle || output.Lines)
  {
    return 3;
  }
  if (!output.IsState)
  {
    return output.Rows.cols();
  }
  const Eigen::Index ofState = block->Path->State().cols();
  const bool areAngles = output.Type == OutputType::Data && block->Period > 0.0;
  return output.NumberOfColumns > 0 ? output.NumberOfColumns : areAngles ? ofState / 2 : ofState;
}

OutputRows::OutputRows(const Output& output, const OutputSource& source)
  : Shared(&output.Rows)
  , Domain(&source.Surface)
  , Elsewhere(&output.Elsewhere)
  , MayBeInfinite(output.MayBeInfinite)
{
  const CellState* const cells = source.Block ? source.Block->Cells.get() : nullptr;
  this->IsOnCells = SurfaceDiffusion::IsOnCells(output, source.Block, source.Traits);
  if (output.Where == Place::PerTriangle)
  {
    this->Own = DirectionsOfCells(
      source.Surface, output.Rows, source.NumberOfCells, source.CellOf, source.Parallel);
    this->Shared = nullptr;
  }
  else if (output.Where == Place::MeansOfTriangles)
  {
    this->Own = MeansOfCells(output.Rows, output.Elsewhere, source);
    this->Shared = nullptr;
  }
  else if (this->IsOnCells)
  {
    this->Cells = cells;
    this->MoveToCells(output, source);
  }
  else if (output.Where == Place::PerVertex)
  {
    this->Vertices = &source.Surface;
    this->TakeState(output, source);
  }
  this->NumberOfRows =
    static_cast<Index>(this->Vertices ? source.Surface.Points().rows() : this->From().rows());
  this->NumberOfColumns = CountColumns(output, source.Block);
  if (output.Given >= 0 && source.ReadData)
  {
    this->GivenColumn = this->IsOnCells == (cells != nullptr) ? output.Given : -1;
    this->HoldsNaN = source.DataAreFloats;
    this->MissingValues = source.Traits.MissingValues;
  }
}

/// Rows of cells from those of vertices.
void OutputRows::MoveToCells(const Output& output, const OutputSource& source)
{
  if (output.Where == Place::PerCell)
  {
    return;
  }
  const CellTransfer& transfer = this->Cells->Transfer;
  this->Shared = nullptr;
  if (!output.IsState)
  {
    this->Own = transfer.ToCells(output.Rows);
  }
  else if (output.Type != OutputType::Data)
  {
    this->Own = transfer.ToCells(source.Block->Path->State());
    this->FirstColumn = output.FirstColumn;
  }
  else
  {
    const Values given = source.ReadData();
    this->Own = source.Block->CellResult(given, source.Traits.KeepCellDetail, source.Parallel);
    if (source.Traits.StateIsUnitVectors && source.AsBytes)
    {
      this->Own.array().colwise() *= FindBrightness(source, true).array();
    }
  }
}

/// Rows of vertices.
void OutputRows::TakeState(const Output& output, const OutputSource& source)
{
  if (!output.IsState)
  {
    return;
  }
  const Run::Block& block = *source.Block;
  this->Shared = &block.Path->State();
  this->FirstColumn = output.FirstColumn;
  if (output.Type != OutputType::Data)
  {
    return;
  }
  this->Unit = block.Units.ValueUnit;
  if (block.IsCoded())
  {
    this->Own = block.DecodedState(source.Parallel);
    this->Shared = nullptr;
    this->Unit = 1.0;
  }
  else if (source.Traits.StateIsUnitVectors && source.AsBytes)
  {
    this->Own = block.Path->State();
    this->Own.array().colwise() *= FindBrightness(source, false).array();
    this->Shared = nullptr;
  }
}

std::map<std::string, Values> CombineNumbers(
  const std::vector<const OutputList*>& surfaces, std::size_t reported)
{
  std::map<std::string, Values> numbers;
  std::map<std::string, double> weights;
  std::set<std::string> different; ///< of the numbers that should be common
  for (std::size_t s = 0; s < surfaces.size(); ++s)
  {
    for (const Output& output : *surfaces[s])
    {
      if (output.Where != Place::Number)
      {
        continue;
      }
      double& weight = weights[output.Name];
      weight += output.Weight;
      const auto [place, isFirst] = numbers.insert({ output.Name, output.Rows });
      Values& number = place->second;
      if (isFirst || (output.Over == Combination::Reported && s == reported))
      {
        number = output.Rows;
        continue;
      }
      switch (output.Over)
      {
        case Combination::Sum:
          number += output.Rows;
          break;
        case Combination::Largest:
          number = number.cwiseMax(output.Rows);
          break;
        case Combination::Smallest:
          number = number.cwiseMin(output.Rows);
          break;
        case Combination::Mean:
          number += weight > 0.0 ? Values((output.Rows - number) * (output.Weight / weight))
                                 : Values(Values::Zero(number.rows(), number.cols()));
          break;
        case Combination::Common:
          if (number.isZero(0.0))
          {
            number = output.Rows;
          }
          else if (!output.Rows.isZero(0.0) && number != output.Rows)
          {
            different.insert(output.Name);
          }
          break;
        case Combination::Reported:
          break;
      }
    }
  }
  for (const std::string& name : different)
  {
    numbers[name].setZero();
  }
  return numbers;
}

std::map<std::string, Values> FindNumbers(const Run& run)
{
  std::vector<const OutputList*> surfaces;
  std::size_t reported = 0;
  for (std::size_t b = 0; b < run.NumberOfBlocks(); ++b)
  {
    surfaces.push_back(&run.GetBlock(b).Outputs);
    reported = &run.GetBlock(b) == &run.ReportedBlock() ? b : reported;
  }
  std::map<std::string, Values> numbers = CombineNumbers(surfaces, reported);
  for (const auto& [name, number] : { std::pair{ "TimeUnit", run.TimeUnit() },
         std::pair{ "MeanEdgeLength", run.Units().MeanEdgeLength },
         std::pair{ "ValueRange", run.Units().ValueRange } })
  {
    numbers[name] = Values::Constant(1, 1, number);
  }
  return numbers;
}

std::map<std::string, Values> FindNumbers(
  const Run& run, const History& history, const Reduction& processes)
{
  std::map<std::string, Values> numbers = FindNumbers(run);
  for (const auto& [name, number] :
    { std::pair{ "NumberOfIterations", static_cast<double>(history.NumberOfIterations()) },
      std::pair{ "Residual", history.LargestResidual() },
      std::pair{ "NumberOfUnusedPoints", static_cast<double>(run.CountUnusedPoints(processes)) },
      std::pair{ "NumberOfStepsComputed", static_cast<double>(run.NumberOfStepsComputed()) } })
  {
    numbers[name] = Values::Constant(1, 1, number);
  }
  return numbers;
}

} // namespace SurfaceDiffusion
