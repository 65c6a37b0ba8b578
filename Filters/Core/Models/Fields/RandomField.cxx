// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Fields/RandomField.h"

#include "Core/Foundation/Columns.h"
#include "Core/Foundation/Random.h"
#include "Core/Models/Fields/FunctionDiagonal.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

const double Pi = std::acos(-1.0);

/// exp(-t L) by 10 solves with s = t / 8.37, to 2e-5: of this degree the best pole.
constexpr int HeatDegree = 10;
constexpr double HeatPole = 8.37;

/// Twice the width is four times the time, three poles further.
const double RatioOfShared = std::cbrt(4.0);

/// What the covariance means for the numerics.
struct FieldOperator
{
  double Step = 0.0; ///< s of the resolvent
  std::vector<double> Series; ///< of p; none: a power
  Vector Extra; ///< e of ResolventPower; no row: 0
  double DeviationOnPlane = 1.0; ///< of p(Y) W
  PoleSum Squared; ///< near to p^2 as a function of s lambda
};

/// Of Matern with ranges that differ or a power that is no polynomial: the largest range is that of e = 0.
FieldOperator MakePower(const RandomField::Settings& settings)
{
  FieldOperator found;
  const double largest = settings.Ranges.size() > 0 ? settings.Ranges.maxCoeff() : settings.Range;
  const double kappa = std::sqrt(8.0 * settings.Nu) / largest;
  found.Step = 1.0 / (kappa * kappa);
  if (settings.Ranges.size() > 0)
  {
    found.Extra = (largest / settings.Ranges.array()).square() - 1.0;
  }
  found.DeviationOnPlane = kappa / std::sqrt(4.0 * Pi * settings.Nu);
  found.Squared = PolesOfSquaredPower(
    0.5 * (settings.Nu + 1.0), found.Extra.size() > 0 ? found.Extra.maxCoeff() : 0.0);
  return found;
}

FieldOperator MakeOperator(const RandomField::Settings& settings, SharedPoles* shared)
{
  const bool isPolynomial = settings.Nu == 1.0 || settings.Nu == 3.0;
  if (settings.Covariance == FieldCovariance::Matern &&
    (!isPolynomial || settings.Ranges.size() > 0))
  {
    return MakePower(settings);
  }
  FieldOperator found;
  double first = 0.8; // poles near the one of the function itself: an error of 1e-7
  double last = 1.2;
  int count = 8;
  if (settings.Covariance == FieldCovariance::Gaussian)
  {
    const double t = settings.Width * settings.Width / (16.0 * std::log(2.0));
    found.Step = t / HeatPole;
    const auto heat = [](double y)
    { return y > 0.0 ? std::exp(-HeatPole * (1.0 / y - 1.0)) : 0.0; };
    found.Series = ChebyshevSeries(heat, HeatDegree);
    found.DeviationOnPlane = 1.0 / std::sqrt(8.0 * Pi * t);
    first = 2.0 / HeatPole; // of all poles those with the smallest error, 4e-4 of the deviation
    last = 6.0 / HeatPole;
    count = 10;
    if (shared)
    {
      shared->Ratio = RatioOfShared;
      count = 14; // with the same error
      first = found.Step * shared->Near(0.0243 / found.Step);
      last = first * std::pow(RatioOfShared, count - 1);
    }
  }
  else
  {
    const double kappa = std::sqrt(8.0 * settings.Nu) / settings.Range;
    found.Step = 1.0 / (kappa * kappa);
    const int degree = settings.Nu == 1.0 ? 1 : 2; // alpha / 2
    found.Series = ChebyshevSeries([degree](double y) { return std::pow(y, degree); }, degree);
    found.DeviationOnPlane = kappa / std::sqrt(4.0 * Pi * settings.Nu);
  }
  found.Squared = FitPoles(
    [&](double x)
    {
      const double p = SumChebyshev(found.Series, 1.0 / (1.0 + x));
      return p * p;
    },
    first, last, count);
  return found;
}

/// Below a thousandth of an edge a field is white noise, and above a million times the size of the
/// surface a constant. Their widths within these bounds have squares that are no zero and finite.
RandomField::Settings WithinBounds(RandomField::Settings settings, double h, double size)
{
  const auto bound = [&](double width)
  { return std::max(1e-3 * h, std::min(width, 1e6 * std::max(size, h))); };
  settings.Width = bound(settings.Width);
  settings.Range = bound(settings.Range);
  settings.Ranges = settings.Ranges.unaryExpr(bound).eval();
  return settings;
}

/// Twice the total length of edges, which no distance within a component exceeds, per component.
std::vector<double> SizesOfComponents(const TriangleMesh& mesh)
{
  const auto& begin = mesh.ComponentsBegin();
  std::vector<double> sizes(static_cast<std::size_t>(mesh.NumberOfComponents()), 0.0);
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const auto after = std::upper_bound(begin.begin(), begin.end(), mesh.TriangleVertices()(t, 0));
    const TriangleMesh::Shape s = mesh.Shapes()[t];
    sizes[static_cast<std::size_t>(after - begin.begin()) - 1] +=
      s.Length + std::hypot(s.X, s.Y) + std::hypot(s.Length - s.X, s.Y);
  }
  return sizes;
}

/// Since 0 <= p <= 1, and p(Y) keeps constants, the variances are between 1 over the area of the
/// component and 1 over that of the vertex; on a component that is much smaller than the width
/// nothing but constants is left. Round-off takes these away where the matrix is all but singular.
void BoundVariances(const TriangleMesh& mesh, double step, Vector& variances)
{
  const std::vector<double> sizes = SizesOfComponents(mesh);
  for (Index c = 0; c < mesh.NumberOfComponents(); ++c)
  {
    const auto number = static_cast<std::size_t>(c);
    const auto first = static_cast<Eigen::Index>(mesh.ComponentsBegin()[number]);
    const auto end = static_cast<Eigen::Index>(mesh.ComponentsBegin()[number + 1]);
    const double smallest = 1.0 / mesh.ControlAreas().segment(first, end - first).sum();
    const bool isConstant = step > sizes[number] * sizes[number];
    for (Eigen::Index i = first; i < end; ++i)
    {
      const double found = isConstant || !std::isfinite(variances[i]) ? smallest : variances[i];
      variances[i] = std::max(smallest, std::min(found, 1.0 / mesh.ControlAreas()[i]));
    }
  }
}

/// A normal deviate by G. Box, M. Muller, Ann. Math. Stat. 29, 1958.
double NormalRandom(std::int64_t seed, std::int64_t number, std::int64_t id)
{
  const double radius = std::sqrt(-2.0 * std::log1p(-UniformRandom(seed, 2 * number, id)));
  return radius * std::cos(2.0 * Pi * UniformRandom(seed, 2 * number + 1, id));
}

} // namespace

RandomField::RandomField(std::shared_ptr<const Assembler> assembler,
  const CornerWeights& coefficients, const Settings& settings, std::vector<std::int64_t> ids,
  Vector deviations, const ParallelFor& parallel, const ProgressMonitor& progress,
  SharedPoles* shared)
  : Assembly(std::move(assembler))
  , Parallel(parallel)
  , Ids(std::move(ids))
  , RelativeDeviations(std::move(deviations))
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  if (settings.Covariance == FieldCovariance::Gaussian && settings.Width == 0.0)
  {
    return;
  }
  const double h = mesh.MeanEdgeLength();
  const double size = std::sqrt(mesh.ControlAreas().sum());
  FieldOperator made = MakeOperator(WithinBounds(settings, h, size), shared);
  this->DeviationOnPlane = made.DeviationOnPlane;
  if (settings.HasUnitVariance && this->RelativeDeviations.size() == 0)
  {
    Vector variances = FunctionDiagonal(*this->Assembly, coefficients, made.Step, made.Squared,
      made.Extra, parallel, progress, shared);
    if (made.Extra.size() == 0)
    {
      BoundVariances(mesh, made.Step, variances);
    }
    this->RelativeDeviations = variances.cwiseSqrt() / made.DeviationOnPlane;
  }
  else if (!settings.HasUnitVariance && made.Extra.size() > 0)
  {
    // On the plane with the range of each vertex the variance is as kappa^(-2 nu).
    this->RelativeDeviations = (made.Extra.array() + 1.0).pow(-0.5 * settings.Nu);
  }
  if (made.Series.empty())
  {
    this->Operator.emplace<ResolventPower>(
      this->Assembly, coefficients, made.Step, made.Extra, 0.5 * (settings.Nu + 1.0), parallel);
    return;
  }
  auto solver = MakeResolventSolver(mesh, made.Step, made.Series, parallel);
  this->Operator.emplace<ResolventPolynomial>(
    this->Assembly, coefficients, made.Step, std::move(made.Series), std::move(solver), parallel);
}

void RandomField::Draw(
  std::int64_t seed, std::int64_t first, Values& fields, const ProgressMonitor& progress)
{
  ForEach(this->Parallel, this->Assembly->Mesh().NumberOfVertices(),
    [&](Index i)
    {
      const double deviation = this->DeviationOfNoise(i);
      for (Eigen::Index k = 0; k < fields.cols(); ++k)
      {
        fields(i, k) =
          deviation * NormalRandom(seed, first + k, this->Ids[static_cast<std::size_t>(i)]);
      }
    });
  this->Apply(fields, progress);
  this->Divide(fields);
}

void RandomField::ApplyTransposed(Values& b, const ProgressMonitor& progress)
{
  if (std::holds_alternative<std::monostate>(this->Operator))
  {
    return;
  }
  this->Divide(b);
  b.array().colwise() /= this->Assembly->Mesh().ControlAreas().array();
  this->Apply(b, progress);
  b.array().colwise() *= this->Assembly->Mesh().ControlAreas().array().sqrt();
}

double RandomField::MissedResidual() const
{
  return std::visit(
    [](const auto& function)
    {
      if constexpr (std::is_same_v<std::decay_t<decltype(function)>, std::monostate>)
      {
        return 0.0;
      }
      else
      {
        return function.MissedResidual();
      }
    },
    this->Operator);
}

double RandomField::DeviationOfNoise(Index i) const
{
  return std::holds_alternative<std::monostate>(this->Operator)
    ? 1.0
    : 1.0 / std::sqrt(this->Assembly->Mesh().ControlAreas()[i]);
}

void RandomField::Apply(Values& fields, const ProgressMonitor& progress)
{
  std::visit(
    [&](auto& function)
    {
      if constexpr (!std::is_same_v<std::decay_t<decltype(function)>, std::monostate>)
      {
        function.ForgetResiduals();
        function.Apply(fields, progress);
      }
    },
    this->Operator);
}

void RandomField::Divide(Values& fields) const
{
  const bool isScaled = this->RelativeDeviations.size() > 0;
  ForEach(this->Parallel, static_cast<Index>(fields.rows()),
    [&](Index i)
    {
      const double relative = isScaled ? this->RelativeDeviations[i] : 1.0;
      fields.row(i) /= relative * this->DeviationOnPlane;
    });
}

} // namespace SurfaceDiffusion
