// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Statistics/NeighbourMeans.h"

namespace SurfaceDiffusion
{

Values NeighbourMeans(
  const Assembler& assembler, const PointData& data, int passes, const ParallelFor& parallel)
{
  const TriangleMesh& mesh = assembler.Mesh();
  const SparsePattern pattern = assembler.Pattern();
  Values means = data.Given;
  Values former;
  for (int pass = 0; pass < passes; ++pass)
  {
    former = means;
    ForEach(parallel, mesh.NumberOfVertices(),
      [&](Index i)
      {
        if (data.FidelityFactor(i) == 0.0)
        {
          return;
        }
        means.row(i).setZero();
        double sum = 0.0;
        for (Index slot = pattern.Outer[i]; slot < pattern.Outer[i + 1]; ++slot) // i is one of them
        {
          const Index j = pattern.Inner[slot];
          const double weight = mesh.ControlAreas()[j] * data.FidelityFactor(j);
          if (weight > 0.0)
          {
            means.row(i) += weight * former.row(j);
            sum += weight;
          }
        }
        means.row(i) /= sum;
      });
  }
  return means;
}

} // namespace SurfaceDiffusion
