// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Smooths values on a surface that is given as arrays, in one call and without VTK.
#include "Run/Solve.h"

#include <cstdio>

using namespace SurfaceDiffusion;

int main()
{
  // A sheet of 60 x 60 squares, each of two triangles, with a step and noise on its points
  const int n = 61;
  Points points(n * n, 3);
  Triangles triangles(2 * (n - 1) * (n - 1), 3);
  Values values(n * n, 1);
  for (int i = 0, t = 0; i < n * n; ++i)
  {
    points.row(i) << i % n, i / n, 0.02 * (i % n) * (i / n);
    values(i, 0) = (i % n > n / 2 ? 1.0 : 0.0) + 0.3 * (i * 7919 % 101 / 50.0 - 1.0);
    if (i % n + 1 < n && i + n < n * n)
    {
      triangles.row(t++) << i, i + 1, i + n;
      triangles.row(t++) << i + 1, i + 1 + n, i + n;
    }
  }
  HeatSettings settings;
  settings.FWHM = 6.0; // in the unit of the coordinates
  const Solution smoothed = Heat(points, triangles, values, settings);
  std::printf("values from %g to %g became %g to %g\n", values.minCoeff(), values.maxCoeff(),
    smoothed.Result.minCoeff(), smoothed.Result.maxCoeff());
  return smoothed.Result.maxCoeff() < values.maxCoeff() ? 0 : 1;
}
