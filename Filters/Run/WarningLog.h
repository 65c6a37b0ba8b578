// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/Fingerprint.h"
#include "Run/Sentence.h"

#include <string>
#include <vector>

namespace SurfaceDiffusion
{

/// A warning that holds at present, and the inputs that it is about.
struct Warning
{
  SurfaceDiffusion::Sentence Sentence;
  Fingerprint Cause;
  /// Not empty: warnings of one kind count as the same, although figures in their sentences differ.
  std::string Kind = {};

  friend bool operator==(const Warning& a, const Warning& b)
  {
    return a.Cause == b.Cause && a.Kind == b.Kind && (!a.Kind.empty() || a.Sentence == b.Sentence);
  }
};

/// Selects the warnings that a user has not seen yet. A warning that holds in update after update
/// is reported once. It is reported again if its sentence or its cause changes, and if it did not
/// hold in between.
class WarningLog
{
public:
  /// The sentences of `warnings`, which are all that hold now, that did not hold at the last call.
  std::vector<Sentence> Report(std::vector<Warning> warnings);

private:
  std::vector<Warning> Reported;
};

} // namespace SurfaceDiffusion
