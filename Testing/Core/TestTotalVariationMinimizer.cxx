// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/TotalVariation/TotalVariationMinimizer.h"
#include "Core/Models/TotalVariation/VertexSplitting.h"
#include "Core/Operators/CotanWeights.h"
#include "Core/Surface/TangentVectors.h"
#include "TotalVariation.h"

#include <gtest/gtest.h>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

using Kind = EdgeFunctionKind;

/// A minimisation and all it needs: noise on a small sphere.
struct Problem
{
  std::shared_ptr<const Assembler> Operators = MakeAssembler(Icosphere(3));
  const TriangleMesh& Mesh = Operators->Mesh();
  Values Data = Noise(Mesh, 2);
  double Quadratic = 10.0;
  double Absolute = 0.0;
  Flags Fixed = Flags::Constant(Mesh.NumberOfVertices(), false);
  TotalVariationMinimizer::Settings Settings = { { Kind::TotalVariation, 0.0, 3.0 },
    ChannelCoupling::Joint, 2.0, 1e-4, 10000 };

  double Energy(const TotalVariationMinimizer& minimizer, const Values& u) const
  {
    double energy = minimizer.GradientEnergy(u);
    for (Index i = 0; i < this->Mesh.NumberOfVertices(); ++i)
    {
      const auto distance = u.row(i) - this->Data.row(i);
      const double absolute =
        this->Settings.Coupling == ChannelCoupling::Joint ? distance.norm() : distance.lpNorm<1>();
      energy += this->Mesh.ControlAreas()[i] *
        (0.5 * this->Quadratic * distance.squaredNorm() + this->Absolute * absolute);
    }
    return energy;
  }

  std::pair<double, TotalVariationMinimizer::Report> Minimum(double tolerance)
  {
    this->Settings.StopTolerance = tolerance;
    const Index n = this->Mesh.NumberOfVertices();
    TotalVariationMinimizer minimizer(this->Operators,
      std::make_shared<const GradientMaps>(this->Operators->SharedMesh()),
      Vector::Constant(n, this->Quadratic), Vector::Constant(n, this->Absolute), this->Fixed,
      this->Data, this->Settings);
    Values u = this->Data;
    const auto report = minimizer.Minimize(this->Data, this->Data, u);
    return { this->Energy(minimizer, u), report };
  }
};

} // namespace

namespace
{

/// The minimum of a convex function over the ball around `centre`, by steps in random directions.
template <typename F>
double MinimumInBall(const F& f, const Eigen::RowVectorXd& centre, double radius)
{
  Eigen::RowVectorXd best = centre;
  double step = 0.5 * radius;
  std::int64_t number = 0;
  while (step > 1e-7 * radius)
  {
    bool found = false;
    for (int trial = 0; trial < 60; ++trial, ++number)
    {
      Eigen::RowVectorXd next = best;
      for (Eigen::Index k = 0; k < next.size(); ++k)
      {
        next[k] += step * (2.0 * UniformRandom(17, k, number) - 1.0);
      }
      const double distance = (next - centre).norm();
      next = distance > radius ? centre + radius / distance * (next - centre) : next;
      if (f(next) < f(best))
      {
        best = next;
        found = true;
      }
    }
    step *= found ? 1.0 : 0.5;
  }
  return f(best);
}

} // namespace

/// The minimum over u_i of d . u_i and the terms of vertex i: anywhere if mu > 0, and otherwise
/// within Range, in each of m channels, of the present value or of f.
TEST(TotalVariationMinimizer, DualOfTheTermsAtVerticesIsTheirMinimum)
{
  const auto mesh = MakeMesh(Tetrahedron());
  const double area = mesh->ControlAreas()[0];
  const double range = 0.7;
  const Values g = Noise(*mesh, 3, 1), f = Noise(*mesh, 3, 2), u = Noise(*mesh, 3, 3);
  for (const auto& weights : { std::pair(0.0, 0.0), { 0.0, 0.9 }, { 1.3, 0.0 }, { 1.3, 0.9 } })
  {
    const double mu = weights.first; // a lambda cannot capture the names of a structured binding
    const double nu = weights.second;
    for (const ChannelCoupling coupling : { ChannelCoupling::Joint, ChannelCoupling::PerChannel })
    {
      VertexSplitting terms(mesh, Values::Constant(4, 1, mu), Vector::Constant(4, nu),
        Flags::Constant(4, false), Vector::Ones(4), { EdgeFunction(), coupling, range },
        SerialFor());
      terms.Start(g, f, u, false);
      for (const double size : { 0.1, 1.0, 4.0 })
      {
        const Values d = size * area * Noise(*mesh, 3, 4);
        double expected = 0.0;
        for (Index i = 0; i < 4; ++i)
        {
          const int together = coupling == ChannelCoupling::Joint ? 3 : 1;
          for (int first = 0; first < 3; first += together)
          {
            const auto part = [&](const Values& x)
            { return Eigen::RowVectorXd(x.row(i).segment(first, together)); };
            const auto energy = [&](const Eigen::RowVectorXd& x)
            {
              return part(d).dot(x) +
                area * (0.5 * mu * (x - part(g)).squaredNorm() + nu * (x - part(f)).norm());
            };
            expected += mu > 0.0
              ? MinimumInBall(energy, part(g), 20.0)
              : MinimumInBall(energy, nu > 0.0 ? part(f) : part(u), range * std::sqrt(together));
          }
        }
        EXPECT_NEAR(terms.DualEnergy(d, u), expected, 1e-4 * area * std::max(1.0, size))
          << mu << ' ' << nu << ' ' << size << ' ' << static_cast<int>(coupling);
      }
    }
  }
}

TEST(TotalVariationMinimizer, GapBoundsTheDistanceToTheMinimum)
{
  for (const Kind kind : { Kind::TotalVariation, Kind::Charbonnier, Kind::Constant })
  {
    for (const ChannelCoupling coupling : { ChannelCoupling::PerChannel, ChannelCoupling::Joint })
    {
      for (const bool absolute : { false, true })
      {
        Problem problem;
        problem.Settings.Function.Kind = kind;
        problem.Settings.Coupling = coupling;
        problem.Quadratic = absolute ? 0.0 : 10.0;
        problem.Absolute = absolute ? 4.0 : 0.0;
        const auto [minimum, fine] = problem.Minimum(1e-6);
        EXPECT_LE(fine.Gap, 1e-6) << static_cast<int>(kind) << static_cast<int>(coupling)
                                  << absolute << " " << fine.Iterations;
        for (const double tolerance : { 1e-1, 1e-2, 1e-3 })
        {
          const auto [energy, report] = problem.Minimum(tolerance);
          EXPECT_LE(report.Gap, tolerance);
          EXPECT_LE(energy - minimum, report.Gap * energy * (1.0 + 1e-6))
            << static_cast<int>(kind) << ' ' << absolute;
          EXPECT_GE(energy - minimum, -1e-6 * energy);
        }
      }
    }
  }
}

TEST(TotalVariationMinimizer, NoSmallChangeLowersTheEnergy)
{
  for (const double absolute : { 0.0, 3.0 })
  {
    Problem problem;
    problem.Absolute = absolute; // together with the quadratic term, as in a time step with L1
    problem.Settings.StopTolerance = 1e-7;
    const Index n = problem.Mesh.NumberOfVertices();
    TotalVariationMinimizer minimizer(problem.Operators,
      std::make_shared<const GradientMaps>(problem.Operators->SharedMesh()),
      Vector::Constant(n, problem.Quadratic), Vector::Constant(n, absolute), problem.Fixed,
      problem.Data, problem.Settings);
    Values u = problem.Data;
    minimizer.Minimize(problem.Data, problem.Data, u);
    const double minimum = problem.Energy(minimizer, u);
    for (int seed = 0; seed < 20; ++seed)
    {
      for (const double size : { 1e-1, 1e-2, 1e-3 })
      {
        EXPECT_GT(problem.Energy(minimizer, u + size * Noise(problem.Mesh, 2, seed)),
          minimum * (1.0 - 1e-7));
      }
    }
  }
}

TEST(TotalVariationMinimizer, FindsTheConstantBelowTheThresholdOfFidelity)
{
  // For small mu the minimiser is the mean: the dual field then bears all of the data.
  Problem problem;
  problem.Quadratic = 1e-3;
  problem.Settings.StopTolerance = 1e-6;
  const Index n = problem.Mesh.NumberOfVertices();
  TotalVariationMinimizer minimizer(problem.Operators,
    std::make_shared<const GradientMaps>(problem.Operators->SharedMesh()),
    Vector::Constant(n, problem.Quadratic), Vector::Zero(n), problem.Fixed, problem.Data,
    problem.Settings);
  Values u = problem.Data;
  minimizer.Minimize(problem.Data, problem.Data, u);
  const Eigen::RowVectorXd mean =
    problem.Mesh.ControlAreas().transpose() * problem.Data / problem.Mesh.ControlAreas().sum();
  EXPECT_LT((u.rowwise() - mean).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(TotalVariationMinimizer, StretchedGradientsGiveTheAnisotropicCoefficients)
{
  const Surface s = Icosphere(2);
  const auto mesh = MakeMesh(s);
  const Points directions = Eigen::RowVector3d(1.0, 2.0, 3.0).replicate(s.NumberOfTriangles(), 1);
  TangentVectors frames = TangentVectorsFromTriangleVectors(*mesh, s.Vertices, s.Faces, directions);
  frames.topRows(10).setZero();
  const GradientMaps maps(mesh, frames, std::sqrt(2.0), std::sqrt(0.3));
  const CornerWeights c = AnisotropicWeights(*mesh, CotanWeights(*mesh), frames, 2.0, 0.3);
  for (Index t = 0; t < mesh->NumberOfTriangles(); ++t)
  {
    EXPECT_NEAR(c(t, 0), -mesh->Shapes()[t].Area() * maps[t].First.dot(maps[t].Second), 1e-13);
  }
}

TEST(TotalVariationMinimizer, SliversAndVeryUnevenTrianglesNeedFewIterationsToo)
{
  // Triangles 1000 times longer than high; next, two meshes of edges 1 and 1/1000 in one problem.
  for (const Surface& s : { Strip(40, 10, 10.0, 0.0025), Joined(Icosphere(3), Icosphere(3, 1e-3)) })
  {
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    const Values f = Noise(mesh);
    const Vector mu = (10.0 * mesh.ControlAreas().array().rsqrt()).matrix();
    TotalVariationMinimizer minimizer(assembler,
      std::make_shared<const GradientMaps>(assembler->SharedMesh()), mu,
      Vector::Zero(mesh.NumberOfVertices()), Flags::Constant(mesh.NumberOfVertices(), false), f,
      { {}, ChannelCoupling::Joint, 2.0, 1e-4, 10000 });
    Values u = f;
    const auto report = minimizer.Minimize(f, f, u);
    EXPECT_LE(report.Gap, 1e-4);
    EXPECT_LE(report.Iterations, 1000);
  }
}

TEST(TotalVariationMinimizer, AbortsWithinAnIteration)
{
  Problem problem;
  const Index n = problem.Mesh.NumberOfVertices();
  TotalVariationMinimizer minimizer(problem.Operators,
    std::make_shared<const GradientMaps>(problem.Operators->SharedMesh()),
    Vector::Constant(n, 10.0), Vector::Zero(n), problem.Fixed, problem.Data, problem.Settings);
  int calls = 0;
  double last = 0.0;
  const ProgressMonitor::Callback stop = [&](double progress)
  {
    EXPECT_GE(progress, last);
    last = progress;
    return ++calls < 7;
  };
  Values u = problem.Data;
  EXPECT_THROW(minimizer.Minimize(problem.Data, problem.Data, u, ProgressMonitor(stop)), Aborted);
  EXPECT_EQ(calls, 7);
}

TEST(TotalVariationMinimizer, SaysWhenTheIterationsEndIt)
{
  Problem problem;
  problem.Settings.MaximumNumberOfIterations = 20;
  const auto [energy, report] = problem.Minimum(1e-8);
  EXPECT_EQ(report.Iterations, 20);
  EXPECT_GT(report.Gap, 1e-8);
  EXPECT_TRUE(std::isfinite(energy));
}
