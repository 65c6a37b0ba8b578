// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/Settings.h"

#include <string>
#include <vector>

namespace SurfaceDiffusion
{

/// The sentence of this name in the table of InputSentences.cxx, which has those about inputs of blocks
/// with named arrays that several interfaces say. parts: stand in place of each {}.
Sentence FillSentence(const std::string& name, const std::vector<Sentence>& parts);

/// The same of texts and numbers.
template <typename... Parts>
Sentence Say(const char* name, const Parts&... parts)
{
  return FillSentence(name, { (Sentence() << parts)... });
}

/// The property, with the name of the array if the user gave one.
std::string ArrayLabel(const std::string& property, const std::string& name);

/// A chosen array is not there. attribute: the active one that was chosen; empty: it was chosen by
/// name. isElsewhere: there is one of this name in the other place.
Sentence SayAbsent(const std::string& label, const std::string& attribute, bool onPoints,
  bool onCells, bool isElsewhere);

/// A description for comparing the arrays of pieces. type: empty if it has no meaning.
std::string DescribeArray(
  const std::string& name, const std::string& type, int components, bool onCells);

/// Properties of all surfaces that are no settings of a run. isAutomatic: whether refineTo may be -1.
void CheckSurfaceProperties(double seamTolerance, double refineTo, bool isAutomatic,
  int maximumNumberOfTriangles, int numberOfThreads, Problems& problems);

} // namespace SurfaceDiffusion
