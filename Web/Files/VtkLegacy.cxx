// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Files/VtkLegacy.h"

#include "Files/VtkMesh.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>

namespace SurfaceDiffusion::Files
{

namespace
{

/// Names have signs as %20.
std::string DecodeName(std::string_view text)
{
  std::string name;
  for (std::size_t i = 0; i < text.size(); ++i)
  {
    const auto isDigit = [&](std::size_t k)
    { return k < text.size() && std::isxdigit(static_cast<unsigned char>(text[k])) != 0; };
    if (text[i] == '%' && isDigit(i + 1) && isDigit(i + 2))
    {
      name +=
        static_cast<char>(std::strtol(std::string(text.substr(i + 1, 2)).c_str(), nullptr, 16));
      i += 2;
      continue;
    }
    name += text[i];
  }
  return name;
}

std::string EncodeName(std::string_view name)
{
  std::string text;
  for (const char c : name)
  {
    if (static_cast<unsigned char>(c) <= 32 || c == '%' || c == '"')
    {
      char code[8];
      std::snprintf(code, sizeof(code), "%%%02X", static_cast<unsigned char>(c));
      text += code;
      continue;
    }
    text += c;
  }
  return text.empty() ? "values" : text;
}

class Reader
{
public:
  explicit Reader(Content content)
    : Bytes(content)
  {
  }

  SurfaceFile Read()
  {
    this->ReadHeader();
    bool hasData = false; // attributes follow the geometry
    for (std::string word = this->Word(); !word.empty(); word = this->Word())
    {
      if (word == "point_data" || word == "cell_data")
      {
        this->OnCells = word == "cell_data";
        hasData = true;
        const std::size_t count = this->Count();
        const std::size_t expected =
          this->OnCells ? this->Mesh.CountCells() : this->Mesh.Surface.NumberOfPoints();
        if (count != expected)
        {
          throw FileError(Quote(word) + " of " + std::to_string(count) +
            "; allowed: " + std::to_string(expected));
        }
        this->Tuples = count;
      }
      else if (word == "field")
      {
        this->ReadField(hasData);
      }
      else if (word == "metadata")
      {
        this->SkipMetadata();
      }
      else if (hasData)
      {
        this->ReadAttribute(word);
      }
      else if (word == "points")
      {
        const std::size_t count = this->Count();
        this->Mesh.Surface.Points = this->Numbers(3 * std::uint64_t{ count }, this->Word());
      }
      else
      {
        this->ReadCells(word);
      }
    }
    return std::move(this->Mesh.Surface);
  }

private:
  void ReadHeader()
  {
    std::string_view line;
    this->Bytes.ReadLine(line);
    const std::size_t at = line.find("Version ");
    this->HasOffsets = at != std::string_view::npos && line.size() > at + 8 && line[at + 8] >= '5';
    this->Bytes.ReadLine(line);
    const std::string form = this->Word();
    this->IsText = form == "ascii";
    const bool isDataset = this->Word() == "dataset";
    this->Type = this->Word();
    if ((!this->IsText && form != "binary") || !isDataset)
    {
      throw FileError("it does not start with a version, a title, ASCII or BINARY, and DATASET");
    }
    if (this->Type != "polydata" && this->Type != "unstructured_grid")
    {
      throw FileError("DATASET " + Quote(this->Type) + "; allowed: POLYDATA, UNSTRUCTURED_GRID");
    }
    this->Mesh.Surface.Kind = "VTK legacy";
  }

  std::string Word() { return LowerCase(this->Bytes.ReadWord().substr(0, 255)); }

  std::size_t Count()
  {
    const std::int64_t count = ToInteger(this->Bytes.ReadWord());
    return CheckCount(count, 1, this->Bytes, "numbers");
  }

  std::vector<double> Numbers(std::uint64_t count, const std::string& type)
  {
    if (this->IsText)
    {
      if (count > this->Bytes.Left())
      {
        throw FileError(std::to_string(count) + " numbers are announced, but only " +
          std::to_string(this->Bytes.Left()) + " bytes follow");
      }
      std::vector<double> numbers;
      for (std::uint64_t i = 0; i < count; ++i)
      {
        const std::string_view word = this->Bytes.ReadWord();
        const double number = ToNumber(word);
        numbers.push_back(
          type == "float" ? static_cast<double>(static_cast<float>(number)) : number);
      }
      return numbers;
    }
    std::string_view line;
    this->Bytes.ReadLine(line);
    if (type == "bit")
    {
      std::vector<double> numbers;
      const std::uint8_t* const bits = this->Bytes.Take(count / 8 + (count % 8 != 0 ? 1 : 0));
      for (std::uint64_t i = 0; i < count; ++i)
      {
        numbers.push_back(bits[i / 8] >> (7 - i % 8) & 1);
      }
      return numbers;
    }
    return ReadNumbers(this->Bytes, count, TypeOf(type), true);
  }

  static NumberType TypeOf(const std::string& word)
  {
    constexpr std::pair<const char*, NumberType> types[] = { { "char", NumberType::Int8 },
      { "signed_char", NumberType::Int8 }, { "unsigned_char", NumberType::UInt8 },
      { "short", NumberType::Int16 }, { "unsigned_short", NumberType::UInt16 },
      { "int", NumberType::Int32 }, { "unsigned_int", NumberType::UInt32 },
      { "long", NumberType::Int64 }, { "unsigned_long", NumberType::UInt64 },
      { "long_long", NumberType::Int64 }, { "vtktypeint64", NumberType::Int64 },
      { "vtktypeuint64", NumberType::UInt64 }, { "vtktypeint32", NumberType::Int32 },
      { "vtkidtype", NumberType::Int32 }, { "float", NumberType::Float32 },
      { "double", NumberType::Float64 } };
    for (const auto& [name, type] : types)
    {
      if (word == name)
      {
        return type;
      }
    }
    throw FileError(Quote(word) + " is no type of numbers");
  }

  void ReadCells(const std::string& word)
  {
    const bool isGrid = this->Type == "unstructured_grid";
    if (isGrid && word == "cell_types")
    {
      const std::vector<double> types = this->Numbers(this->Count(), "int");
      std::size_t c = 0;
      if (types.size() + 1 != this->Offsets.size())
      {
        throw FileError("there are types of " + std::to_string(types.size()) + " cells and " +
          std::to_string(this->Offsets.empty() ? 0 : this->Offsets.size() - 1) + " cells");
      }
      VtkMesh::VisitCells(this->Offsets, this->Corners,
        [&](const std::vector<std::int64_t>& corners)
        {
          const double type = types[c++];
          this->Mesh.AddCellOfType(
            type >= 0.0 && type < 256.0 ? static_cast<int>(type) : 255, corners);
        });
      return;
    }
    const bool isThin = word == "vertices" || word == "lines";
    if (isGrid ? word != "cells" : !isThin && word != "polygons" && word != "triangle_strips")
    {
      throw FileError(Quote(word) + " is no word of DATASET " + Quote(this->Type));
    }
    const std::size_t count = this->Count();
    const std::size_t size = this->Count();
    if (this->HasOffsets)
    {
      this->Expect("offsets");
      this->Offsets = this->Numbers(count, this->Word());
      this->Expect("connectivity");
      this->Corners = this->Numbers(size, this->Word());
    }
    else
    {
      const std::vector<double> numbers = this->Numbers(size, "int");
      this->Offsets = { 0.0 };
      this->Corners.clear();
      std::size_t at = 0;
      for (std::size_t c = 0; c < count; ++c)
      {
        const double corners = at < numbers.size() ? numbers[at] : -1.0;
        if (!(corners >= 0.0 && corners < static_cast<double>(numbers.size() - at)))
        {
          throw FileError("a cell has more corners than its list");
        }
        const auto first = numbers.begin() + static_cast<std::ptrdiff_t>(at) + 1;
        this->Corners.insert(
          this->Corners.end(), first, first + static_cast<std::ptrdiff_t>(corners));
        this->Offsets.push_back(static_cast<double>(this->Corners.size()));
        at += static_cast<std::size_t>(corners) + 1;
      }
    }
    if (isThin)
    {
      this->Mesh.SkipCells(this->Offsets.empty() ? 0 : this->Offsets.size() - 1);
    }
    else if (!isGrid)
    {
      VtkMesh::VisitCells(this->Offsets, this->Corners,
        [&](const std::vector<std::int64_t>& corners)
        {
          if (word == "polygons")
          {
            this->Mesh.AddPolygon(corners);
          }
          else
          {
            this->Mesh.AddStrip(corners);
          }
        });
    }
  }

  void Expect(const char* word)
  {
    const std::string found = this->Word();
    if (found != word)
    {
      throw FileError(Quote(found) + " stands in place of " + word);
    }
  }

  void Add(
    std::string_view name, std::size_t components, const std::string& type, bool isKept = true)
  {
    FileArray array{ DecodeName(name), this->OnCells, components };
    array.Numbers = this->Numbers(std::uint64_t{ components } * this->Tuples, type);
    array.AreBytes = type == "unsigned_char";
    if (isKept)
    {
      this->Mesh.AddArray(std::move(array));
    }
  }

  void ReadAttribute(const std::string& word)
  {
    constexpr std::pair<const char*, std::size_t> sizes[] = { { "vectors", 3 }, { "normals", 3 },
      { "tensors", 9 }, { "tensors6", 6 }, { "global_ids", 1 }, { "pedigree_ids", 1 },
      { "edge_flags", 1 } };
    const std::string_view name = this->Bytes.ReadWord();
    for (const auto& [attribute, components] : sizes)
    {
      if (word == attribute)
      {
        this->Add(name, components, this->Word());
        return;
      }
    }
    if (word == "scalars")
    {
      const std::string type = this->Word();
      // The number of components is left out if it is one.
      std::string_view line;
      this->Bytes.ReadLine(line);
      const std::vector<std::string_view> words = SplitWords(line);
      const std::size_t components = words.empty() ? 1 : this->Components(words[0]);
      this->Expect("lookup_table");
      this->Bytes.ReadWord();
      this->Add(name, components, type);
    }
    else if (word == "color_scalars")
    {
      const std::size_t components = this->Components(this->Bytes.ReadWord());
      this->Add(name, components, this->IsText ? "float" : "unsigned_char");
      FileArray& array = this->Mesh.Surface.Arrays.back();
      for (double& number : array.Numbers)
      {
        number = this->IsText
          ? static_cast<double>(static_cast<int>(255.0 * std::clamp(number, 0.0, 1.0) + 0.5))
          : number;
      }
      array.AreBytes = true;
    }
    else if (word == "texture_coordinates")
    {
      const std::size_t components = this->Components(this->Bytes.ReadWord());
      this->Add(name, components, this->Word());
    }
    else if (word == "lookup_table")
    {
      const std::size_t size = this->Count();
      this->Numbers(4 * std::uint64_t{ size }, this->IsText ? "float" : "unsigned_char");
    }
    else
    {
      throw FileError(Quote(word) + " is no attribute of a surface");
    }
  }

  std::size_t Components(std::string_view word)
  {
    const std::int64_t components = ToInteger(word);
    if (components < 1 || components > 1000)
    {
      throw FileError("an array has " + std::to_string(components) + " components");
    }
    return static_cast<std::size_t>(components);
  }

  void ReadField(bool hasData)
  {
    this->Bytes.ReadWord(); // its name
    const std::size_t count = this->Count();
    for (std::size_t k = 0; k < count; ++k)
    {
      std::string name(this->Bytes.ReadWord());
      if (LowerCase(name) == "metadata")
      {
        this->SkipMetadata();
        name = this->Bytes.ReadWord();
      }
      const std::size_t components = this->Components(this->Bytes.ReadWord());
      const std::size_t tuples = this->Count();
      const std::string type = this->Word();
      if (type == "string")
      {
        this->SkipStrings(components * tuples);
        continue;
      }
      FileArray array{ DecodeName(name), this->OnCells, components };
      array.Numbers = this->Numbers(std::uint64_t{ components } * tuples, type);
      array.AreBytes = type == "unsigned_char";
      if (hasData)
      {
        this->Mesh.AddArray(std::move(array));
      }
    }
  }

  void SkipStrings(std::size_t count)
  {
    std::string_view line;
    this->Bytes.ReadLine(line);
    for (std::size_t k = 0; k < count; ++k)
    {
      if (this->IsText)
      {
        if (!this->Bytes.ReadLine(line))
        {
          throw FileError("it ends too early");
        }
        continue;
      }
      // The length has one to eight bytes, as its first bits say.
      Content ahead = this->Bytes;
      const int first = *ahead.Take(1);
      std::uint64_t length = 0;
      const int bytes = first >= 0xc0 ? 1 : (first >= 0x80 ? 2 : (first >= 0x40 ? 4 : 8));
      const std::uint8_t* const from = this->Bytes.Take(static_cast<std::uint64_t>(bytes));
      for (int b = 0; b < bytes; ++b)
      {
        length = length << 8 | (b == 0 ? from[b] & 0x3fU : from[b]);
      }
      this->Bytes.Take(length);
    }
  }

  /// To the empty line.
  void SkipMetadata()
  {
    std::string_view line;
    this->Bytes.ReadLine(line);
    while (this->Bytes.ReadLine(line) && !SplitWords(line).empty())
    {
    }
  }

  Content Bytes;
  VtkMesh Mesh;
  std::string Type;
  bool IsText = true, HasOffsets = false, OnCells = false;
  std::size_t Tuples = 0;
  std::vector<double> Offsets, Corners; ///< of the last cells
};

} // namespace

SurfaceFile ReadVtkLegacy(Content content)
{
  return Reader(content).Read();
}

Bytes WriteVtkLegacy(const SurfaceFile& surface)
{
  Writer writer;
  writer.Text("# vtk DataFile Version 3.0\nsurface\nBINARY\nDATASET POLYDATA\nPOINTS " +
    std::to_string(surface.NumberOfPoints()) + " double\n");
  for (const double x : surface.Points)
  {
    writer.Binary(x, true);
  }
  writer.Text("\nPOLYGONS " + std::to_string(surface.NumberOfCells()) + " " +
    std::to_string(surface.Corners.size() + surface.NumberOfCells()) + "\n");
  for (std::size_t c = 0; c < surface.NumberOfCells(); ++c)
  {
    writer.Binary(static_cast<std::int32_t>(surface.Begin[c + 1] - surface.Begin[c]), true);
    for (std::size_t k = surface.Begin[c]; k < surface.Begin[c + 1]; ++k)
    {
      writer.Binary(static_cast<std::int32_t>(surface.Corners[k]), true);
    }
  }
  writer.Text("\n");
  for (const bool onCells : { false, true })
  {
    const auto isThere = [&](const FileArray& array) { return array.OnCells == onCells; };
    const auto count = std::count_if(surface.Arrays.begin(), surface.Arrays.end(), isThere);
    if (count == 0)
    {
      continue;
    }
    writer.Text((onCells ? "CELL_DATA " : "POINT_DATA ") +
      std::to_string(onCells ? surface.NumberOfCells() : surface.NumberOfPoints()) +
      "\nFIELD FieldData " + std::to_string(count) + "\n");
    for (const FileArray& array : surface.Arrays)
    {
      if (!isThere(array))
      {
        continue;
      }
      writer.Text(EncodeName(array.Name) + " " + std::to_string(array.Components) + " " +
        std::to_string(array.Rows()) + (array.AreBytes ? " unsigned_char\n" : " double\n"));
      for (const double number : array.Numbers)
      {
        if (array.AreBytes)
        {
          writer.Binary(static_cast<std::uint8_t>(std::clamp(number, 0.0, 255.0)));
        }
        else
        {
          writer.Binary(number, true);
        }
      }
      writer.Text("\n");
    }
  }
  return writer.Written;
}

} // namespace SurfaceDiffusion::Files
