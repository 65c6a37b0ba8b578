// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/LinearFit.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// The weights of the values at `offsets` in the linear fit at the origin, in the plane of the
/// offsets; none if they do not determine one.
Vector WeightsOfFit(const Eigen::Ref<const Points>& offsets)
{
  if (offsets.rows() < 3)
  {
    return Vector();
  }
  const Eigen::Matrix3d spread = offsets.transpose() * offsets;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
  const double size = std::sqrt(axes.eigenvalues()[2]);
  if (!(axes.eigenvalues()[1] > 1e-6 * axes.eigenvalues()[2]) || !(size > 0.0))
  {
    return Vector();
  }
  Eigen::Matrix<double, Eigen::Dynamic, 3> basis(offsets.rows(), 3);
  basis.col(0).setOnes();
  basis.rightCols(2) = offsets * axes.eigenvectors().rightCols(2) / size;
  const Eigen::Matrix3d normal = basis.transpose() * basis;
  const Eigen::Vector3d one = normal.ldlt().solve(Eigen::Vector3d::UnitX());
  const Vector weights = basis * one;
  return std::abs(weights.sum() - 1.0) < 1e-6 ? weights : Vector();
}

} // namespace

LinearFit FitAround(Index vertex, int edges, Rings& rings, const FitData& data)
{
  const std::vector<Index>& row = data.Operators.Mesh().InputVertex();
  LinearFit fit;
  for (const Index j : rings.FindRing(vertex, edges))
  {
    if (!data.IsMissing(j))
    {
      fit.Known.push_back(j);
    }
  }
  Points offsets(static_cast<Eigen::Index>(fit.Known.size()), 3);
  for (std::size_t j = 0; j < fit.Known.size(); ++j)
  {
    offsets.row(static_cast<Eigen::Index>(j)) =
      data.InputPoints.row(row[static_cast<std::size_t>(fit.Known[j])]) -
      data.InputPoints.row(row[static_cast<std::size_t>(vertex)]);
  }
  fit.Weights = WeightsOfFit(offsets);
  return fit;
}

double RobustDeviation(std::vector<double>& deviations)
{
  if (deviations.empty())
  {
    return 0.0;
  }
  const auto middle = deviations.begin() + static_cast<std::ptrdiff_t>(deviations.size() / 2);
  std::nth_element(deviations.begin(), middle, deviations.end());
  return 1.4826 * *middle;
}

} // namespace SurfaceDiffusion
