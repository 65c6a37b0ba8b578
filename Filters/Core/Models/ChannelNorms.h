// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace SurfaceDiffusion
{

/// How the channels of colours meet in norms: of the gradient and of L1 fidelity.
enum class ChannelCoupling
{
  PerChannel, ///< every channel has its own
  Joint ///< one Euclidean norm over all: edges of all channels stay in one place
};

enum class FidelityNorm
{
  L2, ///< lambda/2 |u - f|^2, which pulls with lambda (f - u): Gaussian noise
  L1 ///< lambda |u - f|, which pulls with lambda whatever the distance: impulse noise
};

} // namespace SurfaceDiffusion
