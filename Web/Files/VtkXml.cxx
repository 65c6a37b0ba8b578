// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Files/VtkXml.h"

#include "Files/Inflate.h"
#include "Files/VtkMesh.h"
#include "Files/Xml.h"

#include <algorithm>
#include <utility>

namespace SurfaceDiffusion::Files
{

namespace
{

/// An array as it is described, before its numbers are read.
struct Described
{
  std::string Parent; ///< Points, PointData, CellData, Polys, ...
  std::string Name, Type, Format;
  std::size_t Components = 1;
  std::uint64_t Offset = 0; ///< in the appended data
  std::string_view Text;
};

struct Piece
{
  std::size_t Points = 0;
  std::vector<Described> Arrays;
};

std::uint64_t ToCount(const std::string& text, std::uint64_t otherwise)
{
  if (text.empty())
  {
    return otherwise;
  }
  const std::int64_t count = ToInteger(SplitWords(text).empty() ? text : SplitWords(text)[0]);
  if (count < 0)
  {
    throw FileError(Quote(text) + " is no count");
  }
  return static_cast<std::uint64_t>(count);
}

NumberType TypeOf(const std::string& word)
{
  constexpr std::pair<const char*, NumberType> types[] = { { "Int8", NumberType::Int8 },
    { "UInt8", NumberType::UInt8 }, { "Int16", NumberType::Int16 },
    { "UInt16", NumberType::UInt16 }, { "Int32", NumberType::Int32 },
    { "UInt32", NumberType::UInt32 }, { "Int64", NumberType::Int64 },
    { "UInt64", NumberType::UInt64 }, { "Float32", NumberType::Float32 },
    { "Float64", NumberType::Float64 } };
  for (const auto& [name, type] : types)
  {
    if (word == name)
    {
      return type;
    }
  }
  throw FileError(Quote(word) + " is no type of numbers");
}

class Reader
{
public:
  explicit Reader(Content content)
    : All(content.Text())
  {
  }

  SurfaceFile Read()
  {
    this->ReadStructure();
    SurfaceFile all;
    for (const Piece& piece : this->Pieces)
    {
      Append(all, this->ReadPiece(piece));
    }
    all.Kind = this->IsGrid ? "VTK XML grid" : "VTK XML";
    if (this->Pieces.size() > 1)
    {
      all.Warnings.push_back("the file has " + std::to_string(this->Pieces.size()) +
        " pieces, whose points stay apart; MergeCoincidentPoints joins those at one place");
    }
    return all;
  }

private:
  SurfaceFile ReadPiece(const Piece& piece) const
  {
    VtkMesh mesh;
    for (const Described& array : piece.Arrays)
    {
      if (array.Parent == "Points")
      {
        mesh.Surface.Points = this->Numbers(array);
        if (mesh.Surface.NumberOfPoints() != piece.Points || mesh.Surface.Points.size() % 3 != 0)
        {
          throw FileError("it announces " + std::to_string(piece.Points) + " points and has " +
            std::to_string(mesh.Surface.Points.size()) + " coordinates");
        }
      }
    }
    if (this->IsGrid)
    {
      this->AddGrid(piece, mesh);
    }
    else
    {
      for (const char* const cells : { "Verts", "Lines", "Polys", "Strips" })
      {
        this->AddCells(piece, cells, mesh);
      }
    }
    for (const Described& array : piece.Arrays)
    {
      const bool onCells = array.Parent == "CellData";
      if ((onCells || array.Parent == "PointData") && array.Type != "String" && array.Type != "Bit")
      {
        FileArray read{ array.Name, onCells, array.Components };
        read.Numbers = this->Numbers(array);
        read.AreBytes = array.Type == "UInt8";
        mesh.AddArray(std::move(read));
      }
    }
    return std::move(mesh.Surface);
  }

  /// Arrays that not all pieces have become too short, and are left out later.
  static void Append(SurfaceFile& all, SurfaceFile piece)
  {
    RequireCorners(piece);
    if (all.Points.empty() && all.Arrays.empty())
    {
      all = std::move(piece);
      return;
    }
    const auto points = static_cast<std::int64_t>(all.NumberOfPoints());
    for (const std::int64_t corner : piece.Corners)
    {
      all.Corners.push_back(corner + points);
    }
    const std::size_t corners = all.Begin.back();
    for (std::size_t c = 1; c < piece.Begin.size(); ++c)
    {
      all.Begin.push_back(corners + piece.Begin[c]);
    }
    all.Points.insert(all.Points.end(), piece.Points.begin(), piece.Points.end());
    for (FileArray& array : piece.Arrays)
    {
      const auto known = std::find_if(all.Arrays.begin(), all.Arrays.end(),
        [&array](const FileArray& other)
        {
          return other.Name == array.Name && other.OnCells == array.OnCells &&
            other.Components == array.Components;
        });
      if (known == all.Arrays.end())
      {
        all.Arrays.push_back(std::move(array));
      }
      else
      {
        known->Numbers.insert(known->Numbers.end(), array.Numbers.begin(), array.Numbers.end());
      }
    }
  }

  void ReadStructure()
  {
    XmlReader xml(this->All);
    std::vector<std::string> parents;
    Described* open = nullptr;
    while (xml.Next())
    {
      // Before or after the numbers of an array may be elements that describe it.
      if (open && open->Text.find_first_not_of(" \t\r\n") == std::string_view::npos)
      {
        open->Text = xml.Text();
      }
      if (xml.IsEnd())
      {
        open = xml.Name() == "DataArray" ? nullptr : open;
        if (!parents.empty())
        {
          parents.pop_back();
        }
        continue;
      }
      const std::string name(xml.Name());
      if (parents.empty() && name != "VTKFile")
      {
        throw FileError("it is no file of VTK");
      }
      if (name == "VTKFile")
      {
        this->ReadRoot(xml);
      }
      else if (name == "Piece")
      {
        this->Pieces.push_back(
          { static_cast<std::size_t>(ToCount(xml.Attribute("NumberOfPoints"), 0)), {} });
      }
      else if (name == "AppendedData")
      {
        this->IsRaw = xml.Attribute("encoding") != "base64";
        const std::string_view rest = xml.Rest();
        this->Appended = rest.substr(std::min(rest.find('_'), rest.size() - 1) + 1);
        return; // raw bytes are no XML
      }
      else if ((name == "DataArray" || name == "Array") && !this->Pieces.empty())
      {
        std::vector<Described>& arrays = this->Pieces.back().Arrays;
        Described array;
        array.Parent = parents.back();
        array.Name = xml.Attribute("Name");
        array.Type = name == "Array" ? "String" : xml.Attribute("type");
        array.Format = xml.Attribute("format");
        array.Components = static_cast<std::size_t>(
          std::clamp<std::uint64_t>(ToCount(xml.Attribute("NumberOfComponents"), 1), 1, 100000));
        array.Offset = ToCount(xml.Attribute("offset"), 0);
        arrays.push_back(std::move(array));
        open = &arrays.back();
      }
      parents.push_back(name);
      if (parents.size() > 100)
      {
        throw FileError("its elements are nested more than 100 times");
      }
    }
  }

  void ReadRoot(const XmlReader& xml)
  {
    const std::string type = xml.Attribute("type");
    this->IsGrid = type == "UnstructuredGrid";
    if (!this->IsGrid && type != "PolyData")
    {
      throw FileError("a VTK XML file of " + Quote(type) + "; allowed: PolyData, UnstructuredGrid");
    }
    this->IsBigEndian = xml.Attribute("byte_order") == "BigEndian";
    this->SizeType =
      xml.Attribute("header_type") == "UInt64" ? NumberType::UInt64 : NumberType::UInt32;
    const std::string compressor = xml.Attribute("compressor");
    this->IsCompressed = !compressor.empty();
    if (this->IsCompressed && compressor != "vtkZLibDataCompressor")
    {
      throw FileError("it is compressed by " + Quote(compressor) +
        "; allowed: none and vtkZLibDataCompressor, in which ParaView's dialogue saves it, too");
    }
  }

  const Described* Find(const Piece& piece, const std::string& parent, const char* name) const
  {
    for (const Described& array : piece.Arrays)
    {
      if (array.Parent == parent && array.Name == name)
      {
        return &array;
      }
    }
    return nullptr;
  }

  /// The offsets of cells with a zero before them, and their corners.
  std::pair<std::vector<double>, std::vector<double>> ReadCells(
    const Piece& piece, const std::string& parent) const
  {
    const Described* const offsets = this->Find(piece, parent, "offsets");
    const Described* const corners = this->Find(piece, parent, "connectivity");
    if (!offsets || !corners)
    {
      return {};
    }
    std::vector<double> begin = this->Numbers(*offsets);
    begin.insert(begin.begin(), 0.0);
    return { std::move(begin), this->Numbers(*corners) };
  }

  void AddCells(const Piece& piece, const std::string& parent, VtkMesh& mesh) const
  {
    const auto [offsets, corners] = this->ReadCells(piece, parent);
    VtkMesh::VisitCells(offsets, corners,
      [&mesh, &parent](const std::vector<std::int64_t>& cell)
      {
        if (parent == "Polys")
        {
          mesh.AddPolygon(cell);
        }
        else if (parent == "Strips")
        {
          mesh.AddStrip(cell);
        }
        else
        {
          mesh.SkipCells(1);
        }
      });
  }

  void AddGrid(const Piece& piece, VtkMesh& mesh) const
  {
    const auto [offsets, corners] = this->ReadCells(piece, "Cells");
    const Described* const described = this->Find(piece, "Cells", "types");
    const std::vector<double> types = described ? this->Numbers(*described) : std::vector<double>();
    if (types.size() + 1 != std::max<std::size_t>(offsets.size(), 1))
    {
      throw FileError("there are types of " + std::to_string(types.size()) +
        " cells and offsets of " + std::to_string(offsets.size()));
    }
    std::size_t c = 0;
    VtkMesh::VisitCells(offsets, corners,
      [&](const std::vector<std::int64_t>& cell)
      {
        const double type = types[c++];
        mesh.AddCellOfType(type >= 0.0 && type < 256.0 ? static_cast<int>(type) : 255, cell);
      });
  }

  std::vector<double> Numbers(const Described& array) const
  {
    const NumberType type = TypeOf(array.Type);
    if (array.Format == "ascii" || array.Format.empty())
    {
      std::vector<double> numbers;
      Content text(reinterpret_cast<const std::uint8_t*>(array.Text.data()), array.Text.size());
      for (std::string_view word = text.ReadWord(); !word.empty(); word = text.ReadWord())
      {
        const double number = ToNumber(word);
        numbers.push_back(
          type == NumberType::Float32 ? static_cast<double>(static_cast<float>(number)) : number);
      }
      return numbers;
    }
    const bool isAppended = array.Format == "appended";
    if (isAppended && array.Offset > this->Appended.size())
    {
      throw FileError(
        "the array " + Quote(array.Name) + " is announced behind the end of the file");
    }
    const std::string_view text =
      isAppended ? this->Appended.substr(static_cast<std::size_t>(array.Offset)) : array.Text;
    const Bytes bytes = isAppended && this->IsRaw ? this->ReadRaw(text) : this->ReadBase64(text);
    Content content(bytes.data(), bytes.size());
    return ReadNumbers(content, bytes.size() / SizeOf(type), type, this->IsBigEndian);
  }

  std::uint64_t Size(const std::uint8_t* from) const
  {
    const auto size = this->SizeType == NumberType::UInt64
      ? Content::Decode<std::uint64_t>(from, this->IsBigEndian)
      : Content::Decode<std::uint32_t>(from, this->IsBigEndian);
    return size;
  }

  Bytes ReadRaw(std::string_view text) const
  {
    Content content(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    const std::size_t width = SizeOf(this->SizeType);
    if (!this->IsCompressed)
    {
      const std::uint64_t size = this->Size(content.Take(width));
      const std::uint8_t* const from = content.Take(size);
      return { from, from + size };
    }
    const Content start = content;
    const std::uint64_t blocks = this->Size(content.Take(3 * width));
    if (blocks > content.Left() / width)
    {
      throw FileError("an array announces " + std::to_string(blocks) + " blocks");
    }
    content.Take(blocks * width);
    return this->Expand(start.Here(), static_cast<std::size_t>(blocks), content);
  }

  /// The lengths before compressed data are encoded for themselves, others together with the data.
  Bytes ReadBase64(std::string_view text) const
  {
    const std::size_t width = SizeOf(this->SizeType);
    std::string_view left = text;
    Bytes head = DecodeBase64(left, this->IsCompressed ? 3 * width : width);
    if (head.size() < width)
    {
      return {};
    }
    if (!this->IsCompressed)
    {
      const std::uint64_t size = this->Size(head.data());
      if (size > text.size())
      {
        throw FileError("an array announces " + std::to_string(size) + " bytes");
      }
      Bytes bytes = DecodeBase64(text, width + static_cast<std::size_t>(size));
      if (bytes.size() != width + size)
      {
        throw FileError("it ends too early");
      }
      bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(width));
      return bytes;
    }
    const std::uint64_t blocks = this->Size(head.data());
    if (blocks > text.size())
    {
      throw FileError("an array announces " + std::to_string(blocks) + " blocks");
    }
    head = DecodeBase64(text, (3 + static_cast<std::size_t>(blocks)) * width);
    if (head.size() != (3 + blocks) * width)
    {
      throw FileError("it ends too early");
    }
    std::uint64_t packed = 0;
    for (std::size_t b = 0; b < blocks; ++b)
    {
      packed += std::min<std::uint64_t>(this->Size(&head[(3 + b) * width]), text.size());
    }
    const Bytes data =
      DecodeBase64(text, static_cast<std::size_t>(std::min<std::uint64_t>(packed, text.size())));
    return this->Expand(
      head.data(), static_cast<std::size_t>(blocks), Content(data.data(), data.size()));
  }

  /// head: the number of blocks, the sizes of all and of the last one (0: as the others), and what
  /// each is compressed to.
  Bytes Expand(const std::uint8_t* head, std::size_t blocks, Content content) const
  {
    const std::size_t width = SizeOf(this->SizeType);
    Bytes all;
    for (std::size_t b = 0; b < blocks; ++b)
    {
      const std::uint64_t last = this->Size(head + 2 * width);
      const std::uint64_t size = b + 1 == blocks && last != 0 ? last : this->Size(head + width);
      const std::uint64_t packed = this->Size(head + (3 + b) * width);
      const std::uint8_t* const from = content.Take(packed);
      const Bytes block = Inflate(from, static_cast<std::size_t>(packed), size, true);
      all.insert(all.end(), block.begin(), block.end());
    }
    return all;
  }

  std::string_view All, Appended;
  bool IsGrid = false, IsBigEndian = false, IsCompressed = false, IsRaw = true;
  NumberType SizeType = NumberType::UInt32;
  std::vector<Piece> Pieces;
};

} // namespace

SurfaceFile ReadVtkXml(Content content)
{
  return Reader(content).Read();
}

} // namespace SurfaceDiffusion::Files
