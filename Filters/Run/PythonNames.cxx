// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/PythonNames.h"

#include <cctype>
#include <cstddef>
#include <utility>

namespace SurfaceDiffusion
{

std::string PythonName(const std::string& name)
{
  constexpr std::pair<const char*, const char*> others[] = { { "RandomSeed", "seed" },
    { "ResultOnCells", "result_on_faces" }, { "KeepCellDetail", "keep_face_detail" },
    { "UpDirection", "up" } };
  for (const auto& [known, keyword] : others)
  {
    if (name == known)
    {
      return keyword;
    }
  }
  const auto is = [&name](int (*kind)(int), std::size_t i)
  { return i < name.size() && kind(static_cast<unsigned char>(name[i])) != 0; };
  std::string keyword;
  for (std::size_t i = 0; i < name.size(); ++i)
  {
    if (i > 0 && is(&std::isupper, i) && (!is(&std::isupper, i - 1) || is(&std::islower, i + 1)))
    {
      keyword += '_';
    }
    keyword += static_cast<char>(std::tolower(static_cast<unsigned char>(name[i])));
  }
  return keyword;
}

bool IsOfPipelines(const std::string& setting)
{
  return setting == "GenerateTimeSteps" || setting == "CheckpointMemoryLimit";
}

} // namespace SurfaceDiffusion
