// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Operators/MixedMass.h"

#include <algorithm>

namespace SurfaceDiffusion
{

CornerWeights MixedMassWeights(const TriangleMesh& mesh, const ParallelFor& parallel)
{
  Vector shares(mesh.NumberOfVertices());
  ForEach(parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      const double thirds = mesh.ThirdOfTriangles(i);
      shares[i] = thirds > 0.0 ? mesh.ControlAreas()[i] / thirds : 0.0;
    });
  CornerWeights weights(mesh.NumberOfTriangles(), 3);
  ForEach(parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      const auto corners = mesh.TriangleVertices().row(t);
      const double share = std::min({ shares[corners[0]], shares[corners[1]], shares[corners[2]] });
      weights.row(t).setConstant(-share * mesh.Shapes()[t].Area() / 24.0);
    });
  return weights;
}

SparseMatrix MixedMinusLumped(
  const Assembler& assembler, const CornerWeights& weights, const ParallelFor& parallel)
{
  SparseMatrix difference;
  assembler.TakePattern(difference, parallel);
  assembler.Fill(
    difference, Vector::Zero(assembler.Mesh().NumberOfVertices()), 1.0, weights, nullptr, parallel);
  return difference;
}

} // namespace SurfaceDiffusion
