// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Meshes.h"
#include "ThreadedFor.h"

#include "Core/Geometry/Resampling.h"
#include "Core/Geometry/ResamplingWeights.h"
#include "Core/Geometry/TriangleTree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

// Values that go from the vertices of one sphere to those of another.

namespace SurfaceDiffusion
{

namespace
{

constexpr double Missing = std::numeric_limits<double>::quiet_NaN();

/// Areas that differ by a factor of up to three, as those of a cortex do.
AreaSphere Uneven(const Testing::Surface& s, double phase)
{
  AreaSphere sphere{ s.Vertices, s.Faces, Vector(s.Vertices.rows()) };
  for (Eigen::Index i = 0; i < s.Vertices.rows(); ++i)
  {
    sphere.Areas[i] = 2.0 + std::sin(phase + 7.0 * s.Vertices(i, 0) + 5.0 * s.Vertices(i, 1));
  }
  return sphere;
}

AreaSphere Coarse()
{
  return Uneven(Testing::Icosphere(3), 0.0);
}
AreaSphere Fine()
{
  return Uneven(Testing::Rotated(Testing::Icosphere(4), 0.4), 1.0);
}

RowMatrix Forward(const AreaSphere& source, const AreaSphere& target)
{
  return BarycentricWeights(target.Vertices, source.Vertices, source.Faces, SerialFor(), {});
}

RowMatrix Adaptive(const AreaSphere& source, const AreaSphere& target)
{
  return ResamplingWeights(
    ResamplingMethod::AdaptiveBarycentricArea, source, target, {}, SerialFor(), {});
}

RowMatrix FromDense(const Eigen::MatrixXd& dense)
{
  return dense.sparseView();
}

RowWeights View(const RowMatrix& matrix)
{
  return { matrix.rows(), matrix.cols(), matrix.nonZeros(), matrix.outerIndexPtr(),
    matrix.innerIndexPtr(), matrix.valuePtr() };
}

template <typename T>
ColumnView<T> ViewColumns(T* first, Eigen::Index columns)
{
  return { first, columns, columns };
}

Values Means(const RowMatrix& weights, const Values& source)
{
  Values target(weights.rows(), source.cols());
  ResampleMeans<double>(View(weights), ViewColumns(source.data(), source.cols()),
    ViewColumns(target.data(), target.cols()), SerialFor());
  return target;
}

Values Labels(const RowMatrix& weights, const Values& source)
{
  Values target(weights.rows(), source.cols());
  ResampleLabels(View(weights), ViewColumns(source.data(), source.cols()),
    ViewColumns(target.data(), target.cols()), SerialFor());
  return target;
}

} // namespace

TEST(Resampling, BarycentricWeightsAreThoseOfTheNearestPoint)
{
  const AreaSphere source = Coarse();
  const AreaSphere target = Fine();
  const RowMatrix weights = Forward(source, target);
  for (Eigen::Index i = 0; i < target.Vertices.rows(); ++i)
  {
    const Eigen::Vector3d x = target.Vertices.row(i).transpose();
    double nearest = std::numeric_limits<double>::infinity();
    for (Eigen::Index t = 0; t < source.Faces.rows(); ++t)
    {
      const auto corner = [&](int a)
      { return Eigen::Vector3d(source.Vertices.row(source.Faces(t, a)).transpose()); };
      nearest =
        std::min(nearest, (NearestInTriangle(x, corner(0), corner(1), corner(2)) - x).norm());
    }
    const Eigen::RowVector3d found = weights.row(i) * source.Vertices;
    EXPECT_NEAR((found - x.transpose()).norm(), nearest, 1e-14);
    EXPECT_NEAR(weights.row(i).sum(), 1.0, 1e-14);
    EXPECT_LE(weights.row(i).nonZeros(), 3);
  }
}

TEST(Resampling, ASphereKeepsItsOwnValues)
{
  const AreaSphere sphere = Fine();
  const RowMatrix weights = Adaptive(sphere, sphere);
  ASSERT_EQ(weights.nonZeros(), sphere.Vertices.rows());
  for (Index i = 0; i < weights.rows(); ++i)
  {
    EXPECT_EQ(weights.coeff(i, i), 1.0);
  }
}

TEST(Resampling, AdaptiveAreaWeightsKeepTheIntegralBeforeRowsAreDivided)
{
  const AreaSphere coarse = Coarse();
  const AreaSphere fine = Fine();
  for (const auto& [source, target] : { std::pair{ coarse, fine }, std::pair{ fine, coarse } })
  {
    const RowMatrix weights = AdaptiveAreaWeights(
      Forward(source, target), Forward(target, source), source.Areas, target.Areas);
    const Vector kept = weights.transpose() * Vector::Ones(weights.rows());
    EXPECT_LT((kept - source.Areas).cwiseQuotient(source.Areas).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_GT(weights.coeffs().minCoeff(), 0.0);
  }
}

TEST(Resampling, ARowIsForwardIfItHasAllThatTheOtherHas)
{
  // The second source vertex lies in a triangle of the target with its first vertex.
  const RowMatrix forward =
    FromDense((Eigen::MatrixXd(2, 3) << 0.5, 0.0, 0.5, 0.0, 0.25, 0.75).finished());
  const RowMatrix reverse =
    FromDense((Eigen::MatrixXd(3, 2) << 1.0, 0.0, 0.5, 0.5, 0.0, 1.0).finished());
  const Vector sourceAreas = Eigen::Vector3d(1.0, 2.0, 3.0);
  const Vector targetAreas = Eigen::Vector2d(1.0, 4.0);
  // B = (1, .5, 0) of reverse, and (0, .25, .75) of forward; times target areas; columns of sums A_s.
  const Eigen::MatrixXd expected =
    (Eigen::MatrixXd(2, 3) << 1.0, 2.0 * 0.5 / 1.5, 0.0, 0.0, 2.0 * 1.0 / 1.5, 3.0).finished();
  const Eigen::MatrixXd found = AdaptiveAreaWeights(forward, reverse, sourceAreas, targetAreas);
  EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(Resampling, VerticesWithoutAreaTakeNoPart)
{
  const AreaSphere source = Coarse();
  const AreaSphere target = Fine();
  const auto withPoint = [](AreaSphere sphere)
  {
    sphere.Vertices.conservativeResize(sphere.Vertices.rows() + 1, 3);
    sphere.Vertices.bottomRows(1) = Eigen::RowVector3d(0.36, 0.48, 0.8);
    sphere.Areas.conservativeResize(sphere.Areas.size() + 1);
    sphere.Areas.tail(1).setZero();
    return sphere;
  };
  const Eigen::MatrixXd expected = Adaptive(source, target);
  const Eigen::MatrixXd found = Adaptive(withPoint(source), withPoint(target));
  EXPECT_EQ(found.topLeftCorner(expected.rows(), expected.cols()), expected);
  EXPECT_EQ(found.rightCols(1).norm(), 0.0);
  EXPECT_EQ(found.bottomRows(1).norm(), 0.0);
}

TEST(Resampling, WeightsDoNotDependOnRadiusAndUnitOfAreas)
{
  const RowMatrix expected = Adaptive(Fine(), Coarse());
  AreaSphere source = Fine();
  AreaSphere target = Coarse();
  source.Vertices *= 100.0;
  source.Areas *= 0.3;
  target.Areas *= 7e3;
  const RowMatrix found = Adaptive(source, target);
  EXPECT_LT((found - expected).norm(), 1e-12 * expected.norm());
}

TEST(Resampling, ConstantsKeepTheirBits)
{
  const RowMatrix weights = Adaptive(Fine(), Coarse());
  const Values constant = Values::Constant(weights.cols(), 19, 0.1);
  EXPECT_TRUE((Means(weights, constant).array() == 0.1).all());
  Values holes = constant;
  holes.topRows(weights.cols() / 2).setConstant(Missing);
  const Values found = Means(weights, holes);
  EXPECT_TRUE((found.array() == 0.1 || found.array().isNaN()).all());
}

TEST(Resampling, TheLargestNumbersHaveAMean)
{
  const RowMatrix weights =
    FromDense((Eigen::MatrixXd(2, 3) << 0.25, 0.25, 0.5, 0.5, 0.0, 0.5).finished());
  constexpr double largest = std::numeric_limits<double>::max();
  Values values(3, 2);
  values << largest, largest, -largest, Missing, -largest, -largest;
  const Values found = Means(weights, values);
  EXPECT_NEAR(found(0, 0) / largest, -0.5, 1e-14);
  EXPECT_EQ(found(1, 0), 0.0);
  EXPECT_NEAR(found(0, 1) / largest, -1.0 / 3.0, 1e-14);
  EXPECT_EQ(found(1, 1), 0.0);
}

TEST(Resampling, MissingValuesAreLeftOutAsVerticesAre)
{
  const AreaSphere source = Fine();
  Values values = source.Vertices.leftCols<2>();
  const Flags isLeftOut = source.Vertices.col(2).array() > 0.3;
  for (Index i = 0; i < values.rows(); ++i)
  {
    if (isLeftOut[i])
    {
      values(i, 1) = Missing;
    }
  }
  const RowMatrix all = Adaptive(source, Coarse());
  const RowMatrix some = ResamplingWeights(
    ResamplingMethod::AdaptiveBarycentricArea, source, Coarse(), isLeftOut, SerialFor(), {});
  const Values of = Means(all, values);
  const Values expected = Means(some, source.Vertices.leftCols<2>());
  const Values whole = Means(all, source.Vertices.leftCols<2>());
  Index empty = 0;
  for (Index t = 0; t < of.rows(); ++t)
  {
    EXPECT_EQ(of(t, 0), whole(t, 0));
    EXPECT_EQ(std::isnan(of(t, 1)), std::isnan(expected(t, 1)));
    EXPECT_EQ(std::isnan(of(t, 1)), some.row(t).nonZeros() == 0);
    empty += std::isnan(of(t, 1)) ? 1 : 0;
    if (!std::isnan(of(t, 1)))
    {
      EXPECT_NEAR(of(t, 1), expected(t, 1), 1e-14);
      EXPECT_NEAR(some.row(t).sum(), 1.0, 1e-14);
    }
  }
  EXPECT_GT(empty, 100);
  EXPECT_LT(empty, of.rows() / 2);
}

TEST(Resampling, SinglePrecisionIsThatOfTheMeanOfItsValues)
{
  const RowMatrix weights = Adaptive(Fine(), Coarse());
  const Values values = Fine().Vertices;
  const Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor> single = values.cast<float>();
  Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor> found(weights.rows(), 3);
  ResampleMeans<float>(
    View(weights), ViewColumns(single.data(), 3), ViewColumns(found.data(), 3), SerialFor());
  EXPECT_LT((found.cast<double>() - Means(weights, values)).cwiseAbs().maxCoeff(), 2e-6);
}

TEST(Resampling, LabelsHaveTheLargestSumOfWeights)
{
  const RowMatrix weights = FromDense((Eigen::MatrixXd(4, 4) << 0.25, 0.35, 0.15, 0.25, // 7 has 0.5
    0.0, 0.5, 0.0, 0.5, // equal: the smaller
    0.0, 0.0, 1.0, 0.0, // missing
    0.0, 0.0, 0.0, 0.0)
                                        .finished());
  Values labels(4, 2);
  labels << 7.0, 1.0, 3.0, 1.0, Missing, Missing, 7.0, -2.0;
  const Values found = Labels(weights, labels);
  EXPECT_EQ(found(0, 0), 7.0);
  EXPECT_EQ(found(0, 1), 1.0);
  EXPECT_EQ(found(1, 0), 3.0);
  EXPECT_EQ(found(1, 1), -2.0);
  EXPECT_TRUE(std::isnan(found(2, 0)));
  EXPECT_TRUE(std::isnan(found(3, 1)));
}

TEST(Resampling, HasTheSameBitsOnAnyNumberOfThreads)
{
  const AreaSphere source = Uneven(Testing::Icosphere(6), 0.0);
  const AreaSphere target = Uneven(Testing::Rotated(Testing::Icosphere(5), 0.3), 1.0);
  const Testing::ThreadedFor three(3);
  const RowMatrix one = Adaptive(source, target);
  const RowMatrix other =
    ResamplingWeights(ResamplingMethod::AdaptiveBarycentricArea, source, target, {}, three, {});
  ASSERT_EQ(one.nonZeros(), other.nonZeros());
  EXPECT_EQ(0, std::memcmp(one.valuePtr(), other.valuePtr(), sizeof(double) * one.nonZeros()));
  EXPECT_EQ(
    0, std::memcmp(one.innerIndexPtr(), other.innerIndexPtr(), sizeof(Index) * one.nonZeros()));
}

TEST(Resampling, ReportsProgressAndStops)
{
  const AreaSphere source = Coarse();
  std::vector<double> fractions;
  const ProgressMonitor::Callback report = [&](double fraction)
  {
    fractions.push_back(fraction);
    return true;
  };
  ResamplingWeights(ResamplingMethod::AdaptiveBarycentricArea, source, Fine(), {}, SerialFor(),
    ProgressMonitor(report));
  ASSERT_GE(fractions.size(), 3U);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_EQ(fractions.back(), 1.0);
  const ProgressMonitor::Callback stop = [](double fraction) { return fraction < 0.5; };
  EXPECT_THROW(ResamplingWeights(ResamplingMethod::AdaptiveBarycentricArea, source, Fine(), {},
                 SerialFor(), ProgressMonitor(stop)),
    Aborted);
}

} // namespace SurfaceDiffusion
