// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/MeanPartArea.h"

#include "Core/Surface/AllComponents.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

double MeanPartArea(const std::vector<const TriangleMesh*>& surfaces)
{
  double unit = 0.0; // in which squares of areas do not overflow
  for (const TriangleMesh* const mesh : surfaces)
  {
    unit = std::max(unit, mesh->LengthUnit());
  }
  double sum = 0.0;
  double squares = 0.0;
  for (const TriangleMesh* const mesh : surfaces)
  {
    const Index count = mesh->NumberOfComponents();
    Values here = Values::Zero(count, 1);
    for (Index c = 0; c < count; ++c)
    {
      for (Index i = mesh->ComponentsBegin()[c]; i < mesh->ComponentsBegin()[c + 1]; ++i)
      {
        here(c, 0) += mesh->ThirdOfTriangles(i);
      }
    }
    here *= std::pow(mesh->LengthUnit() / unit, 2);
    Values whole = here;
    mesh->GetReduction().SumComponents(AllComponents(*mesh), whole);
    double sums[2] = { here.sum(), here.col(0).dot(whole.col(0)) };
    mesh->GetReduction().Sum(sums, 2);
    sum += sums[0];
    squares += sums[1];
  }
  return sum > 0.0 ? squares / sum * unit * unit : 0.0;
}

} // namespace SurfaceDiffusion
