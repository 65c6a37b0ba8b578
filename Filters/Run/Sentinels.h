// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/ModelInputs.h"

namespace SurfaceDiffusion
{

/// What a user does about numbers of an array that stand for no value, such as "if it stands for no
/// value, set 0 in its place".
Sentence AboutNoValue(const std::string& array);

/// "allowed: finite numbers, 0 or more", with AboutNoValue().
Sentence AllowedFactors(const std::string& array);

/// A warning for each number that programs write where they have no value, such as -9999 or the fill
/// value of netCDF, 9.969e36, that an array of numbers has farther from all others that count than
/// half of their range: are they values? Collective. aboutData: in place of AboutNoValue() of data and of
/// samples.
std::vector<Sentence> AskForSentinels(const Surface& surface, const Fields& fields,
  const Reduction& processes, const Sentence& aboutData = {});

/// Whether a number is, up to single precision, one of `missing`.
bool StandsForNoValue(double value, const std::vector<double>& missing);

/// Set NaN in the data and the samples where a number stands for no value.
void ReplaceMissingValues(const std::vector<double>& missing, Fields& fields);

} // namespace SurfaceDiffusion
