// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Statistics/UnbiasedRisk.h"

namespace SurfaceDiffusion
{

NoiseResponse MeasureNoiseResponse(const TriangleMesh& mesh, const PointData& data, const Values& u,
  const std::vector<Values>& changed, const std::vector<Values>& directions, int count, double step,
  VertexRange range)
{
  NoiseResponse found;
  double area = 0.0;
  for (Index i = range.Begin; i < range.End; ++i)
  {
    const double factor = data.FidelityFactor(i);
    if (factor > 0.0)
    {
      const double weight = mesh.ControlAreas()[i] * factor;
      area += mesh.ControlAreas()[i];
      found.MeanSquare += weight * (u.row(i) - data.Given.row(i)).squaredNorm();
      for (std::size_t d = 0; d < static_cast<std::size_t>(count); ++d)
      {
        const auto p = directions[d].row(i);
        const Eigen::RowVectorXd kept = (changed[d].row(i) - u.row(i)) / step;
        found.Freedom += weight / count * p.dot(kept);
        found.Removed += weight / count * (p - kept).squaredNorm();
        found.Direction += weight / count * p.squaredNorm();
      }
    }
  }
  const double total = area * static_cast<double>(u.cols());
  if (total > 0.0)
  {
    found.MeanSquare /= total;
    found.Freedom /= total;
    found.Removed /= total;
    found.Direction /= total;
  }
  return found;
}

} // namespace SurfaceDiffusion
