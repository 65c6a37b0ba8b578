// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Meshes.h"

#include "Core/Geometry/Helmholtz.h"
#include "Run/Solve.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <functional>

// The parts of vectors that are a gradient, a curl, and neither.

namespace SurfaceDiffusion
{

namespace
{

using Row = Eigen::RowVector3d;

/// The parts on the triangles of a rough field.
struct Parts
{
  explicit Parts(const Testing::Surface& s)
    : Mesh(Testing::MakeMesh(s))
    , Positions(this->Mesh->NumberOfVertices(), 3)
    , U(this->Mesh->NumberOfTriangles(), 3)
  {
    for (Index i = 0; i < this->Mesh->NumberOfVertices(); ++i)
    {
      this->Positions.row(i) =
        s.Vertices.row(this->Mesh->InputVertex()[i]) / this->Mesh->LengthUnit();
    }
    const Derivatives operators(*this->Mesh, this->Positions);
    for (Index t = 0; t < this->Mesh->NumberOfTriangles(); ++t)
    {
      const Row p = this->Positions.row(this->Mesh->TriangleVertices()(t, 0));
      const Row rough(std::sin(5.0 * p.y()), std::cos(4.0 * p.z()), 0.3 + p.x());
      const Row n = operators.Normals().OfTriangles.row(t);
      this->U.row(t) = rough - rough.dot(n) * n;
    }
    this->Of = DecomposeVectors(this->Mesh, operators, this->U);
  }
  double Product(const Values& a, const Values& b) const
  {
    double sum = 0.0;
    for (Index t = 0; t < this->Mesh->NumberOfTriangles(); ++t)
    {
      sum += this->Mesh->Shapes()[t].Area() * a.row(t).dot(b.row(t));
    }
    return sum;
  }

  std::shared_ptr<const TriangleMesh> Mesh;
  Points Positions;
  Values U;
  HelmholtzParts Of;
};

} // namespace

TEST(Helmholtz, PartsAddUpAndAreOrthogonal)
{
  const Testing::Surface torus = Testing::Torus(24, 12);
  const Testing::Surface plate =
    Testing::Jittered(Testing::Strip(14, 10), 0.02, 0.001, 0.999, 0.001, 0.999);
  for (const Testing::Surface& s : { Testing::Icosphere(3), torus, plate })
  {
    const Parts parts(s);
    const Values& gradient = parts.Of.GradientPart;
    const Values& curl = parts.Of.CurlPart;
    const Values& harmonic = parts.Of.HarmonicPart;
    const double all = parts.Product(parts.U, parts.U);
    EXPECT_LT((gradient + curl + harmonic - parts.U).cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_LT(std::abs(parts.Product(gradient, curl)), 1e-11 * all);
    EXPECT_LT(std::abs(parts.Product(gradient, harmonic)), 1e-11 * all);
    EXPECT_LT(std::abs(parts.Product(curl, harmonic)), 1e-11 * all);
    EXPECT_GT(parts.Product(gradient, gradient), 0.01 * all);
    EXPECT_GT(parts.Product(curl, curl), 0.01 * all);
  }
}

// On the sphere grad z and twice the rotation about z, of the potentials z and -2 z. The field 1/r
// around a torus is harmonic.
TEST(Helmholtz, FindsThePotentialsOfTheSphereAndTheFlowAroundATorus)
{
  const auto solve = [](const Testing::Surface& s, const std::function<Row(const Row&)>& field)
  {
    Values f(s.Vertices.rows(), 3);
    for (Eigen::Index i = 0; i < f.rows(); ++i)
    {
      f.row(i) = field(s.Vertices.row(i));
    }
    DerivativesSettings settings;
    settings.Quantity = DerivativeQuantity::Helmholtz;
    return Derivative(s.Vertices, s.Faces, f, settings);
  };
  double errors[2];
  for (const int level : { 3, 4 })
  {
    const Testing::Surface sphere = Testing::Icosphere(level);
    const Vector z = sphere.Vertices.col(2);
    const Solution ofSum = solve(sphere,
      [](const Row& p) -> Row
      { return Row(0.0, 0.0, 1.0) - p.z() * p + 2.0 * Row(-p.y(), p.x(), 0.0); });
    errors[level - 3] = (ofSum.Arrays.at("GradientPotential") - z).cwiseAbs().maxCoeff() +
      (ofSum.Arrays.at("CurlPotential") + 2.0 * z).cwiseAbs().maxCoeff();
    EXPECT_LT(ofSum.Arrays.at("HarmonicPart").rowwise().norm().maxCoeff(), 0.03);
  }
  EXPECT_LT(errors[1], 0.02);
  EXPECT_GT(Testing::ObservedOrder(errors[0], errors[1]), 1.5);

  // 1/r around the axis has neither divergence nor curl.
  const Testing::Surface torus = Testing::Torus(96, 48);
  const Solution around = solve(torus,
    [](const Row& p) -> Row { return Row(-p.y(), p.x(), 0.0) / (p.x() * p.x() + p.y() * p.y()); });
  EXPECT_LT(around.Arrays.at("GradientPart").rowwise().norm().maxCoeff(), 0.01);
  EXPECT_LT(around.Arrays.at("CurlPart").rowwise().norm().maxCoeff(), 0.01);
  EXPECT_GT(around.Arrays.at("HarmonicPart").rowwise().norm().minCoeff(), 0.3);
}

} // namespace SurfaceDiffusion
