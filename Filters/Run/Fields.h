// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Reduction.h"
#include "Core/Foundation/RobustRange.h"
#include "Core/Models/Model.h"
#include "Core/Statistics/MeasuredVertices.h"
#include "Run/Located.h"
#include "Run/PointSamples.h"
#include "Run/RunSettings.h"
#include "Run/Surface.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace SurfaceDiffusion
{

struct SourceShapes;

/// The input arrays of a run on one surface.
struct Fields
{
  /// f, one row per input point or cell and one column per component; no column if there are no
  /// data. NaN in any component of a row means that the point or cell is missing.
  Located<Values> Data;
  Word DataName = Word::Array("InputArray"); ///< for error messages
  /// Data may be a panel of the columns of the input, from FirstColumn of AllColumns on. Then NaN
  /// in columns outside of the panel is known by Missing: per point, nonzero: NaN in any column.
  Eigen::Index FirstColumn = 0;
  Eigen::Index AllColumns = 0; ///< 0: Data has all columns
  std::vector<char> Missing; ///< may be empty
  /// Per row of Data, nonzero: as if it were masked with MaskMode Inpaint; may be empty. See
  /// MarkWeightless().
  std::vector<char> Weightless;
  /// Per point or cell, nonzero: missing or excluded; may be empty. See MoveMarksToData().
  Located<std::vector<char>> Mask;
  Located<std::vector<char>> Fixed; ///< per point or cell, nonzero: Dirichlet; may be empty
  /// Per point or cell, 0 or more; empty: 1 everywhere.
  Located<std::vector<double>> FidelityFactors;
  /// e1, per point or, OnCells, per input triangle; no row if there are no directions. Finite or
  /// NaN.
  Located<SurfaceDiffusion::Points> Directions;
  /// Diffusion rates of a texture, per input triangle; no row if there are none.
  Values Rates;
  /// Makes numbers per point, for random numbers; empty: they are made from the coordinates.
  std::function<std::vector<std::int64_t>()> MakeIds;
  bool DataAreTerms = false; ///< Data are the data terms of a segmentation
  bool DataAreBytes = false; ///< unsigned char, which models of colours take for sRGB
  /// Per point or cell, the label 1, 2, ... that it keeps, or 0; may be empty.
  Located<std::vector<Index>> Seeds;
  /// In place of Data; null if there are none.
  std::shared_ptr<const PointSamples> Samples;
  std::shared_ptr<const std::vector<ProjectedSample>> Projected; ///< of ProjectSamples()
  /// Of distances. In place of Data; null if there are none.
  std::shared_ptr<const SourceShapes> Sources;
  /// Per point or cell; may be empty. Those along and across Directions are factors of Speeds.
  Located<std::vector<double>> Speeds, AlongSpeeds, AcrossSpeeds;
  std::vector<double> StartTimes; ///< per point; may be empty
  /// Standard errors of the slopes of Data, which are times: per point, a column per component, in the unit
  /// of the data per unit of the coordinates, NaN where unknown; no row if there are none.
  Values SlopeErrors;
  /// Points in space, from whose nearest places on the surface paths lead to the nearest source; null if
  /// there are none. Their segments do not count.
  std::shared_ptr<const SourceShapes> PathPoints;
  /// Of a surface whose edges were bisected. Per point, nonzero: its values were interpolated, and
  /// are no measurements. Per cell: the cell of the given surface that it was cut from. Both may be
  /// empty.
  std::vector<char> Between;
  std::vector<Index> GivenCells;
  /// The cell of each input triangle, below NumberOfCells, if one of the arrays is on cells.
  std::vector<Index> Cells;
  Index NumberOfCells = 0;

  /// Whether the value of a row is left out, unless it is fixed.
  bool IsLeftOut(Eigen::Index row, bool inpaint) const
  {
    return (inpaint && IsSet(this->Mask.Values, row)) || IsSet(this->Weightless, row);
  }

  bool HasDirectedSpeeds() const
  {
    return !this->AlongSpeeds.Values.empty() || !this->AcrossSpeeds.Values.empty();
  }
  bool HasSpeeds() const { return !this->Speeds.Values.empty() || this->HasDirectedSpeeds(); }

  bool HasCells() const
  {
    return this->Data.OnCells || this->Mask.OnCells || this->Fixed.OnCells ||
      this->FidelityFactors.OnCells || this->Seeds.OnCells || this->Speeds.OnCells ||
      this->AlongSpeeds.OnCells || this->AcrossSpeeds.OnCells;
  }
};

/// The extreme known values of each component, over several surfaces.
class ValueStatistics
{
public:
  /// Count the finite values at points or cells of participating triangles; those that are missing
  /// count for Magnitude() alone. inpaint: whether a mask means missing. Over the processes that
  /// have the surface together.
  void Add(const Surface& surface, const Fields& fields, bool inpaint, const Reduction& processes);
  void Merge(const ValueStatistics& other);

  /// R: the largest over the components of max - min, or of RobustRange() where that is at most a
  /// tenth; 1 if no value differs.
  double Range() const;
  /// The largest over the components of max - min; 0 if no value differs.
  double WholeRange() const;
  /// The same of BoundsOfMost() of each surface.
  double RobustRange() const;
  /// The largest magnitude.
  double Magnitude() const { return this->Largest; }

private:
  static void Widen(
    std::vector<ValueBounds>& bounds, std::size_t component, const ValueBounds& other);

  std::vector<ValueBounds> All, Robust; ///< per component
  double Largest = 0.0;
};

/// "`name` `found` at point `row`; `allowed`", or at the cell if the array is on cells.
InputError ErrorAt(const Sentence& name, const Sentence& found, bool onCells, Eigen::Index row,
  const Sentence& allowed);

/// Throws InputError on fidelity factors that are negative or not finite.
void CheckFidelityFactors(const Fields& fields);

/// The mean factor of each vertex over its participating points. Throws as CheckFidelityFactors().
Vector MakeFidelityFactors(const Surface& surface, const Fields& fields);

/// Whether a row of the data belongs to a participating triangle.
std::vector<char> FindParticipatingRows(const Surface& surface, const Fields& fields);

/// Given, Missing and Fixed of the vertices, of data on points, with values divided by `unit`.
/// Points that are merged into one vertex give it the mean of the known ones, and their mean
/// fidelity factor; those in between do not count beside given ones. Throws std::runtime_error on
/// infinite values, on points that are fixed at NaN, and on fidelity factors that are negative or
/// not finite.
PointData MakePointData(const Surface& surface, const Fields& fields, bool inpaint, double unit);

/// The vertices of given points, also for data on cells: those of merged points are, unless all of
/// them are in between. Null if all vertices are. Costs a pass over the surface.
std::shared_ptr<const MeasuredVertices> FindMeasured(const Surface& surface, const Fields& fields);

/// e1 on the triangles of surface.InputMesh(); no row if there are no directions.
TangentVectors MakeInputDirections(
  const Surface& surface, const Fields& fields, const ParallelFor& parallel);

/// The same on those of surface.Mesh().
TangentVectors MakeDirections(
  const Surface& surface, const Fields& fields, const ParallelFor& parallel);

/// The label that each vertex keeps, or 0; empty if there are no seeds. A vertex between cells of
/// different labels is free. Throws std::runtime_error if points of different labels are merged
/// into one vertex.
std::vector<Index> MakeSeeds(const Surface& surface, const Fields& fields);

/// A number per vertex that identifies it in random numbers. Without ids of points it is made from
/// the coordinates, rounded to NoiseGrid(h), so that moves by round-off keep it. h: the mean edge of
/// all surfaces together, so that blocks have the noise of parts of one surface; 0: the coordinates
/// are not rounded, as for runs that know their own surface only. Collective.
std::vector<std::int64_t> MakeVertexIds(
  const Surface& surface, const Fields& fields, double h = 0.0);

} // namespace SurfaceDiffusion
