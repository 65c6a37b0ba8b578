// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Statistics/LinearFit.h"

#include "Core/Foundation/RobustRange.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

constexpr double ShareOfRoundOff = 1e-13; ///< relative

using PlaneCoordinates = Eigen::Matrix<double, Eigen::Dynamic, 2>;

constexpr Eigen::Index TermsOfCubic = 10;
constexpr Eigen::Index LeastValuesOfCubic = 12;
constexpr Eigen::Index MostValuesOfCubic = 100; ///< near a vertex of very many edges there are more

/// The coordinates of the offsets in their plane, of size 1; none if they do not determine one.
PlaneCoordinates InPlane(const Eigen::Ref<const Points>& offsets)
{
  const Eigen::Matrix3d spread = offsets.transpose() * offsets;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
  const double size = std::sqrt(axes.eigenvalues()[2]);
  // Around a corner of a cube they spread alike in all directions.
  const bool isPlane = axes.eigenvalues()[1] > (1.0 + 1e-6) * axes.eigenvalues()[0];
  if (!isPlane || !(axes.eigenvalues()[1] > 1e-6 * axes.eigenvalues()[2]) || !(size > 0.0))
  {
    return PlaneCoordinates();
  }
  return offsets * axes.eigenvectors().rightCols(2) / size;
}

/// The weights of the values at `offsets` in the linear fit at the origin, in the plane of the
/// offsets; none if they do not determine one.
Vector WeightsOfFit(const Eigen::Ref<const Points>& offsets)
{
  const PlaneCoordinates inPlane = offsets.rows() < 3 ? PlaneCoordinates() : InPlane(offsets);
  if (inPlane.rows() == 0)
  {
    return Vector();
  }
  Eigen::Matrix<double, Eigen::Dynamic, 3> basis(offsets.rows(), 3);
  basis.col(0).setOnes();
  basis.rightCols(2) = inPlane;
  const Eigen::Matrix3d normal = basis.transpose() * basis;
  const Eigen::Vector3d one = normal.ldlt().solve(Eigen::Vector3d::UnitX());
  const Vector weights = basis * one;
  return std::abs(weights.sum() - 1.0) < 1e-6 ? weights : Vector();
}

/// The same of the cubic fit.
Vector WeightsOfCubicFit(const Eigen::Ref<const Points>& offsets)
{
  const Eigen::Index count = offsets.rows();
  const bool fits = count >= LeastValuesOfCubic && count <= MostValuesOfCubic;
  PlaneCoordinates inPlane = fits ? InPlane(offsets) : PlaneCoordinates();
  if (inPlane.rows() == 0)
  {
    return Vector();
  }
  // The fit does not depend on the scale of the axes: powers of about 1.
  inPlane.array().rowwise() *=
    (static_cast<double>(count) / inPlane.array().square().colwise().sum()).sqrt();
  const auto x = inPlane.col(0).array();
  const auto y = inPlane.col(1).array();
  Eigen::Array<double, Eigen::Dynamic, TermsOfCubic> basis(count, TermsOfCubic);
  basis << Eigen::ArrayXd::Ones(count), x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y,
    y * y * y;
  using Normal = Eigen::Matrix<double, TermsOfCubic, TermsOfCubic>;
  const Normal normal = basis.matrix().transpose() * basis.matrix();
  const Eigen::LDLT<Normal> factors(normal);
  if (!(factors.rcond() > 1e-6))
  {
    return Vector();
  }
  const Eigen::Matrix<double, TermsOfCubic, 1> one = Normal::Identity().col(0);
  return basis.matrix() * factors.solve(one);
}

/// The vertices that are not missing.
std::vector<Index> KnownOf(const std::vector<Index>& vertices, const FitData& data)
{
  std::vector<Index> known;
  for (const Index j : vertices)
  {
    if (!data.IsMissing(j))
    {
      known.push_back(j);
    }
  }
  return known;
}

Points OffsetsFrom(Index vertex, const std::vector<Index>& vertices, const FitData& data)
{
  const std::vector<Index>& row = data.Operators.Mesh().InputVertex();
  Points offsets(static_cast<Eigen::Index>(vertices.size()), 3);
  for (std::size_t j = 0; j < vertices.size(); ++j)
  {
    offsets.row(static_cast<Eigen::Index>(j)) =
      data.InputPoints.row(row[static_cast<std::size_t>(vertices[j])]) -
      data.InputPoints.row(row[static_cast<std::size_t>(vertex)]);
  }
  return offsets;
}

double RobustDeviation(std::vector<double>& deviations)
{
  return GaussianFactor * Median(deviations);
}

} // namespace

std::vector<Index> FitData::SampleVertices(Index largest) const
{
  const auto mayCount = [this](Index i) { return !this->IsBetween || !(*this->IsBetween)[i]; };
  Index count = this->Range.Size();
  if (this->IsBetween)
  {
    count -=
      static_cast<Index>(this->IsBetween->segment(this->Range.Begin, this->Range.Size()).count());
  }
  const Index stride = 1 + count / largest;
  std::vector<Index> sample;
  Index number = 0;
  for (Index i = this->Range.Begin; i < this->Range.End; ++i)
  {
    if (mayCount(i) && number++ % stride == 0)
    {
      sample.push_back(i);
    }
  }
  return sample;
}

Eigen::RowVectorXd RoundOffOf(const FitData& data)
{
  Eigen::RowVectorXd largest = Eigen::RowVectorXd::Zero(data.Given.cols());
  for (Index i = data.Range.Begin; i < data.Range.End; ++i)
  {
    if (!data.IsMissing(i))
    {
      largest = largest.cwiseMax(data.Given.row(i).cwiseAbs());
    }
  }
  return ShareOfRoundOff * largest;
}

LinearFit FitAround(Index vertex, int edges, Rings& rings, const FitData& data)
{
  LinearFit fit;
  fit.Known = KnownOf(rings.FindRing(vertex, edges), data);
  fit.Weights = WeightsOfFit(OffsetsFrom(vertex, fit.Known, data));
  return fit;
}

LinearFit FitCubicAround(Index vertex, Rings& rings, const FitData& data)
{
  LinearFit fit;
  fit.Known = KnownOf(rings.FindDisk(vertex, 2), data);
  fit.Known.erase(std::remove(fit.Known.begin(), fit.Known.end(), vertex), fit.Known.end());
  fit.Weights = WeightsOfCubicFit(OffsetsFrom(vertex, fit.Known, data));
  return fit;
}

double RobustDeviations::RootMeanSquare(double count)
{
  double variance = 0.0;
  for (std::vector<double>& ofColumn : this->OfColumns)
  {
    const double share = count > 0.0 ? static_cast<double>(ofColumn.size()) / count : 0.0;
    variance +=
      share * std::pow(RobustDeviation(ofColumn), 2) / static_cast<double>(this->OfColumns.size());
  }
  return std::sqrt(variance);
}

} // namespace SurfaceDiffusion
