// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Operators/Assembler.h"
#include "Core/Surface/PointData.h"

namespace SurfaceDiffusion
{

/// Whether data show the white noise that EstimateNoise() takes for granted. The residuals of fits
/// are divided by what white noise of deviation 1 has, so that all deviations here are sigma in
/// data of white noise sigma and a signal that the fits follow. See EstimateNoise() for robust
/// deviations.
struct NeighbourVariation
{
  double OfLinearFits = 0.0; ///< the estimate from neighbours
  double OfCubicFits = 0.0; ///< of the residuals r of cubic fits to vertices 1 and 2 edges away
  double OfSums = 0.0; ///< of r_i + r_j, where j is the nearest neighbour of i
  double OfDifferences = 0.0; ///< of r_i - r_j
  double NumberOfPairs = 0.0; ///< (i, j), of which no two share a vertex
  double Deviation = 0.0; ///< standard deviation of the data
  /// The full width at half maximum of the Gaussian kernel that gives white noise the same
  /// correlation between neighbours as the data have; 0 if they have none.
  double Width = 0.0;

  /// True if white noise makes less than half of the estimate, and if
  /// - what cubic fits leave is no white noise either but is equal at neighbours: the variance of
  ///   the differences is less than a third of that of the sums, or
  /// - white noise is less than 1 % of the deviation of the data. (1 % of the range of data is 2 %
  ///   of their deviation or more.)
  /// White noise is at most the lesser of OfCubicFits and OfDifferences. Both ratios of deviations
  /// also have to be below 1, that of white noise, by four standard errors of their logarithm,
  /// which for medians of Gaussian residuals is sqrt(2 * 1.361 / pairs): 1 of 30,000. False for
  /// fewer than 100 pairs.
  ///
  /// So the estimate is not that of white noise: it is too small for noise that was smoothed with a
  /// Gaussian kernel of a standard deviation of 3 edges or more (1.5 if edges are equally long),
  /// and too large for white noise under waves of less than 7 edges. A smooth signal, with or
  /// without correlated noise, is smooth as well. Not found is correlated noise together with white
  /// noise that makes half of the estimate. Noise may be missed where neighbouring edges differ
  /// much in length or the surface has sharp edges, since it is not smooth in tangent planes there.
  bool IsSmooth() const;
};

/// The full width at half maximum of the Gaussian kernel that gives white noise this mean square of
/// differences at this mean square of distances, the correlation exp(-2 ln 2 d^2/width^2) at the
/// distance d; 0 if there is no correlation.
double WidthOfCorrelation(double squareDifference, double variance, double squareDistance);

/// Measures it at the varying vertices, 10,000 of them at most. Root mean square over the columns.
/// ofLinearFits: NoiseEstimate::BetweenNeighbours. points: see EstimateNoise().
NeighbourVariation MeasureVariation(const Assembler& assembler,
  const Eigen::Ref<const Points>& points, const PointData& data, double ofLinearFits);

} // namespace SurfaceDiffusion
