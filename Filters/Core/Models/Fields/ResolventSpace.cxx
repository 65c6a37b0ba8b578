// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Fields/ResolventSpace.h"

#include "Core/Foundation/ColumnSums.h"
#include "Core/Foundation/SymmetricModes.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// A space is compared with that of so many steps before.
constexpr int Stride = 4;

/// What is left of a vector by round-off is no direction.
constexpr double LeastDirection = 1e-13;

/// The integrals of a(i, k) b(i, k).
std::vector<double> Products(
  const TriangleMesh& mesh, const Values& a, const Values& b, const ParallelFor& parallel)
{
  std::vector<double> products(static_cast<std::size_t>(a.cols()));
  SumColumns(
    parallel, mesh.NumberOfVertices(), a.cols(),
    [&](Index i, Eigen::Index k) { return mesh.ControlAreas()[i] * a(i, k) * b(i, k); },
    products.data());
  return products;
}

} // namespace

ResolventSpace::ResolventSpace(
  const TriangleMesh& mesh, double step, Values u, const ParallelFor& parallel)
  : Mesh(mesh)
  , Parallel(parallel)
  , Step(step)
  , Columns(static_cast<std::size_t>(u.cols()))
{
  const std::vector<double> squares = Products(mesh, u, u, parallel);
  for (std::size_t k = 0; k < squares.size(); ++k)
  {
    this->Columns[k].Norm = std::sqrt(squares[k]);
    u.col(static_cast<Eigen::Index>(k)) /= squares[k] > 0.0 ? this->Columns[k].Norm : 1.0;
  }
  this->Basis.push_back(std::move(u));
}

/// One step of the recurrence for all columns.
void ResolventSpace::Extend(const Resolvent& resolvent, const ProgressMonitor& progress)
{
  const Values& last = this->Basis.back();
  Values w = last;
  resolvent(w, progress);
  const std::vector<double> diagonal = Products(this->Mesh, w, last, this->Parallel);
  const bool isFirst = this->Basis.size() == 1;
  const Values& before = this->Basis[this->Basis.size() - (isFirst ? 1 : 2)];
  std::vector<double> above(this->Columns.size(), 0.0);
  for (std::size_t k = 0; k < above.size() && !isFirst; ++k)
  {
    above[k] = this->Columns[k].Below.back();
  }
  const auto columns = w.cols();
  ForEach(this->Parallel, this->Mesh.NumberOfVertices(),
    [&](Index i)
    {
      for (Eigen::Index k = 0; k < columns; ++k)
      {
        const auto number = static_cast<std::size_t>(k);
        w(i, k) -= diagonal[number] * last(i, k) + above[number] * before(i, k);
      }
    });
  std::vector<double> factors = Products(this->Mesh, w, w, this->Parallel);
  for (std::size_t k = 0; k < factors.size(); ++k)
  {
    const double below = std::sqrt(factors[k]);
    this->Columns[k].Diagonal.push_back(diagonal[k]);
    this->Columns[k].Below.push_back(below > LeastDirection ? below : 0.0);
    factors[k] = below > LeastDirection ? 1.0 / below : 0.0;
  }
  ForEach(this->Parallel, this->Mesh.NumberOfVertices(),
    [&](Index i)
    {
      for (Eigen::Index k = 0; k < columns; ++k)
      {
        w(i, k) *= factors[static_cast<std::size_t>(k)];
      }
    });
  this->Basis.push_back(std::move(w));
}

/// Those of f(L) u in the basis of the first steps, over |u|.
Vector ResolventSpace::Coefficients(
  const Recurrence& column, const Function& f, std::size_t size) const
{
  const auto end = std::find(column.Below.begin(), column.Below.end(), 0.0);
  const auto ended = static_cast<std::size_t>(end - column.Below.begin()) + 1;
  const auto m = static_cast<Eigen::Index>(std::min(size, ended));
  const SymmetricModes ritz(Eigen::Map<const Vector>(column.Diagonal.data(), m),
    Eigen::Map<const Vector>(column.Below.data(), m - 1));
  Vector values(m);
  for (Eigen::Index j = 0; j < m; ++j)
  {
    constexpr double least =
      1e-12; // no resolvent of a mesh has smaller eigenvalues but by round-off
    const double y = std::clamp(ritz.Eigenvalues[j], least, 1.0);
    values[j] = f((1.0 / y - 1.0) / this->Step) * ritz.Vectors(0, j);
  }
  Vector all = Vector::Zero(static_cast<Eigen::Index>(size));
  all.head(m) = ritz.Vectors * values;
  return all;
}

/// The largest relative difference from the space of Stride fewer steps.
double ResolventSpace::Change(const Function& f, std::vector<Vector>& coefficients) const
{
  double largest = 0.0;
  coefficients.clear();
  for (const Recurrence& column : this->Columns)
  {
    const std::size_t size = column.Diagonal.size();
    Vector found = this->Coefficients(column, f, size);
    Vector change = found;
    change.head(static_cast<Eigen::Index>(size) - Stride) -=
      this->Coefficients(column, f, size - Stride);
    largest = std::max(largest, column.Norm > 0.0 ? change.norm() / found.norm() : 0.0);
    coefficients.push_back(column.Norm * found);
  }
  return largest;
}

SolveReport ResolventSpace::Apply(const Function& f, const Resolvent& resolvent,
  const IterationLimits& limits, Values& result, const ProgressMonitor& progress)
{
  SolveReport report;
  std::vector<Vector> coefficients;
  const auto size = [this] { return static_cast<int>(this->Basis.size()) - 1; };
  report.Residual = size() > 2 * Stride ? this->Change(f, coefficients) : 1.0;
  const int most = limits.MaximumNumberOfIterations - Stride;
  while (report.Residual > limits.Tolerance && size() <= most)
  {
    for (int step = 0; step < Stride; ++step)
    {
      this->Extend(resolvent, progress.Part(0.0, 0.0));
    }
    report.Residual = size() >= 2 * Stride ? this->Change(f, coefficients) : 1.0;
  }
  report.Iterations = size();
  report.Converged = report.Residual <= limits.Tolerance;
  if (report.Converged)
  {
    const Eigen::Index columns = this->Basis.front().cols();
    result.resize(this->Basis.front().rows(), columns);
    ForEach(this->Parallel, this->Mesh.NumberOfVertices(),
      [&](Index i)
      {
        for (Eigen::Index k = 0; k < columns; ++k)
        {
          const Vector& c = coefficients[static_cast<std::size_t>(k)];
          double sum = 0.0;
          for (Eigen::Index j = 0; j < c.size(); ++j)
          {
            sum += c[j] * this->Basis[static_cast<std::size_t>(j)](i, k);
          }
          result(i, k) = sum;
        }
      });
  }
  return report;
}

} // namespace SurfaceDiffusion
