// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Operators/GradientTensor.h"

#include "Core/Surface/TangentVectors.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// Squares of gradients up to this length, times the square of another number of this size, are
/// finite.
constexpr double LongestGradient = 1e75;

/// The gradients of the columns of u on a triangle.
class Gradients
{
public:
  Gradients(const TriangleMesh& mesh, const Values& u, Index t)
    : Shape(mesh.Shapes()[t])
    , Count(static_cast<int>(u.cols()))
  {
    for (int a = 0; a < 3; ++a)
    {
      this->Corners[a] =
        u.data() + static_cast<std::ptrdiff_t>(mesh.TriangleVertices()(t, a)) * u.cols();
    }
  }

  int Number() const { return this->Count; }
  double GetValueScale() const { return this->ValueScale; }
  double GetScale() const { return this->Scale; }
  /// To a length of about LongestGradient. Before they are divided by lengths, which may be as
  /// small as any number, values are made small, by a power of two: neighbouring numbers stay
  /// apart.
  void Shorten()
  {
    this->ValueScale = std::ldexp(1.0, -660);
    double longest = 0.0;
    for (int k = 0; k < this->Count; ++k)
    {
      longest = std::max(longest, (*this)[k].cwiseAbs().maxCoeff());
    }
    this->Scale = longest > 0.0 ? LongestGradient / longest : 1.0;
  }

  Eigen::Vector2d operator[](int k) const
  {
    return this->Scale *
      Gradient(this->Shape, this->ValueScale * this->Corners[0][k],
        this->ValueScale * this->Corners[1][k], this->ValueScale * this->Corners[2][k]);
  }

private:
  const TriangleMesh::Shape Shape;
  const double* Corners[3];
  int Count;
  double ValueScale = 1.0, Scale = 1.0;
};

PlaneTensor SumSquares(const Gradients& gradients)
{
  PlaneTensor sum{ 0.0, 0.0, 0.0 };
  for (int k = 0; k < gradients.Number(); ++k)
  {
    const Eigen::Vector2d g = gradients[k];
    sum.XX += g[0] * g[0];
    sum.XY += g[0] * g[1];
    sum.YY += g[1] * g[1];
  }
  return sum;
}

} // namespace

GradientTensor SumGradients(const TriangleMesh& mesh, const Values& u, Index t)
{
  Gradients gradients(mesh, u, t);
  GradientTensor sum{ SumSquares(gradients) };
  if (!(sum.T.Trace() < LongestGradient * LongestGradient))
  {
    gradients.Shorten();
    sum.T = SumSquares(gradients);
    sum.ValueScale = gradients.GetValueScale();
    sum.Scale = gradients.GetScale();
  }
  const double larger = std::max(sum.T.XX, sum.T.YY);
  if (gradients.Number() == 1 || !(larger > 0.0))
  {
    return sum;
  }
  // The row of the smaller components minus its part along that of the larger ones (Gram-Schmidt).
  double rest = 0.0;
  const double share = sum.T.XY / larger;
  for (int k = 0; k < gradients.Number(); ++k)
  {
    const Eigen::Vector2d g = gradients[k];
    const double r = sum.T.XX > sum.T.YY ? g[1] - share * g[0] : g[0] - share * g[1];
    rest += r * r;
  }
  sum.RootDeterminant = std::sqrt(larger) * std::sqrt(rest); // the product might overflow
  return sum;
}

GivenFactors::GivenFactors(TangentVectors frames, double along, double across)
  : Frames(std::move(frames))
  , Along(std::sqrt(along))
  , Across(std::sqrt(across))
  , AreOne(along == 1.0 && across == 1.0)
{
}

PlaneTensor GivenFactors::operator()(Index t) const
{
  if (this->Frames.rows() == 0 || !HasDirection(this->Frames, t))
  {
    const double factor = IsotropicMean(this->Along, this->Across);
    return { factor, 0.0, factor };
  }
  const double x = this->Frames(t, 0);
  const double y = this->Frames(t, 1);
  return { this->Along * x * x + this->Across * y * y, (this->Along - this->Across) * x * y,
    this->Along * y * y + this->Across * x * x };
}

Eigen::RowVector2d StrongestAxis(const PlaneTensor& d)
{
  return MainAxis(d.XX, d.XY, d.YY);
}

} // namespace SurfaceDiffusion
