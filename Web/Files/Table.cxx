// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Files/Table.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace SurfaceDiffusion::Files
{

namespace
{

std::vector<std::string_view> CellsOf(std::string_view line)
{
  line = line.substr(0, line.find('#'));
  if (line.substr(0, 3) == "\xef\xbb\xbf")
  {
    line.remove_prefix(3);
  }
  const char separator = line.find(';') != std::string_view::npos
    ? ';'
    : (line.find(',') != std::string_view::npos ? ',' : ' ');
  if (separator == ' ')
  {
    return SplitWords(line);
  }
  std::vector<std::string_view> cells;
  while (true)
  {
    const std::size_t end = line.find(separator);
    std::string_view cell = line.substr(0, end);
    const std::size_t first = cell.find_first_not_of(" \t\"");
    const std::size_t last = cell.find_last_not_of(" \t\"");
    cells.push_back(
      first == std::string_view::npos ? std::string_view() : cell.substr(first, last + 1 - first));
    if (end == std::string_view::npos)
    {
      return cells;
    }
    line.remove_prefix(end + 1);
  }
}

bool AreNumbers(const std::vector<std::string_view>& cells)
{
  return std::all_of(cells.begin(), cells.end(),
    [](std::string_view cell)
    {
      try
      {
        return cell.empty() || (ToNumber(cell), true);
      }
      catch (const FileError&)
      {
        return false;
      }
    });
}

bool IsBlank(const std::vector<std::string_view>& cells)
{
  return std::all_of(
    cells.begin(), cells.end(), [](std::string_view cell) { return cell.empty(); });
}

} // namespace

bool IsTable(const Content& content)
{
  if (content.Text().substr(0, 4096).find('\0') != std::string_view::npos)
  {
    return false;
  }
  Content lines = content;
  std::string_view line;
  for (int k = 0; k < 20 && lines.ReadLine(line); ++k)
  {
    const std::vector<std::string_view> cells = CellsOf(line);
    if (!IsBlank(cells) && AreNumbers(cells))
    {
      return true;
    }
  }
  return false;
}

SurfaceFile ReadTable(Content content, const std::string& name)
{
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;
  std::string_view line;
  std::size_t number = 0;
  while (content.ReadLine(line))
  {
    ++number;
    const std::vector<std::string_view> cells = CellsOf(line);
    if (IsBlank(cells))
    {
      continue;
    }
    if (columns.empty() && !AreNumbers(cells))
    {
      names.assign(cells.begin(), cells.end());
      continue;
    }
    columns.resize(columns.empty() ? cells.size() : columns.size());
    if (cells.size() != columns.size())
    {
      throw FileError("line " + std::to_string(number) + " has " + std::to_string(cells.size()) +
        " numbers; allowed: " + std::to_string(columns.size()) + " as in the line before");
    }
    for (std::size_t k = 0; k < cells.size(); ++k)
    {
      columns[k].push_back(
        cells[k].empty() ? std::numeric_limits<double>::quiet_NaN() : ToNumber(cells[k]));
    }
  }
  if (columns.empty())
  {
    throw FileError("it has no line of numbers");
  }
  if (names.size() != columns.size())
  {
    names.clear();
    // Without names, three columns before others are coordinates.
    for (std::size_t k = 0; k < columns.size(); ++k)
    {
      const char* const axes[] = { "x", "y", "z" };
      names.push_back(columns.size() > 3 && k < 3
          ? axes[k]
          : (columns.size() == 1 ? name : name + " " + std::to_string(k + 1)));
    }
  }
  SurfaceFile file;
  file.Kind = "CSV";
  std::vector<std::size_t> axes;
  for (const char* const axis : { "x", "y", "z" })
  {
    const auto found = std::find_if(names.begin(), names.end(),
      [&](const std::string& given) { return LowerCase(given) == axis; });
    if (found != names.end())
    {
      axes.push_back(static_cast<std::size_t>(found - names.begin()));
    }
  }
  if (axes.size() == 3)
  {
    for (std::size_t i = 0; i < columns[0].size(); ++i)
    {
      for (const std::size_t axis : axes)
      {
        file.Points.push_back(columns[axis][i]);
      }
    }
  }
  for (std::size_t k = 0; k < columns.size(); ++k)
  {
    if (axes.size() < 3 || std::find(axes.begin(), axes.end(), k) == axes.end())
    {
      FileArray array;
      array.Name = names[k];
      array.Numbers = std::move(columns[k]);
      file.Arrays.push_back(std::move(array));
    }
  }
  return file;
}

Bytes WriteTable(const SurfaceFile& surface)
{
  Writer writer;
  writer.Text("x,y,z");
  std::vector<const FileArray*> arrays;
  for (const FileArray& array : surface.Arrays)
  {
    if (array.OnCells)
    {
      continue;
    }
    arrays.push_back(&array);
    std::string name = array.Name;
    std::replace_if(
      name.begin(), name.end(), [](char c) { return c == ',' || c == '"' || c == '\n'; }, ' ');
    for (std::size_t k = 0; k < array.Components; ++k)
    {
      writer.Text("," + name + (array.Components > 1 ? "_" + std::to_string(k) : std::string()));
    }
  }
  writer.Text("\n");
  for (std::size_t i = 0; i < surface.NumberOfPoints(); ++i)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      writer.Text(k > 0 ? "," : "");
      writer.Number(surface.Points[3 * i + k]);
    }
    for (const FileArray* const array : arrays)
    {
      for (std::size_t k = 0; k < array->Components; ++k)
      {
        writer.Text(",");
        writer.Number(array->Numbers[array->Components * i + k]);
      }
    }
    writer.Text("\n");
  }
  return writer.Written;
}

} // namespace SurfaceDiffusion::Files
