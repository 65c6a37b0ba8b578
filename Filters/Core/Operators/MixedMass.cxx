// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Operators/MixedMass.h"

#include <algorithm>

namespace SurfaceDiffusion
{

CornerWeights WithMixedMass(const TriangleMesh& mesh, double scale,
  const CornerWeights& coefficients, const ParallelFor& parallel)
{
  Vector shares(mesh.NumberOfVertices());
  ForEach(parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      const double thirds = mesh.ThirdOfTriangles(i);
      shares[i] = thirds > 0.0 ? mesh.ControlAreas()[i] / thirds : 0.0;
    });
  CornerWeights joined(mesh.NumberOfTriangles(), 3);
  ForEach(parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      const auto corners = mesh.TriangleVertices().row(t);
      const double share = std::min({ shares[corners[0]], shares[corners[1]], shares[corners[2]] });
      const double mass = share * mesh.Shapes()[t].Area() / 24.0;
      joined.row(t) = scale * coefficients.row(t).array() - mass;
    });
  return joined;
}

SparseMatrix MixedMinusLumped(const Assembler& assembler, const ParallelFor& parallel)
{
  const TriangleMesh& mesh = assembler.Mesh();
  SparseMatrix difference;
  assembler.TakePattern(difference, parallel);
  assembler.Fill(difference, Vector::Zero(mesh.NumberOfVertices()), 1.0,
    WithMixedMass(mesh, 0.0, CornerWeights::Zero(mesh.NumberOfTriangles(), 3), parallel), nullptr,
    parallel);
  return difference;
}

} // namespace SurfaceDiffusion
