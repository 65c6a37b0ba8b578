// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Model.h"
#include "Core/Operators/Assembler.h"

#include <functional>

namespace SurfaceDiffusion
{

/// Standard deviation of white noise in the known values, estimated without knowing the signal:
/// 1.4826 x the median of |f_i - mean of the neighbours| / sqrt(1 + 1/valence), which is robust to
/// edges and smooth variation (median absolute deviation; Donoho 1995). Root mean square over the
/// columns; 0 if every vertex has a missing neighbour.
double EstimateNoiseLevel(const Assembler& assembler, const PointData& data);

/// The fidelity weight at which the mean square of u - f equals the noise: discrepancy principle
/// (Morozov 1966). discrepancy(lambda), the root mean square of u - f at lambda, must not
/// increase with lambda. `start` is the first guess, of the right units. Stops at 1 % in lambda. If
/// even lambda = 1e-8 start leaves less than the noise, that lambda is returned; likewise 1e8
/// start.
double FindFidelityByDiscrepancy(
  const std::function<double(double)>& discrepancy, double noiseLevel, double start);

/// Root of the area-weighted mean over the known vertices, and the columns, of (u - f)^2.
double Discrepancy(const TriangleMesh& mesh, const PointData& data, const Values& u);

} // namespace SurfaceDiffusion
