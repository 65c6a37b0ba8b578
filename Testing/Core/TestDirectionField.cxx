// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/DirectionField.h"
#include "Core/Surface/TangentVectors.h"
#include "Meshes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// The lines of the smoothest field in space, per triangle.
Points SmoothLines(const Surface& s, bool perpendicular = false)
{
  const Assembler assembler(MakeMesh(s));
  DirectionSettings settings;
  settings.Method = DirectionMethod::Smooth;
  settings.Perpendicular = perpendicular;
  const TangentVectors none = TangentVectors::Zero(s.NumberOfTriangles(), 2);
  return VectorsInSpace(assembler.Mesh(), s.Vertices, s.Faces,
    MakeDirectionField(assembler, s.Vertices, s.Faces, none, settings));
}

} // namespace

/// On round parts all fields of a whole family are equally smooth, and curvature chooses none.
TEST(DirectionField, SmoothLinesDoNotDependOnNumbers)
{
  Surface egg = Icosphere(3);
  egg.Vertices.col(2) *= 1.6;
  egg.Vertices.col(0) += 0.2 * egg.Vertices.col(1).cwiseAbs2();
  const Surface s = Joined(Joined(egg, Moved(Icosphere(4, 0.02), { 2.0, 1.0, 0.0 })),
    Moved(Rotated(Plate(6, 0.5)), { -3.0, 0.0, 0.0 }));
  const Points lines = SmoothLines(s);

  const Surface other = Renumbered(s, Permutation(s.NumberOfVertices(), 7));
  const Points again = SmoothLines(other);
  const std::vector<Index> place = Permutation(s.NumberOfTriangles(), 99); // of Renumbered()
  for (Index t = 0; t < s.NumberOfTriangles(); ++t)
  {
    EXPECT_NEAR(std::abs(again.row(place[t]).dot(lines.row(t))), 1.0, 1e-6);
  }
}

TEST(DirectionField, PerpendicularSmoothLinesAreTurnedByARightAngle)
{
  for (const Surface& s : { Icosphere(2), Torus(24, 12), Rotated(Strip(6, 4)) })
  {
    const Points lines = SmoothLines(s);
    const Points across = SmoothLines(s, true);
    EXPECT_LT(lines.cwiseProduct(across).rowwise().sum().cwiseAbs().maxCoeff(), 1e-5);
  }
}
