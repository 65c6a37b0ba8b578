// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Operators/Assembler.h"
#include "Core/Surface/PointData.h"

#include <vector>

namespace SurfaceDiffusion
{

/// The scales of the edges of data on a connected component of a surface, for MumfordShah: values
/// in the unit of the data, lengths in the unit of the points.
struct EdgeScales
{
  double Noise = 0.0; ///< standard deviation of a channel
  double Slope = 0.0; ///< of the data between edges, over all channels together
  double Threshold = 0.0; ///< J, the jump from which on an edge costs less than smoothing; > 0
  double SmoothingLength = 1.0; ///< L, over which data are smoothed between edges; > 0
};

struct EdgeScalesInput
{
  double EdgeWidth = 1.0; ///< eps, in TriangleMesh::LengthUnit()
  double NoiseLevel = 0.0; ///< the standard deviation of the noise of a channel; 0: estimated
  /// Of data that cells were averaged to: times the estimate from neighbours it gives the noise. 0:
  /// of other data.
  double NoiseGain = 0.0;
};

/// J and L, in TriangleMesh::LengthUnit(), of each connected component, from the data alone. With
/// the mean edge length h, the noise sigma (EstimateNoise(), in the Euclidean norm over the
/// channels), the range R (RobustBounds(), likewise), and the slope g of the data between their
/// jumps,
///   J = max(0.12 R, 3.2 sigma sqrt(8 h / L), g max(sqrt(24 eps L), 2 L)).
/// The second term keeps noise from making edges, measured on spheres, scans and jittered grids.
/// The third is the gradient limit of the functional (A. Blake, A. Zisserman, Visual
/// Reconstruction, 1987): slopes above J/(2 L) cost less as a staircase of edges, and above
/// J/sqrt(24 eps L) the flux v^2 |grad u| of the approximation by Ambrosio and Tortorelli falls
/// with the slope, so that it concentrates in edges.
///   L is what noise needs for J = 0.12 R, in 4 h to 24 h. If the slope then asks for a larger J,
/// then L is shorter, down to 2 h, where the noise and the slope ask for the same J.
///
/// g is found from linear fits on disks of four edges around at most 3000 vertices. Disks with a
/// jump are left out: their residual is above that of the noise and 0.12 of the fitted slope times
/// the radius, in squares. g is the quantile of 90 % of the others, and a lower one the more disks
/// have a jump.
std::vector<EdgeScales> FindEdgeScales(const Assembler& assembler,
  const Eigen::Ref<const Points>& points, const PointData& data, const EdgeScalesInput& input);

} // namespace SurfaceDiffusion
