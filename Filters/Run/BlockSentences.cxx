// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/BlockSentences.h"

#include <algorithm>

namespace SurfaceDiffusion
{

namespace
{

/// Data of thousands of blocks would make messages of thousands of names.
constexpr std::size_t LargestNumberOfNames = 8;

} // namespace

std::string ListBlocks(const std::vector<std::string>& names)
{
  const std::size_t shown = std::min(names.size(), LargestNumberOfNames);
  std::string text = names.size() == 1 ? "block " : "blocks ";
  for (std::size_t i = 0; i < shown; ++i)
  {
    text += (i == 0 ? "" : ", ") + names[i];
  }
  return shown == names.size() ? text
                               : text + " and " + std::to_string(names.size() - shown) + " more";
}

void BlockSentences::Add(const Sentence& sentence, const std::string& block)
{
  auto entry = std::find_if(this->Entries.begin(), this->Entries.end(),
    [&](const Entry& known) { return known.Sentence == sentence; });
  if (entry == this->Entries.end())
  {
    entry = this->Entries.insert(entry, { sentence, {} });
  }
  if (entry->Blocks.empty() || entry->Blocks.back() != block)
  {
    entry->Blocks.push_back(block);
  }
}

void BlockSentences::Add(const std::vector<Sentence>& sentences, const std::string& block)
{
  for (const Sentence& sentence : sentences)
  {
    this->Add(sentence, block);
  }
}

void BlockSentences::AppendTo(std::vector<Sentence>& sentences, std::size_t blocks) const
{
  for (const Entry& entry : this->Entries)
  {
    const bool holdsForAll = entry.Blocks.size() == blocks || entry.Blocks.front().empty();
    Sentence text(holdsForAll ? "" : ListBlocks(entry.Blocks) + ": ");
    sentences.push_back(text << entry.Sentence);
  }
}

} // namespace SurfaceDiffusion
