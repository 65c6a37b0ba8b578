// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/TotalVariation/GradientSplitting.h"
#include "TotalVariation.h"

#include <gtest/gtest.h>

#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

using Kind = EdgeFunctionKind;

constexpr double Relaxation = 1.7;

/// A splitting, and the same method written triangle by triangle with p and b of their own.
struct Problem
{
  std::shared_ptr<const TriangleMesh> Mesh;
  std::shared_ptr<const GradientMaps> Gradients;
  EdgeFunction Function;
  ChannelCoupling Coupling;
  GradientSplitting Splitting;
  Vector Penalty; ///< r A
  std::vector<Eigen::MatrixX2d> P, B; ///< per triangle a row for each column
  double Growth = 1.0;
  Vector Scales;

  Problem(Kind kind, ChannelCoupling coupling, const Surface& s = Icosphere(2),
    const ParallelFor& parallel = SerialFor())
    : Mesh(std::make_shared<TriangleMesh>(s.Vertices, s.Faces))
    , Gradients(std::make_shared<const GradientMaps>(Mesh))
    , Function{ kind, 0.0, 3.0 }
    , Coupling(coupling)
    , Splitting(Mesh, Gradients, Function, coupling, Vector::Ones(Mesh->NumberOfTriangles()),
        Mesh->NumberOfVertices(), parallel)
    , Penalty(Mesh->NumberOfTriangles())
    , Scales(Vector::Ones(Mesh->NumberOfTriangles()))
  {
    const CornerWeights weights = this->Splitting.MakeCoefficients();
    for (Index t = 0; t < this->Mesh->NumberOfTriangles(); ++t)
    {
      const GradientMap map = (*this->Gradients)[t];
      this->Penalty[t] = -weights(t, 0) / map.OfCorner(1).dot(map.OfCorner(2));
    }
  }

  void Start(const Values& u)
  {
    this->P.clear();
    for (Index t = 0; t < this->Mesh->NumberOfTriangles(); ++t)
    {
      this->P.push_back(this->GradientOf(u, t));
    }
    this->B.assign(this->P.size(), Eigen::MatrixX2d::Zero(u.cols(), 2));
  }

  Eigen::MatrixX2d GradientOf(const Values& u, Index t) const
  {
    const auto corners = this->Mesh->TriangleVertices().row(t);
    Eigen::MatrixX2d gradient = Eigen::MatrixX2d::Zero(u.cols(), 2);
    for (int a = 0; a < 3; ++a)
    {
      gradient += u.row(corners[a]).transpose() * (*this->Gradients)[t].OfCorner(a).transpose();
    }
    return gradient;
  }

  void SetGrowth(double growth)
  {
    for (Eigen::MatrixX2d& b : this->B)
    {
      b *= this->Growth / growth;
    }
    this->Growth = growth;
    this->Splitting.SetGrowth(growth);
  }

  /// Both: where p = 0 the penalty doubles, and where r |p| is far from 1 it changes towards it. The
  /// multipliers r b stay, and so does p.
  void Balance()
  {
    this->Splitting.Balance();
    for (Index t = 0; t < this->Mesh->NumberOfTriangles(); ++t)
    {
      const double r =
        this->Growth * this->Scales[t] * this->Penalty[t] / this->Mesh->Shapes()[t].Area();
      const double factor = this->Splitting.GetScales()[t] / this->Scales[t];
      double largest = 0.0;
      ForEachNorm(this->Coupling, static_cast<int>(this->P[t].rows()),
        [&](int first, int last)
        { largest = std::max(largest, r * this->P[t].middleRows(first, last - first).norm()); });
      EXPECT_TRUE(factor == 0.5 || factor == 1.0 || factor == 2.0);
      EXPECT_TRUE(factor != 0.5 || largest > 0.5);
      EXPECT_TRUE(factor != 2.0 || largest < 0.2);
      EXPECT_TRUE(factor != 1.0 || (largest > 0.1 && largest < 0.7) || this->Scales[t] == 8.0 ||
        this->Scales[t] == 0.125);
      this->Scales[t] *= factor;
      this->B[t] /= factor;
    }
  }

  /// Both, and the largest difference of what they give to the equation for u, as a share of it.
  double Update(const Values& u)
  {
    Values expected = Values::Zero(u.rows(), u.cols());
    for (Index t = 0; t < this->Mesh->NumberOfTriangles(); ++t)
    {
      Eigen::MatrixX2d& p = this->P[t];
      Eigen::MatrixX2d& b = this->B[t];
      const double area = this->Mesh->Shapes()[t].Area();
      const double r = this->Growth * this->Scales[t] * this->Penalty[t] / area;
      b += Relaxation * this->GradientOf(u, t) + (1.0 - Relaxation) * p;
      ForEachNorm(this->Coupling, static_cast<int>(u.cols()),
        [&](int first, int last)
        {
          const double norm = b.middleRows(first, last - first).norm();
          p.middleRows(first, last - first) =
            this->Function.Shrinkage(r, norm) * b.middleRows(first, last - first);
        });
      b -= p;
      for (int a = 0; a < 3; ++a)
      {
        expected.row(this->Mesh->TriangleVertices()(t, a)) +=
          r * area * ((p - b) * (*this->Gradients)[t].OfCorner(a)).transpose();
      }
    }
    this->Splitting.Update(u, Relaxation);
    return (this->RightHandSide(u.cols()) - expected).cwiseAbs().maxCoeff() /
      expected.cwiseAbs().maxCoeff();
  }

  Values RightHandSide(Eigen::Index columns) const
  {
    Values side(this->Mesh->NumberOfVertices(), columns);
    for (Index i = 0; i < this->Mesh->NumberOfVertices(); ++i)
    {
      this->Splitting.GatherRightHandSide<0>(i, &side(i, 0));
    }
    return side;
  }
};

std::vector<double> MultipliersOf(const GradientSplitting& splitting)
{
  std::vector<double> multipliers(splitting.NumberOfMultipliers(splitting.NumberOfColumns()));
  splitting.GetMultipliers(multipliers.data());
  return multipliers;
}

} // namespace

TEST(GradientSplitting, IsTheMethodOfMultipliersOnEachTriangle)
{
  for (const Kind kind : { Kind::TotalVariation, Kind::Charbonnier, Kind::Constant })
  {
    for (const ChannelCoupling coupling : { ChannelCoupling::PerChannel, ChannelCoupling::Joint })
    {
      for (const int columns : { 1, 2, 3, 5 })
      {
        for (const bool isSingle : { false, true })
        {
          Problem problem(kind, coupling);
          const bool isRounded = isSingle && kind == Kind::TotalVariation;
          problem.Splitting.Start(columns, false, isSingle);
          problem.Start(Noise(*problem.Mesh, columns, 0));
          // The first update takes p from the start.
          EXPECT_LT(problem.Update(Noise(*problem.Mesh, columns, 0)), isRounded ? 1e-5 : 1e-12);
          double difference = 0.0;
          for (int update = 1; update < 6; ++update)
          {
            problem.SetGrowth(update < 3 ? 1.0 : 1.0 + 0.5 * update);
            difference =
              std::max(difference, problem.Update(Noise(*problem.Mesh, columns, update)));
          }
          EXPECT_LT(difference, isRounded ? 1e-5 : 1e-12) << columns;
          EXPECT_EQ(difference > 1e-9, isRounded); // it is in single precision
        }
      }
    }
  }
}

TEST(GradientSplitting, MultipliersAreWithinTheirBoundAndGrowthLeavesThem)
{
  for (const bool isSingle : { false, true })
  {
    Problem problem(Kind::TotalVariation, ChannelCoupling::Joint);
    problem.Splitting.Start(3, false, isSingle);
    problem.Start(Noise(*problem.Mesh, 3));
    problem.Update(Noise(*problem.Mesh, 3));
    const std::vector<double> before = MultipliersOf(problem.Splitting);
    problem.SetGrowth(5.0);
    const std::vector<double> after = MultipliersOf(problem.Splitting);
    double largest = 0.0;
    for (std::size_t at = 0; at < before.size(); at += 6)
    {
      const Eigen::Map<const Eigen::VectorXd> y(&before[at], 6);
      const Eigen::Map<const Eigen::VectorXd> grown(&after[at], 6);
      largest = std::max(largest, y.norm());
      EXPECT_LT((y - grown).norm(), isSingle ? 1e-6 : 1e-14);
    }
    EXPECT_NEAR(largest, 1.0, isSingle ? 1e-6 : 1e-14);
  }
}

TEST(GradientSplitting, IsTheMethodOfMultipliersWithABalancedPenalty)
{
  for (const ChannelCoupling coupling : { ChannelCoupling::PerChannel, ChannelCoupling::Joint })
  {
    for (const bool isSingle : { false, true })
    {
      Problem problem(Kind::TotalVariation, coupling);
      const auto gentle = [&](int seed) { return Values(0.005 * Noise(*problem.Mesh, 2, seed)); };
      problem.Splitting.Start(2, false, isSingle);
      problem.Start(gentle(0));
      problem.Splitting.Balance(); // nothing before the first update
      EXPECT_EQ(problem.Splitting.GetScales(), Vector::Ones(problem.Penalty.size()));
      problem.Update(gentle(0));
      for (int update = 1; update < 6; ++update)
      {
        problem.SetGrowth(1.0 + 0.5 * update);
        problem.Balance();
        EXPECT_LT(problem.Update(gentle(update)), isSingle ? 1e-5 : 1e-12);
      }
      EXPECT_LT(problem.Splitting.GetScales().minCoeff(), 1.0);
      EXPECT_GT(problem.Splitting.GetScales().maxCoeff(), 1.0);
      // A new start has the first penalties, to the same bits.
      Problem fresh(Kind::TotalVariation, coupling);
      const Values u = Noise(*problem.Mesh, 2, 9);
      for (Problem* other : { &problem, &fresh })
      {
        other->Splitting.Start(2, false, isSingle);
        other->Splitting.Update(u, Relaxation);
      }
      EXPECT_TRUE(problem.RightHandSide(2) == fresh.RightHandSide(2));
    }
  }
}

TEST(GradientSplitting, GoesOnFromMultipliersThatAreGivenBack)
{
  for (const bool isSingle : { false, true })
  {
    Problem one(Kind::TotalVariation, ChannelCoupling::PerChannel);
    Problem two(Kind::TotalVariation, ChannelCoupling::PerChannel);
    EXPECT_EQ(one.Splitting.NumberOfColumns(), 0);
    const Values u = Noise(*one.Mesh, 2);
    one.Splitting.Start(2, false, isSingle);
    one.Splitting.SetGrowth(2.0);
    one.Splitting.Update(u, Relaxation);
    two.Splitting.SetMultipliers(MultipliersOf(one.Splitting).data(), 2);
    EXPECT_TRUE(MultipliersOf(two.Splitting) == MultipliersOf(one.Splitting));
    for (Problem* problem : { &one, &two })
    {
      problem->Splitting.Start(2, true, isSingle);
      EXPECT_EQ(problem->Splitting.Growth(), 1.0);
      problem->Splitting.Update(u, Relaxation);
    }
    EXPECT_TRUE(one.RightHandSide(2) == two.RightHandSide(2));
    two.Splitting.Start(2, false, isSingle);
    two.Splitting.Update(u, Relaxation);
    EXPECT_FALSE(one.RightHandSide(2) == two.RightHandSide(2));
  }
}

TEST(GradientSplitting, KeepsItsMultipliersWhenThePrecisionChanges)
{
  Problem problem(Kind::TotalVariation, ChannelCoupling::Joint);
  const Values u = Noise(*problem.Mesh, 1);
  problem.Splitting.Start(1, false, true);
  problem.Splitting.Update(u, Relaxation);
  const std::vector<double> single = MultipliersOf(problem.Splitting);
  problem.Splitting.Start(1, true, false);
  EXPECT_TRUE(MultipliersOf(problem.Splitting) == single);
  problem.Splitting.Start(1, true, true);
  EXPECT_TRUE(MultipliersOf(problem.Splitting) == single);
  problem.Splitting.Start(2, true, true); // of another number of columns
  for (const double y : MultipliersOf(problem.Splitting))
  {
    EXPECT_EQ(y, 0.0);
  }
}

// Coefficients that single precision cannot hold.
TEST(GradientSplitting, OfATinySurfaceIsInDoublePrecision)
{
  Problem problem(Kind::TotalVariation, ChannelCoupling::Joint,
    Joined(Icosphere(2), Scaled(Icosphere(2), 1e-25)));
  const Values u = Noise(*problem.Mesh, 1);
  problem.Splitting.Start(1, false, true);
  problem.Start(u);
  EXPECT_LT(problem.Update(u), 1e-12);
}
