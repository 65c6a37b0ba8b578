// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/TangentVectors.h"
#include "Heat.h"
#include "Meshes.h"
#include "ThreadedFor.h"

#include <gtest/gtest.h>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// Everything the linear models do, in one run: directions, fidelity, missing and fixed values.
/// `values`: per input vertex. The result is in the input's numbering.
Values RunModel(const Surface& s, const Values& values, std::shared_ptr<LinearSolver> solver,
  const ParallelFor& parallel = SerialFor(), Scheme scheme = Scheme::SDIRK2)
{
  const auto mesh = std::make_shared<TriangleMesh>(s.Vertices, s.Faces, parallel);
  const auto assembler = std::make_shared<Assembler>(mesh, parallel);
  PointData data = PointData::FromValues(GatherVertices(*mesh, values));
  for (Index i = 0; i < mesh->NumberOfVertices(); ++i)
  {
    const double v = data.Given(i, 0);
    data.Missing[i] = v > 0.9;
    data.Fixed[i] = v < -0.95;
  }
  Points directions(s.NumberOfVertices(), 3);
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    directions.row(i) = Eigen::RowVector3d(s.Vertices.row(i)).cross(Eigen::RowVector3d(1, 2, 3));
  }
  const TangentVectors frames =
    TangentVectorsFromPointVectors(*mesh, s.Vertices, s.Faces, directions, parallel);
  const CornerWeights c =
    AnisotropicWeights(*mesh, CotanWeights(*mesh, parallel), frames, 1.0, 0.3, parallel);
  LinearDiffusion heat(assembler, c, std::move(data), HeatSettings(*mesh, 0.002, 10.0, scheme),
    std::move(solver), parallel);
  Advance(heat, 3);
  Values u = ToInput(*mesh, heat.State(), s.NumberOfVertices());
  u.conservativeResize(u.rows() + 1, Eigen::NoChange);
  u.bottomRows(1).setConstant(heat.Energy());
  return u;
}

Values NoiseOnInput(const Surface& s, Eigen::Index columns)
{
  Values u(s.NumberOfVertices(), columns);
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    for (Eigen::Index k = 0; k < columns; ++k)
    {
      u(i, k) = 2.0 * UniformRandom(11, k, i) - 1.0;
    }
  }
  return u;
}

} // namespace

TEST(Invariance, ThreadsDoNotChangeABit)
{
  const Surface s = Icosphere(5); // 10,242 vertices: enough blocks for several threads
  for (const Eigen::Index columns : { 1, 3 })
  {
    const Values f = NoiseOnInput(s, columns);
    for (const Scheme scheme : { Scheme::BackwardEuler, Scheme::SDIRK2, Scheme::SteadyState })
    {
      const Values serial = RunModel(s, f, MakeConjugateGradientSolver(), SerialFor(), scheme);
      for (const int threads : { 1, 2, 4 })
      {
        const ThreadedFor parallel(threads);
        EXPECT_TRUE(
          RunModel(s, f, MakeConjugateGradientSolver(parallel), parallel, scheme) == serial)
          << threads;
      }
    }
    const ThreadedFor parallel(3);
    EXPECT_TRUE(RunModel(s, f, MakeCholeskySolver(parallel), parallel) ==
      RunModel(s, f, MakeCholeskySolver()));
  }
}

TEST(Invariance, ThreadsDoNotChangeTheMeshOrTheMatrix)
{
  const Surface s = Icosphere(5);
  const ThreadedFor parallel(4);
  const auto serialMesh = MakeMesh(s);
  const auto mesh = std::make_shared<TriangleMesh>(s.Vertices, s.Faces, parallel);
  EXPECT_EQ(mesh->InputVertex(), serialMesh->InputVertex());
  EXPECT_EQ(mesh->TotalEdgeLength(), serialMesh->TotalEdgeLength());
  EXPECT_TRUE(mesh->ControlAreas() == serialMesh->ControlAreas());
  const Assembler serial(serialMesh);
  const Assembler threaded(mesh, parallel);
  SparseMatrix a = ZeroMatrix(serial.Pattern());
  SparseMatrix b = ZeroMatrix(threaded.Pattern());
  serial.Fill(a, serialMesh->ControlAreas(), 0.1, CotanWeights(*serialMesh));
  threaded.Fill(b, mesh->ControlAreas(), 0.1, CotanWeights(*mesh, parallel), nullptr, parallel);
  ASSERT_EQ(a.nonZeros(), b.nonZeros());
  EXPECT_TRUE(std::equal(a.valuePtr(), a.valuePtr() + a.nonZeros(), b.valuePtr()));
}

TEST(Invariance, NumberingOfVerticesAndTrianglesDoesNotMatter)
{
  for (const Surface& s : { Icosphere(3), ThreeFins(8), Joined(Torus(20, 12), Disk(6)) })
  {
    const Values f = NoiseOnInput(s, 2);
    const Values u = RunModel(s, f, MakeCholeskySolver());
    const std::vector<Index> numbers = Permutation(s.NumberOfVertices(), 17);
    Values moved(f.rows(), 2);
    for (Index i = 0; i < s.NumberOfVertices(); ++i)
    {
      moved.row(numbers[i]) = f.row(i);
    }
    const Values v = RunModel(Renumbered(s, numbers), moved, MakeCholeskySolver());
    for (Index i = 0; i < s.NumberOfVertices(); ++i)
    {
      EXPECT_LT((u.row(i) - v.row(numbers[i])).cwiseAbs().maxCoeff(), 1e-12);
    }
    EXPECT_NEAR(u(s.NumberOfVertices(), 0), v(s.NumberOfVertices(), 0), 1e-12 * u(u.rows() - 1, 0));
  }
}

TEST(Invariance, OrientationDoesNotMatter)
{
  const Surface s = Icosphere(3);
  const Values f = NoiseOnInput(s, 2);
  const Values u = RunModel(s, f, MakeCholeskySolver());
  EXPECT_LT((RunModel(Flipped(s), f, MakeCholeskySolver()) - u).cwiseAbs().maxCoeff(), 1e-12);
  Surface mixed = s;
  for (Index t = 0; t < s.NumberOfTriangles(); t += 3)
  {
    std::swap(mixed.Faces(t, 0), mixed.Faces(t, 1));
  }
  EXPECT_LT((RunModel(mixed, f, MakeCholeskySolver()) - u).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Invariance, PlaceAndPostureDoNotMatter)
{
  // Isotropic, since the directions above are tied to the axes.
  const Surface s = Icosphere(3);
  const auto run = [&](const Surface& moved)
  {
    const auto assembler = MakeAssembler(moved);
    const Values u = Diffuse(assembler, PointData::FromValues(Noise(assembler->Mesh())), 0.01, 3);
    return ToInput(assembler->Mesh(), u, s.NumberOfVertices());
  };
  const Values u = run(s);
  EXPECT_LT((run(Rotated(s, 2.0)) - u).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((run(Moved(s, { 3.0, -2.0, 5.0 })) - u).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Invariance, ComponentsTogetherHaveTheBitsTheyHaveAlone)
{
  const Surface s = Icosphere(3);
  for (const Eigen::Index columns : { 2, 3, 5 })
  {
    Values f = NoiseOnInput(s, columns);
    f.col(1).array() += 3.0; // the first column decides what is missing and what is fixed
    const auto mesh = MakeMesh(s);
    const auto assembler = std::make_shared<Assembler>(mesh);
    PointData all = PointData::FromValues(GatherVertices(*mesh, f));
    all.Missing.head(30) = true;
    all.Fixed.tail(20) = true;
    const auto run = [&](const PointData& data)
    {
      const auto heat =
        MakeHeat(assembler, data, HeatSettings(*mesh, 0.01, 5.0), MakeConjugateGradientSolver());
      Advance(*heat, 4);
      return heat->State();
    };
    const Values together = run(all);
    for (Eigen::Index k = 0; k < columns; ++k)
    {
      PointData one = all;
      one.Given = all.Given.col(k).eval();
      one.Start = all.Start.col(k).eval();
      EXPECT_TRUE(run(one).col(0) == together.col(k)) << k << " of " << columns;
    }
  }
}
