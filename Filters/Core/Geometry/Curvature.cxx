// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/Curvature.h"

#include "Core/Foundation/IndexLists.h"
#include "Core/Geometry/HeatRegression.h"
#include "Core/Geometry/OrientedNormals.h"

#include <Eigen/Geometry>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

/// The tangent plane of a vertex.
Eigen::Matrix<double, 3, 2> TangentAxes(const Eigen::Vector3d& normal)
{
  Eigen::Matrix<double, 3, 2> axes;
  axes.col(0) = normal.unitOrthogonal();
  axes.col(1) = normal.cross(axes.col(0));
  return axes;
}

/// Vertices around a vertex, without itself, ascending.
struct Disk
{
  std::vector<Index> Ring; ///< one edge from it
  std::vector<Index> All; ///< at most two edges from it
};

/// The search does not pass vertices of many triangles, such as the middle of a disc that is cut
/// into slices.
void FindDisk(const TriangleMesh& mesh, Index centre, Disk& found)
{
  std::vector<Index>& disk = found.All;
  constexpr Index manyTriangles = 32;
  const auto addNeighbours = [&](Index i)
  {
    for (Index c = mesh.VertexCornersBegin()[i]; c < mesh.VertexCornersBegin()[i + 1]; ++c)
    {
      for (int step = 1; step <= 2; ++step)
      {
        disk.push_back(mesh.OtherCorner(mesh.VertexCorners()[c], step));
      }
    }
  };
  disk.clear();
  addNeighbours(centre);
  SortUnique(disk, 0);
  found.Ring = disk;
  for (const Index i : found.Ring)
  {
    if (found.Ring.size() <= static_cast<std::size_t>(manyTriangles) &&
      mesh.VertexCornersBegin()[i + 1] - mesh.VertexCornersBegin()[i] <= manyTriangles)
    {
      addNeighbours(i);
    }
  }
  SortUnique(disk, 0);
  const auto own = std::lower_bound(disk.begin(), disk.end(), centre);
  if (own != disk.end() && *own == centre)
  {
    disk.erase(own);
  }
}

/// The normal and the curvatures of the quadratic polynomial at a vertex.
struct LocalShape
{
  Eigen::RowVector3d Normal;
  double Mean = 0.0;
  double Gaussian = 0.0;
};

/// The vertices of the disk that a function over the plane orthogonal to the normal of vertex i can
/// reach, and if `withRing` all of its ring.
std::vector<Index> ReachableOf(const Points& normals, Index i, const Disk& disk, bool withRing)
{
  constexpr double steepest = 0.5; // the cosine of the largest angle of normals
  std::vector<Index> reachable;
  std::copy_if(disk.All.begin(), disk.All.end(), std::back_inserter(reachable),
    [&](Index j)
    {
      return normals.row(j).dot(normals.row(i)) > steepest ||
        (withRing && std::binary_search(disk.Ring.begin(), disk.Ring.end(), j));
    });
  return reachable;
}

/// isDetermined: whether these vertices determine the polynomial.
LocalShape FitPolynomial(const Points& positions, const Points& normals, Index i,
  const std::vector<Index>& vertices, bool& isDetermined)
{
  const Eigen::Vector3d normal = normals.row(i).transpose();
  LocalShape found{ normals.row(i) };
  isDetermined = false;
  if (!(normal.norm() > 0.0))
  {
    return found;
  }
  const auto axes = TangentAxes(normal);
  const auto count = static_cast<Eigen::Index>(vertices.size());
  Eigen::Matrix<double, Eigen::Dynamic, 5> rows(count, 5);
  Vector heights(count);
  double radius = 0.0;
  for (Eigen::Index k = 0; k < count; ++k)
  {
    const Eigen::Vector3d d = (positions.row(vertices[k]) - positions.row(i)).transpose();
    rows.row(k).head<2>() = d.transpose() * axes;
    heights[k] = -d.dot(normal); // positive where the surface bends away from the normal
    radius = std::max(radius, rows.row(k).head<2>().norm());
  }
  if (!(radius > 0.0))
  {
    return found;
  }
  for (Eigen::Index k = 0; k < count; ++k)
  {
    const double x = rows(k, 0) / radius;
    const double y = rows(k, 1) / radius;
    rows.row(k) << x, y, 0.5 * x * x, x * y, 0.5 * y * y;
  }
  Eigen::CompleteOrthogonalDecomposition<Eigen::Matrix<double, Eigen::Dynamic, 5>> fit;
  fit.setThreshold(1e-6);
  fit.compute(rows);
  isDetermined = fit.rank() == 5;
  const Eigen::Matrix<double, 5, 1> c = fit.solve(Vector(heights / radius));
  const double p = c[0];
  const double q = c[1];
  const double w = 1.0 + p * p + q * q;
  found.Normal = (normal + axes * c.head<2>()).transpose().normalized();
  // By the first and second fundamental forms of the graph.
  found.Mean = ((1.0 + q * q) * c[2] - 2.0 * p * q * c[3] + (1.0 + p * p) * c[4]) /
    (2.0 * w * std::sqrt(w) * radius);
  found.Gaussian = (c[2] * c[4] - c[3] * c[3]) / (w * w * radius * radius);
  return found;
}

/// Where the vertices that a function reaches do not determine a polynomial, as at edges and
/// corners that are sharp, all neighbours count.
LocalShape FitPolynomial(const Points& positions, const Points& normals, Index i, const Disk& disk)
{
  bool isDetermined = false;
  const std::vector<Index> reachable = ReachableOf(normals, i, disk, false);
  const LocalShape found = FitPolynomial(positions, normals, i, reachable, isDetermined);
  if (isDetermined || reachable.size() == disk.All.size())
  {
    return found;
  }
  return FitPolynomial(positions, normals, i, ReachableOf(normals, i, disk, true), isDetermined);
}

/// Call use(i, shape) for all vertices.
template <typename Use>
void FitEach(const TriangleMesh& mesh, const Points& positions, const Points& normals,
  const ParallelFor& parallel, const ProgressMonitor& progress, const Use& use)
{
  const std::int64_t n = mesh.NumberOfVertices();
  constexpr std::int64_t parts = 16;
  for (std::int64_t part = 0; part < parts; ++part)
  {
    const auto first = static_cast<Index>(n * part / parts);
    const auto last = static_cast<Index>(n * (part + 1) / parts);
    ForEachBlock(parallel, last - first,
      [&](Index, Index begin, Index end)
      {
        Disk disk;
        for (Index i = first + begin; i < first + end; ++i)
        {
          FindDisk(mesh, i, disk);
          use(i, FitPolynomial(positions, normals, i, disk));
        }
      });
    progress.Report(static_cast<double>(part + 1) / parts);
  }
}

} // namespace

double Curvatures::ShapeIndex(Index i) const
{
  const double sum = this->Principal(i, 0) + this->Principal(i, 1);
  const double difference = this->Principal(i, 0) - this->Principal(i, 1);
  return sum == 0.0 ? 0.0 : std::atan2(sum, difference) / std::acos(0.0);
}

double Curvatures::Curvedness(Index i) const
{
  return std::hypot(this->Principal(i, 0), this->Principal(i, 1)) / std::sqrt(2.0);
}

Curvatures EstimateCurvature(const TriangleMesh& mesh, const Points& positions, double fwhm,
  const Assembler* operators, const ParallelFor& parallel, const ProgressMonitor& progress)
{
  const Index n = mesh.NumberOfVertices();
  const OrientedNormals normals = FindOrientedNormals(mesh, positions, parallel);
  progress.Report(0.05);
  Curvatures found;
  found.TurnedTriangles = normals.TurnedTriangles;
  found.Mean.resize(n);
  found.Gaussian.resize(n);
  Points fitted(n, 3);
  const double middle = fwhm > 0.0 ? 0.3 : 1.0;
  FitEach(mesh, positions, normals.OfVertices, parallel, progress.Part(0.05, middle),
    [&](Index i, const LocalShape& shape)
    {
      found.Mean[i] = shape.Mean;
      found.Gaussian[i] = shape.Gaussian;
      fitted.row(i) = shape.Normal;
    });
  if (fwhm > 0.0)
  {
    const LinearFits fits = FitByHeat(
      *operators, positions, fitted, fitted, fwhm, true, parallel, progress.Part(middle, 1.0));
    found.MissedResidual = fits.MissedResidual;
    ForEach(parallel, n,
      [&](Index i)
      {
        // The symmetric part has an eigenvalue 0 besides those of the tangent plane.
        const Eigen::Map<const Eigen::Matrix3d> slope(fits.Slopes.row(i).data());
        const Eigen::Matrix3d s = 0.5 * (slope + slope.transpose());
        const double trace = s.trace();
        found.Mean[i] = 0.5 * trace;
        found.Gaussian[i] = 0.5 * (trace * trace - s.squaredNorm());
      });
  }
  found.Principal.resize(n, 2);
  for (Index i = 0; i < n; ++i)
  {
    const double mean = found.Mean[i];
    const double root = std::sqrt(std::max(0.0, mean * mean - found.Gaussian[i]));
    found.Principal.row(i) << mean + root, mean - root;
  }
  progress.Report(1.0);
  return found;
}

} // namespace SurfaceDiffusion
