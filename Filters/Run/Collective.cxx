// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/Collective.h"

#include <cstddef>
#include <vector>

namespace SurfaceDiffusion
{

std::string FirstMessage(const Reduction& processes, const std::string& here)
{
  // The length of each process's message, and its characters.
  std::vector<double> characters = { static_cast<double>(here.size()) };
  for (const char character : here)
  {
    characters.push_back(static_cast<unsigned char>(character));
  }
  const std::vector<double> all = processes.Gather(characters);
  std::string message;
  for (std::size_t begin = 1; begin <= all.size() && message.empty();)
  {
    const std::size_t end = begin + static_cast<std::size_t>(all[begin - 1]);
    for (std::size_t i = begin; i < end; ++i)
    {
      message.push_back(static_cast<char>(static_cast<unsigned char>(all[i])));
    }
    begin = end + 1;
  }
  return message;
}

} // namespace SurfaceDiffusion
