// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Files/Inflate.h"
#include "Files/VtkXml.h"
#include "Files/Xml.h"

namespace SurfaceDiffusion::Files
{

namespace
{

/// An element with numbers in base 64.
template <typename To, typename Numbers>
void WriteArray(
  Writer& writer, const std::string& attributes, const char* type, const Numbers& numbers)
{
  Writer bytes;
  bytes.Binary(static_cast<std::uint64_t>(numbers.size() * sizeof(To)));
  for (const auto number : numbers)
  {
    bytes.Binary(static_cast<To>(number));
  }
  writer.Text(
    std::string("<DataArray type=\"") + type + "\" " + attributes + " format=\"binary\">");
  writer.Text(EncodeBase64(bytes.Written.data(), bytes.Written.size()));
  writer.Text("</DataArray>\n");
}

void WriteArrays(Writer& writer, const SurfaceFile& surface, bool onCells)
{
  const char* const place = onCells ? "CellData" : "PointData";
  writer.Text(std::string("<") + place + ">\n");
  for (const FileArray& array : surface.Arrays)
  {
    if (array.OnCells != onCells)
    {
      continue;
    }
    const std::string attributes = "Name=\"" + XmlReader::Escaped(array.Name) +
      "\" NumberOfComponents=\"" + std::to_string(array.Components) + "\"";
    if (array.AreBytes)
    {
      WriteArray<std::uint8_t>(writer, attributes, "UInt8", array.Numbers);
    }
    else
    {
      WriteArray<double>(writer, attributes, "Float64", array.Numbers);
    }
  }
  writer.Text(std::string("</") + place + ">\n");
}

} // namespace

Bytes WriteVtkXml(const SurfaceFile& surface, bool isGrid)
{
  const std::string cells = std::to_string(surface.NumberOfCells());
  const std::string type = isGrid ? "UnstructuredGrid" : "PolyData";
  const std::string kind = isGrid ? "Cells" : surface.AreLines ? "Lines" : "Polys";
  Writer writer;
  writer.Text("<?xml version=\"1.0\"?>\n<VTKFile type=\"" + type +
    "\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<" + type +
    ">\n<Piece NumberOfPoints=\"" + std::to_string(surface.NumberOfPoints()) + "\" " + "NumberOf" +
    kind + "=\"" + cells + "\">\n");
  WriteArrays(writer, surface, false);
  WriteArrays(writer, surface, true);
  writer.Text("<Points>\n");
  WriteArray<double>(writer, "Name=\"Points\" NumberOfComponents=\"3\"", "Float64", surface.Points);
  writer.Text("</Points>\n<" + kind + ">\n");
  WriteArray<std::int64_t>(writer, "Name=\"connectivity\"", "Int64", surface.Corners);
  WriteArray<std::int64_t>(writer, "Name=\"offsets\"", "Int64",
    std::vector<std::size_t>(surface.Begin.begin() + 1, surface.Begin.end()));
  if (isGrid)
  {
    std::vector<int> types;
    for (std::size_t c = 0; c < surface.NumberOfCells(); ++c)
    {
      types.push_back(surface.Begin[c + 1] - surface.Begin[c] == 3 ? 5 : 7);
    }
    WriteArray<std::uint8_t>(writer, "Name=\"types\"", "UInt8", types);
  }
  writer.Text("</" + kind + ">\n</Piece>\n</" + type + ">\n</VTKFile>\n");
  return writer.Written;
}

} // namespace SurfaceDiffusion::Files
