// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Operators/CotanWeights.h"

#include <algorithm>

namespace SurfaceDiffusion
{

/// By what the square of gradients in a triangle is multiplied in energies of fourth order: 1, but
/// less in needles, whose cotangents are reduced to a largest one. A fourth-order operator squares
/// them, and its round-off would be larger than the weights of values. The ends of an edge that is
/// so short keep nearly the same value: their difference is at most of the order of 1e-4 of that
/// along other edges.
inline double NeedleShare(const TriangleMesh::Shape& shape)
{
  constexpr double largest = 1e4;
  return std::min(1.0, largest / CotanWeights(shape).cwiseAbs().maxCoeff());
}

} // namespace SurfaceDiffusion
