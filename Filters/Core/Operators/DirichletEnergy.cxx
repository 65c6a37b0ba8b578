// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Operators/DirichletEnergy.h"

namespace SurfaceDiffusion
{

double DirichletEnergy(const TriangleMesh& mesh, const CornerWeights& coefficients, const Values& u,
  const ParallelFor& parallel)
{
  const Triangles& corners = mesh.TriangleVertices();
  return 0.5 *
    Sum(parallel, mesh.NumberOfTriangles(),
      [&](Index t)
      {
        const auto square = [&](int a, int b)
        {
          double sum = 0.0;
          for (Eigen::Index k = 0; k < u.cols(); ++k)
          {
            const double difference = u(corners(t, a), k) - u(corners(t, b), k);
            sum += difference * difference;
          }
          return sum;
        };
        return coefficients(t, 0) * square(1, 2) + coefficients(t, 1) * square(2, 0) +
          coefficients(t, 2) * square(0, 1);
      });
}

double DirichletEnergy(const SparseMatrix& stiffness, const Values& u, const ParallelFor& parallel)
{
  return 0.5 *
    Sum(parallel, static_cast<Index>(u.rows()),
      [&](Index i)
      {
        double sum = 0.0;
        for (Eigen::Index k = 0; k < u.cols(); ++k)
        {
          double product = 0.0;
          for (SparseMatrix::InnerIterator entry(stiffness, i); entry; ++entry)
          {
            product += entry.value() * u(entry.index(), k);
          }
          sum += u(i, k) * product;
        }
        return sum;
      });
}

} // namespace SurfaceDiffusion
