// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Fields/FunctionDiagonal.h"
#include "Core/Models/Fields/ResolventPolynomial.h"
#include "Core/Models/Fields/ResolventPower.h"

#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

namespace SurfaceDiffusion
{

/// The covariance of a Gaussian random field.
enum class FieldCovariance
{
  /// White noise after the heat equation, exp(-t L) W: on the plane the correlation at distance r is
  /// exp(-r^2 / (8 t)).
  Gaussian,
  /// The solution of (kappa^2 + L)^(alpha/2) u = W with alpha = nu + 1, for nu in (0, 4]: on the
  /// plane the correlation is that of Matern's class, (kappa r)^nu K_nu(kappa r) / (2^(nu-1)
  /// Gamma(nu)) (F. Lindgren, H. Rue, J. Lindstrom, J. R. Statist. Soc. B 73, 2011).
  Matern
};

/// Gaussian random fields on a surface, of mean 0: L = M^-1 K with lumped masses, and white noise W,
/// independent at the vertices with the variances 1 / A_i. Fields are divided by their standard
/// deviation on the plane, which that on surfaces exceeds near boundaries (by sqrt(2) on a straight
/// one, where there is no flux) and where the surface is small beside the correlation; or by that
/// at each vertex, which makes it 1 everywhere.
class RandomField
{
public:
  struct Settings
  {
    FieldCovariance Covariance = FieldCovariance::Gaussian;
    /// Full width at half maximum of the kernel of Gaussian; 0: white noise of variance 1 at each vertex
    double Width = 1.0;
    double Range = 1.0; ///< of Matern, above 0: sqrt(8 nu) / kappa, where the correlation is 0.14
    Vector
      Ranges; ///< per vertex, in place of Range, within a factor of 10; no row: the same everywhere
    double Nu = 1.0; ///< of Matern: above 0, up to 4; other numbers than 1 and 3 are exact to 0.5 %
    bool HasUnitVariance = true; ///< at each vertex, rather than on the plane
  };

  /// ids: a number per vertex, of which its random numbers are functions. Lengths are in the units
  /// of the mesh. shared: of fields of several Gaussian widths, which are made in ascending order: each
  /// twice as wide as the one before needs 3 factors. deviations: Deviations() of fields with these settings; no row: they are found.
  /// Throws Aborted.
  RandomField(std::shared_ptr<const Assembler> assembler, const CornerWeights& coefficients,
    const Settings& settings, std::vector<std::int64_t> ids, Vector deviations = Vector(),
    const ParallelFor& parallel = SerialFor(), const ProgressMonitor& progress = ProgressMonitor(),
    SharedPoles* shared = nullptr);

  /// Fields first, first + 1, ... of a seed as the columns of `fields`, n x count. The numbers of a
  /// field depend on the seed and on its own number, not on which others are drawn. Throws
  /// NotConverged and Aborted.
  void Draw(std::int64_t seed, std::int64_t first, Values& fields,
    const ProgressMonitor& progress = ProgressMonitor());

  /// With fields F w of independent deviates w of variance 1, one per vertex, b becomes the transpose of F
  /// times b: the covariances of sums b* F w of fields are the products b* F F* b. Throws NotConverged and
  /// Aborted.
  void ApplyTransposed(Values& b, const ProgressMonitor& progress = ProgressMonitor());

  /// The standard deviations before the division, relative to that on the plane; no row if they are
  /// not needed.
  const Vector& Deviations() const { return this->RelativeDeviations; }

  /// Of the last Draw() or ApplyTransposed(): see ResolventPolynomial.
  double MissedResidual() const;

private:
  using Function = std::variant<std::monostate, ResolventPolynomial, ResolventPower>;

  double DeviationOfNoise(Index vertex) const;
  void Apply(Values& fields, const ProgressMonitor& progress);
  void Divide(Values& fields) const; ///< by the deviations

  std::shared_ptr<const Assembler> Assembly;
  const ParallelFor& Parallel;
  std::vector<std::int64_t> Ids;
  double DeviationOnPlane = 1.0;
  Vector
    RelativeDeviations; ///< what fields are divided by beside DeviationOnPlane; no row: nothing
  Function Operator; ///< none of white noise
};

} // namespace SurfaceDiffusion
