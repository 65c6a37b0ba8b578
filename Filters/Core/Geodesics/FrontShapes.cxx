// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geodesics/FrontShapes.h"

#include "Core/Operators/CotanWeights.h"

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
  const Eigen::Ref<const TangentVectors>& directions, double along, double across)
{
  FrontShapes shapes;
  shapes.reserve(static_cast<std::size_t>(mesh.NumberOfTriangles()));
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    TriangleMesh::Shape shape = mesh.Shapes()[t];
    const double ofTriangle = slowness.empty() ? 1.0 : slowness[static_cast<std::size_t>(t)];
    if (std::isinf(ofTriangle))
    {
      shape.Length = std::numeric_limits<double>::infinity();
    }
    else if (directions.rows() > 0 && HasDirection(directions, t))
    {
      shape = Stretched(shape, directions.row(t), ofTriangle / along, ofTriangle / across);
    }
    else
    {
      shape = Scaled(shape, ofTriangle / IsotropicMean(along, across));
    }
    shapes.push_back(shape);
  }
  return shapes;
}

} // namespace SurfaceDiffusion
