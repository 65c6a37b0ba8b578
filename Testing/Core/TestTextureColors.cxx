// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Textures/TextureColors.h"

#include <gtest/gtest.h>

using namespace SurfaceDiffusion;

TEST(TextureColors, ContrastIsThatOfAllButTheFewMostExtreme)
{
  Vector u = Vector::LinSpaced(1001, 2.0, 3.0);
  u[1000] = 1e6;
  const Vector stretched = StretchContrast(u, ContrastLimits(u));
  EXPECT_EQ(stretched.minCoeff(), 0.0);
  EXPECT_EQ(stretched.maxCoeff(), 1.0);
  EXPECT_NEAR(stretched[500], 0.5, 1e-2);
}

TEST(TextureColors, AConstantIsHalfWay)
{
  const Vector u = Vector::Constant(7, 3.0);
  EXPECT_TRUE((StretchContrast(u, ContrastLimits(u)).array() == 0.5).all());
}

TEST(TextureColors, MixesEachComponent)
{
  const Colors colors =
    MixColors(Eigen::Vector3d(0.0, 0.5, 1.0), { 1.0, 0.0, 0.2 }, { 0.0, 1.0, 0.2 });
  const int expected[3][3] = { { 255, 0, 51 }, { 128, 128, 51 }, { 0, 255, 51 } };
  for (int i = 0; i < 3; ++i)
  {
    for (int k = 0; k < 3; ++k)
    {
      EXPECT_EQ(colors(i, k), expected[i][k]) << i << ' ' << k;
    }
  }
}
