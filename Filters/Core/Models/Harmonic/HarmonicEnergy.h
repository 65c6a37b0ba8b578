// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Surface/TriangleMesh.h"

#include <memory>

namespace SurfaceDiffusion
{

/// The regularised p-Dirichlet energy of a map u on a triangulated surface,
///   int ((|grad u|^2 + beta)^(p/2) - beta^(p/2)) / p,  1 <= p <= 2,
/// and its diffusivity g = (|grad u|^2 + beta)^((p-2)/2) of (20), (21). |grad u|, constant on each
/// triangle, runs over all components of u. With the coefficients of a diffusion tensor
/// D = g1 e1 e1^T + g2 e2 e2^T, |grad u|^2 is grad u . D grad u / d with d = max(g1, g2), and the
/// integral has the factor d. Line fields (u and -u are the same) take in each triangle, of the
/// four ways to choose the signs of its corners, the one of the smallest |grad u|.
class HarmonicEnergy
{
public:
  struct Settings
  {
    double Exponent = 1.0; ///< p
    double Beta = 1e-6; ///< > 0, or 0 if p = 2
    double LargestDiffusivity = 1.0; ///< d
    bool LineField = false;
  };

  HarmonicEnergy(std::shared_ptr<const TriangleMesh> mesh, CornerWeights coefficients,
    const Settings& settings, const ParallelFor& parallel);

  /// The energy, summed over the triangles of this process.
  double operator()(const Values& u) const;

  /// Evaluate |grad u|^2, g and the signs of lines on each triangle, to be kept for a time step.
  /// Returns the energy.
  double Evaluate(const Values& u);

  const CornerWeights& GetCoefficients() const { return this->Coefficients; }
  const Vector& GradientSquares() const { return this->Squares; }
  const Vector& Diffusivities() const { return this->Weights; }
  /// For Assembler::Fill(); null unless u is a line field.
  const CornerWeights* GetSigns() const { return this->Options.LineField ? &this->Signs : nullptr; }

private:
  template <int K>
  double GradientSquare(const Values& u, Index t, double* signs) const;
  double Diffusivity(double square) const;
  double Density(double square) const;

  std::shared_ptr<const TriangleMesh> Mesh;
  CornerWeights Coefficients;
  Settings Options;
  const ParallelFor& Parallel;
  Vector Weights, Squares;
  CornerWeights Signs;
};

} // namespace SurfaceDiffusion
