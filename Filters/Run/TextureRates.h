// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"
#include "Run/TextureSettings.h"

#include <array>

namespace SurfaceDiffusion
{

/// g1 and g2 of both chemicals in LengthUnit^2 ReactionRate, per triangle of the mesh, and their
/// means over the surface.
struct TextureSettings::Rates
{
  std::array<Vector, 2> Along, Across;
  std::array<double, 2> MeanAlong, MeanAcross;

  void Scale(double factor)
  {
    for (int c = 0; c < 2; ++c)
    {
      this->Along[c] *= factor;
      this->Across[c] *= factor;
      this->MeanAlong[c] *= factor;
      this->MeanAcross[c] *= factor;
    }
  }
};

} // namespace SurfaceDiffusion
