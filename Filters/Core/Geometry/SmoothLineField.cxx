// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/SmoothLineField.h"

#include "Core/Foundation/Random.h"
#include "Core/Operators/CotanWeights.h"
#include "Core/Surface/MedialMesh.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

/// exp(2 i angle of v) for v of any length; zero for zero.
Eigen::Vector2d Square(double x, double y)
{
  const double square = x * x + y * y;
  return square > 0.0 ? Eigen::Vector2d((x * x - y * y) / square, 2.0 * x * y / square)
                      : Eigen::Vector2d(Eigen::Vector2d::Zero());
}

void SolveWith(LinearSolver& solver, const Values& b, Values& x, const ProgressMonitor& progress)
{
  const SolveReport report = solver.Solve(b, x, progress);
  if (!report.Converged)
  {
    throw NotConverged(report);
  }
}

/// One step towards the lowest mode of A x = lambda M x (A. Knyazev, SIAM J. Sci. Comput. 23,
/// 2001): column 0 of `basis` becomes the best combination of the three columns, of unit M-norm,
/// column 2 the share of the last two in it. image = A basis throughout. Returns its lambda.
double Improve(Eigen::Ref<Eigen::Matrix<double, Eigen::Dynamic, 3>> basis,
  Eigen::Ref<Eigen::Matrix<double, Eigen::Dynamic, 3>> image, const Eigen::Ref<const Vector>& mass)
{
  // Gram-Schmidt, twice for the sake of round-off; what depends on the others is left out.
  int rank = 0;
  for (int k = 0; k < 3; ++k)
  {
    const auto norm = [&](int j)
    { return std::sqrt(basis.col(j).dot(mass.cwiseProduct(basis.col(j)))); };
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
    if (after > 1e-6 * before)
    {
      basis.col(rank) = basis.col(k) / after;
      image.col(rank) = image.col(k) / after;
      ++rank;
    }
  }
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

} // namespace

Eigen::Matrix2d LineFieldOperator::Transport::Matrix() const
{
  Eigen::Matrix2d matrix;
  matrix << this->Real, -this->Imaginary, this->Imaginary, this->Real;
  if (this->Reflect)
  {
    matrix.col(1) *= -1.0;
  }
  return matrix;
}

LineFieldOperator::LineFieldOperator(std::shared_ptr<const TriangleMesh> mesh)
  : Surface(std::move(mesh))
  , Medial(MedialMesh(*this->Surface).Edges())
{
  const Triangles& corners = this->Surface->TriangleVertices();
  const Triangles& edges = this->Medial->TriangleVertices();
  const Index triangleCount = this->Surface->NumberOfTriangles();
  const Index edgeCount = this->Medial->NumberOfVertices();

  // An edge's axes are those of its first triangle, turned so that the edge is the first axis. Of
  // a triangle that runs along the edge the same way as the first one, the orientation differs.
  this->Transports.resize(3 * static_cast<std::size_t>(triangleCount));
  std::vector<signed char> firstWay(edgeCount, 0);
  for (Index t = 0; t < triangleCount; ++t)
  {
    const TriangleMesh::Shape& s = this->Surface->Shapes()[t];
    const Eigen::Vector2d along[3] = { Square(s.X - s.Length, s.Y), Square(s.X, s.Y),
      Square(s.Length, 0.0) };
    for (int a = 0; a < 3; ++a)
    {
      const signed char way = corners(t, (a + 1) % 3) < corners(t, (a + 2) % 3) ? 1 : -1;
      signed char& first = firstWay[edges(t, a)];
      this->Transports[3 * t + a] = { along[a][0], along[a][1], first == way };
      first = first == 0 ? way : first;
    }
  }

  const CornerWeights c = CotanWeights(*this->Surface);
  std::vector<Eigen::Triplet<double, Index>> entries;
  entries.reserve(36 * static_cast<std::size_t>(triangleCount));
  this->M = Vector::Zero(2 * edgeCount);
  for (Index t = 0; t < triangleCount; ++t)
  {
    for (int a = 0; a < 3; ++a)
    {
      const int b = (a + 1) % 3;
      const double weight = 4.0 * c(t, (a + 2) % 3);
      const Index i = 2 * edges(t, a);
      const Index j = 2 * edges(t, b);
      const Eigen::Matrix2d coupling = -weight * this->Transports[3 * t + a].Matrix().transpose() *
        this->Transports[3 * t + b].Matrix();
      for (int k = 0; k < 2; ++k)
      {
        entries.emplace_back(i + k, i + k, weight);
        entries.emplace_back(j + k, j + k, weight);
        for (int l = 0; l < 2; ++l)
        {
          entries.emplace_back(i + k, j + l, coupling(k, l));
          entries.emplace_back(j + l, i + k, coupling(k, l));
        }
      }
      this->M.segment(i, 2).array() += this->Surface->Shapes()[t].Area() / 3.0;
    }
  }
  this->K.resize(2 * edgeCount, 2 * edgeCount);
  this->K.setFromTriplets(entries.begin(), entries.end());
}

void LineFieldOperator::Project(const Eigen::Ref<const TangentVectors>& frames,
  const Eigen::Ref<const Vector>& weights, Vector& load, Vector& diagonal) const
{
  load = Vector::Zero(this->M.size());
  diagonal = Vector::Zero(this->M.size());
  for (Index t = 0; t < this->Surface->NumberOfTriangles(); ++t)
  {
    const Eigen::Vector2d line = Square(frames(t, 0), frames(t, 1));
    if (line.isZero(0.0))
    {
      continue;
    }
    const double share = weights[t] * this->Surface->Shapes()[t].Area() / 3.0;
    for (int a = 0; a < 3; ++a)
    {
      const Index i = 2 * this->Medial->TriangleVertices()(t, a);
      load.segment(i, 2) += share * this->Transports[3 * t + a].Matrix().transpose() * line;
      diagonal.segment(i, 2).array() += share;
    }
  }
}

TangentVectors LineFieldOperator::Frames(const Eigen::Ref<const Vector>& z) const
{
  TangentVectors frames(this->Surface->NumberOfTriangles(), 2);
  for (Index t = 0; t < this->Surface->NumberOfTriangles(); ++t)
  {
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    for (int a = 0; a < 3; ++a)
    {
      mean += this->Transports[3 * t + a].Matrix() *
        z.segment(2 * this->Medial->TriangleVertices()(t, a), 2);
    }
    const double angle = 0.5 * std::atan2(mean[1], mean[0]);
    frames.row(t) << std::cos(angle), std::sin(angle);
    frames.row(t) *= mean.isZero(0.0) ? 0.0 : 1.0;
  }
  return frames;
}

TangentVectors SmoothestLineField(const LineFieldOperator& lines,
  const Eigen::Ref<const TangentVectors>& start, const Eigen::Ref<const Vector>& weights,
  LinearSolver& solver, const ProgressMonitor& progress, double* lambda)
{
  const Vector& mass = lines.Mass();
  const auto n = mass.size();
  // Far below the smallest eigenvalue that curvature makes (2 on the unit sphere), and keeps the
  // matrix of a flat surface, where it is 0, definite.
  const double area = 0.5 * mass.sum();
  const double shift = 1e-3 / area;
  SparseMatrix matrix = lines.Stiffness();
  matrix.diagonal() += shift * mass;
  solver.SetMatrix(matrix, progress.Part(0.0, 0.7));

  Vector preferred, diagonal;
  lines.Project(start, weights, preferred, diagonal);
  const double size = preferred.cwiseAbs().maxCoeff();
  const double largest = mass.maxCoeff();
  Values z(n, 1), b(n, 1);
  for (Eigen::Index i = 0; i < n; ++i)
  {
    // Some of everything, so that the smoothest is in it.
    const double random = 2.0 * UniformRandom(0, 0, i) - 1.0;
    b(i, 0) = (size > 0.0 ? preferred[i] / size : 0.0) + 1e-3 * mass[i] / largest * random;
  }
  z = Values::Zero(n, 1);
  SolveWith(solver, b, z, progress.Part(0.7, 0.72));

  // Locally optimal inverse iteration: the best of z, its inverse iterate and the last change.
  Eigen::Matrix<double, Eigen::Dynamic, 3> basis(n, 3), image(n, 3); // image = matrix x basis
  basis.setZero();
  image.setZero();
  basis.col(0) = z;
  image.col(0) = b;
  const std::vector<Index>& components = lines.Edges()->ComponentsBegin();
  std::vector<double> eigenvalues(components.size() - 1, 0.0);
  constexpr int most = 50;
  bool settled = false;
  for (int iteration = 0; iteration < most && !settled; ++iteration)
  {
    b = mass.cwiseProduct(basis.col(0));
    SolveWith(solver, b, z, progress.Part(0.72, 0.72));
    basis.col(1) = z;
    image.col(1) = b;
    settled = true;
    // Every connected component has a smoothest field of its own.
    for (std::size_t c = 0; c < eigenvalues.size(); ++c)
    {
      const Index begin = 2 * components[c];
      const Index count = 2 * components[c + 1] - begin;
      const double next = Improve(basis.middleRows(begin, count), image.middleRows(begin, count),
                            mass.segment(begin, count)) -
        shift;
      settled = settled && std::abs(eigenvalues[c] - next) <= 1e-4 * (next + shift);
      eigenvalues[c] = next;
    }
    progress.Report(0.72 + 0.28 * iteration / most);
  }
  if (lambda)
  {
    *lambda = *std::max_element(eigenvalues.begin(), eigenvalues.end());
  }
  return lines.Frames(basis.col(0));
}

TangentVectors LineFieldFromHints(const LineFieldOperator& lines,
  const Eigen::Ref<const TangentVectors>& hints, const Eigen::Ref<const Vector>& weights,
  LinearSolver& solver, const ProgressMonitor& progress)
{
  Vector load, diagonal;
  lines.Project(hints, weights, load, diagonal);
  SparseMatrix matrix = lines.Stiffness();
  // Where a component has no hint, z = 0 is the answer: keep its matrix definite.
  const double area = 0.5 * lines.Mass().sum();
  matrix.diagonal() += diagonal + 1e-9 / area * lines.Mass();
  solver.SetMatrix(matrix, progress.Part(0.0, 0.8));
  const Values b = load;
  Values z = Values::Zero(b.rows(), 1);
  SolveWith(solver, b, z, progress.Part(0.8, 1.0));
  return lines.Frames(z.col(0));
}

} // namespace SurfaceDiffusion
