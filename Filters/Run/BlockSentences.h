// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/ErrorCauses.h"

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace SurfaceDiffusion
{

/// "block a" or "blocks a, b and 3 more".
std::string ListBlocks(const std::vector<std::string>& names);

/// Sentences about the surfaces of an update. A sentence that does not hold for all of them names
/// its blocks; surfaces that are no blocks have an empty name.
class BlockSentences
{
public:
  void Add(const Sentence& sentence, const std::string& block);
  void Add(const std::vector<Sentence>& sentences, const std::string& block);

  /// Append each distinct sentence, in the order of the first calls. blocks: the number of all
  /// surfaces.
  void AppendTo(std::vector<Sentence>& sentences, std::size_t blocks) const;

private:
  struct Entry
  {
    SurfaceDiffusion::Sentence Sentence;
    std::vector<std::string> Blocks;
  };
  std::vector<Entry> Entries;
};

/// Calls a function whose errors name the block, and the settings that may be their remedy.
template <typename Function>
void NameBlockInErrors(const std::string& block, Settings& settings, const Function& function)
{
  try
  {
    function();
  }
  catch (const std::runtime_error& error)
  {
    if (block.empty())
    {
      throw;
    }
    throw InputError(Sentence(ListBlocks({ block }) + ": ") << ExplainError(settings, error));
  }
}

} // namespace SurfaceDiffusion
