// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

#include <cstddef>
#include <vector>

namespace SurfaceDiffusion
{

/// The smoothness of noise maps: the full width at half maximum of the Gaussian kernel that white
/// noise has to be smoothed with to have the same correlation between neighbours, in the unit of the
/// mesh. 0 without correlation between neighbours; infinite for constant maps, and for those that are
/// as smooth as the surface is large: the equation below has no solution.
///
/// After a Gaussian kernel of the standard deviation sigma the correlation at the distance d is
/// rho(d) = exp(-d^2/(4 sigma^2)). sigma solves
///
///     sum_e w_e (s_i s_j - rho(d_e) (s_i^2 + s_j^2)/2) = 0
///
/// over the edges e = ij, of length d_e and weight w_e, the area of the triangles of the edge over
/// d_e^2. If the mean is subtracted, which takes the part q = 4 pi sigma^2/area of the variance, rho -
/// q and 1 - q stand in place of rho and 1: then the width is at most that of q = 1/2. For edges of one
/// length this is the estimator of S. Forman et al., Magnetic Resonance in Medicine 33, 1995. Edges
/// are grouped by their lengths into 256 parts of equal area, where they are many.
class NoiseWidth
{
public:
  /// subtractsMean: of each map over the area first. Control areas that were given scale the lengths
  /// of edges by their roots. The mesh must live longer than this object.
  NoiseWidth(const TriangleMesh& mesh, bool subtractsMean);

  /// Add columns: one row per vertex, NaN where a value is missing.
  void Add(const Values& maps);

  /// Of each column that was added.
  std::vector<double> OfColumns() const;
  /// Of all columns together; constant ones say nothing of the others.
  double OfAll() const;
  /// The largest width that a column may have; 0 if it is constant, NaN without a known value.
  std::vector<double> LargestOfColumns() const;

private:
  struct Column
  {
    double Product = 0.0; ///< of neighbours, over the variance
    Vector Variances; ///< the shares of the parts of edges, or 0
    double Area = 0.0; ///< of the known part
    bool Varies() const { return this->Variances.sum() > 0.0; }
  };
  Column Measure(const Values& maps, Eigen::Index column) const;
  double Solve(double product, const Vector& variances, double area) const;

  const TriangleMesh& Mesh;
  bool SubtractsMean;
  Vector EdgeWeights; ///< of the sides of triangles, w_e
  std::vector<int> PartOfEdge;
  Vector Squares; ///< the mean of d^2 in each part
  std::vector<Column> Columns;
};

/// The width to smooth by so that noise of the width `found` gets the width `wanted`: squares of
/// widths add up, and a secant step on squares corrects that until what is reached is right.
class WidthCorrection
{
public:
  /// area: of the surface, in the square of the unit of widths.
  WidthCorrection(double wanted, double found, double area);

  double Width() const; ///< to smooth by
  /// Take the width that smoothing by Width() has reached. False: no other width would help.
  bool Take(double reached);
  double LargestReached() const;

private:
  double Wanted, Area; ///< Wanted and all others: squares
  double Square;
  double SquareBefore = 0.0, ReachedBefore;
  double Largest;
  double Low = 0.0, High; ///< squares that reach less and more
};

} // namespace SurfaceDiffusion
