// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

namespace SurfaceDiffusion::Testing
{

constexpr int NumberOfModels = 7;

/// Which model a run was of, and whether its steps have results.
struct Outcome
{
  int Model; ///< of NumberOfModels
  bool HasResult; ///< no failure has ended the steps
};

/// Reads a surface, data and a model with its settings from any bytes and runs a few steps. Throws
/// std::logic_error if the core breaks a promise: states are finite, integrals are conserved,
/// bounds hold if the scheme has them, energies do not grow, and a restored state continues with
/// the same bits. The only failures allowed are an iteration that does not converge, an unbounded
/// reaction, and triangles so flat that round-off makes the matrix indefinite.
Outcome RunFromBytes(const std::uint8_t* bytes, std::size_t count);

} // namespace SurfaceDiffusion::Testing
