// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geometry/DenoisingScheme.h"

namespace SurfaceDiffusion
{

struct DenoisingSettings
{
  /// The standard deviation of the noise of the vertices along the normal, in the unit of the
  /// points; 0: estimated for each part of the surface (see EstimateVertexNoise() and
  /// EstimateCorrelatedNoise()). Estimates below 0.005 mean edge lengths are taken for none.
  double NoiseLevel = 0.0;
  SurfaceType Type = SurfaceType::Automatic;
  /// The deviation of the kernel that correlates the noise, in mean edge lengths of each part; 0: found.
  /// Below 0.5 the noise is independent.
  double NoiseLength = 0.0;
  /// Edges whose triangles differ by this angle and more, in degrees, are creases; 0: none are.
  double CreaseAngle = 0.0;
  /// Others that are creases, by vertices of the mesh.
  VertexPairs Creases;
  /// No vertex moves farther, in the unit of the points; 0: without limit.
  double DisplacementLimit = 0.0;
};

struct DenoisingReport
{
  /// Given or estimated, in the unit of the points: the root mean square over the vertices.
  double NoiseLevel = 0.0;
  /// Given or found; Automatic: no noise was found, or parts are of different types.
  SurfaceType Type = SurfaceType::Automatic;
  /// The length over which the noise is correlated, in the unit of the points: the largest of the
  /// parts. 0: none was found (see EstimateCorrelatedNoise()).
  double CorrelationLength = 0.0;
  double MeanDisplacement = 0.0; ///< of the vertices, in the unit of the points
  double MaximumDisplacement = 0.0;
  Index Spikes = 0; ///< see FindSpikes(); moved between their neighbours before anything else
  /// The other vertices whose displacement is more than 10 times the noise level of their part:
  /// edges that were sharpened, or triangles so thin that their normals determine no place.
  Index FarVertices = 0;
  Index LimitedVertices = 0; ///< those that would have moved farther than DisplacementLimit
  Index Parts = 0; ///< connected components
  /// What may be correlated noise, or relief, and stays: its deviation along the normals, in the unit of
  /// the points, and the length over which it is correlated. The largest of the parts; 0: none.
  double Relief = 0.0;
  double ReliefLength = 0.0;
  double ReliefEdges = 0.0; ///< the deviation of its kernel, in mean edge lengths
  /// How much more the displacements along the normals differ than those of noise that is everywhere the
  /// same, where its level was estimated: the largest TailOfNormal() of the parts. Such noise has up to 1.1,
  /// relief 1.4 to 3, impulsive noise more.
  double Tail = 1.0;
  /// Those whose noise cannot be distinguished from their shape, and that stay: with less than 200
  /// vertices, or more than a quarter of the edges within flat faces. None if the level is given.
  Index CoarseParts = 0;
  /// The largest relative change of the volume of a part that is closed.
  double VolumeChange = 0.0;
};

/// Remove the noise of the vertices of a triangulated surface.
///
/// Connected components have their own unit of length, noise level and type, so that the result for
/// several surfaces together is that of each alone. Those with less than 200 vertices are too few for
/// an estimate of the noise, and stay; if the level is given, they share one type. So do those with
/// more than a quarter of their edges within a flat face, which no noise leaves: their vertices are
/// at corners and edges of the shape, which resemble noise. Triangles
/// are oriented first (see OrientTriangles()), and the result does not depend on the numbering of
/// vertices and triangles.
///
/// Each iteration filters the normals of the present surface and moves the points towards the fit
/// of the given points to them, FitToNormals(), by one step of conjugate gradients: few steps
/// regularise. The first iterations use FilterNormals(), which suits piecewise constant normals and
/// sharpens edges. The second ones use FitLinearNormals() with the normals of the present surface
/// as guide, for piecewise linear normals, and TurnFlippedFaces(). On surfaces of the type CAD,
/// iterations with NormalVariation follow, and a fit to the last normals that is nearly solved.
/// Tangential displacements are small, so that triangles and boundaries keep their shape. A noise
/// level of 0 leaves the points as they are.
///
/// Displacements along the normal should resemble the noise, in two ways. They should have its
/// variance (the discrepancy principle): during the first iterations the fidelity grows and falls
/// per vertex, by local means of the squared displacements (G. Gilboa, N. Sochen, Y. Zeevi,
/// Variational Denoising of Partly Textured Images by Spatially Varying Constraints, IEEE
/// Transactions on Image Processing 15(8), 2006). And they should be as white (see
/// DisplacementStatistics). Where their whiteness stays below that of independent noise, the second
/// iterations have removed noise only, and their result is kept. Elsewhere they have removed
/// details, and the result is that of steps which end before. It is so, too, where displacements
/// have three times the variance of the noise.
///
/// If the type is Automatic, the variation of normals is minimised, too, and its result is kept if
/// the displacements are then as white as independent noise. Otherwise it has removed details,
/// which are of a few triangles on organic surfaces.
///
/// Noise that is correlated over several edges has a scheme of its own, SchemeForCorrelatedNoise(). If it
/// may be relief, its displacements are kept if they are normally distributed: the 0.95 quantile of noise
/// is 0.9 to 1.15 of that of such numbers with its 0.3 quantile, and that of relief, which differs from
/// place to place, 1.2 to 2.
/// A given level of a surface of the type Organic is that of independent noise, unless its length is
/// given, too.
///
/// Vertices of creases stay, and normals on the two sides of one do not smooth each other.
///
/// points: per vertex of the mesh; fixed: per vertex, nonzero for vertices that stay, may be empty.
/// Throws Aborted.
Points DenoiseSurface(const TriangleMesh& mesh, const Points& points,
  const std::vector<char>& fixed, const DenoisingSettings& settings,
  DenoisingReport* report = nullptr, const ParallelFor& parallel = SerialFor(),
  const ProgressMonitor& progress = ProgressMonitor());

} // namespace SurfaceDiffusion
