// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/SmoothLineField.h"

#include "Core/Foundation/Random.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

/// Returns the relative residual if it missed the tolerance, otherwise 0.
double SolveWith(LinearSolver& solver, const Values& b, Values& x, const ProgressMonitor& progress)
{
  const SolveReport report = solver.Solve(b, x, progress);
  RequireAnswer(report, solver.GetLimits());
  return report.Converged ? 0.0 : report.Residual;
}

using Columns3 = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// Makes the columns of `basis` orthonormal in the inner product of `mass`, by Gram-Schmidt, twice
/// because of round-off. Dependent columns are dropped. image = A basis throughout. Returns the
/// rank.
int Orthonormalise(
  Eigen::Ref<Columns3> basis, Eigen::Ref<Columns3> image, const Eigen::Ref<const Vector>& mass)
{
  constexpr double independent = 1e-6; // of a column's norm must remain
  const auto norm = [&](int j)
  { return std::sqrt(basis.col(j).dot(mass.cwiseProduct(basis.col(j)))); };
  int rank = 0;
  for (int k = 0; k < 3; ++k)
  {
    const double before = norm(k);
    for (int pass = 0; pass < 2; ++pass)
    {
      for (int j = 0; j < rank; ++j)
      {
        const double share = basis.col(j).dot(mass.cwiseProduct(basis.col(k)));
        basis.col(k) -= share * basis.col(j);
        image.col(k) -= share * image.col(j);
      }
    }
    const double after = norm(k);
    if (after > independent * before)
    {
      basis.col(rank) = basis.col(k) / after;
      image.col(rank) = image.col(k) / after;
      ++rank;
    }
  }
  return rank;
}

/// One step towards the lowest mode of A x = lambda M x (A. Knyazev, SIAM J. Sci. Comput. 23,
/// 2001): column 0 of `basis` becomes the combination of the three columns with the smallest
/// Rayleigh quotient, of unit M-norm, and column 2 the share of the last two in it. image = A basis
/// throughout. Returns the Rayleigh quotient.
double Improve(
  Eigen::Ref<Columns3> basis, Eigen::Ref<Columns3> image, const Eigen::Ref<const Vector>& mass)
{
  const int rank = Orthonormalise(basis, image, mass);
  const Eigen::MatrixXd reduced = basis.leftCols(rank).transpose() * image.leftCols(rank);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(reduced);
  const Vector best = modes.eigenvectors().col(0);
  const Vector change = basis.middleCols(1, rank - 1) * best.tail(rank - 1);
  const Vector imageOfChange = image.middleCols(1, rank - 1) * best.tail(rank - 1);
  basis.col(0) = best[0] * basis.col(0) + change;
  image.col(0) = best[0] * image.col(0) + imageOfChange;
  basis.col(2) = change;
  image.col(2) = imageOfChange;
  return modes.eigenvalues()[0];
}

/// The start of the inverse iteration: b = M z, with some of every mode.
Values StartLoad(const LineFieldOperator& laplacian, const Eigen::Ref<const TangentVectors>& start,
  const Eigen::Ref<const Vector>& weights)
{
  const Vector& mass = laplacian.Mass();
  Vector preferred, diagonal;
  laplacian.Project(start, weights, preferred, diagonal);
  const double size = preferred.cwiseAbs().maxCoeff();
  const double largest = mass.maxCoeff();
  constexpr double noise = 1e-3;
  Values b(mass.size(), 1);
  for (Eigen::Index i = 0; i < mass.size(); ++i)
  {
    const double random = 2.0 * UniformRandom(0, 0, i) - 1.0;
    b(i, 0) = (size > 0.0 ? preferred[i] / size : 0.0) + noise * mass[i] / largest * random;
  }
  return b;
}

/// The combination of the iterate, its inverse iterate and its last change with the smallest
/// Rayleigh quotient, on each connected component.
class InverseIteration
{
public:
  InverseIteration(
    const LineFieldOperator& laplacian, double shift, const Values& z, const Values& b)
    : Mass(laplacian.Mass())
    , Shift(shift)
    , Components(laplacian.Edges()->ComponentsBegin())
    , Basis(Columns3::Zero(z.rows(), 3))
    , Image(Columns3::Zero(z.rows(), 3))
    , Eigenvalues(this->Components.size() - 1, 0.0)
  {
    this->Basis.col(0) = z;
    this->Image.col(0) = b;
  }

  /// One step. Updates the report; its UnsettledChange is 0 if the eigenvalues no longer change.
  void Step(
    LinearSolver& solver, Values& z, LineFieldReport& report, const ProgressMonitor& progress)
  {
    const Values b = this->Mass.cwiseProduct(this->Basis.col(0));
    report.MissedResidual = std::max(report.MissedResidual, SolveWith(solver, b, z, progress));
    this->Basis.col(1) = z;
    this->Image.col(1) = b;
    constexpr double tolerance = 1e-4;
    double largest = 0.0;
    for (std::size_t c = 0; c < this->Eigenvalues.size(); ++c)
    {
      const Index begin = 2 * this->Components[c];
      const Index count = 2 * this->Components[c + 1] - begin;
      const double next =
        Improve(this->Basis.middleRows(begin, count), this->Image.middleRows(begin, count),
          this->Mass.segment(begin, count)) -
        this->Shift;
      largest = std::max(largest, std::abs(this->Eigenvalues[c] - next) / (next + this->Shift));
      this->Eigenvalues[c] = next;
    }
    report.UnsettledChange = largest <= tolerance ? 0.0 : largest;
    report.Lambda = *std::max_element(this->Eigenvalues.begin(), this->Eigenvalues.end());
  }

  Vector Mode() const { return this->Basis.col(0); }

private:
  const Vector& Mass;
  const double Shift;
  const std::vector<Index>& Components; ///< of the edges
  Columns3 Basis;
  Columns3 Image; ///< of the basis under K + Shift M
  std::vector<double> Eigenvalues; ///< per component, of K
};

} // namespace

TangentVectors SmoothestLineField(const LineFieldOperator& laplacian,
  const Eigen::Ref<const TangentVectors>& start, const Eigen::Ref<const Vector>& weights,
  LinearSolver& solver, const ProgressMonitor& progress, LineFieldReport* report,
  int maximumNumberOfSteps)
{
  // Far below the smallest eigenvalue that curvature causes (2 on the unit sphere), and keeps the
  // matrix of a flat surface, whose smallest eigenvalue is 0, definite.
  constexpr double relativeShift = 1e-3;
  const Vector& mass = laplacian.Mass();
  const double area = 0.5 * mass.sum();
  const double shift = relativeShift / area;
  SparseMatrix matrix = laplacian.Stiffness();
  matrix.diagonal() += shift * mass;
  solver.SetMatrix(matrix, progress.Part(0.0, 0.7));

  const Values b = StartLoad(laplacian, start, weights);
  Values z = Values::Zero(b.rows(), 1);
  LineFieldReport found;
  found.MissedResidual = SolveWith(solver, b, z, progress.Part(0.7, 0.72));
  InverseIteration iteration(laplacian, shift, z, b);
  for (int i = 0; i < maximumNumberOfSteps && (i == 0 || found.UnsettledChange > 0.0); ++i)
  {
    iteration.Step(solver, z, found, progress.Part(0.72, 0.72));
    progress.Report(0.72 + 0.28 * i / maximumNumberOfSteps);
  }
  if (report)
  {
    *report = found;
  }
  return laplacian.Lines(iteration.Mode());
}

TangentVectors LineFieldFromHints(const LineFieldOperator& laplacian,
  const Eigen::Ref<const TangentVectors>& hints, const Eigen::Ref<const Vector>& weights,
  LinearSolver& solver, const ProgressMonitor& progress, LineFieldReport* report)
{
  constexpr double regularisation = 1e-9; // see the header
  Vector load, diagonal;
  laplacian.Project(hints, weights, load, diagonal);
  SparseMatrix matrix = laplacian.Stiffness();
  const double area = 0.5 * laplacian.Mass().sum();
  matrix.diagonal() += diagonal + regularisation / area * laplacian.Mass();
  solver.SetMatrix(matrix, progress.Part(0.0, 0.8));
  const Values b = load;
  Values z = Values::Zero(b.rows(), 1);
  const double missed = SolveWith(solver, b, z, progress.Part(0.8, 1.0));
  if (report)
  {
    report->MissedResidual = missed;
  }
  return laplacian.Lines(z.col(0));
}

} // namespace SurfaceDiffusion
