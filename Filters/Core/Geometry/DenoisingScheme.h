// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geometry/LinearNormals.h"
#include "Core/Geometry/NormalFit.h"
#include "Core/Geometry/NormalVariation.h"

#include <optional>
#include <vector>

namespace SurfaceDiffusion
{

/// How normals are filtered and vertices fitted for one kind of surface, in mean edge lengths h.
struct DenoisingScheme
{
  /// The first stage: FilterNormals(), which finds the edges of the surface.
  NormalFilterSettings Filter;
  int Iterations = 10;
  /// Fidelity of the fit in the first and in the last iteration for noise of 0.3 h. It is
  /// proportional to the inverse of the variance of the noise.
  double FirstFidelity = 0.45;
  double LastFidelity = 0.045;
  /// The second stage: FitLinearNormals(), which regains the curvature that the first flattened.
  NormalFilterSettings LinearFilter;
  int LinearIterations = 20;
  double LinearFidelity = 0.04; ///< of the fit, for noise of 0.3 h
  /// The third stage: NormalVariation, whose weight of the first order falls geometrically, and a
  /// fit after each minimisation. 0 iterations: none.
  int VariationIterations = 6;
  double FirstVariation = 0.1; ///< a1 in the first and in the last iteration
  double LastVariation = 0.08;
  double SecondOrder = 1.3; ///< weight of the second order over that of the first
  double VariationRange = 0.3; ///< of the weights of the edges
  double VariationFidelity = 0.1; ///< of the fit, for noise of 0.3 h
  int VariationSplittings = 12; ///< in each of them
  int VariationFitIterations = 6;
  /// The end: one fit to the normals of the last iteration that is nearly solved, with a fidelity
  /// that grows less with weaker noise than those of the iterations, in which too loose a fit would
  /// lose details step by step. 0 iterations: none.
  double FinalFidelity = 0.03; ///< for noise of 0.3 h
  int FinalFitIterations = 15;
  double TangentialFidelity = 0.1;
  int FitIterations = 4; ///< of conjugate gradients in each iteration: few of them regularise
  double OutlierLevel = 1.0; ///< OutlierDistance of the fit, in standard deviations of the noise
  /// Whether the fidelity follows the local displacements (see DenoiseSurface()), or their median.
  bool HasLocalFidelity = false;
};

/// The scheme with which surfaces of this kind are denoised. noise: its standard deviation in h.
DenoisingScheme SchemeFor(SurfaceKind kind, double noise);

/// The scheme for noise that is correlated over this length in h, on surfaces of both kinds: the
/// variation of normals averages over that length.
DenoisingScheme SchemeForCorrelatedNoise(double length);

/// Remove noise of this standard deviation, in the unit of the points, by the iterations of a
/// scheme: DenoiseSurface() says which.
Points DenoiseWithScheme(const FaceGraph& graph, const Points& points,
  const std::vector<char>& fixed, double noise, const DenoisingScheme& scheme,
  const ParallelFor& parallel = SerialFor(), const ProgressMonitor& progress = ProgressMonitor());

/// The same, or nothing if the displacements after the second stage are more alike at neighbours
/// than independent noise is: then they are details of the surface, too.
std::optional<Points> DenoiseUnlessDetailsAreLost(const FaceGraph& graph, const Points& points,
  const std::vector<char>& fixed, double noise, const DenoisingScheme& scheme,
  const ParallelFor& parallel = SerialFor(), const ProgressMonitor& progress = ProgressMonitor());

} // namespace SurfaceDiffusion
