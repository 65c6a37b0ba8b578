// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Interpolation/ScatteredValues.h"

#include <utility>

namespace SurfaceDiffusion
{

/// Values at places that differ, and what repeats at one place say of the noise: pure error.
struct RepeatedValues : ScatteredValues
{
  RepeatedValues() = default;
  /// Without repeats.
  RepeatedValues(ScatteredValues values) // NOLINT(google-explicit-constructor)
    : ScatteredValues(std::move(values))
    , Scatter(Values::Zero(this->Given.rows(), this->Given.cols()))
    , Repeats(Vector::Zero(this->Given.rows()))
  {
  }
  /// merged: those of the given values. If most places with repeats have equal ones, these are copies
  /// of one measurement: only places whose values differ have Repeats.
  RepeatedValues(const ScatteredValues& given, const MergedValues& merged);

  Values Scatter; ///< per place, the sum of w times the squares of the deviations from d
  Vector Repeats; ///< per place, the number of its values less 1
};

} // namespace SurfaceDiffusion
