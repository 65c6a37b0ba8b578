// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/LinearFit.h"

namespace SurfaceDiffusion
{

/// The correlation of the residuals of linear fits to neighbours, see EstimateNoise(), between
/// vertices at a distance of one and of two edges, less that of white noise on the same mesh.
///
/// The residuals of white noise have a correlation, too, since they share neighbours: about -0.22 and
/// 0.04. In a signal that bends, both distances exceed it. In noise that was smoothed or
/// interpolated over up to about 6 edges, the first exceeds it and the second does not.
struct ResidualCorrelation
{
  double OneEdge = 0.0;
  double TwoEdges = 0.0;
  double NumberOfPairs = 0.0; ///< at one edge

  bool IsOfCorrelatedNoise() const;
};

/// Measures it at known vertices, at 20,000 at most. Residuals above three times their median
/// deviation, those of edges and outliers, do not count.
ResidualCorrelation CorrelateResiduals(const FitData& data);

} // namespace SurfaceDiffusion
