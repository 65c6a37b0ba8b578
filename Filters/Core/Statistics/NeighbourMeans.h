// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Operators/Assembler.h"
#include "Core/Surface/PointData.h"

namespace SurfaceDiffusion
{

/// The data after `passes` times replacing each known value by the mean over it and its known
/// neighbours, each with the weight of its control area times its fidelity factor. On an even mesh
/// white noise keeps 0.38 of its deviation after one pass, and about 0.4/sqrt(passes) after several.
Values NeighbourMeans(const Assembler& assembler, const PointData& data, int passes,
  const ParallelFor& parallel = SerialFor());

} // namespace SurfaceDiffusion
