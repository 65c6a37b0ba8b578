// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Foundation/SymmetricModes.h"
#include "Core/Models/Fields/CellScaleFilter.h"
#include "Core/Models/Fields/FunctionDiagonal.h"
#include "Core/Models/Fields/RandomField.h"
#include "Core/Models/Fields/ScaleFilter.h"
#include "Core/Operators/CotanWeights.h"
#include "Core/Solvers/SolverChoice.h"
#include "Meshes.h"
#include "ThreadedFor.h"

#include <gtest/gtest.h>

#include <numeric>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

double Heat(double x)
{
  return std::exp(-x);
}

/// f(L) M^-1 with L = M^-1 K by all eigenvectors.
Eigen::MatrixXd DenseFunction(
  const Assembler& assembler, const std::function<double(double)>& f, bool timesMass = false)
{
  const TriangleMesh& mesh = assembler.Mesh();
  SparseMatrix stiffness = ZeroMatrix(assembler.Pattern());
  assembler.Fill(stiffness, Vector::Zero(mesh.NumberOfVertices()), 1.0, CotanWeights(mesh));
  const Vector roots = mesh.ControlAreas().cwiseSqrt().cwiseInverse();
  const SymmetricModes dense(roots.asDiagonal() * Eigen::MatrixXd(stiffness) * roots.asDiagonal());
  const Vector values = dense.Eigenvalues.cwiseMax(0.0).unaryExpr(f);
  const Eigen::MatrixXd vectors = roots.asDiagonal() * dense.Vectors;
  Eigen::MatrixXd result = vectors * values.asDiagonal() * vectors.transpose();
  if (timesMass)
  {
    result = result * mesh.ControlAreas().asDiagonal();
  }
  return result;
}

std::vector<std::int64_t> Numbers(Index count)
{
  std::vector<std::int64_t> numbers(static_cast<std::size_t>(count));
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

RandomField MakeField(const std::shared_ptr<const Assembler>& assembler,
  const RandomField::Settings& settings, const ParallelFor& parallel = SerialFor())
{
  const TriangleMesh& mesh = assembler->Mesh();
  return { assembler, CotanWeights(mesh), settings, Numbers(mesh.NumberOfVertices()), Vector(),
    parallel };
}

Values Draw(const std::shared_ptr<const Assembler>& assembler,
  const RandomField::Settings& settings, Index count, std::int64_t first = 0, std::int64_t seed = 0)
{
  Values fields(assembler->Mesh().NumberOfVertices(), count);
  MakeField(assembler, settings).Draw(seed, first, fields);
  return fields;
}

RandomField::Settings Gaussian(double width)
{
  RandomField::Settings settings;
  settings.Width = width;
  return settings;
}

RandomField::Settings MaternField(double range, double nu)
{
  RandomField::Settings settings;
  settings.Covariance = FieldCovariance::Matern;
  settings.Range = range;
  settings.Nu = nu;
  return settings;
}

std::vector<RandomField::Settings> AllCovariances()
{
  return { Gaussian(0.4), MaternField(0.8, 1), MaternField(0.8, 3), MaternField(0.8, 1.7) };
}

/// The weight of spherical harmonics of degree l in the covariance, without a factor.
double WeightOfDegree(const RandomField::Settings& settings, int l)
{
  const double lambda = l * (l + 1.0);
  if (settings.Covariance == FieldCovariance::Gaussian)
  {
    return std::exp(-settings.Width * settings.Width / (8.0 * std::log(2.0)) * lambda);
  }
  const double kappa = std::sqrt(8.0 * settings.Nu) / settings.Range;
  return std::pow(kappa * kappa + lambda, -settings.Nu - 1.0);
}

/// The correlation at the angle `angle` on the unit sphere, by Legendre polynomials.
double CorrelationOnSphere(const RandomField::Settings& settings, double angle)
{
  const double x = std::cos(angle);
  double before = 1.0;
  double polynomial = x;
  double sum = WeightOfDegree(settings, 0);
  double all = sum;
  for (int l = 1; l < 400; ++l)
  {
    const double weight = (2.0 * l + 1.0) * WeightOfDegree(settings, l);
    sum += weight * polynomial;
    all += weight;
    before = std::exchange(polynomial, ((2.0 * l + 1.0) * x * polynomial - l * before) / (l + 1.0));
  }
  return sum / all;
}

} // namespace

TEST(ResolventPolynomial, SeriesHoldsExactlyAtBothEnds)
{
  const auto g = [](double y) { return y * y / (1.0 - 2.0 * y + 2.0 * y * y); };
  for (const int degree : { 1, 2, 5, 10 })
  {
    const std::vector<double> series = ChebyshevSeries(g, degree);
    EXPECT_NEAR(SumChebyshev(series, 0.0), 0.0, 1e-15);
    EXPECT_NEAR(SumChebyshev(series, 1.0), 1.0, 1e-15);
  }
  EXPECT_NEAR(SumChebyshev(ChebyshevSeries([](double y) { return y * y; }, 2), 0.3), 0.09, 1e-16);
}

TEST(ResolventPolynomial, IsTheFunctionOfTheDenseOperator)
{
  for (const Testing::Surface& s : { Strip(24, 9, 5.0, 1.0), Disk(8), ThreeFins(7), Moebius(30, 6),
         Joined(Torus(16, 8), Moved(Icosphere(1), { 9.0, 0.0, 0.0 })) })
  {
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    constexpr double t = 0.02;
    constexpr double pole = 8.37;
    Values u = Noise(mesh, 19);
    const double before = RootMeanSquare(mesh, u);
    const Values expected = DenseFunction(
                              *assembler, [](double lambda) { return Heat(t * lambda); }, true) *
      u;
    ResolventPolynomial heat(assembler, CotanWeights(mesh), t / pole,
      ChebyshevSeries([](double y) { return y > 0.0 ? Heat(pole * (1.0 / y - 1.0)) : 0.0; }, 10),
      MakeCholeskySolver());
    heat.Apply(u);
    EXPECT_LT(RootMeanSquare(mesh, u - expected), 3e-5 * before);
  }
}

TEST(ResolventPolynomial, KeepsConstantsAndIntegralsOfComponents)
{
  const Testing::Surface s = Joined(Torus(40, 20), Moved(Icosphere(3), { 9.0, 0.0, 0.0 }));
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  Values u(mesh.NumberOfVertices(), 2);
  u << Vector::Constant(mesh.NumberOfVertices(), 1e6), Noise(mesh).array() + 100.0;
  const Values before = u;
  for (const int order : { 1, 2 })
  {
    u = before;
    ScaleFilter(assembler, Vector::Constant(u.rows(), 3.0), order).Apply(u);
    EXPECT_LT((u.col(0).array() / 1e6 - 1.0).abs().maxCoeff(), 1e-14);
    EXPECT_GT((u.col(1) - before.col(1)).norm(), 0.1 * Noise(mesh).norm());
    for (Index c = 0; c < mesh.NumberOfComponents(); ++c)
    {
      double change = 0.0;
      double total = 0.0;
      for (Index k = mesh.ComponentsBegin()[c]; k < mesh.ComponentsBegin()[c + 1]; ++k)
      {
        change += mesh.ControlAreas()[k] * (u(k, 1) - before(k, 1));
        total += mesh.ControlAreas()[k] * before(k, 1);
      }
      EXPECT_LT(std::abs(change), 1e-14 * total);
    }
  }
}

// On cells, which are pairs of triangles and single ones, in two parts, one of which has a boundary.
TEST(CellScaleFilter, KeepsConstantsAndIntegralsOfEachPart)
{
  const Testing::Surface s = Joined(Icosphere(2), Moved(Strip(20, 6, 4.0, 1.0), { 5.0, 0.0, 0.0 }));
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  std::vector<Index> cells;
  const Index ofBall = Icosphere(2).NumberOfTriangles();
  for (Index t = 0; t < s.NumberOfTriangles(); ++t)
  {
    cells.push_back(t < ofBall ? t : ofBall + (t - ofBall) / 2); // the triangles of a square follow
  }
  const Index count = cells.back() + 1;
  Values before(count, 2);
  for (Index c = 0; c < count; ++c)
  {
    before(c, 0) = 1e6;
    before(c, 1) = 2.0 + std::sin(37.0 * c);
  }
  for (const int order : { 1, 2 })
  {
    CellScaleFilter filter(
      assembler, s.Vertices, cells, count, Vector::Constant(mesh.NumberOfVertices(), 4.0), order);
    Values f = before;
    filter.Apply(f);
    EXPECT_LT((f.col(0).array() / 1e6 - 1.0).abs().maxCoeff(), 1e-13);
    EXPECT_GT(
      (f.col(1) - before.col(1)).norm(), 0.3 * (before.col(1).array() - 2.0).matrix().norm());
    const Vector moved = filter.CellAreas().cwiseProduct(f.col(1) - before.col(1));
    EXPECT_LT(std::abs(moved.head(ofBall).sum()), 1e-13 * filter.CellAreas().sum());
    EXPECT_LT(std::abs(moved.tail(count - ofBall).sum()), 1e-13 * filter.CellAreas().sum());
  }
}

TEST(FunctionDiagonal, IsThatOfTheDenseOperator)
{
  const auto square = [](double x) { return 1.0 / ((1.0 + x) * (1.0 + x)); };
  const PoleSum poles = FitPoles(square, 0.8, 1.2, 8);
  for (const Testing::Surface& s : { Strip(24, 9, 5.0, 1.0), Disk(8), ThreeFins(7), Torus(24, 12) })
  {
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    for (const double step : { 1e-3, 0.1, 10.0 })
    {
      const Vector expected =
        DenseFunction(*assembler, [&](double lambda) { return square(step * lambda); }).diagonal();
      const Vector found = FunctionDiagonal(*assembler, CotanWeights(mesh), step, poles, Vector());
      EXPECT_LT((found - expected).cwiseQuotient(expected).cwiseAbs().maxCoeff(), 1e-6) << step;
    }
  }
}

// The variance of each field by all eigenvectors of the surface, beside boundaries, too.
TEST(RandomField, HasTheVarianceOfTheDenseOperator)
{
  for (const Testing::Surface& s : { Strip(24, 9, 3.0, 1.0), Disk(8), Icosphere(2) })
  {
    const auto assembler = MakeAssembler(s);
    for (RandomField::Settings settings : AllCovariances())
    {
      const double unit = assembler->Mesh().LengthUnit();
      settings.Width /= unit;
      settings.Range /= unit;
      const double t = settings.Width * settings.Width / (16.0 * std::log(2.0));
      const double kappa = std::sqrt(8.0 * settings.Nu) / settings.Range;
      const bool isMatern = settings.Covariance == FieldCovariance::Matern;
      const auto square = [&](double lambda)
      {
        return isMatern ? std::pow(kappa * kappa + lambda, -settings.Nu - 1.0)
                        : Heat(2.0 * t * lambda);
      };
      const double onPlane = isMatern
        ? std::pow(kappa, -2.0 * settings.Nu) / (4.0 * Pi * settings.Nu)
        : 1.0 / (8.0 * Pi * t);
      const Vector expected = (DenseFunction(*assembler, square).diagonal() / onPlane).cwiseSqrt();
      const Vector found = MakeField(assembler, settings).Deviations();
      EXPECT_LT((found - expected).cwiseQuotient(expected).cwiseAbs().maxCoeff(), 1e-3);
    }
  }
}

// The covariances of all pairs of vertices by all eigenvectors, of any smoothness and with ranges that
// differ from place to place.
TEST(RandomField, OfAnySmoothnessHasTheCovarianceOfTheDenseOperator)
{
  for (const Testing::Surface& s : { Strip(24, 9, 3.0, 1.0), Disk(8),
         Joined(Icosphere(2), Moved(Torus(16, 8), { 9.0, 0.0, 0.0 })) })
  {
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    const Index n = mesh.NumberOfVertices();
    SparseMatrix stiffness = ZeroMatrix(assembler->Pattern());
    assembler->Fill(stiffness, Vector::Zero(n), 1.0, CotanWeights(mesh));
    const Vector roots = mesh.ControlAreas().cwiseSqrt().cwiseInverse();
    for (const bool differ : { false, true })
    {
      for (const double nu : { 0.05, 0.25, 0.5, 0.9, 1.0, 1.3, 2.0, 2.6, 3.0, 4.0 })
      {
        RandomField::Settings settings = MaternField(0.8 / mesh.LengthUnit(), nu);
        if (differ)
        {
          const Values x =
            Sample(mesh, s, [](const Eigen::RowVector3d& p) { return 1.0 + 0.6 * std::sin(p[0]); });
          settings.Ranges = settings.Range * x.col(0);
        }
        const Vector ranges = differ ? settings.Ranges : Vector::Constant(n, settings.Range);
        const Vector kappas = std::sqrt(8.0 * nu) * ranges.cwiseInverse();
        Eigen::MatrixXd matrix =
          roots.asDiagonal() * Eigen::MatrixXd(stiffness) * roots.asDiagonal();
        matrix.diagonal() += kappas.cwiseAbs2();
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> dense(matrix);
        const Eigen::MatrixXd vectors = roots.asDiagonal() * dense.eigenvectors();
        const Eigen::MatrixXd covariance = vectors *
          dense.eigenvalues().array().pow(-nu - 1.0).matrix().asDiagonal() * vectors.transpose();
        const Vector deviations = covariance.diagonal().cwiseSqrt();
        const Vector onPlane = kappas.array().pow(-nu) / std::sqrt(4.0 * Pi * nu);
        for (const bool isUnit : { true, false })
        {
          settings.HasUnitVariance = isUnit;
          const Vector scale = (isUnit ? deviations : onPlane).cwiseInverse();
          Values found = Values::Identity(n, n);
          MakeField(assembler, settings).ApplyTransposed(found);
          const Values expected = scale.asDiagonal() * covariance * scale.asDiagonal();
          const Values error = found.transpose() * found - expected;
          EXPECT_LT(error.cwiseAbs().maxCoeff(), 5e-3 * expected.diagonal().maxCoeff())
            << nu << " " << differ << " " << isUnit;
        }
      }
    }
  }
}

TEST(RandomField, DrawsWhatItsTransposeSays)
{
  const auto assembler = MakeAssembler(Disk(6));
  const Index n = assembler->Mesh().NumberOfVertices();
  for (const RandomField::Settings& settings : AllCovariances())
  {
    Values transposed = Values::Identity(n, n);
    MakeField(assembler, settings).ApplyTransposed(transposed);
    RandomField::Settings white = Gaussian(0.0);
    const Values noise = Draw(assembler, white, 3);
    const Values fields = Draw(assembler, settings, 3);
    EXPECT_LT((fields - transposed.transpose() * noise).cwiseAbs().maxCoeff(), 1e-9);
  }
}

// Fields of twice the width share the factors of all but three poles, and have the same variances.
TEST(RandomField, WidthsThatShareTheirPolesHaveTheSameVariances)
{
  for (const Testing::Surface& s : { Strip(24, 9, 3.0, 1.0), Disk(8), Icosphere(3) })
  {
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    SharedPoles shared;
    RandomField::Settings settings;
    for (settings.Width = 2.0 * MeanEdge(mesh); settings.Width * mesh.LengthUnit() < 8.0;
         settings.Width *= 2.0)
    {
      const double t = settings.Width * settings.Width / (16.0 * std::log(2.0));
      const Vector expected =
        DenseFunction(*assembler, [&](double lambda) { return Heat(2.0 * t * lambda); }).diagonal();
      const RandomField field(assembler, CotanWeights(mesh), settings,
        Numbers(mesh.NumberOfVertices()), Vector(), SerialFor(), ProgressMonitor(), &shared);
      const Vector found = field.Deviations().cwiseAbs2() / (8.0 * Pi * t);
      EXPECT_LT((found - expected).cwiseQuotient(expected).cwiseAbs().maxCoeff(), 8e-4);
      EXPECT_EQ(shared.Diagonals.size(), 14) << "those of a narrower field are forgotten";
    }
  }
}

TEST(RandomField, OfNoWidthIsWhiteNoiseOfVarianceOne)
{
  const auto assembler = MakeAssembler(Icosphere(4));
  RandomField::Settings settings;
  settings.Width = 0.0;
  const Values fields = Draw(assembler, settings, 20);
  EXPECT_NEAR(fields.cwiseAbs2().mean(), 1.0, 0.02);
  EXPECT_LT(std::abs(fields.mean()), 0.02);
}

TEST(RandomField, CovarianceOnTheSphereIsTheSumOfLegendrePolynomials)
{
  const Testing::Surface s = Icosphere(5);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  constexpr Index count = 400;
  for (RandomField::Settings settings : AllCovariances())
  {
    const RandomField::Settings given = settings;
    settings.Width /= mesh.LengthUnit();
    settings.Range /= mesh.LengthUnit();
    const Values fields = Draw(assembler, settings, count);
    EXPECT_NEAR(std::sqrt(fields.cwiseAbs2().mean()), 1.0, 0.01);
    std::vector<double> sums(11, 0.0);
    std::vector<double> expected(11, 0.0);
    std::vector<Index> numbers(11, 0);
    for (Index i = 0; i < mesh.NumberOfVertices(); i += 197)
    {
      for (Index j = 0; j < mesh.NumberOfVertices(); ++j)
      {
        const auto p = s.Vertices.row(mesh.InputVertex()[i]);
        const auto q = s.Vertices.row(mesh.InputVertex()[j]);
        const double angle = std::acos(std::clamp(p.dot(q), -1.0, 1.0));
        const auto bin = static_cast<std::size_t>(angle / 0.1);
        if (bin < sums.size())
        {
          sums[bin] += fields.row(i).dot(fields.row(j)) / count;
          expected[bin] += CorrelationOnSphere(given, angle);
          ++numbers[bin];
        }
      }
    }
    for (std::size_t bin = 0; bin < sums.size(); ++bin)
    {
      // Means over all pairs of a distance and 400 fields, of some 80 independent places each.
      EXPECT_NEAR(sums[bin] / numbers[bin], expected[bin] / numbers[bin], 0.02) << bin;
    }
  }
}

TEST(RandomField, DependsOnItsNumberAloneAndNotOnThreads)
{
  const auto assembler = MakeAssembler(Torus(30, 16));
  for (const RandomField::Settings& settings : AllCovariances())
  {
    const Values all = Draw(assembler, settings, 21);
    EXPECT_EQ(all.middleCols(18, 2), Draw(assembler, settings, 2, 18));
    Values threaded(all.rows(), all.cols());
    const ThreadedFor threads(3);
    MakeField(assembler, settings, threads).Draw(0, 0, threaded);
    EXPECT_EQ(all, threaded);
    EXPECT_GT((all - Draw(assembler, settings, 21, 0, 1)).norm(), all.norm()) << "independent";
  }
}

// On uneven surfaces the first solve with a matrix finds that another method is faster: it must be the same one in all.
TEST(RandomField, OfAnySmoothnessDependsOnNoFieldBeforeOnUnevenSurfaces)
{
  Testing::Surface flat = Icosphere(5);
  flat.Vertices.col(2) *= 0.05;
  const auto assembler = MakeAssembler(flat);
  RandomField::Settings settings;
  settings.Covariance = FieldCovariance::Matern;
  settings.Range = 12.0 * assembler->Mesh().MeanEdgeLength();
  settings.Nu = 0.7;
  RandomField field = MakeField(assembler, settings);
  Values first(assembler->Mesh().NumberOfVertices(), 3), again = first, last(first.rows(), 1);
  field.Draw(0, 0, first);
  field.Draw(0, 0, again);
  field.Draw(0, 2, last);
  EXPECT_EQ(first, again);
  EXPECT_EQ(first.col(2), last.col(0));
}

// Y_lm times 1 / (1 + 2 (l (l + 1) / (k R)^2)^order), with an error of second order.
TEST(ScaleFilter, ScalesSphericalHarmonics)
{
  constexpr double radius = 3.0;
  constexpr double wavelength = 5.0;
  const double k = 2.0 * Pi / wavelength;
  for (const int order : { 1, 2 })
  {
    std::vector<double> errors;
    for (const int subdivisions : { 3, 4 })
    {
      const Testing::Surface s = Icosphere(subdivisions, radius);
      const auto assembler = MakeAssembler(s);
      const TriangleMesh& mesh = assembler->Mesh();
      Values u = Sample(mesh, s,
        [](const Eigen::RowVector3d& x)
        { return x[0] * x[1] * x[2] / (radius * radius * radius); }); // l = 3
      const double expected = 1.0 / (1.0 + 2.0 * std::pow(12.0 / std::pow(k * radius, 2), order));
      const Values exact = expected * u;
      ScaleFilter(assembler, Vector::Constant(u.rows(), wavelength / mesh.LengthUnit()), order)
        .Apply(u);
      errors.push_back(RootMeanSquare(mesh, u - exact) / RootMeanSquare(mesh, exact));
    }
    EXPECT_LT(errors[1], 0.01);
    EXPECT_GT(ObservedOrder(errors[0], errors[1]), 1.9);
  }
}

// By the recurrence and, where that would be longer, by the polynomial.
TEST(ScaleFilter, OfOrderTwoIsThePolynomialOfSteps)
{
  const Testing::Surface s = Joined(Torus(40, 20), Moved(Disk(12), { 9.0, 0.0, 0.0 }));
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  Values f(mesh.NumberOfVertices(), 18);
  f << Noise(mesh, 17), Vector::Constant(mesh.NumberOfVertices(), 1e6);
  f.col(3) *= 1e-200;
  const ThreadedFor threads(3);
  for (const double edges : { 3.0, 7.0, 15.0, 3000.0 })
  {
    const Vector wavelengths = Vector::Constant(f.rows(), edges * mesh.MeanEdgeLength());
    CornerWeights coefficients = CotanWeights(mesh);
    const Vector diffusivities = ScaleFilterDiffusivities(mesh, wavelengths, 2);
    for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
    {
      coefficients.row(t) *= diffusivities[t];
    }
    Values expected = f;
    ResolventPolynomial(assembler, coefficients, 1.0, ScaleFilterSeries(2), MakeCholeskySolver())
      .Apply(expected);
    Values found = f;
    ScaleFilter(assembler, wavelengths, 2, threads).Apply(found);
    for (Index c = 0; c < f.cols(); ++c)
    {
      EXPECT_LT((found.col(c) - expected.col(c)).cwiseAbs().maxCoeff(),
        2e-9 * f.col(c).cwiseAbs().maxCoeff())
        << edges << " " << c;
    }
    Values alone = f.rightCols(2);
    ScaleFilter(assembler, wavelengths, 2).Apply(alone);
    EXPECT_EQ(alone, found.rightCols(2)) << edges;
    SquareResolvent square(assembler, coefficients);
    EXPECT_EQ(square.ExpectedIterations() < 500.0, edges < 100.0);
    Values once = f;
    EXPECT_TRUE(square.Apply(once)) << "within twice the expected iterations";
    EXPECT_EQ(edges < 100.0, once == found);
  }
}

TEST(ScaleFilter, SolvesItsEquationForWavelengthsThatDiffer)
{
  const Testing::Surface s = Disk(20);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values x = Sample(mesh, s, [](const Eigen::RowVector3d& p) { return p[0]; });
  const Vector wavelengths = (0.5 + 0.4 * x.col(0).array()) / mesh.LengthUnit();
  const Values f = Noise(mesh, 3);
  CornerWeights coefficients = CotanWeights(mesh);
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    double square = 0.0;
    for (int a = 0; a < 3; ++a)
    {
      square += std::pow(wavelengths[mesh.TriangleVertices()(t, a)] / (2.0 * Pi), 2) / 3.0;
    }
    coefficients.row(t) *= square;
  }
  SparseMatrix stiffness = ZeroMatrix(assembler->Pattern());
  assembler->Fill(stiffness, Vector::Zero(mesh.NumberOfVertices()), 1.0, coefficients);
  const auto laplace = [&](const Values& u) -> Values
  { return mesh.ControlAreas().cwiseInverse().asDiagonal() * (stiffness * u); };
  for (const int order : { 1, 2 })
  {
    Values u = f;
    ScaleFilter(assembler, wavelengths, order).Apply(u);
    const Values power = order == 1 ? laplace(u) : laplace(laplace(u));
    EXPECT_LT((u + 2.0 * power - f).norm(), 1e-6 * f.norm());
    EXPECT_LT(u.norm(), 0.5 * f.norm());
  }
}
