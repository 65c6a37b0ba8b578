// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Textures/Reaction.h"

#include "Core/Foundation/Random.h"

namespace SurfaceDiffusion
{

Values NoisySteadyState(
  const Reaction& reaction, double noise, std::int64_t seed, const std::vector<std::int64_t>& ids)
{
  const Eigen::Vector2d steady = reaction.Terms->SteadyState(reaction.Parameters);
  Values u(static_cast<Eigen::Index>(ids.size()), 2);
  for (Eigen::Index i = 0; i < u.rows(); ++i)
  {
    for (Eigen::Index k = 0; k < 2; ++k)
    {
      const double random = 2.0 * UniformRandom(seed, k, ids[static_cast<std::size_t>(i)]) - 1.0;
      const double size = reaction.Terms->NonNegative ? steady[k] : 1.0;
      u(i, k) = steady[k] + size * noise * random;
    }
  }
  return u;
}

} // namespace SurfaceDiffusion
