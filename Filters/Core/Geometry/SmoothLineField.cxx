// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/SmoothLineField.h"

#include "Core/Foundation/Random.h"
#include "Core/Foundation/SymmetricModes.h"

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

/// The load b = M z of the start, with so little of every mode that it chooses where the start has
/// nothing.
Values StartLoad(const LineFieldOperator& laplacian, const Eigen::Ref<const TangentVectors>& start,
  const Eigen::Ref<const Vector>& weights)
{
  const Vector& mass = laplacian.Mass();
  Vector preferred, diagonal;
  laplacian.Project(start, weights, preferred, diagonal);
  const double size = preferred.cwiseAbs().maxCoeff();
  const double largest = mass.maxCoeff();
  constexpr double noise = 1e-12;
  Values b(mass.size(), 1);
  for (Eigen::Index i = 0; i < mass.size(); ++i)
  {
    const double random = 2.0 * UniformRandom(0, 0, i) - 1.0;
    b(i, 0) = (size > 0.0 ? preferred[i] / size : 0.0) + noise * mass[i] / largest * random;
  }
  return b;
}

/// The projection of a start onto the modes of K z = lambda M z whose eigenvalue is nearly the
/// smallest, on each connected component, by Lanczos' method for A^-1 = (K + shift M)^-1. Vectors
/// that have lost their orthogonality by round-off do no harm to functions of a matrix (V.
/// Druskin, L. Knizhnerman, Numer. Linear Algebra Appl. 2, 1995).
class LowestModes
{
public:
  /// shifts: per row.
  LowestModes(const LineFieldOperator& laplacian, const Vector& shifts, const Vector& start)
    : Mass(laplacian.Mass())
    , Shifts(shifts)
    , Next(start)
  {
    const std::vector<Index>& edges = laplacian.Edges()->ComponentsBegin();
    for (std::size_t c = 0; c + 1 < edges.size(); ++c)
    {
      Component component;
      component.Begin = 2 * edges[c];
      component.Count = 2 * edges[c + 1] - component.Begin;
      Normalise(this->Next.segment(component.Begin, component.Count), this->MassOf(component));
      this->Components.push_back(component);
    }
  }

  /// One step. Updates the report; its UnsettledChange is 0 if no field changes any more.
  void Step(LinearSolver& solver, LineFieldReport& report, const ProgressMonitor& progress)
  {
    this->Basis.push_back(this->Next);
    const Values b = this->Mass.cwiseProduct(this->Next);
    Values x = Values::Zero(b.rows(), 1);
    report.MissedResidual = std::max(report.MissedResidual, SolveWith(solver, b, x, progress));
    report.UnsettledChange = 0.0;
    report.Lambda = 0.0;
    this->Next = x.col(0);
    for (Component& component : this->Components)
    {
      this->Extend(component);
      const auto [lambda, change] = this->Project(component);
      report.Lambda = std::max(report.Lambda, lambda);
      // Modes decay exponentially away from where they live, and lines have a direction there too.
      constexpr double tolerance = 1e-9;
      if (change > tolerance)
      {
        report.UnsettledChange = std::max(report.UnsettledChange, change);
      }
    }
  }

  Vector Projection() const
  {
    Vector z = Vector::Zero(this->Mass.size());
    for (const Component& component : this->Components)
    {
      for (std::size_t k = 0; k < this->Basis.size(); ++k)
      {
        z.segment(component.Begin, component.Count) +=
          component.Shares[static_cast<Eigen::Index>(k)] *
          this->Basis[k].segment(component.Begin, component.Count);
      }
    }
    return z;
  }

private:
  struct Component
  {
    Index Begin, Count;
    std::vector<double> Diagonal, OffDiagonal; ///< V^T M A^-1 V for the basis V
    Vector Shares; ///< of the basis in the projection
  };

  Eigen::Ref<const Vector> MassOf(const Component& component) const
  {
    return this->Mass.segment(component.Begin, component.Count);
  }

  /// Returns the norm. A vector of less than `least` becomes zero.
  static double Normalise(
    Eigen::Ref<Vector> z, const Eigen::Ref<const Vector>& mass, double least = 0.0)
  {
    const double norm = std::sqrt(z.dot(mass.cwiseProduct(z)));
    if (!(norm > least))
    {
      z.setZero();
      return 0.0;
    }
    z /= norm;
    return norm;
  }

  void Extend(Component& component)
  {
    const auto part = [&](Vector& z) { return z.segment(component.Begin, component.Count); };
    auto next = part(this->Next);
    const auto last = part(this->Basis.back());
    component.Diagonal.push_back(next.dot(this->MassOf(component).cwiseProduct(last)));
    next -= component.Diagonal.back() * last;
    if (this->Basis.size() > 1)
    {
      next -= component.OffDiagonal.back() * part(this->Basis[this->Basis.size() - 2]);
    }
    // What round-off leaves where the basis already spans all that the start reaches
    constexpr double negligible = 1e-13;
    component.OffDiagonal.push_back(
      Normalise(next, this->MassOf(component), negligible * std::abs(component.Diagonal.front())));
  }

  /// Returns the smallest eigenvalue of K and the change of the projection, relative to its norm.
  std::pair<double, double> Project(Component& component) const
  {
    // The eigenvalues of equally smooth fields of a sphere differ by 0.1 % on a coarse mesh.
    constexpr double nearly = 0.005;
    const auto size = static_cast<Eigen::Index>(component.Diagonal.size());
    // Eigen takes entries that are far below 1 for zeros.
    const double unit = component.Diagonal.front() > 0.0 ? component.Diagonal.front() : 1.0;
    const SymmetricModes modes(Eigen::Map<const Vector>(component.Diagonal.data(), size) / unit,
      Eigen::Map<const Vector>(component.OffDiagonal.data(), size - 1) / unit);
    const double largest = modes.Eigenvalues[size - 1]; // of A^-1
    Vector shares = Vector::Zero(size);
    for (Eigen::Index k = 0; k < size; ++k)
    {
      const double value = modes.Eigenvalues[k];
      if (value > 0.0)
      {
        const double distance = (largest / value - 1.0) / nearly;
        shares += std::exp(-0.5 * distance * distance) * modes.Vectors(0, k) * modes.Vectors.col(k);
      }
    }
    Vector difference = shares;
    difference.head(component.Shares.size()) -= component.Shares;
    const double norm = shares.norm();
    const double change = norm > 0.0 ? difference.norm() / norm : 0.0;
    component.Shares = shares;
    const double lambda =
      largest > 0.0 ? 1.0 / (unit * largest) - this->Shifts[component.Begin] : 0.0;
    return { lambda, change };
  }

  const Vector& Mass;
  const Vector& Shifts;
  std::vector<Component> Components;
  std::vector<Vector> Basis; ///< orthonormal on each component in the inner product of the mass
  Vector Next;
};

/// Per row, 1e-3 over the area of its connected component: far below the smallest eigenvalue that
/// curvature causes (2 on the unit sphere), and keeps the matrix of flat components, whose smallest
/// eigenvalue is 0, definite.
Vector Shifts(const LineFieldOperator& laplacian)
{
  constexpr double relative = 1e-3;
  const std::vector<Index>& edges = laplacian.Edges()->ComponentsBegin();
  Vector shifts(laplacian.Mass().size());
  for (std::size_t c = 0; c + 1 < edges.size(); ++c)
  {
    const Index begin = 2 * edges[c];
    const Index count = 2 * edges[c + 1] - begin;
    const double area = 0.5 * laplacian.Mass().segment(begin, count).sum();
    shifts.segment(begin, count).setConstant(relative / area);
  }
  return shifts;
}

} // namespace

TangentVectors SmoothestLineField(const LineFieldOperator& laplacian,
  const Eigen::Ref<const TangentVectors>& start, const Eigen::Ref<const Vector>& weights,
  LinearSolver& solver, const ProgressMonitor& progress, LineFieldReport* report,
  int maximumNumberOfSteps)
{
  const Vector shifts = Shifts(laplacian);
  SparseMatrix matrix = laplacian.Stiffness();
  matrix.diagonal() += shifts.cwiseProduct(laplacian.Mass());
  solver.SetMatrix(matrix, progress.Part(0.0, 0.7));

  const Values b = StartLoad(laplacian, start, weights);
  Values z = Values::Zero(b.rows(), 1);
  LineFieldReport found;
  found.MissedResidual = SolveWith(solver, b, z, progress.Part(0.7, 0.72));
  LowestModes modes(laplacian, shifts, z.col(0));
  for (int i = 0; i < maximumNumberOfSteps && (i == 0 || found.UnsettledChange > 0.0); ++i)
  {
    modes.Step(solver, found, progress.Part(0.72, 0.72));
    constexpr double usual = 20.0; // steps
    progress.Report(0.72 + 0.25 * std::min(1.0, i / usual));
  }
  constexpr double visible = 1e-6; // below it are changes by the tolerance of the solver
  if (found.UnsettledChange < visible)
  {
    found.UnsettledChange = 0.0;
  }
  if (report)
  {
    *report = found;
  }
  return laplacian.Lines(modes.Projection());
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
