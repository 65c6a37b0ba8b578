// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geodesics/FrontShapes.h"

#include "Core/Operators/CotanWeights.h"

#include <algorithm>
#include <limits>

namespace SurfaceDiffusion
{

namespace
{

TriangleMesh::Shape Scaled(TriangleMesh::Shape shape, double factor)
{
  shape.Length *= factor;
  shape.X *= factor;
  shape.Y *= factor;
  return shape;
}

/// The shape of a triangle after scaling by ofAlong along e and by ofAcross across.
TriangleMesh::Shape Stretched(
  TriangleMesh::Shape shape, const Eigen::RowVector2d& e, double ofAlong, double ofAcross)
{
  const auto image = [&](double x, double y)
  { return Eigen::Vector2d(ofAlong * (e[0] * x + e[1] * y), ofAcross * (e[0] * y - e[1] * x)); };
  const Eigen::Vector2d first = image(shape.Length, 0.0);
  const Eigen::Vector2d second = image(shape.X, shape.Y);
  shape.Y *= ofAlong * ofAcross * shape.Length / first.norm();
  shape.X = first.dot(second) / first.norm();
  shape.Length = first.norm();
  return shape;
}

} // namespace

FrontShapes MakeFrontShapes(const TriangleMesh& mesh, const std::vector<double>& slowness,
  const Eigen::Ref<const TangentVectors>& directions, const std::vector<double>& along,
  const std::vector<double>& across)
{
  const auto factorOf = [](const std::vector<double>& factors, Index t)
  {
    const std::size_t place = factors.size() == 1 ? 0 : static_cast<std::size_t>(t);
    return factors.empty() ? 1.0 : factors[place];
  };
  FrontShapes shapes;
  shapes.reserve(static_cast<std::size_t>(mesh.NumberOfTriangles()));
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const TriangleMesh::Shape given = mesh.Shapes()[t];
    const double ofTriangle = factorOf(slowness, t);
    const double s1 = factorOf(along, t);
    const double s2 = factorOf(across, t);
    const double least = std::max(s1, s2) / LargestSpeedRatio;
    const bool isDirected = s1 != s2 && directions.rows() > 0 && HasDirection(directions, t);
    TriangleMesh::Shape shape = isDirected
      ? Stretched(given, directions.row(t), ofTriangle / std::max(s1, least),
          ofTriangle / std::max(s2, least))
      : Scaled(given, ofTriangle / IsotropicMean(s1, s2));
    if (!(shape.Length < std::numeric_limits<double>::infinity()))
    {
      shape = given;
      shape.Length = std::numeric_limits<double>::infinity();
    }
    shapes.push_back(shape);
  }
  return shapes;
}

} // namespace SurfaceDiffusion
