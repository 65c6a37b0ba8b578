// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/GradientTensor.h"

#include "Core/Surface/TangentVectors.h"

#include <cmath>
#include <utility>

namespace SurfaceDiffusion
{

GradientTensor SumGradients(const TriangleMesh& mesh, const Values& u, Index t)
{
  const TriangleMesh::Shape& s = mesh.Shapes()[t];
  const auto columns = static_cast<int>(u.cols());
  const Triangles& corners = mesh.TriangleVertices();
  const double* const u0 = u.data() + corners(t, 0) * u.cols();
  const double* const u1 = u.data() + corners(t, 1) * u.cols();
  const double* const u2 = u.data() + corners(t, 2) * u.cols();
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (int k = 0; k < columns; ++k)
  {
    const Eigen::Vector2d g = Gradient(s, u0[k], u1[k], u2[k]);
    xx += g[0] * g[0];
    xy += g[0] * g[1];
    yy += g[1] * g[1];
  }
  GradientTensor sum;
  sum.T = { xx, xy, yy };
  const double larger = xx > yy ? xx : yy;
  if (columns == 1 || !(larger > 0.0))
  {
    return sum;
  }
  // The row of the smaller components minus its part along that of the larger ones (Gram-Schmidt).
  double rest = 0.0;
  const double share = xy / larger;
  for (int k = 0; k < columns; ++k)
  {
    const Eigen::Vector2d g = Gradient(s, u0[k], u1[k], u2[k]);
    const double r = xx > yy ? g[1] - share * g[0] : g[0] - share * g[1];
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
