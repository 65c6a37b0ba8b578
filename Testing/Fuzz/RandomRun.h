// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

namespace SurfaceDiffusion::Testing
{

/// Reads a surface, data and a model with its settings from the bytes, any bytes, and runs it for
/// a few steps. Throws std::logic_error where something the core promises does not hold: states
/// are finite, sums kept, bounds kept where they must be, energies do not grow, a restored state
/// goes on with the same bits, and the only failure is of an iteration that does not converge, of
/// a reaction without bounds, and of triangles so flat that round-off takes their matrix apart.
void RunFromBytes(const std::uint8_t* bytes, std::size_t count);

} // namespace SurfaceDiffusion::Testing
