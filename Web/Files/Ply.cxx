// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Files/Ply.h"

#include "Files/MeshText.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace SurfaceDiffusion::Files
{

namespace
{

struct Property
{
  std::string Name;
  NumberType Type = NumberType::Float32;
  std::optional<NumberType> Count = {}; ///< of lists
};

struct Element
{
  std::string Name;
  std::int64_t Count = 0;
  std::vector<Property> Properties;
};

struct Header
{
  bool IsText = false, IsBigEndian = false;
  std::vector<Element> Elements;
};

NumberType TypeOf(std::string_view word)
{
  constexpr std::pair<std::string_view, NumberType> types[] = { { "char", NumberType::Int8 },
    { "uchar", NumberType::UInt8 }, { "short", NumberType::Int16 },
    { "ushort", NumberType::UInt16 }, { "int", NumberType::Int32 }, { "uint", NumberType::UInt32 },
    { "float", NumberType::Float32 }, { "double", NumberType::Float64 },
    { "int8", NumberType::Int8 }, { "uint8", NumberType::UInt8 }, { "int16", NumberType::Int16 },
    { "uint16", NumberType::UInt16 }, { "int32", NumberType::Int32 },
    { "uint32", NumberType::UInt32 }, { "float32", NumberType::Float32 },
    { "float64", NumberType::Float64 } };
  for (const auto& [name, type] : types)
  {
    if (word == name)
    {
      return type;
    }
  }
  throw FileError(Quote(word) + " is no type; allowed: char to double");
}

Header ReadHeader(Content& content)
{
  Header header;
  bool hasFormat = false;
  std::string_view line;
  while (true)
  {
    if (!content.ReadLine(line))
    {
      throw FileError("the header has no end");
    }
    const std::vector<std::string_view> words = SplitWords(line);
    const auto is = [&](std::string_view key, std::size_t size)
    { return !words.empty() && words[0] == key && words.size() >= size; };
    if (is("end_header", 1))
    {
      break;
    }
    if (is("format", 2))
    {
      hasFormat = true;
      header.IsText = words[1] == "ascii";
      header.IsBigEndian = words[1] == "binary_big_endian";
      if (!header.IsText && !header.IsBigEndian && words[1] != "binary_little_endian")
      {
        throw FileError(Quote(words[1]) +
          " is no format; allowed: ascii, binary_little_endian, binary_big_endian");
      }
    }
    else if (is("element", 3))
    {
      header.Elements.push_back({ std::string(words[1]), ToInteger(words[2]), {} });
    }
    else if (is("property", 3))
    {
      if (header.Elements.empty())
      {
        throw FileError("a property stands before all elements");
      }
      Property property{ std::string(words.back()) };
      const bool isList = words[1] == "list";
      if (words.size() != (isList ? 5U : 3U))
      {
        throw FileError(Quote(line) + "; allowed: property, its type and name");
      }
      property.Type = TypeOf(words[isList ? 3 : 1]);
      if (isList)
      {
        property.Count = TypeOf(words[2]);
      }
      header.Elements.back().Properties.push_back(std::move(property));
    }
  }
  if (!hasFormat)
  {
    throw FileError("the header does not say the format");
  }
  return header;
}

/// The numbers of the rows of elements, one after another.
class Numbers
{
public:
  Numbers(Content content, const Header& header)
    : Bytes(content)
    , IsText(header.IsText)
    , IsBigEndian(header.IsBigEndian)
  {
  }

  double Next(NumberType type)
  {
    if (!this->IsText)
    {
      return ReadNumber(this->Bytes.Take(SizeOf(type)), type, this->IsBigEndian);
    }
    const std::string_view word = this->Bytes.ReadWord();
    if (word.empty())
    {
      throw FileError("it ends too early");
    }
    const double number = ToNumber(word);
    return type == NumberType::Float32 ? static_cast<double>(static_cast<float>(number)) : number;
  }
  const Content& Left() const { return this->Bytes; }

private:
  Content Bytes;
  bool IsText, IsBigEndian;
};

/// Triangles of one orientation; -1 starts a new strip.
void AddStrip(const std::vector<std::int64_t>& strip, SurfaceFile& file)
{
  bool flip = false;
  std::vector<std::int64_t> row;
  for (const std::int64_t vertex : strip)
  {
    if (vertex == -1)
    {
      row.clear();
    }
    else
    {
      row.push_back(vertex);
    }
    if (row.size() > 3)
    {
      row.erase(row.begin());
    }
    flip = row.size() == 3 && !flip;
    if (row.size() == 3 && row[0] != row[1] && row[1] != row[2] && row[0] != row[2])
    {
      file.AddCell(flip ? row : std::vector<std::int64_t>{ row[1], row[0], row[2] });
    }
  }
}

/// Columns that belong together become an array: normals, and colours.
void AddColumns(const Element& element, std::vector<std::vector<double>>& columns, bool onCells,
  SurfaceFile& file)
{
  const auto find = [&](std::string_view name)
  {
    const auto found = std::find_if(element.Properties.begin(), element.Properties.end(),
      [&](const Property& property) { return property.Name == name && !property.Count; });
    return static_cast<std::size_t>(found - element.Properties.begin());
  };
  std::vector<char> used(columns.size(), 0);
  const auto join = [&](const char* name, const std::vector<std::string_view>& parts)
  {
    FileArray array{ name, onCells, parts.size() };
    std::vector<std::size_t> places;
    for (const std::string_view part : parts)
    {
      places.push_back(find(part));
      if (places.back() == columns.size() || used[places.back()])
      {
        return;
      }
    }
    const std::size_t rows = columns[places[0]].size();
    for (std::size_t i = 0; i < rows; ++i)
    {
      for (const std::size_t place : places)
      {
        array.Numbers.push_back(columns[place][i]);
      }
    }
    array.AreBytes = element.Properties[places[0]].Type == NumberType::UInt8;
    for (const std::size_t place : places)
    {
      used[place] = 1;
    }
    if (std::string_view(name) == "Points")
    {
      file.Points = std::move(array.Numbers);
      return;
    }
    file.Arrays.push_back(std::move(array));
  };
  if (!onCells)
  {
    join("Points", { "x", "y", "z" });
  }
  join("Normals", { "nx", "ny", "nz" });
  join("RGBA", { "red", "green", "blue", "alpha" });
  join("RGB", { "red", "green", "blue" });
  for (std::size_t p = 0; p < columns.size(); ++p)
  {
    if (!used[p] && !element.Properties[p].Count)
    {
      FileArray array{ element.Properties[p].Name, onCells };
      array.Numbers = std::move(columns[p]);
      array.AreBytes = element.Properties[p].Type == NumberType::UInt8;
      file.Arrays.push_back(std::move(array));
    }
  }
}

} // namespace

SurfaceFile ReadPly(Content content)
{
  const Header header = ReadHeader(content);
  Numbers numbers(content, header);
  SurfaceFile file;
  file.Kind = "PLY";
  std::vector<std::vector<std::int64_t>> strips;
  for (const Element& element : header.Elements)
  {
    const bool areVertices = element.Name == "vertex";
    const bool areFaces = element.Name == "face";
    // A row has at least a byte for each property, in text a digit and a space but for the last one.
    const std::size_t rows = element.Properties.empty()
      ? 0
      : CheckCount(element.Count, element.Properties.size(), numbers.Left(), "rows");
    std::vector<std::vector<double>> columns(element.Properties.size());
    std::vector<std::int64_t> corners;
    for (std::size_t i = 0; i < rows; ++i)
    {
      for (std::size_t p = 0; p < columns.size(); ++p)
      {
        const Property& property = element.Properties[p];
        if (!property.Count)
        {
          const double number = numbers.Next(property.Type);
          if (areVertices || areFaces)
          {
            columns[p].push_back(number);
          }
          continue;
        }
        const double count = numbers.Next(*property.Count);
        if (!(count >= 0.0 && count <= static_cast<double>(numbers.Left().Left())))
        {
          throw FileError("the file ends within the element " + Quote(element.Name));
        }
        corners.clear();
        for (double k = 0.0; k < count; ++k)
        {
          const double corner = numbers.Next(property.Type);
          corners.push_back(std::abs(corner) < 1e15 ? static_cast<std::int64_t>(corner) : -2);
        }
        if (property.Name == "vertex_indices" || property.Name == "vertex_index")
        {
          if (areFaces)
          {
            file.AddCell(corners);
          }
          else if (element.Name == "tristrips")
          {
            strips.push_back(corners);
          }
        }
      }
    }
    if (areVertices || areFaces)
    {
      AddColumns(element, columns, areFaces, file);
    }
  }
  for (const std::vector<std::int64_t>& strip : strips)
  {
    AddStrip(strip, file);
  }
  if (!strips.empty())
  {
    file.Arrays.erase(std::remove_if(file.Arrays.begin(), file.Arrays.end(),
                        [](const FileArray& array) { return array.OnCells; }),
      file.Arrays.end());
  }
  if (file.Points.empty())
  {
    throw FileError("the vertices have no properties x, y and z");
  }
  return file;
}

Bytes WritePly(const SurfaceFile& surface)
{
  Writer writer;
  const FileArray* const colors = FindColors(surface);
  std::vector<const FileArray*> arrays;
  writer.Text("ply\nformat binary_little_endian 1.0\nelement vertex " +
    std::to_string(surface.NumberOfPoints()) +
    "\nproperty double x\nproperty double y\nproperty double z\n");
  for (const FileArray& array : surface.Arrays)
  {
    if (array.OnCells || &array == colors || array.Rows() != surface.NumberOfPoints())
    {
      continue;
    }
    arrays.push_back(&array);
    std::string name;
    for (const char c : array.Name.empty() ? std::string("value") : array.Name)
    {
      name += static_cast<unsigned char>(c) <= 32 ? '_' : c; // which ends a name in the header
    }
    for (std::size_t k = 0; k < array.Components; ++k)
    {
      writer.Text("property double " + name +
        (array.Components > 1 ? "_" + std::to_string(k) : std::string()) + "\n");
    }
  }
  if (colors)
  {
    writer.Text("property uchar red\nproperty uchar green\nproperty uchar blue\n");
  }
  writer.Text("element face " + std::to_string(surface.NumberOfCells()) +
    "\nproperty list int int vertex_indices\nend_header\n");
  for (std::size_t i = 0; i < surface.NumberOfPoints(); ++i)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      writer.Binary(surface.Points[3 * i + k]);
    }
    for (const FileArray* const array : arrays)
    {
      for (std::size_t k = 0; k < array->Components; ++k)
      {
        writer.Binary(array->Numbers[array->Components * i + k]);
      }
    }
    for (std::size_t k = 0; colors && k < 3; ++k)
    {
      writer.Binary(static_cast<std::uint8_t>(
        std::clamp(std::round(colors->Numbers[colors->Components * i + k]), 0.0, 255.0)));
    }
  }
  for (std::size_t c = 0; c < surface.NumberOfCells(); ++c)
  {
    writer.Binary(static_cast<std::int32_t>(surface.Begin[c + 1] - surface.Begin[c]));
    for (std::size_t k = surface.Begin[c]; k < surface.Begin[c + 1]; ++k)
    {
      writer.Binary(static_cast<std::int32_t>(surface.Corners[k]));
    }
  }
  return writer.Written;
}

} // namespace SurfaceDiffusion::Files
