// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Files/FreeSurfer.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace SurfaceDiffusion::Files
{

SurfaceFile ReadFreeSurfer(Content content)
{
  content.Take(3);
  SurfaceFile file;
  file.Kind = "FreeSurfer surface";
  file.Unit = "mm";
  // Two lines of text, and an empty one in most files
  for (int line = 0; line < 2; ++line)
  {
    while (*content.Take(1) != '\n')
    {
    }
  }
  const auto points = content.Read<std::int32_t>(true);
  const auto faces = content.Read<std::int32_t>(true);
  CheckCount(points, 12, content, "points");
  file.Points =
    ReadNumbers(content, 3 * static_cast<std::uint64_t>(points), NumberType::Float32, true);
  CheckCount(faces, 12, content, "faces");
  for (std::int32_t f = 0; f < faces; ++f)
  {
    for (int k = 0; k < 3; ++k)
    {
      file.Corners.push_back(content.Read<std::int32_t>(true));
    }
    file.Begin.push_back(file.Corners.size());
  }
  return file;
}

namespace
{

/// The points and triangles after the counts: a row of each, with a number after it that does not count.
void ReadRows(Content content, std::int64_t points, std::int64_t faces, SurfaceFile& file)
{
  file.Kind = "FreeSurfer surface";
  file.Unit = "mm";
  CheckCount(points, 6, content, "points");
  for (std::int64_t i = 0; i < points; ++i)
  {
    for (int k = 0; k < 3; ++k)
    {
      file.Points.push_back(ToNumber(content.ReadWord()));
    }
    content.ReadWord();
  }
  CheckCount(faces, 6, content, "faces");
  for (std::int64_t f = 0; f < faces; ++f)
  {
    for (int k = 0; k < 3; ++k)
    {
      file.Corners.push_back(ToInteger(content.ReadWord()));
    }
    file.Begin.push_back(file.Corners.size());
    content.ReadWord();
  }
}

} // namespace

SurfaceFile ReadFreeSurferText(Content content, const std::string& name)
{
  std::string_view line;
  content.ReadLine(line); // "#!ascii ..."
  content.ReadLine(line);
  const std::vector<std::string_view> counts = SplitWords(line);
  SurfaceFile file;
  if (counts.size() == 2)
  {
    ReadRows(content, ToInteger(counts[0]), ToInteger(counts[1]), file);
    return file;
  }
  file.Kind = "FreeSurfer label";
  FileArray inside{ name };
  inside.Elsewhere = 0.0;
  FileArray values{ name + " value" };
  const std::int64_t rows = counts.size() == 1 ? ToInteger(counts[0]) : 0;
  CheckCount(rows, 10, content, "points");
  for (std::int64_t row = 0; row < rows; ++row)
  {
    file.At.push_back(ToInteger(content.ReadWord()));
    for (int k = 0; k < 3; ++k)
    {
      content.ReadWord();
    }
    values.Numbers.push_back(ToNumber(content.ReadWord()));
  }
  if (file.At.empty())
  {
    throw FileError("the label has no point; allowed: one or more");
  }
  inside.Numbers.assign(file.At.size(), 1.0);
  const bool hasValues = std::any_of(values.Numbers.begin(), values.Numbers.end(),
    [&values](double value) { return value != values.Numbers[0]; });
  file.Arrays.push_back(std::move(inside));
  if (hasValues)
  {
    file.Arrays.push_back(std::move(values));
  }
  return file;
}

SurfaceFile ReadAnnotation(Content content, const std::string& name)
{
  const std::size_t rows = CheckCount(content.Read<std::int32_t>(true), 8, content, "points");
  std::vector<std::int32_t> points;
  std::vector<std::int32_t> codes;
  for (std::size_t row = 0; row < rows; ++row)
  {
    points.push_back(content.Read<std::int32_t>(true));
    codes.push_back(content.Read<std::int32_t>(true));
  }
  // The table: a version, the number of entries, a file name, and entries of a name and a colour
  const auto skipText = [&content]
  { content.Take(static_cast<std::uint32_t>(content.Read<std::int32_t>(true))); };
  std::map<std::int32_t, double> regions;
  if (content.Left() > 4 && content.Read<std::int32_t>(true) != 0)
  {
    const auto version = content.Read<std::int32_t>(true);
    const bool isOld = version > 0;
    content.Take(isOld ? 0 : 4);
    skipText();
    const std::int32_t entries = isOld ? version : content.Read<std::int32_t>(true);
    CheckCount(entries, 20, content, "regions");
    for (std::int32_t entry = 0; entry < entries; ++entry)
    {
      const std::int32_t region = isOld ? entry : content.Read<std::int32_t>(true);
      skipText();
      std::int32_t code = 0;
      for (int k = 0; k < 4; ++k)
      {
        const auto part = static_cast<std::uint32_t>(content.Read<std::int32_t>(true)) & 255U;
        code |= k < 3 ? static_cast<std::int32_t>(part << (8 * k)) : 0;
      }
      regions[code] = region;
    }
  }
  SurfaceFile file;
  file.Kind = "FreeSurfer annotation";
  FileArray array{ name };
  for (std::size_t row = 0; row < rows; ++row)
  {
    const auto found = regions.find(codes[row]);
    file.At.push_back(points[row]);
    array.Numbers.push_back(regions.empty() ? codes[row]
        : found == regions.end()            ? array.Elsewhere
                                            : found->second);
  }
  if (rows > 0)
  {
    file.Arrays.push_back(std::move(array));
  }
  return file;
}

SurfaceFile ReadCurv(Content content, const std::string& name)
{
  content.Take(3);
  const auto points = content.Read<std::int32_t>(true);
  content.Take(4);
  const auto perPoint = content.Read<std::int32_t>(true);
  if (perPoint != 1)
  {
    throw FileError(
      "a curv file with " + std::to_string(perPoint) + " values per vertex; allowed: 1");
  }
  if (points < 0 || static_cast<std::size_t>(points) != content.Left() / 4)
  {
    throw FileError("the header announces " + std::to_string(points) + " values, the file holds " +
      std::to_string(content.Left() / 4));
  }
  FileArray array;
  array.Name = name;
  array.Numbers =
    ReadNumbers(content, static_cast<std::uint64_t>(points), NumberType::Float32, true);
  SurfaceFile file;
  file.Kind = "FreeSurfer curv";
  file.Arrays.push_back(std::move(array));
  return file;
}

bool IsMgh(Content content)
{
  return content.Left() >= 284 && content.Read<std::int32_t>(true) == 1;
}

SurfaceFile ReadMgh(Content content, const std::string& name)
{
  Content header = content;
  header.Take(4);
  std::array<std::int64_t, 4> sizes{};
  for (std::int64_t& size : sizes)
  {
    size = header.Read<std::int32_t>(true);
  }
  const auto type = header.Read<std::int32_t>(true);
  content.Take(284);
  constexpr std::pair<std::int32_t, NumberType> types[] = { { 0, NumberType::UInt8 },
    { 1, NumberType::Int32 }, { 3, NumberType::Float32 }, { 4, NumberType::Int16 } };
  const auto* const found = std::find_if(
    std::begin(types), std::end(types), [&](const auto& entry) { return entry.first == type; });
  const bool isLine = std::min({ sizes[0], sizes[1], sizes[2] }) >= 1 &&
    (sizes[1] == 1 || std::min(sizes[0], sizes[1]) == 1 || sizes[2] == 1);
  if (found == std::end(types) || !isLine || sizes[3] < 1)
  {
    throw FileError("a volume of " + std::to_string(sizes[0]) + " x " + std::to_string(sizes[1]) +
      " x " + std::to_string(sizes[2]) + " voxels; allowed: n x 1 x 1 values");
  }
  std::uint64_t count = 1;
  for (const std::int64_t size : sizes)
  {
    const std::uint64_t left = content.Left() / count;
    if (static_cast<std::uint64_t>(size) > left)
    {
      throw FileError("it ends too early");
    }
    count *= static_cast<std::uint64_t>(size);
  }
  const std::vector<double> numbers = ReadNumbers(content, count, found->second, true);
  FileArray array;
  array.Name = name;
  array.Components = static_cast<std::size_t>(sizes[3]);
  array.Numbers.resize(numbers.size());
  const std::size_t rows = numbers.size() / array.Components;
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    array.Numbers[i % rows * array.Components + i / rows] = numbers[i];
  }
  SurfaceFile file;
  file.Kind = "FreeSurfer mgh";
  file.Arrays.push_back(std::move(array));
  return file;
}

Bytes WriteFreeSurfer(const SurfaceFile& surface)
{
  Writer writer;
  writer.Text("\xff\xff\xfe"
              "created by surfacediffusion\n\n");
  writer.Binary(static_cast<std::int32_t>(surface.NumberOfPoints()), true);
  writer.Binary(static_cast<std::int32_t>(surface.NumberOfCells()), true);
  for (const double x : surface.Points)
  {
    writer.Binary(static_cast<float>(x), true);
  }
  for (const std::int64_t corner : surface.Corners)
  {
    writer.Binary(static_cast<std::int32_t>(corner), true);
  }
  return writer.Written;
}

} // namespace SurfaceDiffusion::Files
