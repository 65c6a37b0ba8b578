// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Operators/LineFieldOperator.h"
#include "Core/Solvers/LinearSolver.h"

namespace SurfaceDiffusion
{

/// How the solution for a line field ended.
struct LineFieldReport
{
  /// The largest relative residual of the solves that missed the tolerance, otherwise 0.
  double MissedResidual = 0.0;
  /// If the iteration ended at its largest number of steps: the change of a field in the last one,
  /// relative to it. Otherwise 0.
  double UnsettledChange = 0.0;
  /// The largest eigenvalue over the connected components.
  double Lambda = 0.0;
};

/// The globally smoothest line field: the eigenvector of K z = lambda M z of the smallest lambda
/// (F. Knoppel, K. Crane, U. Pinkall, P. Schroder, Globally Optimal Direction Fields, ACM Trans.
/// Graph. 32(4), 2013). Of several that are equally smooth, with eigenvalues that exceed the
/// smallest, l, by about 0.5 % or less, it is the one nearest to `start`: the projection of the
/// start with the factors exp(-((lambda - l) / (0.005 l))^2 / 2). start: lines and their weights
/// per triangle (zero rows: none). Every connected component has a field of its own.
///
/// `solver` is given K + 1e-3/area M, with the area of each component, which is definite on flat
/// surfaces too and has the same eigenvectors, and is asked for 10 to 20 solutions.
TangentVectors SmoothestLineField(const LineFieldOperator& laplacian,
  const Eigen::Ref<const TangentVectors>& start, const Eigen::Ref<const Vector>& weights,
  LinearSolver& solver, const ProgressMonitor& progress = ProgressMonitor(),
  LineFieldReport* report = nullptr, int maximumNumberOfSteps = 100);

/// The line field that minimises int |grad z|^2 + w |z - hint|^2 + 1e-9/area |z|^2 for hints and
/// their weights w, in 1/LengthUnit()^2, per triangle (zero rows: no hint). The last term keeps the
/// matrix definite on connected components without hints, whose field is zero. Elsewhere it is far
/// below any w that has an effect.
TangentVectors LineFieldFromHints(const LineFieldOperator& laplacian,
  const Eigen::Ref<const TangentVectors>& hints, const Eigen::Ref<const Vector>& weights,
  LinearSolver& solver, const ProgressMonitor& progress = ProgressMonitor(),
  LineFieldReport* report = nullptr);

} // namespace SurfaceDiffusion
