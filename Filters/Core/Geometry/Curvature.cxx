// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/Curvature.h"

#include "Core/Geometry/CoordinateRounding.h"
#include "Core/Geometry/HeatRegression.h"
#include "Core/Geometry/QuadraticFits.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace SurfaceDiffusion
{

namespace
{

/// The normal and the curvatures of the quadratic polynomial at a vertex.
struct LocalShape
{
  Eigen::RowVector3d Normal;
  double Mean = 0.0;
  double Gaussian = 0.0;
};

/// A sharp vertex whose neighbours all lie on one side of its tangent plane is convex or concave. A
/// polynomial through few vertices, or through those of one flat side beyond a re-entrant edge, may be
/// flat there or bend to the other side.
bool IsFlatOrOpposite(double mean, double ofNeighbours)
{
  constexpr double flat = 0.01;
  return ofNeighbours != 0.0 && mean / ofNeighbours < flat;
}

/// The root of half the sum of squares of the principal curvatures.
double CurvednessOf(double mean, double gaussian)
{
  return std::sqrt(std::max(0.0, 2.0 * mean * mean - gaussian));
}

/// rounding: the error of coordinates. Curvature that it may cause is 0.
LocalShape FitShape(QuadraticFits& fits, const OrientedNormals& normals, double rounding, Index i)
{
  LocalShape found{ normals.OfVertices.row(i) };
  if (!fits.MoveTo(i))
  {
    return found;
  }
  const double radius = fits.Radius();
  const QuadraticFits::Coefficients c = fits.Fit(fits.Depths() / radius);
  const double p = c[0];
  const double q = c[1];
  const double w = 1.0 + p * p + q * q;
  // By the first and second fundamental forms of the graph.
  found.Mean = ((1.0 + q * q) * c[2] - 2.0 * p * q * c[3] + (1.0 + p * p) * c[4]) /
    (2.0 * w * std::sqrt(w) * radius);
  found.Gaussian = (c[2] * c[4] - c[3] * c[3]) / (w * w * radius * radius);
  constexpr double largest = 1e4; // of the curvature of rounding, for which errors are estimated
  const double curvedness = CurvednessOf(found.Mean, found.Gaussian) * radius * radius;
  if (curvedness < largest * rounding && curvedness <= 2.0 * rounding * fits.ErrorOfSecondOrder())
  {
    found.Mean = 0.0;
    found.Gaussian = 0.0;
  }
  const double ofNeighbours = fits.IsSharp() ? fits.CurvatureOfNeighbours() : 0.0;
  if (IsFlatOrOpposite(found.Mean, ofNeighbours))
  {
    found.Mean = ofNeighbours;
    found.Gaussian = ofNeighbours * ofNeighbours;
    return found;
  }
  found.Normal = (found.Normal.transpose() + fits.Axes() * c.head<2>()).transpose().normalized();
  return found;
}

/// Call use(i, shape) for all vertices.
template <typename Use>
void FitEach(const TriangleMesh& mesh, const Points& positions, const OrientedNormals& normals,
  double rounding, const ParallelFor& parallel, const ProgressMonitor& progress, const Use& use)
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
        QuadraticFits fits(mesh, positions, normals);
        for (Index i = first + begin; i < first + end; ++i)
        {
          use(i, FitShape(fits, normals, rounding, i));
        }
      });
    progress.Report(static_cast<double>(part + 1) / parts);
  }
}

/// From the slope of the normals, whose symmetric part has an eigenvalue 0 besides those of the tangent
/// plane.
void TakeShapeOperator(const Eigen::Matrix3d& slope, Index i, Curvatures& found)
{
  const Eigen::Matrix3d s = 0.5 * (slope + slope.transpose());
  const double trace = s.trace();
  found.Mean[i] = 0.5 * trace;
  found.Gaussian[i] = 0.5 * (trace * trace - s.squaredNorm());
}

using Tensor = Eigen::Map<const Eigen::Matrix3d>;

Eigen::Vector3d MainAxis(const Tensor& tensor)
{
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(tensor).eigenvectors().col(2);
}

/// On surfaces with one side: with the slope of n n^T, which has no sign, that of n is
/// dn/dx = (d(n n^T)/dx) n.
void TakeSlopesWithoutSide(const Assembler& operators, const Points& positions,
  const Points& fitted, const OrientedNormals& normals, double fwhm, Curvatures& found,
  const ParallelFor& parallel, const ProgressMonitor& progress)
{
  const Index n = operators.Mesh().NumberOfVertices();
  Values tensors(n, 9);
  ForEach(parallel, n,
    [&](Index i)
    {
      const Eigen::Matrix3d tensor = fitted.row(i).transpose() * fitted.row(i);
      tensors.row(i) = Eigen::Map<const Eigen::RowVectorXd>(tensor.data(), 9);
    });
  const LinearFits fits = FitByHeat(
    operators, positions,
    [](Index, const Eigen::RowVectorXd& smooth) { return MainAxis(Tensor(smooth.data())); },
    tensors, fwhm, parallel, progress);
  found.MissedResidual = std::max(found.MissedResidual, fits.MissedResidual);
  ForEach(parallel, n,
    [&](Index i)
    {
      if (normals.IsOnOneSide(i))
      {
        const Eigen::Vector3d normal = MainAxis(Tensor(fits.Constants.row(i).data()));
        Eigen::Matrix3d slope = Eigen::Matrix3d::Zero();
        for (int column = 0; column < 9; ++column)
        {
          slope.col(column / 3) +=
            normal[column % 3] * fits.Slopes.row(i).segment<3>(3 * column).transpose();
        }
        TakeShapeOperator(slope, i, found);
      }
    });
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
  const double rounding = RoundingOfCoordinates(positions);
  const double middle = fwhm > 0.0 ? 0.3 : 1.0;
  FitEach(mesh, positions, normals, rounding, parallel, progress.Part(0.05, middle),
    [&](Index i, const LocalShape& shape)
    {
      found.Mean[i] = shape.Mean;
      found.Gaussian[i] = shape.Gaussian;
      fitted.row(i) = shape.Normal;
    });
  if (fwhm > 0.0)
  {
    const double end = normals.OnOneSide.empty() ? 1.0 : 0.5 * (middle + 1.0);
    const LinearFits fits = FitByHeat(
      *operators, positions,
      [](Index, const Eigen::RowVectorXd& smooth) -> Eigen::Vector3d { return smooth.transpose(); },
      fitted, fwhm, parallel, progress.Part(middle, end));
    found.MissedResidual = fits.MissedResidual;
    ForEach(parallel, n,
      [&](Index i)
      {
        const Eigen::Map<const Eigen::Matrix3d> slope(fits.Slopes.row(i).data());
        TakeShapeOperator(slope, i, found);
      });
    if (!normals.OnOneSide.empty())
    {
      TakeSlopesWithoutSide(
        *operators, positions, fitted, normals, fwhm, found, parallel, progress.Part(end, 1.0));
    }
  }
  constexpr double factor = 32.0;
  const double least = fwhm > 0.0 ? factor * rounding / (fwhm * fwhm) : 0.0;
  found.Principal.resize(n, 2);
  for (Index i = 0; i < n; ++i)
  {
    found.Mean[i] = normals.IsOnOneSide(i) ? std::abs(found.Mean[i]) : found.Mean[i];
    if (CurvednessOf(found.Mean[i], found.Gaussian[i]) <= least)
    {
      found.Mean[i] = 0.0;
      found.Gaussian[i] = 0.0;
    }
    const double mean = found.Mean[i];
    const double root = std::sqrt(std::max(0.0, mean * mean - found.Gaussian[i]));
    found.Principal.row(i) << mean + root, mean - root;
  }
  progress.Report(1.0);
  return found;
}

} // namespace SurfaceDiffusion
