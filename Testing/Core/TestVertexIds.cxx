// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RunInput.h"

#include "Core/Foundation/Random.h"
#include "Run/Surface.h"

#include <gtest/gtest.h>

#include <set>

using namespace SurfaceDiffusion;
using Testing::Icosphere;
using Testing::Joined;

namespace
{

std::vector<std::int64_t> IdsOf(const Testing::Surface& s)
{
  const SurfaceDiffusion::Surface surface(
    { s.Vertices, s.Faces, {} }, {}, SerialFor(), ProgressMonitor());
  const TriangleMesh& mesh = surface.InputMesh();
  const double h = mesh.MeanEdgeLength() * mesh.LengthUnit();
  const std::vector<std::int64_t> ids = MakeVertexIds(surface, Fields(), h);
  std::vector<std::int64_t> ofPoints(ids.size());
  for (std::size_t v = 0; v < ids.size(); ++v)
  {
    ofPoints[static_cast<std::size_t>(mesh.InputVertex()[v])] = ids[v];
  }
  return ofPoints;
}

double SizeOf(const Testing::Surface& s)
{
  return (s.Vertices.colwise().maxCoeff() - s.Vertices.colwise().minCoeff()).norm();
}

Testing::Surface Shaken(Testing::Surface s, double amount, std::int64_t seed)
{
  for (Eigen::Index i = 0; i < s.Vertices.rows(); ++i)
  {
    for (Eigen::Index k = 0; k < 3; ++k)
    {
      s.Vertices(i, k) += amount * (2.0 * UniformRandom(seed, k, i) - 1.0);
    }
  }
  return s;
}

} // namespace

TEST(VertexIds, AreKeptWhereASurfaceMovesByRoundOff)
{
  const Testing::Surface part = Icosphere(3);
  for (const Testing::Surface& s :
    { Icosphere(4), Testing::Plate(30, 1.0), Testing::Plate(21, 0.35), Testing::Torus(40, 20),
      Testing::Rotated(Testing::Plate(24, 0.5)),
      Joined(part, Testing::Moved(Testing::Scaled(part, 1e-3), { 3.0, 0.0, 0.0 })) })
  {
    for (const double unit : { 1.0, 1e3, 1e-3, 1e-12 })
    {
      const Testing::Surface scaled = Testing::Scaled(s, unit);
      const std::vector<std::int64_t> ids = IdsOf(scaled);
      const double move = 1e-12 * SizeOf(scaled);
      EXPECT_EQ(IdsOf(Shaken(scaled, move, 1)), ids);
      EXPECT_EQ(IdsOf(Shaken(scaled, move, 2)), ids);
      EXPECT_EQ(IdsOf(Testing::Moved(scaled, { move, -move, move })), ids);
    }
  }
}

TEST(VertexIds, DifferAtPointsThatAreNearEachOther)
{
  const Testing::Surface s = Icosphere(3);
  for (const double apart : { 0.0, 1e-12, 1e-9, 1e-6, 1e-3 })
  {
    const Testing::Surface sheets = Joined(
      Joined(s, Testing::Moved(s, { apart, 0.0, 0.0 })), Testing::Moved(s, { 0.0, apart, apart }));
    const std::vector<std::int64_t> ids = IdsOf(sheets);
    EXPECT_EQ(std::set<std::int64_t>(ids.begin(), ids.end()).size(), ids.size()) << apart;
  }
}

TEST(VertexIds, DoNotDependOnTheNumbering)
{
  const Testing::Surface s = Joined(Icosphere(3), Testing::Moved(Icosphere(3), { 1e-9, 0.0, 0.0 }));
  const std::vector<Index> numbers = Testing::Permutation(s.NumberOfVertices(), 7);
  const std::vector<std::int64_t> ids = IdsOf(s);
  const std::vector<std::int64_t> renumbered = IdsOf(Testing::Renumbered(s, numbers));
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    EXPECT_EQ(renumbered[static_cast<std::size_t>(numbers[i])], ids[i]) << i;
  }
}
