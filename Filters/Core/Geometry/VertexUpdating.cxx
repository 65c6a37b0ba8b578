// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/VertexUpdating.h"

#include "Core/Operators/CotanWeights.h"

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

using Row3 = Eigen::RowVector3d;

/// The matrix of the fit, K_N + M/range^2, applied without being stored, and the conjugate
/// gradients that solve with it; the preconditioner is its 3 x 3 diagonal blocks.
class NormalFit
{
public:
  NormalFit(
    const TriangleMesh& mesh, const Values& normals, double range, const ParallelFor& parallel)
    : Mesh(mesh)
    , Parallel(parallel)
    , Coefficients(CotanWeights(mesh, parallel))
    , Normals(mesh.NumberOfTriangles(), 3)
    , Pull(mesh.ControlAreas() / (range * range))
    , InverseBlocks(mesh.NumberOfVertices())
  {
    ForEach(parallel, mesh.NumberOfTriangles(),
      [&](Index t)
      {
        Eigen::Matrix3d tensor = Eigen::Matrix3d::Zero();
        for (int a = 0; a < 3; ++a)
        {
          const Row3 u = normals.row(mesh.TriangleVertices()(t, a));
          tensor += u.transpose() * u; // no sign: the orientation of triangles does not matter
        }
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
        axes.computeDirect(tensor);
        this->Normals.row(t) = axes.eigenvectors().col(2).transpose();
      });
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

  /// y = (K_N + pull M/range^2) x
  void Multiply(const Points& x, Points& y, double pull) const
  {
    const Triangles& corners = this->Mesh.TriangleVertices();
    ForEach(this->Parallel, this->Mesh.NumberOfVertices(),
      [&](Index i)
      {
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
        y.row(i) = sum;
      });
  }

  /// x with (K_N + M/range^2) x = b, from x = 0.
  Points Solve(
    const Points& b, const IterationLimits& limits, const ProgressMonitor& progress) const
  {
    const Index n = this->Mesh.NumberOfVertices();
    Points x = Points::Zero(n, 3), r = b, z(n, 3), p = Points::Zero(n, 3), q(n, 3);
    SolveReport report;
    double start = 0.0;
    double rho = 0.0;
    while (true)
    {
      const double previous = rho;
      rho = Sum(this->Parallel, n,
        [&](Index i)
        {
          z.row(i) = r.row(i) * this->InverseBlocks[i];
          return z.row(i).dot(r.row(i));
        });
      start = report.Iterations == 0 ? rho : start;
      report.Residual = start > 0.0 ? std::sqrt(rho / start) : 0.0;
      if (report.Residual <= limits.Tolerance)
      {
        return x;
      }
      if (report.Iterations == limits.MaximumNumberOfIterations)
      {
        throw NotConverged(report);
      }
      const double beta = previous > 0.0 ? rho / previous : 0.0;
      ForEach(this->Parallel, n, [&](Index i) { p.row(i) = z.row(i) + beta * p.row(i); });
      this->Multiply(p, q, 1.0);
      const double alpha =
        rho / Sum(this->Parallel, n, [&](Index i) { return p.row(i).dot(q.row(i)); });
      ForEach(this->Parallel, n,
        [&](Index i)
        {
          x.row(i) += alpha * p.row(i);
          r.row(i) -= alpha * q.row(i);
        });
      ++report.Iterations;
      progress.Report(
        std::min(0.99, std::max(0.0, std::log(report.Residual) / std::log(limits.Tolerance))));
    }
  }

private:
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
  Points Normals; ///< per triangle
  Vector Pull;
  std::vector<Eigen::Matrix3d> InverseBlocks;
};

/// Enclosed volume; 0 where an edge is not passed once in each direction.
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
  if (edges != reversed)
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

} // namespace

Points UpdateVerticesFromNormals(const TriangleMesh& mesh, const Eigen::Ref<const Points>& points,
  const Values& normals, double range, VertexMotion& motion, const IterationLimits& limits,
  const ParallelFor& parallel, const ProgressMonitor& progress)
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
  Points start(n, 3), load(n, 3);
  ForEach(parallel, n,
    [&](Index i) { start.row(i) = (points.row(mesh.InputVertex()[i]) - origin) / unit; });
  const NormalFit fit(mesh, normals, range / unit, parallel);
  fit.Multiply(start, load, 0.0);
  const Points step = fit.Solve(-load, limits, progress);
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
