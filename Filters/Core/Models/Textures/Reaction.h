// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"
#include "Core/Models/Textures/Kinetics.h"

#include <cstdint>
#include <vector>

namespace SurfaceDiffusion
{

/// The reaction terms F and G of (22), kinetics with a reaction rate s.
struct Reaction
{
  const Kinetics* Terms = &GetKinetics(KineticsName::Turing);
  KineticsParameters Parameters = Terms->Defaults();
  double Rate = 1.0; ///< s, in 1/time
};

/// The steady state with uniform relative noise of half width `noise`, the same for a seed on any
/// machine: u_k = u*_k (1 + noise (2 r - 1)) with r in [0, 1) from seed, k and id; for kinetics of
/// either sign u_k = u*_k + noise (2 r - 1). ids: one per vertex.
Values NoisySteadyState(
  const Reaction& reaction, double noise, std::int64_t seed, const std::vector<std::int64_t>& ids);

} // namespace SurfaceDiffusion
