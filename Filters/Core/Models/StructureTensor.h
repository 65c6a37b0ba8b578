// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/HeatBlur.h"
#include "Core/Operators/LineFieldOperator.h"

#include <memory>

namespace SurfaceDiffusion
{

/// The full width at half maximum of a Gaussian of standard deviation 1, 2 sqrt(2 ln 2): the
/// kernels of the classes below have the widths of Gaussians.
constexpr double WidthOfDeviation = 2.3548200450309493;

/// Parallel smoothing of the traceless part of a tensor field on a surface (intrinsic anisotropic
/// diffusion: L. Naden, T. Maerz, C. Macdonald, arXiv 1403.2131, 2014): N steps of backward Euler
/// for the heat equation of the connection Laplacian, ((M + tau/N K)^-1 M)^N, with M and K of
/// LineFieldOperator. The traceless part of a symmetric tensor with eigenvalues m1 >= m2 and the
/// main axis at angle a is the complex number z = (m1 - m2)/2 exp(2 i a). It is smoothed in the
/// tangent planes, with the parallel transport of the surface, and not by components in space:
/// fields that are constant on a flat surface stay, and a rotation of the surface has no effect.
class TensorSmoothing
{
public:
  /// width: full width at half maximum of the kernel, see HeatBlur.
  TensorSmoothing(std::shared_ptr<const LineFieldOperator> laplacian, double width, int steps,
    std::shared_ptr<LinearSolver> solver, const ParallelFor& parallel = SerialFor());

  /// z: per triangle, real and imaginary part in its own axes (m x 2). The solves are added to the
  /// report.
  void Apply(
    TangentVectors& z, StepReport& report, const ProgressMonitor& progress = ProgressMonitor());

private:
  std::shared_ptr<const LineFieldOperator> Laplacian;
  std::shared_ptr<LinearSolver> Solver;
  const ParallelFor& Parallel;
  int Steps;
  bool Prepared = false;
  SparseMatrix Matrix;
  Values OnEdges, RightHandSide;
};

/// The structure tensor J = G_rho * sum over the channels k of grad u_sigma,k grad u_sigma,k^T
/// (J. Weickert, Anisotropic Diffusion in Image Processing, Teubner 1998), u_sigma being u after a
/// Gaussian of standard deviation sigma. Its main axis points across lines in the data, and the
/// difference of its eigenvalues measures how line-like they are (coherence).
class StructureTensor
{
public:
  /// noise: smooths u; null: sigma = 0. integration: smooths J; null: rho = 0.
  StructureTensor(std::shared_ptr<const TriangleMesh> mesh, std::unique_ptr<HeatBlur> noise,
    std::unique_ptr<TensorSmoothing> integration, const ParallelFor& parallel = SerialFor());

  /// Evaluate J of u.
  void Evaluate(const Values& u, StepReport& report, const ProgressMonitor& progress);

  /// (m1 - m2)/2 exp(2 i a) of J per triangle; see TensorSmoothing.
  const TangentVectors& Deviators() const { return this->Deviator; }
  /// m1 + m2 per triangle, without the integration.
  const Vector& Traces() const { return this->Trace; }

private:
  std::shared_ptr<const TriangleMesh> Surface;
  std::unique_ptr<HeatBlur> Noise;
  std::unique_ptr<TensorSmoothing> Integration;
  const ParallelFor& Parallel;
  Values Smooth;
  TangentVectors Deviator;
  Vector Trace;
};

} // namespace SurfaceDiffusion
