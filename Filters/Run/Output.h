// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

/// What the rows of an output belong to.
enum class Place
{
  PerVertex, ///< of the model; written at the points, or at the cells if the result is on cells
  PerPoint, ///< of the input
  PerCell, ///< of the input
  /// Of Surface::InputMesh(); written at the cells, as the means of their triangles by area.
  MeansOfTriangles,
  PerTriangle, ///< of Surface::InputMesh(), tangent vectors up to their sign; written at the cells
  PerCurvePoint,
  PerCurve,
  Column, ///< of a table
  PerSample, ///< of the values at points in space; not written by the classes for VTK
  Number ///< nothing: a number of the run, or a matrix of numbers
};

/// The numeric type that an output is written in.
enum class OutputType
{
  Data, ///< that of the result of the data, with the components of the data, alpha included
  Real, ///< single precision if the result of the data is, double precision otherwise
  Double,
  Integer,
  Byte
};

/// The role of an output among the attributes of the surface.
enum class Role
{
  None,
  Scalars,
  Vectors, ///< or normals in place of normals, or scalars if they are no vectors in space
  Coordinates ///< the points of the surface themselves
};

/// How the numbers of several surfaces become one.
enum class Combination
{
  Reported, ///< that of Run::ReportedBlock()
  Sum,
  Largest,
  Smallest,
  Mean, ///< weighted by Output::Weight
  Common ///< that of all surfaces that have one other than 0; 0 if they differ
};

/// Polylines. Curve l has the points Corners[Begin[l]] to Corners[Begin[l + 1] - 1], which are rows
/// of Points; a closed curve ends where it starts.
struct Curves
{
  SurfaceDiffusion::Points Points;
  std::vector<Index> Begin = { 0 };
  std::vector<Index> Corners;

  Index NumberOfCurves() const { return static_cast<Index>(this->Begin.size()) - 1; }
};

/// One result of a run on one surface: what a model returns, under which name and where. The
/// classes for VTK and the functions for numpy write any list of outputs.
struct Output
{
  std::string Name = {};
  Place Where = Place::PerVertex;
  OutputType Type = OutputType::Real;
  Values Rows = {}; ///< in coordinate and array units, if there is a unit
  Role Active = Role::None;

  /// The name is that of the data followed by Name, or ResultArrayName if that is set. The names of
  /// other outputs begin with ResultArrayName.
  bool IsResult = false;
  bool IsBesideResult = false; ///< the name is that of the data, or ResultArrayName, and then Name
  std::string DataName = {}; ///< the name of the data, if they are samples

  /// The rows are those of the state, of NumberOfColumns columns from FirstColumn on. For Type Data
  /// they are its values in array units, with the detail of cells and the encoding of colours.
  bool IsState = false;
  Eigen::Index FirstColumn = 0;
  Eigen::Index NumberOfColumns = 0; ///< 0: all

  /// At points and cells that take no part: the component of the data that the first column takes,
  /// if the data are there; NaN where nothing determines floating-point data. -1: Elsewhere.
  int Given = -1;
  Values Elsewhere = {}; ///< one row; no row: 0
  bool MayBeInfinite = false; ///< infinity is a result, of real types, and no overflow

  std::shared_ptr<const Curves> Lines = {}; ///< of the output of Place PerCurve that has the curves

  Combination Over = Combination::Reported;
  double Weight = 1.0;

  /// The state as the result of the data. suffix: of its name.
  static Output OfState(std::string suffix)
  {
    Output output = OfData(std::move(suffix), Place::PerVertex, {});
    output.IsState = true;
    return output;
  }

  /// Another result of the data, in array units.
  static Output OfData(std::string suffix, Place where, Values rows)
  {
    Output output{ std::move(suffix), where, OutputType::Data, std::move(rows), Role::Scalars };
    output.IsResult = true;
    output.Given = 0;
    return output;
  }

  /// Columns of the state as they are; all of them for a count of 0.
  static Output OfColumns(std::string name, Eigen::Index first, Eigen::Index count)
  {
    Output output{ std::move(name) };
    output.IsState = true;
    output.FirstColumn = first;
    output.NumberOfColumns = count;
    return output;
  }

  static Output OfNumber(std::string name, double value, Combination over = Combination::Reported,
    OutputType type = OutputType::Double)
  {
    Output output{ std::move(name), Place::Number, type, Values::Constant(1, 1, value) };
    output.Over = over;
    return output;
  }

  static Output OfCurves(std::string name, Curves curves)
  {
    Output output{ std::move(name), Place::PerCurve, OutputType::Double };
    output.Lines = std::make_shared<const Curves>(std::move(curves));
    return output;
  }
};

/// The output of a name and place; null if there is none.
inline const Output* FindOutput(
  const std::vector<Output>& outputs, const std::string& name, Place where)
{
  for (const Output& output : outputs)
  {
    if (output.Name == name && output.Where == where)
    {
      return &output;
    }
  }
  return nullptr;
}

/// A number; 0 if there is none of this name.
inline double FindNumber(const std::vector<Output>& outputs, const std::string& name)
{
  const Output* const found = FindOutput(outputs, name, Place::Number);
  return found ? found->Rows(0, 0) : 0.0;
}

} // namespace SurfaceDiffusion
