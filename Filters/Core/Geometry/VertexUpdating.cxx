// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/VertexUpdating.h"

#include "Core/Operators/CotanWeights.h"
#include "Core/Solvers/ConjugateGradients.h"
#include "Core/Solvers/SolverChoice.h"

#include <Eigen/Dense>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

using Row3 = Eigen::RowVector3d;

/// N of UpdateVerticesFromNormals() in triangle t. n: its normal.
Row3 TargetNormal(
  const TriangleMesh& mesh, Index t, const Row3& n, const PointData& before, const Values& after)
{
  constexpr double noticeable = 0.001; // as a square, of three unit vectors together
  Eigen::Matrix3d old;
  Eigen::Matrix3d now;
  bool isKnown = true;
  for (int a = 0; a < 3; ++a)
  {
    const Index i = mesh.TriangleVertices()(t, a);
    old.row(a) = before.Start.row(i);
    now.row(a) = after.row(i);
    isKnown = isKnown && !before.Missing[i];
    // The orientation of triangles and the signs of lines do not matter.
    old.row(a) *= old.row(a).dot(n) < 0.0 ? -1.0 : 1.0;
    now.row(a) *= now.row(a).dot(old.row(a)) < 0.0 ? -1.0 : 1.0;
  }
  const Row3 oldMean = old.colwise().mean();
  const Row3 mean = now.colwise().mean();
  const double change = (now - old).squaredNorm();
  if (!(change > 0.0))
  {
    return n; // also where a vector was missing
  }
  const double kept = std::max(0.0, 1.0 - change / noticeable);
  const double rest = isKnown ? kept * kept : 0.0;
  const Row3 from = oldMean.stableNormalized();
  const Row3 to = mean.stableNormalized();
  // The smallest rotation that takes one mean to the other, of the rest
  const Row3 axis = from.cross(to);
  const Row3 apart = n - from;
  const Row3 turned =
    apart + axis.cross(apart) + axis.cross(axis.cross(apart)) / std::max(1.0 + from.dot(to), 1e-12);
  return (to + rest * turned).stableNormalized();
}

/// The matrix of the fit, K_N + M/range^2, applied without being stored. Its 3 x 3 diagonal blocks
/// precondition the conjugate gradients.
class NormalFit : public SystemDefaults
{
public:
  static constexpr bool IsCoupled = true;

  /// normals: per triangle.
  NormalFit(
    const TriangleMesh& mesh, const Points& normals, double range, const ParallelFor& parallel)
    : Mesh(mesh)
    , Parallel(parallel)
    , Coefficients(CotanWeights(mesh, parallel))
    , Normals(normals)
    , Pull(mesh.ControlAreas() / (range * range))
    , InverseBlocks(mesh.NumberOfVertices())
  {
    ForEach(parallel, mesh.NumberOfVertices(),
      [&](Index i)
      {
        Eigen::Matrix3d block = this->Pull[i] * Eigen::Matrix3d::Identity();
        this->ForEachCorner(i,
          [&](Index t, int, int a, int b)
          {
            const Row3 n = this->Normals.row(t);
            block += (this->Coefficients(t, a) + this->Coefficients(t, b)) * n.transpose() * n;
          });
        this->InverseBlocks[i] = block.inverse();
      });
  }

  template <int K>
  void MultiplyRows(const Values& x, Values& y, Index begin, Index end) const
  {
    for (Index i = begin; i < end; ++i)
    {
      y.row(i) = this->Product(i, x, 1.0);
    }
  }
  double Scale(Index i, int c, const double* r) const
  {
    const Eigen::Matrix3d& block = this->InverseBlocks[i];
    return r[0] * block(0, c) + r[1] * block(1, c) + r[2] * block(2, c);
  }

  /// x with (K_N + M/range^2) x = -K_N start, from x = 0. The residual is relative to that of x =
  /// 0. factorize: whether a factorisation follows if conjugate gradients do not converge.
  Values Solve(const Values& start, const IterationLimits& limits, bool factorize,
    SolveReport& report, const ProgressMonitor& progress) const
  {
    const Index n = this->Mesh.NumberOfVertices();
    Values x = Values::Zero(n, 3);
    Values residual(n, 3);
    ConjugateGradientWork work;
    work.Resize(n, 3, 1);
    const double square = Sum(this->Parallel, n,
      [&](Index i)
      {
        residual.row(i) = -this->Product(i, start, 0.0);
        return (residual.row(i) * this->InverseBlocks[i]).dot(residual.row(i));
      });
    work.Reference[0] = square > 0.0 ? square : 1.0;
    const Values b = factorize ? residual : Values();
    report = ConjugateGradients<3, NormalFit>(*this, residual, work, this->Parallel)
               .Solve(x, limits, progress.Part(0.0, factorize ? 0.5 : 1.0));
    if (!report.Converged && factorize && n <= LargestFactor)
    {
      this->SolveDirectly(b, x, limits, report, progress.Part(0.5, 1.0));
    }
    RequireAnswer(report, limits);
    return x;
  }

private:
  /// Replaces x by the solution for b from a factorisation, if it comes closer.
  void SolveDirectly(const Values& b, Values& x, const IterationLimits& limits, SolveReport& report,
    const ProgressMonitor& progress) const
  {
    const SparseMatrix matrix = this->Matrix();
    const std::unique_ptr<LinearSolver> solver = MakeCholeskySolver(this->Parallel);
    solver->SetLimits(limits);
    try
    {
      solver->SetMatrix(matrix, progress.Part(0.0, 0.9));
      const Values load = Eigen::Map<const Values>(b.data(), b.size(), 1);
      Values direct(load.rows(), 1);
      const SolveReport other = solver->Solve(load, direct, progress.Part(0.9, 1.0));
      if (other.Residual < report.Residual)
      {
        x = Eigen::Map<const Values>(direct.data(), x.rows(), 3);
        report.Residual = other.Residual;
        report.Converged = other.Converged;
      }
    }
    catch (const std::runtime_error&)
    {
      // It cannot be factorised: the other answer stays.
    }
    report.IsFinal = true;
  }

  /// K_N + M/range^2, three rows per vertex.
  SparseMatrix Matrix() const
  {
    const Triangles& corners = this->Mesh.TriangleVertices();
    std::vector<Eigen::Triplet<double, Index>> entries;
    const auto add = [&](Index i, Index j, const Eigen::Matrix3d& block)
    {
      for (int k = 0; k < 3; ++k)
      {
        for (int l = 0; l < 3; ++l)
        {
          entries.emplace_back(3 * i + k, 3 * j + l, block(k, l));
        }
      }
    };
    for (Index i = 0; i < this->Mesh.NumberOfVertices(); ++i)
    {
      add(i, i, this->Pull[i] * Eigen::Matrix3d::Identity());
      this->ForEachCorner(i,
        [&](Index t, int, int next, int last)
        {
          const Row3 n = this->Normals.row(t);
          const Eigen::Matrix3d onto = n.transpose() * n;
          add(i, i, (this->Coefficients(t, last) + this->Coefficients(t, next)) * onto);
          add(i, corners(t, next), -this->Coefficients(t, last) * onto);
          add(i, corners(t, last), -this->Coefficients(t, next) * onto);
        });
    }
    const Index size = 3 * this->Mesh.NumberOfVertices();
    SparseMatrix matrix(size, size);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
  }

  /// Row i of (K_N + pull M/range^2) x.
  Row3 Product(Index i, const Values& x, double pull) const
  {
    const Triangles& corners = this->Mesh.TriangleVertices();
    Row3 sum = (pull * this->Pull[i]) * x.row(i);
    this->ForEachCorner(i,
      [&](Index t, int corner, int next, int last)
      {
        const Row3 n = this->Normals.row(t);
        const Row3 own = x.row(corners(t, corner));
        const Row3 difference = this->Coefficients(t, last) * (own - x.row(corners(t, next))) +
          this->Coefficients(t, next) * (own - x.row(corners(t, last)));
        sum += n.dot(difference) * n;
      });
    return sum;
  }

  /// body(t, corner, next corner, last corner) for every triangle around vertex i.
  template <typename Body>
  void ForEachCorner(Index i, const Body& body) const
  {
    const auto& begin = this->Mesh.VertexCornersBegin();
    for (Index c = begin[i]; c < begin[i + 1]; ++c)
    {
      const Index corner = this->Mesh.VertexCorners()[c];
      const int a = corner % 3;
      body(corner / 3, a, (a + 1) % 3, (a + 2) % 3);
    }
  }

  const TriangleMesh& Mesh;
  const ParallelFor& Parallel;
  CornerWeights Coefficients;
  const Points& Normals; ///< per triangle
  Vector Pull;
  std::vector<Eigen::Matrix3d> InverseBlocks;
};

} // namespace

double EnclosedVolume(
  const TriangleMesh& mesh, const Eigen::Ref<const Points>& points, const ParallelFor& parallel)
{
  std::vector<std::pair<Index, Index>> edges, reversed;
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const auto v = mesh.TriangleVertices().row(t);
    for (int a = 0; a < 3; ++a)
    {
      edges.emplace_back(v[a], v[(a + 1) % 3]);
      reversed.emplace_back(v[(a + 1) % 3], v[a]);
    }
  }
  std::sort(edges.begin(), edges.end());
  std::sort(reversed.begin(), reversed.end());
  if (edges.empty() || edges != reversed) // an edge is not passed once in each direction
  {
    return 0.0;
  }
  const Row3 origin = points.row(mesh.InputVertex()[0]); // any; a near one keeps digits
  const auto place = [&](Index t, int a)
  { return Row3(points.row(mesh.InputVertex()[mesh.TriangleVertices()(t, a)]) - origin); };
  return Sum(parallel, mesh.NumberOfTriangles(),
           [&](Index t) { return place(t, 0).dot(place(t, 1).cross(place(t, 2))); }) /
    6.0;
}

Points UpdateVerticesFromNormals(const TriangleMesh& mesh, const Eigen::Ref<const Points>& points,
  const PointData& before, const Values& after, double range, VertexMotion& motion,
  const IterationLimits& limits, bool factorize, const ParallelFor& parallel,
  const ProgressMonitor& progress)
{
  const Index n = mesh.NumberOfVertices();
  Points moved = points;
  motion = VertexMotion();
  if (n == 0)
  {
    return moved;
  }
  // Displacements rather than places, so that a surface far from the origin keeps its digits.
  const Row3 origin = points.row(mesh.InputVertex()[0]);
  const double unit = mesh.LengthUnit();
  Values start(n, 3);
  ForEach(parallel, n,
    [&](Index i) { start.row(i) = (points.row(mesh.InputVertex()[i]) - origin) / unit; });
  Values step = Values::Zero(n, 3);
  if (before.Start != after)
  {
    Points normals(mesh.NumberOfTriangles(), 3);
    ForEach(parallel, mesh.NumberOfTriangles(),
      [&](Index t)
      {
        const auto corner = [&](int a) { return start.row(mesh.TriangleVertices()(t, a)); };
        const Row3 normal = Row3(corner(1) - corner(0)).cross(Row3(corner(2) - corner(0)));
        normals.row(t) = TargetNormal(mesh, t, normal.stableNormalized(), before, after);
      });
    const NormalFit fit(mesh, normals, range / unit, parallel);
    SolveReport report;
    step = fit.Solve(start, limits, factorize, report, progress);
    motion.MissedResidual = report.Converged ? 0.0 : report.Residual;
  }
  for (Index i = 0; i < n; ++i)
  {
    moved.row(mesh.InputVertex()[i]) += unit * step.row(i);
    const double length = unit * step.row(i).norm();
    motion.MaximumDisplacement = std::max(motion.MaximumDisplacement, length);
    motion.MeanDisplacement += mesh.ControlAreas()[i] * length;
  }
  motion.MeanDisplacement /= mesh.ControlAreas().sum();
  motion.VolumeBefore = EnclosedVolume(mesh, points, parallel);
  motion.VolumeAfter = EnclosedVolume(mesh, moved, parallel);
  return moved;
}

} // namespace SurfaceDiffusion
