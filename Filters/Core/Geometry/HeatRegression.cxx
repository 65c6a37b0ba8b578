// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/HeatRegression.h"

#include "Core/Operators/CotanWeights.h"
#include "Core/Operators/ExponentialSeries.h"
#include "Core/Operators/MixedMass.h"
#include "Core/Operators/SparseProduct.h"
#include "Core/Solvers/SolverChoice.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

double TimeOfWidth(double fwhm)
{
  return fwhm * fwhm / (16.0 * std::log(2.0));
}

/// The columns of a matrix of moments: x, the six products of x, u, and the products of u with x.
constexpr Eigen::Index ProductsBegin = 3;
constexpr Eigen::Index DataBegin = 9;

Values MakeMoments(const Points& x, const Values& u, const ParallelFor& parallel)
{
  const Eigen::Index k = u.cols();
  Values moments(u.rows(), DataBegin + 4 * k);
  ForEach(parallel, static_cast<Index>(u.rows()),
    [&](Index i)
    {
      const Eigen::RowVector3d p = x.row(i);
      moments.row(i).head<3>() = p;
      moments.row(i).segment<6>(ProductsBegin) << p[0] * p[0], p[0] * p[1], p[0] * p[2],
        p[1] * p[1], p[1] * p[2], p[2] * p[2];
      for (Eigen::Index c = 0; c < k; ++c)
      {
        moments(i, DataBegin + c) = u(i, c);
        moments.row(i).segment<3>(DataBegin + k + 3 * c) = u(i, c) * p;
      }
    });
  return moments;
}

/// Two axes perpendicular to a direction; those of the plane z = 0 if it is zero.
Eigen::Matrix<double, 3, 2> AxesOfPlane(const Eigen::Vector3d& normal)
{
  Eigen::Matrix<double, 3, 2> axes = Eigen::Matrix<double, 3, 2>::Identity();
  if (normal.norm() > 0.0)
  {
    const Eigen::Vector3d n = normal.normalized();
    axes.col(0) = n.unitOrthogonal();
    axes.col(1) = n.cross(axes.col(0));
  }
  return axes;
}

/// The inverse of a covariance. Directions in which the vertices do not spread, or in which weights
/// of obtuse triangles, which may be negative, leave no positive spread, are left out.
Eigen::Matrix2d InvertSpread(const Eigen::Matrix2d& covariance)
{
  constexpr double smallest = 1e-6; // of the largest spread
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> modes(covariance);
  const double bound = smallest * modes.eigenvalues()[1];
  Eigen::Vector2d inverse = Eigen::Vector2d::Zero();
  for (int a = 0; a < 2; ++a)
  {
    if (modes.eigenvalues()[a] > bound && bound > 0.0)
    {
      inverse[a] = 1.0 / modes.eigenvalues()[a];
    }
  }
  return modes.eigenvectors() * inverse.asDiagonal() * modes.eigenvectors().transpose();
}

} // namespace

double SmoothByHeat(const Assembler& assembler, double fwhm, Values& u, LinearSolver& solver,
  const ParallelFor& parallel, const ProgressMonitor& progress)
{
  const TriangleMesh& mesh = assembler.Mesh();
  const CornerWeights mass = MixedMassWeights(mesh, parallel);
  const SparseMatrix massDifference = MixedMinusLumped(assembler, mass, parallel);
  const CornerWeights coefficients =
    ExponentialSeries::Step * TimeOfWidth(fwhm) * CotanWeights(mesh, parallel) + mass;
  SparseMatrix matrix;
  assembler.TakePattern(matrix, parallel);
  assembler.Fill(matrix, mesh.ControlAreas(), 1.0, coefficients, nullptr, parallel);
  solver.SetMatrix(matrix, progress.Part(0.0, 0.5));
  double missed = 0.0;
  Values b(u.rows(), u.cols());
  ExponentialSeries::Work work;
  ExponentialSeries::Apply(u, work,
    [&](int k, const Values& last, Values& y)
    {
      Multiply(massDifference, last, b, parallel);
      b += mesh.ControlAreas().asDiagonal() * last;
      const double part = 0.5 + 0.5 * (k - 1) / ExponentialSeries::Degree;
      const SolveReport report =
        solver.Solve(b, y, progress.Part(part, part + 0.5 / ExponentialSeries::Degree));
      RequireAnswer(report, solver.GetLimits());
      missed = std::max(missed, report.Converged ? 0.0 : report.Residual);
    });
  return missed;
}

LinearFits FitByHeat(const Assembler& assembler, const Points& positions,
  const std::function<Eigen::Vector3d(Index, const Eigen::RowVectorXd&)>& normalOf, const Values& u,
  double fwhm, const ParallelFor& parallel, const ProgressMonitor& progress)
{
  const TriangleMesh& mesh = assembler.Mesh();
  const Index n = mesh.NumberOfVertices();
  const Eigen::Index k = u.cols();
  LinearFits fits;
  fits.Constants.resize(n, k);
  fits.Slopes.resize(n, 3 * k);
  if (n == 0 || k == 0)
  {
    return fits;
  }
  // Covariances are differences of moments, whose digits are lost far from the origin.
  const Points x = positions.rowwise() - positions.colwise().mean();
  const Eigen::RowVectorXd middle = u.colwise().mean();
  Values moments = MakeMoments(x, u.rowwise() - middle, parallel);
  SolverTask task;
  const double h = mesh.MeanEdgeLength();
  task.NumberOfVertices = n;
  task.DiffusionNumber = ExponentialSeries::Step * TimeOfWidth(fwhm) / (h * h);
  task.NumberOfSolves = ExponentialSeries::Degree;
  task.NumberOfColumns = static_cast<int>(moments.cols());
  task.Tolerance = 1e-12; // the covariances are smaller than the moments by (fwhm/size)^2
  const auto solver = MakeSolver(SolverMethod::Automatic, task, parallel);
  IterationLimits limits;
  limits.Tolerance = task.Tolerance;
  limits.MaximumNumberOfIterations = 20000;
  solver->SetLimits(limits);
  fits.MissedResidual =
    SmoothByHeat(assembler, fwhm, moments, *solver, parallel, progress.Part(0.0, 0.95));
  ForEach(parallel, n,
    [&](Index i)
    {
      const Eigen::RowVector3d mean = moments.row(i).head<3>();
      const auto product = moments.row(i).segment<6>(ProductsBegin);
      Eigen::Matrix3d spread;
      spread << product[0], product[1], product[2], product[1], product[3], product[4], product[2],
        product[4], product[5];
      spread -= mean.transpose() * mean;
      const auto means = moments.row(i).segment(DataBegin, k);
      const auto axes = AxesOfPlane(normalOf(i, means + middle));
      const Eigen::Matrix2d inverse = InvertSpread(axes.transpose() * spread * axes);
      for (Eigen::Index c = 0; c < k; ++c)
      {
        const Eigen::RowVector3d common =
          moments.row(i).segment<3>(DataBegin + k + 3 * c) - means[c] * mean;
        const Eigen::RowVector3d slope = common * axes * inverse * axes.transpose();
        fits.Slopes.row(i).segment<3>(3 * c) = slope;
        fits.Constants(i, c) = middle[c] + means[c] + slope.dot(x.row(i) - mean);
      }
    });
  progress.Report(1.0);
  return fits;
}

} // namespace SurfaceDiffusion
