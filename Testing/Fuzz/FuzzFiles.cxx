// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Files/SurfaceFile.h"

#include <iterator>
#include <string>

/// The first byte selects the file name, on which the choice of the format depends for some files.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count)
{
  const char* const names[] = { "a", "a.stl", "a.vtp", "a.csv", "lh.thickness", "a.gz", "a.annot" };
  if (count == 0)
  {
    return 0;
  }
  using namespace SurfaceDiffusion::Files;
  const std::string name = names[bytes[0] % std::size(names)];
  try
  {
    const SurfaceFile file = ReadFile(name, bytes + 1, count - 1);
    for (const char* const ending : { "a.stl", "a.ply", "a.obj", "a.off", "a.vtp", "a.vtu", "a.vtk",
           "a.gii", "a.3mf", "a.csv", "lh.a" })
    {
      WriteFile(ending, file);
    }
  }
  catch (const FileError&)
  {
  }
  return 0;
}
