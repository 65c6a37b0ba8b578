// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Geometry/FaceNormalFilter.h"

#include <vector>

namespace SurfaceDiffusion
{

/// The kind of surface that a user asks for.
enum class SurfaceType
{
  Automatic, ///< found by what the third stage removes
  CAD, ///< smooth faces, which may meet in sharp edges
  Organic ///< details of a few triangles
};

/// How normals are filtered and vertices fitted, in mean edge lengths h. DenoiseSurface() says why.
/// Fidelities are proportional to the inverse of the variance of the noise.
struct DenoisingScheme
{
  /// The first stage: FilterNormals(), which finds the edges of the surface.
  NormalFilterSettings Filter;
  int Iterations = 10;
  double Fidelity = 0.09; ///< of the fit, for noise of 0.3 h
  /// The second stage: FitLinearNormals(), which regains the curvature that the first flattened.
  NormalFilterSettings LinearFilter = { 0.3, 1.5 };
  int LinearIterations = 30;
  double LinearFidelity = 0.02; ///< the same
  double TangentialFidelity = 1.0; ///< of the fits of the first two stages
  /// Whether the fidelity and the second stage follow the displacements around each vertex: those of
  /// independent noise have its variance and are independent.
  bool IsNoiseIndependent = true;
  /// The third stage: NormalVariation, whose weight of the first order falls geometrically, and a
  /// fit after each minimisation.
  int VariationIterations = 8;
  double FirstVariation = 0.1; ///< a1 in the first and in the last iteration
  double LastVariation = 0.08;
  double SecondOrder = 1.3; ///< weight of the second order over that of the first
  double VariationRange = 0.3; ///< of the weights of the edges
  double VariationFidelity = 0.1; ///< of the fit, for noise of 0.3 h
  int VariationSplittings = 13; ///< in each of them
  int VariationFitIterations = 6;
  double VariationTangentialFidelity = 0.1; ///< of this fit and the last
  /// The end: one fit to the normals of the last iteration that is nearly solved, with a fidelity
  /// that grows less with weaker noise than those of the iterations, in which too loose a fit would
  /// lose details step by step.
  double FinalFidelity = 0.03; ///< for noise of 0.3 h
  int FinalFitIterations = 15;
  double OutlierLevel = 1.0; ///< OutlierDistance of the fit, in standard deviations of the noise
};

/// The scheme for independent noise of this standard deviation, in h.
DenoisingScheme SchemeForIndependentNoise(double noise);

/// The scheme for noise that is correlated over this length in h: the variation of normals averages
/// over that length.
DenoisingScheme SchemeForCorrelatedNoise(double length);

struct DenoisedSurface
{
  Points Moved;
  SurfaceType Type; ///< given or found
};

/// Remove noise of this standard deviation, in the unit of the points, by the stages of a scheme:
/// of surfaces of the type Organic by the first two. If the type is Automatic, the result of the
/// third is kept if its displacements are as white as independent noise, within two standard
/// deviations (see DisplacementStatistics).
/// points: per vertex of the mesh; fixed: see DenoiseSurface(); creases: over which normals have
/// nothing to do with each other, and whose vertices are fixed. Throws Aborted.
DenoisedSurface DenoiseWithScheme(const TriangleMesh& mesh, const Points& points,
  const std::vector<char>& fixed, const VertexPairs& creases, double noise,
  const DenoisingScheme& scheme, SurfaceType type, const ParallelFor& parallel = SerialFor(),
  const ProgressMonitor& progress = ProgressMonitor());

} // namespace SurfaceDiffusion
