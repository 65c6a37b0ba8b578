// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ExactDistances.h"

#include <gtest/gtest.h>

#include <limits>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

constexpr double Never = std::numeric_limits<double>::infinity();

/// A point with coordinates from -1 to 1.
Eigen::RowVector3d RandomPoint(std::int64_t seed, Index i)
{
  return { 2.0 * UniformRandom(seed, 0, i) - 1.0, 2.0 * UniformRandom(seed, 1, i) - 1.0,
    2.0 * UniformRandom(seed, 2, i) - 1.0 };
}

TEST(ExactDistance, VerticesOfATetrahedronAreAsFarAsItsEdgesAreLong)
{
  for (std::int64_t seed = 0; seed < 300; ++seed)
  {
    Surface s = Tetrahedron();
    for (Index i = 0; i < 4; ++i)
    {
      s.Vertices.row(i) = RandomPoint(seed, i);
    }
    const ExactOn on(s);
    for (Index i = 0; i < 4; ++i)
    {
      const auto found = on.From(i);
      for (Index j = 0; j < 4; ++j)
      {
        EXPECT_NEAR(found[j], (s.Vertices.row(i) - s.Vertices.row(j)).norm(), 1e-13)
          << "seed " << seed << ", from " << i << " to " << j;
      }
    }
  }
}

TEST(ExactDistance, NothingLiesBehindAnEdgeOfOneTriangle)
{
  const Surface s = MakeSurface(
    { { 0, 0, 0 }, { -1, 1, 0 }, { 1, 1, 0 }, { 0, 3, 0 }, { -1.5, .5, 0 }, { 1.5, .5, 0 } },
    { { 0, 1, 4 }, { 0, 5, 2 }, { 1, 2, 3 } });
  EXPECT_NEAR(ExactOn(s).From(0)[3], std::sqrt(2.0) + std::sqrt(5.0), 1e-13);
}

} // namespace
