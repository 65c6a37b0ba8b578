// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Statistics/NoiseWidth.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace SurfaceDiffusion
{

namespace
{

constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr std::size_t NumberOfParts = 256;
/// So few sides of triangles have a part each, so that round-off of lengths groups none otherwise.
constexpr std::size_t FewSides = 4096;
const double Rate = 2.0 * std::log(2.0); ///< exp(-d^2/(4 sigma^2)) = exp(-Rate d^2/FWHM^2)

/// The square of the width over the area that takes half of the variance with the mean: 4 pi sigma^2
/// is half of the area.
const double HalfOfVariance = std::log(2.0) / 3.14159265358979323846;

/// The x at which the sum of variances times exp(-squares x) is the correlation: Newton's method from
/// the left of a convex, decreasing function is monotone.
double InvertSum(double correlation, const Vector& variances, const Vector& squares)
{
  double x = 0.0;
  for (int i = 0; i < 100; ++i)
  {
    const Vector terms = variances.array() * (-x * squares.array()).exp();
    const double step = (terms.sum() - correlation) / terms.dot(squares);
    x += step;
    if (step <= 1e-13 * x)
    {
      break;
    }
  }
  return x;
}

} // namespace

NoiseWidth::NoiseWidth(const TriangleMesh& mesh, bool subtractsMean)
  : Mesh(mesh)
  , SubtractsMean(subtractsMean)
{
  const auto sides = static_cast<std::size_t>(mesh.NumberOfTriangles()) * 3;
  Vector factors = Vector::Zero(mesh.NumberOfVertices()); // of given areas
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    for (const Index i : mesh.TriangleVertices().row(t))
    {
      factors[i] += mesh.Shapes()[t].Area() / 3.0;
    }
  }
  factors = mesh.ControlAreas().cwiseQuotient(factors);
  Vector squares(static_cast<Eigen::Index>(sides));
  Vector areas(squares.size());
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const auto corners = mesh.TriangleVertices().row(t);
    const double mean = (factors[corners[0]] + factors[corners[1]] + factors[corners[2]]) / 3.0;
    for (int a = 0; a < 3; ++a)
    {
      const double factor = 0.5 * (factors[corners[(a + 1) % 3]] + factors[corners[(a + 2) % 3]]);
      squares[3 * t + a] = factor * std::pow(mesh.Shapes()[t].EdgeLength(a), 2);
      areas[3 * t + a] = mean * mesh.Shapes()[t].Area();
    }
  }
  this->EdgeWeights = areas.cwiseQuotient(squares);

  std::vector<Eigen::Index> order(sides);
  std::iota(order.begin(), order.end(), Eigen::Index{ 0 });
  std::stable_sort(order.begin(), order.end(),
    [&](Eigen::Index a, Eigen::Index b) { return squares[a] < squares[b]; });
  this->PartOfEdge.resize(sides);
  const std::size_t parts = sides > FewSides ? NumberOfParts : sides;
  Vector weights = Vector::Zero(static_cast<Eigen::Index>(parts));
  this->Squares = weights;
  const double total = areas.sum();
  double sum = 0.0;
  for (std::size_t k = 0; k < sides; ++k)
  {
    const Eigen::Index side = order[k];
    sum += areas[side];
    const auto byArea = static_cast<std::size_t>(sum / total * static_cast<double>(parts));
    const auto part = static_cast<int>(parts == sides ? k : std::min(parts - 1, byArea));
    this->PartOfEdge[static_cast<std::size_t>(side)] = part;
    weights[part] += this->EdgeWeights[side];
    this->Squares[part] += areas[side];
  }
  this->Squares = (weights.array() > 0.0).select(this->Squares.cwiseQuotient(weights), 0.0);
}

void NoiseWidth::Add(const Values& maps)
{
  for (Eigen::Index k = 0; k < maps.cols(); ++k)
  {
    this->Columns.push_back(this->Measure(maps, k));
  }
}

NoiseWidth::Column NoiseWidth::Measure(const Values& maps, Eigen::Index column) const
{
  Column found;
  found.Variances = Vector::Zero(this->Squares.size());
  Vector s = maps.col(column);
  double mean = 0.0;
  for (Index i = 0; i < this->Mesh.NumberOfVertices(); ++i)
  {
    if (std::isfinite(s[i]))
    {
      found.Area += this->Mesh.ControlAreas()[i];
      mean += this->Mesh.ControlAreas()[i] * s[i];
    }
  }
  double scale = 0.0; // squares neither overflow nor vanish
  for (Index i = 0; i < this->Mesh.NumberOfVertices(); ++i)
  {
    s[i] -= this->SubtractsMean ? mean / found.Area : 0.0;
    scale = std::isfinite(s[i]) ? std::max(scale, std::abs(s[i])) : scale;
  }
  s /= scale > 0.0 ? scale : 1.0;
  double total = 0.0;
  for (Index t = 0; t < this->Mesh.NumberOfTriangles(); ++t)
  {
    const auto corners = this->Mesh.TriangleVertices().row(t);
    for (int a = 0; a < 3; ++a)
    {
      const double v = s[corners[(a + 1) % 3]];
      const double w = s[corners[(a + 2) % 3]];
      if (std::isfinite(v) && std::isfinite(w))
      {
        const double weight = this->EdgeWeights[3 * t + a];
        const double local = 0.5 * weight * (v * v + w * w);
        total += local;
        found.Product += weight * v * w;
        found.Variances[this->PartOfEdge[static_cast<std::size_t>(3 * t + a)]] += local;
      }
    }
  }
  if (total > 0.0)
  {
    found.Product /= total;
    found.Variances /= total;
  }
  return found;
}

std::vector<double> NoiseWidth::OfColumns() const
{
  std::vector<double> widths;
  for (const Column& column : this->Columns)
  {
    widths.push_back(this->Solve(column.Product, column.Variances, column.Area));
  }
  return widths;
}

double NoiseWidth::OfAll() const
{
  double count = 0.0;
  double product = 0.0;
  double area = 0.0;
  Vector variances = Vector::Zero(this->Squares.size());
  for (const Column& column : this->Columns)
  {
    if (column.Varies())
    {
      count += 1.0;
      product += column.Product;
      variances += column.Variances;
      area += column.Area;
    }
  }
  return count > 0.0 ? this->Solve(product / count, variances / count, area / count) : Infinity;
}

std::vector<double> NoiseWidth::LargestOfColumns() const
{
  std::vector<double> widths;
  for (const Column& column : this->Columns)
  {
    const double area = this->SubtractsMean ? column.Area : Infinity;
    widths.push_back(column.Area == 0.0 ? std::numeric_limits<double>::quiet_NaN()
        : column.Varies()               ? std::sqrt(HalfOfVariance * area)
                                        : 0.0);
  }
  return widths;
}

/// The width of noise whose neighbours have the correlation `product`. variances: the shares of the
/// parts of edges, which sum to 1.
double NoiseWidth::Solve(double product, const Vector& variances, double area) const
{
  if (!(variances.sum() > 0.0) || product >= 1.0)
  {
    return Infinity;
  }
  if (product <= 0.0)
  {
    return 0.0;
  }
  const double x = InvertSum(product, variances, this->Squares);
  const double narrowest = x > 0.0 ? std::sqrt(Rate / x) : Infinity;
  if (!this->SubtractsMean)
  {
    return narrowest;
  }
  const auto isAbove = [&](double width)
  {
    const double expected =
      variances.dot((-Rate / (width * width) * this->Squares.array()).exp().matrix());
    const double taken = 0.5 * width * width / (HalfOfVariance * area); // with the mean
    return (expected - taken) / (1.0 - taken) > product;
  };
  // It rises with the width until the mean takes half of the variance, or less on coarse surfaces, and
  // only lessens the correlation, so the width is not below the one without it.
  const double largest = std::sqrt(HalfOfVariance * area);
  double low = 0.999 * narrowest;
  double high = std::min(low, largest);
  while (!isAbove(high))
  {
    if (high == largest)
    {
      return Infinity;
    }
    low = high;
    high = std::min(1.02 * high, largest);
  }
  for (double middle = 0.5 * (low + high); low < middle && middle < high;
       middle = 0.5 * (low + high))
  {
    (isAbove(middle) ? high : low) = middle;
  }
  return high;
}

//------------------------------------------------------------------------------------------------
WidthCorrection::WidthCorrection(double wanted, double found, double area)
  : Wanted(wanted * wanted)
  , Area(area)
  , Square(wanted * wanted - found * found)
  , ReachedBefore(found * found)
  , Largest(found * found)
  , High(Infinity)
{
}

double WidthCorrection::Width() const
{
  return std::sqrt(this->Square);
}

double WidthCorrection::LargestReached() const
{
  return std::sqrt(this->Largest);
}

bool WidthCorrection::Take(double reachedWidth)
{
  const double reached = reachedWidth * reachedWidth;
  (reached > this->Wanted ? this->High : this->Low) = this->Square;
  double step = this->Wanted - reached;
  if (std::isfinite(reached)) // else the surface is smaller than the kernel
  {
    this->Largest = std::max(this->Largest, reached);
    const double slope = (reached - this->ReachedBefore) / (this->Square - this->SquareBefore);
    step /= slope > 0.1 ? slope : 1.0;
    this->SquareBefore = this->Square;
    this->ReachedBefore = reached;
  }
  double next = std::clamp(this->Square + step, 0.01 * this->Square, 100.0 * this->Square);
  if (!(this->Low < next && next < this->High))
  {
    next = 0.5 * (this->Low + this->High);
  }
  this->Square = next;
  return this->Low < next && next < this->High && this->High - this->Low >= 1e-9 * this->Low &&
    next <= 4.0 * HalfOfVariance * this->Area;
}

} // namespace SurfaceDiffusion
