// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/TikhonovDeblurring.h"
#include "Core/Models/TotalVariation/TotalVariationDeblurring.h"
#include "Core/Operators/CotanWeights.h"
#include "Core/Operators/MeanCorrection.h"
#include "EveryMeshFile.h"
#include "Heat.h"
#include "TotalVariation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

constexpr int Steps = 4;
const double CapAngle = Pi / 3.0;

/// A unit sphere, or another surface, its blur of `edges` mean edge lengths, and what tests measure
/// on it.
struct BlurredSphere
{
  Surface Sphere;
  std::shared_ptr<const Assembler> Operators;
  const TriangleMesh& Mesh;
  double Width;

  explicit BlurredSphere(int level, double edges = 4.0)
    : BlurredSphere(Icosphere(level), edges)
  {
  }
  explicit BlurredSphere(Surface surface, double edges = 4.0)
    : Sphere(std::move(surface))
    , Operators(MakeAssembler(Sphere))
    , Mesh(Operators->Mesh())
    , Width(edges * MeanEdge(Mesh))
  {
  }

  std::unique_ptr<HeatBlur> MakeBlur() const
  {
    return std::make_unique<HeatBlur>(this->Operators, this->Width, Steps, MakeCholeskySolver());
  }
  Values Blur(Values u) const
  {
    StepReport report;
    this->MakeBlur()->Apply(u, report);
    return u;
  }
  /// lambda in coordinate units.
  std::unique_ptr<TikhonovDeblurring> MakeTikhonov(
    PointData data, double lambda, std::shared_ptr<DeblurringSpace> space = nullptr) const
  {
    const double unit = this->Mesh.LengthUnit();
    return std::make_unique<TikhonovDeblurring>(this->Operators,
      CotanWeights(this->Mesh, SerialFor()), std::move(data), lambda * unit * unit,
      this->MakeBlur(), MakeCholeskySolver(), IterationLimits(), SerialFor(), std::move(space));
  }
  /// lambda in 1/(h R).
  std::unique_ptr<TotalVariationDeblurring> MakeTotalVariation(
    PointData data, double lambda, double tolerance = 1e-4, int iterations = 2000) const
  {
    TotalVariationDeblurring::Settings settings;
    settings.Fidelity = lambda / MeanEdge(this->Mesh);
    settings.StopTolerance = tolerance;
    settings.MaximumNumberOfIterations = iterations;
    return std::make_unique<TotalVariationDeblurring>(
      this->Operators, TangentVectors(), std::move(data), settings, this->MakeBlur());
  }

  Values Coordinate() const
  {
    Values z(this->Mesh.NumberOfVertices(), 1);
    for (Index i = 0; i < this->Mesh.NumberOfVertices(); ++i)
    {
      z(i, 0) = this->Sphere.Vertices(this->Mesh.InputVertex()[i], 2);
    }
    return z;
  }
  Values Cap() const { return Testing::Cap(this->Mesh, this->Sphere, CapAngle); }

  double Product(const Values& a, const Values& b) const
  {
    return a.col(0).cwiseProduct(b.col(0)).dot(this->Mesh.ControlAreas());
  }
  double RootMeanSquare(const Values& a) const
  {
    return std::sqrt(this->Product(a, a) / this->Mesh.ControlAreas().sum());
  }
  /// The area of values between 10 and 90 %, over the perimeter of the cap.
  double EdgeWidth(const Values& u) const
  {
    double area = 0.0;
    for (Index i = 0; i < this->Mesh.NumberOfVertices(); ++i)
    {
      area += u(i, 0) > 0.1 && u(i, 0) < 0.9 ? this->Mesh.ControlAreas()[i] : 0.0;
    }
    return area * std::pow(this->Mesh.LengthUnit(), 2) / (2.0 * Pi * std::sin(CapAngle));
  }
};

} // namespace

TEST(HeatBlur, TimeOfAWidthTendsToThatOfTheGaussian)
{
  const double gaussian = 1.0 / (16.0 * std::log(2.0));
  EXPECT_NEAR(HeatBlur::TimeOfWidth(1.0, 4), 1.6383362 * gaussian, 1e-6);
  EXPECT_NEAR(HeatBlur::TimeOfWidth(3.0, 4), 9.0 * HeatBlur::TimeOfWidth(1.0, 4), 1e-12);
  double excess = HeatBlur::TimeOfWidth(1.0, 2) / gaussian - 1.0;
  for (int steps = 4; steps <= 64; steps *= 2)
  {
    const double next = HeatBlur::TimeOfWidth(1.0, steps) / gaussian - 1.0;
    EXPECT_LT(next, 0.5 * excess) << steps;
    excess = next;
  }
  EXPECT_LT(excess, 0.03);
}

TEST(HeatBlur, PointSpreadFunctionHasTheWidthAskedFor)
{
  const BlurredSphere s(5, 8.0);
  const Eigen::RowVector3d pole = s.Sphere.Vertices.row(s.Mesh.InputVertex()[0]);
  Values u = Values::Zero(s.Mesh.NumberOfVertices(), 1);
  u(0, 0) = 1.0;
  u = s.Blur(u);
  // The distance at half the maximum, by a straight line through the values near it.
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d side = Eigen::Vector2d::Zero();
  for (Index i = 0; i < s.Mesh.NumberOfVertices(); ++i)
  {
    const Eigen::RowVector3d place = s.Sphere.Vertices.row(s.Mesh.InputVertex()[i]);
    const Eigen::Vector2d line(1.0, u(i, 0) / u(0, 0) - 0.5);
    if (std::abs(line[1]) < 0.2)
    {
      normal += line * line.transpose();
      side += std::acos(pole.dot(place)) * line;
    }
  }
  const double radius = normal.inverse().row(0).dot(side);
  EXPECT_NEAR(2.0 * radius / (s.Width * s.Mesh.LengthUnit()), 1.0, 0.02);
}

TEST(HeatBlur, IsSelfAdjointOfNormOneAndKeepsConstantsTotalsAndBounds)
{
  const BlurredSphere s(3);
  const Values u = Noise(s.Mesh);
  const Values v = Noise(s.Mesh, 1, 11);
  const Values hu = s.Blur(u);
  const double scale = s.Product(u, u);
  EXPECT_NEAR(s.Product(s.Blur(v), u), s.Product(v, hu), 1e-12 * scale);
  EXPECT_LT(s.Product(hu, hu), scale);
  EXPECT_NEAR(Total(s.Mesh, hu, 0), Total(s.Mesh, u, 0), 1e-12);
  EXPECT_LE(hu.maxCoeff(), u.maxCoeff());
  EXPECT_GE(hu.minCoeff(), u.minCoeff());
  const Values one = Values::Ones(u.rows(), 1);
  EXPECT_LT((s.Blur(one) - one).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(HeatBlur, ErrorsAreRelativeToTheContrastOfTheValues)
{
  const BlurredSphere s(4, 8.0);
  HeatBlur blur(s.Operators, s.Width, Steps, MakeConjugateGradientSolver());
  const double offset = 1e6;
  Values u = Noise(s.Mesh);
  Values far = u.array() + offset;
  StepReport report;
  blur.Apply(u, report);
  blur.Apply(far, report);
  EXPECT_LT((far.array() - offset - u.array()).abs().maxCoeff(), 1e-8);
}

TEST(TikhonovDeblurring, KeepsTheTotalWithAnInexactSolver)
{
  const BlurredSphere sphere(3);
  Values f(sphere.Mesh.NumberOfVertices(), 2);
  f << sphere.Blur(sphere.Cap()), Noise(sphere.Mesh).array() + 3.0;
  TikhonovDeblurring model(sphere.Operators, CotanWeights(sphere.Mesh), PointData::FromValues(f),
    100.0, sphere.MakeBlur(), MakeConjugateGradientSolver(), { 0.05, 1000 });
  model.Advance(ProgressMonitor());
  EXPECT_GT((model.State() - f).cwiseAbs().maxCoeff(), 0.1);
  for (int k = 0; k < 2; ++k)
  {
    const double total = Total(sphere.Mesh, f, k);
    EXPECT_NEAR(Total(sphere.Mesh, model.State(), k), total, 1e-12 * total);
  }
}

TEST(TikhonovDeblurring, SphericalHarmonicsAreScaledByTheTransferFunctionWithSecondOrder)
{
  const double lambda = 10.0;
  const double width = 0.6;
  const double h = std::pow(1.0 + HeatBlur::TimeOfWidth(width, Steps) * 2.0 / Steps, -Steps);
  const double exact = h / (h * h + 2.0 / lambda);
  std::vector<double> errors;
  for (const int level : { 2, 3, 4 })
  {
    BlurredSphere s(level);
    s.Width = width / s.Mesh.LengthUnit();
    const Values f = s.Coordinate();
    const auto model = s.MakeTikhonov(PointData::FromValues(f), lambda);
    Advance(*model, 1);
    errors.push_back(s.RootMeanSquare(model->State() - exact * f));
  }
  EXPECT_LT(errors[2], 1e-3);
  EXPECT_GT(std::log2(errors[0] / errors[1]), 1.8);
  EXPECT_GT(std::log2(errors[1] / errors[2]), 1.8);
}

TEST(TikhonovDeblurring, WithoutBlurItIsTheSteadyState)
{
  BlurredSphere s(3, 1e-4);
  PointData data = PointData::FromValues(Noise(s.Mesh, 2));
  data.Fixed.head(5) = true;
  data.Missing.segment(40, 30) = true;
  const auto steady = MakeHeat(
    s.Operators, data, HeatSettings(s.Mesh, 1.0, 50.0, LinearDiffusion::Scheme::SteadyState));
  Advance(*steady, 1);
  const auto model = s.MakeTikhonov(data, 50.0);
  Advance(*model, 1);
  EXPECT_LT((model->State() - steady->State()).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(TikhonovDeblurring, MinimisesItsEnergyAndKeepsTotalAndFixedValues)
{
  const BlurredSphere s(3);
  PointData data = PointData::FromValues(Noise(s.Mesh, 2));
  const auto free = s.MakeTikhonov(data, 200.0);
  Advance(*free, 1);
  EXPECT_NEAR(Total(s.Mesh, free->State(), 1), Total(s.Mesh, data.Start, 1), 1e-12);

  data.Fixed.head(5) = true;
  data.Missing.segment(40, 30) = true;
  const auto model = s.MakeTikhonov(data, 200.0);
  Advance(*model, 1);
  const Values u = model->State();
  EXPECT_EQ(u.topRows(5), data.Start.topRows(5));
  const double least = model->Energy();
  for (int trial = 0; trial < 4; ++trial)
  {
    Values other = u + 1e-3 * Noise(s.Mesh, 2, 100 + trial);
    other.topRows(5) = u.topRows(5);
    model->Restore(other.data());
    EXPECT_GT(model->Energy(), least);
  }
}

TEST(TikhonovDeblurring, ColumnsAreAsIfAloneAndMissingValuesAreNotRead)
{
  const BlurredSphere s(3);
  PointData data = PointData::FromValues(Noise(s.Mesh, 3));
  data.Missing.segment(40, 30) = true;
  const auto all = s.MakeTikhonov(data, 200.0);
  Advance(*all, 1);
  for (Eigen::Index k = 0; k < 3; ++k)
  {
    PointData alone = data;
    alone.Start = data.Start.col(k);
    alone.Given = data.Given.col(k);
    alone.Given.middleRows(40, 30).setConstant(1e3);
    const auto model = s.MakeTikhonov(alone, 200.0);
    Advance(*model, 1);
    EXPECT_LT((model->State() - all->State().col(k)).cwiseAbs().maxCoeff(), 1e-8);
  }
}

/// One Krylov space of the data serves the models of all weights; other data need a space of their own.
TEST(TikhonovDeblurring, AFunctionOfTheOperatorIsWhatConjugateGradientsFindInFewSolves)
{
  const BlurredSphere s(4);
  const double h = MeanEdge(s.Mesh) * s.Mesh.LengthUnit();
  const auto space = std::make_shared<DeblurringSpace>();
  for (const int seed : { 1, 2 })
  {
    const PointData data = PointData::FromValues(Noise(s.Mesh, 2, seed));
    for (const double weight : { 1.0, 0.1, 10.0, 0.01 })
    {
      const auto iterative = s.MakeTikhonov(data, weight / (h * h));
      iterative->Advance(ProgressMonitor());
      const auto model = s.MakeTikhonov(data, weight / (h * h), space);
      EXPECT_LE(model->Advance(ProgressMonitor()).Iterations, weight < 0.1 ? 80 : 48) << weight;
      EXPECT_LT((model->State() - iterative->State()).cwiseAbs().maxCoeff(), 1e-7) << weight;
    }
  }
}

TEST(TikhonovDeblurring, WeightsThatNeedManyStepsAndUnequalOnesAreFoundByConjugateGradients)
{
  const BlurredSphere s(4);
  const double h = MeanEdge(s.Mesh) * s.Mesh.LengthUnit();
  PointData data = PointData::FromValues(Noise(s.Mesh));
  const auto compare = [&](double weight)
  {
    const auto iterative = s.MakeTikhonov(data, weight / (h * h));
    iterative->Advance(ProgressMonitor());
    const auto model = s.MakeTikhonov(data, weight / (h * h), std::make_shared<DeblurringSpace>());
    model->Advance(ProgressMonitor());
    EXPECT_LT((model->State() - iterative->State()).cwiseAbs().maxCoeff(), 1e-7) << weight;
  };
  compare(1e-6);
  data.Missing.segment(40, 30) = true;
  compare(1.0);
}

TEST(TotalVariationDeblurring, RestoresTheEdgeOfABlurredCap)
{
  const BlurredSphere s(4);
  const Values blurred = s.Blur(s.Cap());
  const auto model = s.MakeTotalVariation(PointData::FromValues(blurred), 100.0);
  Advance(*model, 1);
  const Values& u = model->State();
  const Plateaus plateaus = MeasurePlateaus(s.Mesh, s.Sphere, u, CapAngle);
  EXPECT_NEAR(plateaus.Inside, 1.0, 0.02);
  EXPECT_NEAR(plateaus.Outside, 0.0, 0.02);
  EXPECT_LT(s.EdgeWidth(u), s.EdgeWidth(blurred) / 3.0);
  EXPECT_NEAR(Total(s.Mesh, u, 0), Total(s.Mesh, blurred, 0), 1e-12);
}

TEST(TotalVariationDeblurring, GainsThreeDecibelsOnTrueHeatFlowWithNoise)
{
  const BlurredSphere s(4);
  const double time = std::pow(s.Width * s.Mesh.LengthUnit(), 2) / (16.0 * std::log(2.0));
  Values f = Diffuse(s.Operators, PointData::FromValues(s.Cap()), time, 20);
  const double before = s.EdgeWidth(f);
  f += 0.01 * std::sqrt(3.0) * Noise(s.Mesh); // of the standard deviation 0.01
  const auto model = s.MakeTotalVariation(PointData::FromValues(f), 20.0);
  Advance(*model, 1);
  const double gain =
    20.0 * std::log10(s.RootMeanSquare(f - s.Cap()) / s.RootMeanSquare(model->State() - s.Cap()));
  EXPECT_GT(gain, 3.0);
  EXPECT_LT(s.EdgeWidth(model->State()), 0.4 * before);
}

/// The residual is a mean over the channels, so that they stop where one of them alone does.
TEST(TotalVariationDeblurring, EqualChannelsHaveTheResidualOfOne)
{
  const BlurredSphere s(3);
  const Values f = s.Blur(s.Cap()) + 0.1 * Noise(s.Mesh);
  const auto residualOf = [&](int channels)
  {
    TotalVariationDeblurring::Settings settings;
    settings.Fidelity = 10.0 / MeanEdge(s.Mesh);
    settings.StopTolerance = 1e-6;
    settings.MaximumNumberOfIterations = 4;
    settings.Regularization.Coupling = ChannelCoupling::PerChannel;
    TotalVariationDeblurring model(s.Operators, TangentVectors(),
      PointData::FromValues(f.replicate(1, channels)), settings, s.MakeBlur());
    return model.Advance(ProgressMonitor()).Residual;
  };
  const double one = residualOf(1);
  EXPECT_GT(one, 1e-5);
  EXPECT_NEAR(residualOf(4), one, 1e-6 * one);
}

TEST(TotalVariationDeblurring, EnergyNeverRises)
{
  const BlurredSphere s(3);
  PointData data = PointData::FromValues(s.Blur(s.Cap()) + 0.1 * Noise(s.Mesh));
  data.Fixed.head(5) = true;
  data.Missing.segment(40, 30) = true;
  double last = s.MakeTotalVariation(data, 10.0)->Energy();
  for (const int iterations : { 1, 2, 4, 8, 16, 32, 64 })
  {
    const auto model = s.MakeTotalVariation(data, 10.0, 1e-6, iterations);
    Advance(*model, 1);
    EXPECT_LE(model->Energy(), last) << iterations;
    EXPECT_EQ(model->State().topRows(5), data.Start.topRows(5));
    last = model->Energy();
  }
}

TEST(TotalVariationDeblurring, EnergyNeverRisesOnScannedMeshes)
{
  ForEachMeshFile(
    [](const Surface& surface)
    {
      const BlurredSphere s(surface);
      const PointData data = PointData::FromValues(Noise(s.Mesh));
      double last = s.MakeTotalVariation(data, 10.0)->Energy();
      for (const int iterations : { 1, 4 })
      {
        const auto model = s.MakeTotalVariation(data, 10.0, 1e-6, iterations);
        Advance(*model, 1);
        EXPECT_LE(model->Energy() - last, 1e-12 * last) << iterations;
        last = model->Energy();
      }
    });
}

TEST(TotalVariationDeblurring, WithoutBlurItIsTheMinimiserWithoutBlur)
{
  const BlurredSphere s(3, 1e-4);
  const PointData data = PointData::FromValues(s.Cap() + 0.2 * Noise(s.Mesh));
  const double lambda = 2.0;
  const auto deblurring = s.MakeTotalVariation(data, lambda, 1e-6);
  Advance(*deblurring, 1);
  TotalVariationFlow::Settings settings;
  settings.SteadyState = true;
  settings.Fidelity = lambda / MeanEdge(s.Mesh);
  settings.StopTolerance = 1e-8;
  const auto minimiser = MakeExact(s.Operators, data, settings);
  Advance(*minimiser, 1);
  EXPECT_LT(s.RootMeanSquare(deblurring->State() - minimiser->State()), 1e-4);
  EXPECT_NEAR(deblurring->Energy(), minimiser->Energy(), 1e-5 * minimiser->Energy());
}
