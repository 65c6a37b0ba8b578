// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Files/Stl.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace SurfaceDiffusion::Files
{

namespace
{

constexpr std::size_t Header = 84; ///< 80 bytes of text and the number of triangles
constexpr std::size_t Triangle = 50; ///< the normal, three corners and two bytes

std::uint64_t SizeOfBinary(const Content& content)
{
  return content.Left() < Header ? 0
                                 : Header +
      Triangle * std::uint64_t{ Content::Decode<std::uint32_t>(content.Here() + 80, false) };
}

std::vector<double> ReadText(Content content)
{
  std::vector<double> corners;
  std::string_view line;
  std::size_t number = 0;
  bool inSolid = false;
  while (content.ReadLine(line))
  {
    ++number;
    const std::vector<std::string_view> words = SplitWords(line);
    const std::string key = words.empty() ? "" : LowerCase(words[0]);
    const auto require = [&](bool holds, const char* problem)
    {
      if (!holds)
      {
        throw FileError("line " + std::to_string(number) + ": " + problem);
      }
    };
    if (key == "solid" || key == "\xef\xbb\xbfsolid")
    {
      inSolid = true;
    }
    else if (key == "vertex")
    {
      require(words.size() == 4, "a vertex does not have three coordinates");
      for (std::size_t k = 1; k < 4; ++k)
      {
        corners.push_back(ToNumber(words[k]));
      }
    }
    else if (key == "endfacet")
    {
      require(corners.size() % 9 == 0, "a facet does not have three vertices");
    }
    else if (key == "endsolid")
    {
      inSolid = false;
    }
  }
  if (inSolid || corners.size() % 9 != 0)
  {
    throw FileError("the end is missing: there is no endsolid after the last solid");
  }
  return corners;
}

std::vector<double> ReadBinary(Content content, SurfaceFile& file)
{
  const std::uint64_t size = SizeOfBinary(content);
  if (size > content.Left() || content.Left() < Header)
  {
    throw FileError("it ends too early");
  }
  if (size < content.Left())
  {
    file.Warnings.push_back(std::to_string(content.Left() - size) +
      " bytes after the triangles of its header are not read");
  }
  const auto count = static_cast<std::size_t>((size - Header) / Triangle);
  content.Take(Header);
  std::vector<double> corners;
  corners.reserve(9 * count);
  for (std::size_t t = 0; t < count; ++t)
  {
    const std::uint8_t* const triangle = content.Take(Triangle);
    for (std::size_t k = 3; k < 12; ++k)
    {
      corners.push_back(Content::Decode<float>(triangle + 4 * k, false));
    }
  }
  return corners;
}

} // namespace

bool IsBinaryStl(const Content& content)
{
  return content.Left() >= Header && SizeOfBinary(content) == content.Left();
}

SurfaceFile ReadStl(Content content)
{
  const bool isText =
    content.Text().substr(0, 4096).find('\0') == std::string_view::npos && !IsBinaryStl(content);
  SurfaceFile file;
  file.Kind = "STL";
  const std::vector<double> corners = isText ? ReadText(content) : ReadBinary(content, file);
  // Corners at one place are one point. The points are in the order of their coordinates.
  std::vector<std::size_t> order(corners.size() / 3);
  std::iota(order.begin(), order.end(), std::size_t{ 0 });
  const auto less = [&](std::size_t a, std::size_t b)
  {
    return std::lexicographical_compare(corners.begin() + 3 * a, corners.begin() + 3 * a + 3,
      corners.begin() + 3 * b, corners.begin() + 3 * b + 3);
  };
  if (std::any_of(
        corners.begin(), corners.end(), [](double number) { return !std::isfinite(number); }))
  {
    throw FileError("a coordinate is not finite; allowed: finite coordinates");
  }
  std::sort(order.begin(), order.end(), less);
  file.Corners.resize(order.size());
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    if (i == 0 || less(order[i - 1], order[i]))
    {
      file.Points.insert(
        file.Points.end(), corners.begin() + 3 * order[i], corners.begin() + 3 * order[i] + 3);
    }
    file.Corners[order[i]] = static_cast<std::int64_t>(file.NumberOfPoints()) - 1;
  }
  JoinSeams(file);
  for (std::size_t end = 3; end <= file.Corners.size(); end += 3)
  {
    file.Begin.push_back(end);
  }
  return file;
}

Bytes WriteStl(const SurfaceFile& surface)
{
  Writer writer;
  writer.Text(std::string(80, ' '));
  writer.Binary(static_cast<std::uint32_t>(surface.NumberOfCells()));
  for (std::size_t c = 0; c < surface.NumberOfCells(); ++c)
  {
    std::array<std::array<double, 3>, 3> corners{};
    for (std::size_t k = 0; k < 9; ++k)
    {
      const auto point = static_cast<std::size_t>(surface.Corners[surface.Begin[c] + k / 3]);
      corners[k / 3][k % 3] = surface.Points[3 * point + k % 3];
    }
    std::array<double, 3> normal{};
    for (std::size_t k = 0; k < 3; ++k)
    {
      const std::size_t a = (k + 1) % 3;
      const std::size_t b = (k + 2) % 3;
      normal[k] = (corners[1][a] - corners[0][a]) * (corners[2][b] - corners[0][b]) -
        (corners[1][b] - corners[0][b]) * (corners[2][a] - corners[0][a]);
    }
    const double length = std::hypot(normal[0], normal[1], normal[2]);
    for (const double x : normal)
    {
      writer.Binary(static_cast<float>(length > 0.0 ? x / length : 0.0));
    }
    for (const auto& corner : corners)
    {
      for (const double x : corner)
      {
        writer.Binary(static_cast<float>(x));
      }
    }
    writer.Binary(std::uint16_t{ 0 });
  }
  return writer.Written;
}

} // namespace SurfaceDiffusion::Files
