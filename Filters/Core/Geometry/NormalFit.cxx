// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/NormalFit.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// The reduction of the squared residual at which conjugate gradients end.
constexpr double ResidualReduction = 1e-10;
constexpr double SmallestWeight = 1e-9;

using Row3 = Eigen::RowVector3d;

/// A symmetric 3 x 3 matrix.
struct Symmetric
{
  double XX = 0.0, XY = 0.0, XZ = 0.0, YY = 0.0, YZ = 0.0, ZZ = 0.0;

  /// Add s n n^T.
  void AddSquare(double s, const Row3& n)
  {
    this->XX += s * n[0] * n[0];
    this->XY += s * n[0] * n[1];
    this->XZ += s * n[0] * n[2];
    this->YY += s * n[1] * n[1];
    this->YZ += s * n[1] * n[2];
    this->ZZ += s * n[2] * n[2];
  }

  Symmetric Inverse() const
  {
    Symmetric c; // cofactors
    c.XX = this->YY * this->ZZ - this->YZ * this->YZ;
    c.XY = this->XZ * this->YZ - this->XY * this->ZZ;
    c.XZ = this->XY * this->YZ - this->XZ * this->YY;
    c.YY = this->XX * this->ZZ - this->XZ * this->XZ;
    c.YZ = this->XY * this->XZ - this->XX * this->YZ;
    c.ZZ = this->XX * this->YY - this->XY * this->XY;
    const double scale = 1.0 / (this->XX * c.XX + this->XY * c.XY + this->XZ * c.XZ);
    return { scale * c.XX, scale * c.XY, scale * c.XZ, scale * c.YY, scale * c.YZ, scale * c.ZZ };
  }

  Row3 operator*(const Row3& r) const
  {
    return { this->XX * r[0] + this->XY * r[1] + this->XZ * r[2],
      this->XY * r[0] + this->YY * r[1] + this->YZ * r[2],
      this->XZ * r[0] + this->YZ * r[1] + this->ZZ * r[2] };
  }
};

/// The symmetric positive definite system of FitToNormals().
class FitSystem
{
public:
  FitSystem(const TriangleMesh& mesh, const Points& normals, const std::vector<char>& fixed,
    const NormalFitSettings& settings, const ParallelFor& parallel)
    : Mesh(mesh)
    , Normals(normals)
    , Fixed(fixed)
    , Settings(settings)
    , Parallel(parallel)
    , Data(static_cast<std::size_t>(mesh.NumberOfVertices()))
    , Inverses(settings.MaximumNumberOfIterations > 1 ? Data.size() : 0)
    , Sums(static_cast<std::size_t>(mesh.NumberOfTriangles()))
  {
  }

  bool IsFixed(Index i) const { return !this->Fixed.empty() && this->Fixed[i]; }

  /// Find the system at vertex i, its residual at these points, and the first direction. Returns
  /// their product.
  double Begin(
    Index i, const Points& given, const Points& points, Points& residual, Points& direction)
  {
    const Row3 own = points.row(i);
    Row3 normal = Row3::Zero();
    Row3 force = Row3::Zero();
    Symmetric matrix;
    this->ForEachTriangle(i,
      [&](Index t, Index corner)
      {
        const Row3 n = this->Normals.row(t);
        const Row3 others = points.row(this->Mesh.OtherCorner(corner, 1)) +
          points.row(this->Mesh.OtherCorner(corner, 2));
        normal += n;
        matrix.AddSquare(2.0 / 3.0, n);
        force += n.dot(2.0 * own - others) / 3.0 * n;
      });
    normal.normalize(); // which leaves a vector of length 0 as it is
    const Row3 moved = own - given.row(i);
    const Vertex vertex = this->MakeVertex(i, normal, std::abs(normal.dot(moved)));
    this->Data[i] = vertex;
    matrix.AddSquare(vertex.Along, normal);
    matrix.XX += vertex.Across;
    matrix.YY += vertex.Across;
    matrix.ZZ += vertex.Across;
    const Symmetric inverse = matrix.Inverse();
    if (!this->Inverses.empty())
    {
      this->Inverses[i] = inverse;
    }
    const Row3 r = this->IsFixed(i) ? Row3(Row3::Zero()) : Row3(-vertex.Apply(moved) - force);
    const Row3 d = inverse * r;
    residual.row(i) = r;
    direction.row(i) = d;
    return r.dot(d);
  }

  /// The products of the matrix and x. Returns their product with x.
  double Multiply(const Points& x, Points& product)
  {
    ForEach(this->Parallel, this->Mesh.NumberOfTriangles(),
      [&](Index t)
      {
        const auto corners = this->Mesh.TriangleVertices().row(t);
        const Row3 sum = x.row(corners[0]) + x.row(corners[1]) + x.row(corners[2]);
        this->Sums[t] = Row3(this->Normals.row(t)).dot(sum) / 3.0;
      });
    return Sum(this->Parallel, this->Mesh.NumberOfVertices(),
      [&](Index i)
      {
        const Row3 own = x.row(i);
        Row3 row = Row3::Zero();
        if (!this->IsFixed(i))
        {
          row = this->Data[i].Apply(own);
          this->ForEachTriangle(i,
            [&](Index t, Index)
            {
              const Row3 n = this->Normals.row(t);
              row += (n.dot(own) - this->Sums[t]) * n;
            });
        }
        product.row(i) = row;
        return own.dot(row);
      });
  }

  Row3 Precondition(const Row3& r, Index i) const { return this->Inverses[i] * r; }

private:
  /// The part of the given point.
  struct Vertex
  {
    Row3 Normal;
    double Along; ///< less Across
    double Across;

    Row3 Apply(const Row3& x) const
    {
      return this->Across * x + this->Along * this->Normal.dot(x) * this->Normal;
    }
  };

  /// moved: the distance along the normal.
  Vertex MakeVertex(Index i, const Row3& normal, double moved) const
  {
    const double outlier = this->Settings.OutlierDistance;
    const bool hasFactors = this->Settings.FidelityFactors.size() > 0;
    const double full =
      this->Settings.Fidelity * (hasFactors ? this->Settings.FidelityFactors[i] : 1.0);
    const double fidelity = outlier > 0.0 && moved > outlier ? full * outlier / moved : full;
    const double across = std::max(full, this->Settings.TangentialFidelity);
    return { normal, fidelity + SmallestWeight - across, across };
  }

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
  const NormalFitSettings& Settings;
  const ParallelFor& Parallel;
  std::vector<Vertex> Data;
  std::vector<Symmetric> Inverses; ///< no entries for one iteration
  std::vector<double> Sums; ///< per triangle: of n . x over its corners, over 3
};

} // namespace

void FitToNormals(const TriangleMesh& mesh, const Points& given, const Points& normals,
  const std::vector<char>& fixed, const NormalFitSettings& settings, Points& points,
  const ParallelFor& parallel, const ProgressMonitor& progress)
{
  const Index count = mesh.NumberOfVertices();
  FitSystem system(mesh, normals, fixed, settings, parallel);
  Points residual(count, 3), direction(count, 3), product(count, 3);
  Points preconditioned(settings.MaximumNumberOfIterations > 1 ? count : 0, 3);
  double rz = Sum(
    parallel, count, [&](Index i) { return system.Begin(i, given, points, residual, direction); });
  const double target = ResidualReduction * rz;
  for (int step = 0; step < settings.MaximumNumberOfIterations && rz > target; ++step)
  {
    progress.Report(static_cast<double>(step) / settings.MaximumNumberOfIterations);
    const double curvature = system.Multiply(direction, product);
    if (!(curvature > 0.0))
    {
      break;
    }
    const double length = rz / curvature;
    ForEach(parallel, count, [&](Index i) { points.row(i) += length * direction.row(i); });
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
}

} // namespace SurfaceDiffusion
