// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/CorrelatedNoise.h"

#include "Core/Models/Interpolation/ScatteredValues.h"
#include "Core/Statistics/NoiseCorrelation.h"
#include "Run/Surface.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// The mean square of the residuals of a quadratic fit, in the plane of least squares, to the values at
/// the first `count` of some places around x.
double ResidualOfFit(const Points& places, const Vector& values, const Eigen::RowVector3d& x,
  const std::vector<std::pair<double, Index>>& nearest, Eigen::Index count)
{
  Points offsets(count, 3);
  Vector given(count);
  for (Eigen::Index k = 0; k < count; ++k)
  {
    const Index place = nearest[static_cast<std::size_t>(k)].second;
    offsets.row(k) = places.row(place) - x;
    given[k] = values[place];
  }
  offsets /= std::max(offsets.cwiseAbs().maxCoeff(), std::numeric_limits<double>::min());
  const Points spread = offsets.rowwise() - offsets.colwise().mean();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread.transpose() * spread);
  const Eigen::ArrayXXd plane = (offsets * axes.eigenvectors().rightCols<2>()).array();
  Eigen::MatrixXd terms(count, 6);
  terms << Vector::Ones(count), plane.matrix(), plane.square().matrix(),
    (plane.col(0) * plane.col(1)).matrix();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> fit(terms);
  return (given - terms * fit.solve(given)).squaredNorm() / static_cast<double>(count - fit.rank());
}

/// Whether values vary between neighbours hardly less than farther apart, as correlated noise does:
/// what quadratic fits leave of a smooth function is 4^(3/2) = 8 times as much for 48 places as for
/// 12, of functions with features of the size of the surface 4.5 and more for 200 places, of noise as
/// wide as three distances of neighbours 2 to 2.8, and of white noise once.
bool VariesAlikeAtAllScales(const Points& places, const Vector& values, double variance)
{
  constexpr std::array<Eigen::Index, 2> sizes = { 12, 48 };
  constexpr Index fewest = 200;
  constexpr Index sample = 200;
  constexpr double growth = 3.3;
  constexpr double roundOff = 1e-10; // of the deviation
  const auto count = static_cast<Index>(values.size());
  std::array<double, 2> squares = {};
  double fits = 0.0;
  for (Index i = 0; count >= fewest && i < count; i += (count + sample - 1) / sample)
  {
    std::vector<std::pair<double, Index>> nearest(static_cast<std::size_t>(count));
    for (Index j = 0; j < count; ++j)
    {
      nearest[static_cast<std::size_t>(j)] = { (places.row(j) - places.row(i)).squaredNorm(), j };
    }
    std::partial_sort(nearest.begin(), nearest.begin() + sizes[1], nearest.end());
    for (std::size_t k = 0; k < sizes.size(); ++k)
    {
      squares[k] += ResidualOfFit(places, values, places.row(i), nearest, sizes[k]);
    }
    fits += 1.0;
  }
  return squares[0] > fits * roundOff * roundOff * variance &&
    squares[1] < growth * growth * squares[0];
}

} // namespace

Sentence DescribeSmoothData(double width, double estimate, double deviation, const Sentence& next)
{
  return Sentence(Word::Setting("NoiseLevel"))
    << ": the data show no white noise but are smooth over about " << width
    << " (full width at half maximum), as correlated noise is, so that its estimate, " << estimate
    << ", may be too small; without a signal the noise is " << deviation << " (" << next << ")";
}

Sentence DescribeSmoothValues(
  const ScatteredValues& data, int column, double estimate, double unit, const Surface& surface)
{
  constexpr Index sample = 300;
  const Index count = data.Count();
  const Points vertices = VertexPositions(surface);
  const double length = surface.InputMesh().LengthUnit();
  Points places = Points::Zero(count, 3);
  for (Index i = 0; i < count; ++i)
  {
    for (std::size_t a = 0; a < 3; ++a)
    {
      places.row(i) +=
        length * data.Places[i].Coordinates[a] * vertices.row(data.Places[i].Vertices[a]);
    }
  }
  const Vector values = unit * data.Given.col(column);
  const double mean = data.Weights.dot(values) / data.Weights.sum();
  const double variance =
    data.Weights.dot((values.array() - mean).square().matrix()) / data.Weights.sum();
  if (values.minCoeff() == values.maxCoeff() || !VariesAlikeAtAllScales(places, values, variance))
  {
    return {};
  }
  double squareDifference = 0.0; // between nearest places
  double squareDistance = 0.0;
  double pairs = 0.0;
  const Index stride = (count + sample - 1) / sample;
  for (Index i = 0; i < count; i += stride)
  {
    Index nearest = -1;
    double least = std::numeric_limits<double>::infinity();
    for (Index j = 0; j < count; ++j)
    {
      const double square = (places.row(j) - places.row(i)).squaredNorm();
      if (square > 0.0 && square < least)
      {
        nearest = j;
        least = square;
      }
    }
    if (nearest >= 0)
    {
      squareDifference += std::pow(values[nearest] - values[i], 2);
      squareDistance += least;
      pairs += 1.0;
    }
  }
  const double width =
    WidthOfCorrelation(squareDifference / pairs, variance, squareDistance / pairs);
  return DescribeSmoothData(std::max(width, std::sqrt(squareDistance / pairs)), estimate,
    std::sqrt(variance),
    Sentence("set ") << Word::Setting("NoiseLevel") << ", or turn " << Word::Setting("Exact")
                     << " on if there is no noise");
}

} // namespace SurfaceDiffusion
