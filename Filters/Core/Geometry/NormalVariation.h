// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Geometry/FaceGraph.h"

#include <memory>

namespace SurfaceDiffusion
{

struct NormalVariationSettings
{
  double First = 0.15; ///< a1
  double Second = 0.25; ///< a0
  int Iterations = 15; ///< of the splitting
};

/// The total generalised variation of the normals of a surface of triangles (Z. Liu, Y. Li, W.
/// Wang, L. Liu, R. Chen, Mesh Total Generalized Variation for Denoising, TVCG 28(12), 2022): each
/// triangle f has a normal n_f, a row of three, and a slope u_f, two rows along the axes of its
/// plane, that minimise
///
///   sum_f a_f/2 |n_f - d_f|^2 + r/2 |u_f|^2
///     + a1 sum_e w_e l_e |n_f + u_f . (m_e - c_f) - n_g - u_g . (m_e - c_g)|
///     + a0 sum_e w_e l_e |u_f - T_fg u_g|
///
/// for given normals d, with the areas a over their mean, the edges e between two triangles f and
/// g, their lengths l and midpoints m, the centroids c, the rotation T about the edge, and r = 1e-6.
/// Lengths are in the given unit. Functions that are linear on a surface that can be unrolled into
/// a plane have no variation, and jumps have that of their height.
///
/// The energy is split: v = D (n, u) are the differences at the edges, and the alternating direction
/// method of multipliers takes turns between (n, u), by one step of descent of a fixed length with
/// a preconditioner from the last ones, and the shrinkage of v. The three components of the normals
/// share all coefficients. All of this is in single precision.
class NormalVariation
{
public:
  /// unit: of the lengths, such as the mean edge length.
  NormalVariation(const FaceGraph& graph, double unit, const ParallelFor& parallel = SerialFor());
  NormalVariation(NormalVariation&& other) noexcept;
  ~NormalVariation();

  /// Take the edges and triangles at these points. (n, u) and the multipliers stay.
  void SetPlaces(const Points& points, const FaceGeometry& geometry);
  /// w_e = 1/(1 + (|n_f - n_g|/range)^2) of these normals: then the first sum majorises a penalty that
  /// saturates, so that high jumps keep their height.
  void SetWeights(const Points& normals, double range);

  /// Approach the minimum for the given normals from the last (n, u), the first time from the given
  /// normals without slopes. Returns n, which are no unit vectors. Throws Aborted.
  Points Minimize(const Points& given, const NormalVariationSettings& settings,
    const ProgressMonitor& progress = ProgressMonitor());

  /// The energy of (n, u), and how far at most it is above its minimum: the energy less that of the
  /// dual problem at the multipliers. given, and the settings: of the last Minimize().
  struct Energy
  {
    double Value = 0.0;
    double Gap = 0.0;
  };
  Energy MeasureEnergy(const Points& given) const;

private:
  class Splitting;
  std::unique_ptr<Splitting> Work;
};

} // namespace SurfaceDiffusion
