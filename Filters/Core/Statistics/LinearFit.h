// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"
#include "Core/Operators/Assembler.h"
#include "Core/Operators/Rings.h"
#include "Core/Statistics/MeasuredVertices.h"
#include "Core/Surface/PointData.h"

#include <vector>

namespace SurfaceDiffusion
{

/// The data of a range of vertices: whole connected components. InputPoints has rows as in
/// TriangleMesh::InputVertex.
struct FitData
{
  /// Values between those that were measured are missing, and those of weight 0, which may be
  /// anything. pattern: that of the assembler; it must outlive this.
  FitData(const Assembler& assembler, const SparsePattern& pattern,
    const Eigen::Ref<const Points>& points, const PointData& data, VertexRange range)
    : Operators(assembler)
    , InputPoints(points)
    , Given(data.Given)
    , Range(range)
    , Neighbours(data.Measured ? data.Measured->Neighbours : pattern)
    , Missing(data.Missing.segment(range.Begin, range.Size()))
  {
    if (data.FidelityFactors.size() > 0)
    {
      this->Missing =
        this->Missing || data.FidelityFactors.segment(range.Begin, range.Size()).array() == 0.0;
    }
    if (data.Measured)
    {
      this->IsBetween = &data.Measured->IsBetween;
      this->Missing = this->Missing || this->IsBetween->segment(range.Begin, range.Size());
    }
  }

  const Assembler& Operators;
  const Eigen::Ref<const Points>& InputPoints;
  const Values& Given;
  const VertexRange Range;
  const SparsePattern& Neighbours; ///< of the vertices with measured values
  Flags Missing; ///< per vertex of the range

  bool IsMissing(Index vertex) const { return this->Missing[vertex - this->Range.Begin] != 0; }
  Rings MakeRings() const { return Rings(this->Neighbours, this->Range); }
  /// At most about so many of the vertices with measured or missing values, evenly by number.
  std::vector<Index> SampleVertices(Index largest) const;

private:
  const Flags* IsBetween = nullptr; ///< null: no vertex
};

/// The difference up to which the values of each column are equal: means of equal numbers, such as
/// data on cells have at vertices, differ by less.
Eigen::RowVectorXd RoundOffOf(const FitData& data);

/// A linear function, in the tangent plane of a vertex, fitted to known values around it: its value
/// at the vertex is the sum of Weights times the values at Known.
struct LinearFit
{
  std::vector<Index> Known;
  Vector Weights; ///< none if the places do not determine a function
};

/// The fit to the vertices at a distance of `edges` edges that are not missing.
LinearFit FitAround(Index vertex, int edges, Rings& rings, const FitData& data);

/// The same with a cubic polynomial fitted to the vertices at a distance of 1 and 2 edges, of which
/// it needs 12. None to more than 100.
LinearFit FitCubicAround(Index vertex, Rings& rings, const FitData& data);

/// The standard deviation of Gaussian numbers over the median of their absolute values.
constexpr double GaussianFactor = 1.4826;

/// Absolute deviations of columns of data.
class RobustDeviations
{
public:
  explicit RobustDeviations(Eigen::Index columns)
    : OfColumns(static_cast<std::size_t>(columns))
  {
  }

  void Add(Eigen::Index column, double deviation)
  {
    this->OfColumns[static_cast<std::size_t>(column)].push_back(deviation);
  }

  /// The standard deviation of Gaussian ones, 1.4826 times the median, as root mean square over the
  /// columns. A column without deviations at some of `count` places is constant there. Reorders
  /// them.
  double RootMeanSquare(double count);

private:
  std::vector<std::vector<double>> OfColumns;
};

} // namespace SurfaceDiffusion
