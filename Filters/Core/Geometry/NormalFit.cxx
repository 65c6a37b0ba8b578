// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/NormalFit.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// The reduction of the squared residual at which conjugate gradients end.
constexpr double ResidualReduction = 1e-10;
constexpr double SmallestWeight = 1e-9;

using Block = Eigen::Matrix3d;

/// The symmetric positive definite system of FitToNormals().
class FitSystem
{
public:
  FitSystem(const TriangleMesh& mesh, const Points& given, const Points& normals,
    const std::vector<char>& fixed, const NormalFitSettings& settings, const Points& points,
    const ParallelFor& parallel)
    : Mesh(mesh)
    , Normals(normals)
    , Fixed(fixed)
    , Data(static_cast<std::size_t>(mesh.NumberOfVertices()))
    , Inverse(Data.size())
  {
    ForEach(parallel, mesh.NumberOfVertices(),
      [&](Index i)
      {
        Eigen::RowVector3d normal = Eigen::RowVector3d::Zero();
        Block diagonal = Block::Zero();
        this->ForEachTriangle(i,
          [&](Index t, int)
          {
            const Eigen::RowVector3d n = this->Normals.row(t);
            normal += n;
            diagonal += 2.0 / 3.0 * n.transpose() * n;
          });
        normal.normalize(); // which leaves a vector of length 0 as it is
        const double moved = std::abs(normal.dot(points.row(i) - given.row(i)));
        const double outlier = settings.OutlierDistance;
        const bool hasFactors = settings.FidelityFactors.size() > 0;
        const double full = settings.Fidelity * (hasFactors ? settings.FidelityFactors[i] : 1.0);
        const double fidelity = outlier > 0.0 && moved > outlier ? full * outlier / moved : full;
        const double tangential = std::max(full, settings.TangentialFidelity);
        const Block along = normal.transpose() * normal;
        this->Data[i] =
          (fidelity + SmallestWeight) * along + tangential * (Block::Identity() - along);
        this->Inverse[i] = (this->Data[i] + diagonal).inverse();
      });
  }

  bool IsFixed(Index i) const { return !this->Fixed.empty() && this->Fixed[i]; }

  /// Row i of the product of the matrix and x.
  Eigen::RowVector3d Row(const Points& x, Index i) const
  {
    return this->ApplyData(x, i) + this->ApplyNormals(x, i);
  }

  Eigen::RowVector3d ApplyData(const Points& x, Index i) const { return x.row(i) * this->Data[i]; }
  /// The part of the normals, to which only differences of x matter.
  Eigen::RowVector3d ApplyNormals(const Points& x, Index i) const
  {
    const Eigen::RowVector3d own = x.row(i);
    Eigen::RowVector3d row = Eigen::RowVector3d::Zero();
    this->ForEachTriangle(i,
      [&](Index t, Index corner)
      {
        const Eigen::RowVector3d n = this->Normals.row(t);
        const Eigen::RowVector3d others =
          x.row(this->Mesh.OtherCorner(corner, 1)) + x.row(this->Mesh.OtherCorner(corner, 2));
        row += n.dot(2.0 * own - others) / 3.0 * n;
      });
    return row;
  }

  Eigen::RowVector3d Precondition(const Eigen::RowVector3d& r, Index i) const
  {
    return r * this->Inverse[i];
  }

private:
  template <typename Use>
  void ForEachTriangle(Index vertex, const Use& use) const
  {
    const std::vector<Index>& begin = this->Mesh.VertexCornersBegin();
    for (Index k = begin[vertex]; k < begin[vertex + 1]; ++k)
    {
      const Index corner = this->Mesh.VertexCorners()[k];
      use(corner / 3, corner);
    }
  }

  const TriangleMesh& Mesh;
  const Points& Normals;
  const std::vector<char>& Fixed;
  std::vector<Block> Data, Inverse;
};

} // namespace

void FitToNormals(const TriangleMesh& mesh, const Points& given, const Points& normals,
  const std::vector<char>& fixed, const NormalFitSettings& settings, Points& points,
  const ParallelFor& parallel, const ProgressMonitor& progress)
{
  const Index count = mesh.NumberOfVertices();
  const FitSystem system(mesh, given, normals, fixed, settings, points, parallel);
  // In displacements from the given points, which may be far from the origin.
  Points x = points - given;
  Points residual(count, 3), direction(count, 3), product(count, 3);
  Points preconditioned(settings.MaximumNumberOfIterations > 1 ? count : 0, 3);
  double rz = Sum(parallel, count,
    [&](Index i)
    {
      residual.row(i) = -system.ApplyData(x, i) - system.ApplyNormals(points, i);
      if (system.IsFixed(i))
      {
        residual.row(i).setZero();
      }
      direction.row(i) = system.Precondition(residual.row(i), i);
      return residual.row(i).dot(direction.row(i));
    });
  const double target = ResidualReduction * rz;
  for (int step = 0; step < settings.MaximumNumberOfIterations && rz > target; ++step)
  {
    progress.Report(static_cast<double>(step) / settings.MaximumNumberOfIterations);
    const double curvature = Sum(parallel, count,
      [&](Index i)
      {
        product.row(i) = system.IsFixed(i) ? Eigen::RowVector3d(Eigen::RowVector3d::Zero())
                                           : system.Row(direction, i);
        return direction.row(i).dot(product.row(i));
      });
    if (!(curvature > 0.0))
    {
      break;
    }
    const double length = rz / curvature;
    ForEach(parallel, count, [&](Index i) { x.row(i) += length * direction.row(i); });
    if (step + 1 == settings.MaximumNumberOfIterations)
    {
      break;
    }
    const double next = Sum(parallel, count,
      [&](Index i)
      {
        residual.row(i) -= length * product.row(i);
        preconditioned.row(i) = system.Precondition(residual.row(i), i);
        return residual.row(i).dot(preconditioned.row(i));
      });
    ForEach(parallel, count,
      [&](Index i) { direction.row(i) = preconditioned.row(i) + next / rz * direction.row(i); });
    rz = next;
  }
  points = given + x;
}

} // namespace SurfaceDiffusion
