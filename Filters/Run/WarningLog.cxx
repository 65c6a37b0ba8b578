// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/WarningLog.h"

#include <algorithm>
#include <utility>

namespace SurfaceDiffusion
{

std::vector<Sentence> WarningLog::Report(std::vector<Warning> warnings)
{
  std::vector<Sentence> sentences;
  for (const Warning& warning : warnings)
  {
    const bool reported =
      std::find(this->Reported.begin(), this->Reported.end(), warning) != this->Reported.end();
    const bool repeated =
      std::find(sentences.begin(), sentences.end(), warning.Sentence) != sentences.end();
    if (!reported && !repeated)
    {
      sentences.push_back(warning.Sentence);
    }
  }
  this->Reported = std::move(warnings);
  return sentences;
}

} // namespace SurfaceDiffusion
