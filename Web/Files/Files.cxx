// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Files/Stl.h"

#include <algorithm>

namespace SurfaceDiffusion::Files
{

namespace
{

std::string EndingOf(const std::string& name)
{
  const std::size_t dot = name.rfind('.');
  return dot == std::string::npos ? "" : LowerCase(name.substr(dot + 1));
}

/// Corners that are no points, and cells that are no polygons, end here.
void Check(const SurfaceFile& file)
{
  const auto points = static_cast<std::int64_t>(file.NumberOfPoints());
  for (const std::int64_t corner : file.Corners)
  {
    if (corner < 0 || corner >= points)
    {
      throw FileError("a face refers to point " + std::to_string(corner) + "; allowed: 0 to " +
        std::to_string(points - 1));
    }
  }
  for (std::size_t c = 0; c < file.NumberOfCells(); ++c)
  {
    if (file.Begin[c + 1] < file.Begin[c] + 3)
    {
      throw FileError("a face has fewer than three points; allowed: polygons");
    }
  }
}

} // namespace

SurfaceFile ReadFile(const std::string& name, const std::uint8_t* data, std::size_t size)
{
  const Content content(data, size);
  if (size == 0)
  {
    throw FileError("the file is empty");
  }
  SurfaceFile file;
  if (IsBinaryStl(content) || EndingOf(name) == "stl")
  {
    file = ReadStl(content);
  }
  else
  {
    throw FileError(
      "a file of unknown kind that starts with " + Quote(content.Text().substr(0, 12)));
  }
  Check(file);
  return file;
}

Bytes WriteFile(const std::string& name, const SurfaceFile& surface)
{
  if (EndingOf(name) == "stl")
  {
    return WriteStl(surface);
  }
  throw FileError(name + ": the name ends in no format that is written; allowed: .stl");
}

} // namespace SurfaceDiffusion::Files
