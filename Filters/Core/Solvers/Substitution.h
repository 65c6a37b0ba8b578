// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Solvers/SparseFactor.h"

namespace SurfaceDiffusion
{

/// w = L^-T D^-1 L^-1 w for K columns in one pass over the factor. w: row-major, in the order of
/// the factor. Every column has the bits that it has alone, on any processor. Instantiated for one,
/// two and three columns, half a panel and a panel.
template <int K>
void SubstituteRows(const SparseFactor& factor, double* w);

} // namespace SurfaceDiffusion
