// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/Sentence.h"

#include <ostream>

namespace SurfaceDiffusion
{

Sentence& Sentence::operator<<(const Sentence& more)
{
  for (const Word& word : std::vector<Word>(more.All))
  {
    const bool continues = !this->All.empty() && this->All.back().Type == Word::Kind::Text;
    if (continues && word.Type == Word::Kind::Text)
    {
      this->All.back().Spelling += word.Spelling;
    }
    else
    {
      this->All.push_back(word);
    }
  }
  return *this;
}

std::string Sentence::Text(const std::map<std::string, std::string>& names) const
{
  std::string text;
  for (const Word& word : this->All)
  {
    const bool isName = word.Type == Word::Kind::Setting || word.Type == Word::Kind::Array;
    const auto other = isName ? names.find(word.Name) : names.end();
    text += other == names.end() ? word.Spelling : other->second;
  }
  return text;
}

std::ostream& operator<<(std::ostream& stream, const Sentence& sentence)
{
  return stream << sentence.Text();
}

Sentence Join(const std::vector<Sentence>& sentences)
{
  Sentence all;
  for (const Sentence& sentence : sentences)
  {
    all << (all.Words().empty() ? "" : "; ") << sentence;
  }
  return all;
}

} // namespace SurfaceDiffusion
