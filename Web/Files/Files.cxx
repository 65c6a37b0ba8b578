// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Files/FreeSurfer.h"
#include "Files/Gifti.h"
#include "Files/Inflate.h"
#include "Files/MeshText.h"
#include "Files/Ply.h"
#include "Files/Stl.h"
#include "Files/Table.h"
#include "Files/ThreeMf.h"
#include "Files/VtkLegacy.h"
#include "Files/VtkXml.h"
#include "Files/Xml.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

namespace SurfaceDiffusion::Files
{

namespace
{

/// Without folders and .gz.
std::string PlainName(const std::string& name)
{
  std::string plain = name.substr(name.find_last_of("/\\") + 1);
  const std::string lower = LowerCase(plain);
  if (lower.size() > 3 && lower.compare(lower.size() - 3, 3, ".gz") == 0)
  {
    plain.resize(plain.size() - 3);
  }
  return plain;
}

std::string EndingOf(const std::string& name)
{
  const std::string plain = PlainName(name);
  const std::size_t dot = plain.rfind('.');
  return dot == std::string::npos ? "" : LowerCase(plain.substr(dot + 1));
}

/// What values are called whose file has no name for them: thickness of lh.thickness, and heights of
/// heights.csv.
std::string NameOfValues(const std::string& name)
{
  std::string plain = PlainName(name);
  const std::string start = plain.substr(0, 3);
  if ((start == "lh." || start == "rh.") && plain.size() > 3)
  {
    plain.erase(0, 3);
  }
  const auto isKnown = [&plain](const char* ending) { return EndingOf(plain) == ending; };
  constexpr const char* endings[] = { "csv", "txt", "tsv", "mgh", "mgz", "label", "annot", "asc",
    "gii", "shape", "func" };
  while (std::any_of(std::begin(endings), std::end(endings), isKnown))
  {
    plain.resize(plain.rfind('.'));
  }
  return plain.empty() ? "values" : plain;
}

/// By the name of the root element.
std::string RootOf(const Content& content)
{
  std::string_view text = content.Text().substr(0, 65536);
  text.remove_prefix(text.substr(0, 3) == "\xef\xbb\xbf" ? 3 : 0);
  if (text.substr(0, std::min<std::size_t>(text.size(), 4096)).find('<') !=
    std::min(text.find_first_not_of(" \t\r\n"), text.size()))
  {
    return {};
  }
  try
  {
    XmlReader xml(content.Text());
    return xml.Next() ? std::string(xml.Name()) : std::string();
  }
  catch (const FileError&)
  {
    return {};
  }
}

SurfaceFile ReadByKind(const std::string& name, const Content& content)
{
  const std::string ending = EndingOf(name);
  if (content.StartsWith("\xff\xff\xfe"))
  {
    return ReadFreeSurfer(content);
  }
  if (content.StartsWith("\xff\xff\xff"))
  {
    return ReadCurv(content, NameOfValues(name));
  }
  if (content.StartsWith("#!ascii"))
  {
    return ReadFreeSurferText(content, NameOfValues(name));
  }
  if (ending == "annot")
  {
    return ReadAnnotation(content, NameOfValues(name));
  }
  if (content.StartsWith("# vtk DataFile"))
  {
    return ReadVtkLegacy(content);
  }
  if (content.StartsWith("PK\3\4"))
  {
    return ReadThreeMf(content);
  }
  if (content.StartsWith("ply\n") || content.StartsWith("ply\r"))
  {
    return ReadPly(content);
  }
  const std::string root = RootOf(content);
  if (root == "GIFTI")
  {
    return ReadGifti(content, NameOfValues(name));
  }
  if (root == "VTKFile")
  {
    return ReadVtkXml(content);
  }
  if (IsBinaryStl(content) || ending == "stl")
  {
    return ReadStl(content);
  }
  if (IsMgh(content))
  {
    return ReadMgh(content, NameOfValues(name));
  }
  if (content.Text().substr(0, 4096).find('\0') == std::string_view::npos)
  {
    if (IsOff(content))
    {
      return ReadOff(content);
    }
    if (IsObj(content))
    {
      return ReadObj(content);
    }
    if (IsTable(content))
    {
      return ReadTable(content, NameOfValues(name));
    }
  }
  throw FileError("a file of unknown kind that starts with " + Quote(content.Text().substr(0, 12)) +
    "; allowed: STL, OBJ, PLY, OFF, 3MF, VTK, GIFTI, FreeSurfer, CSV");
}

/// The name as text that a page can show; bytes that are no UTF-8 become question marks.
std::string CleanName(const std::string& name)
{
  std::string clean;
  for (std::size_t i = 0; i < name.size() && clean.size() < 200;)
  {
    const auto byte = static_cast<unsigned char>(name[i]);
    const std::size_t size = byte < 0x80 ? 1 : (byte >= 0xf0 ? 4 : (byte >= 0xe0 ? 3 : 2));
    bool isWhole = byte < 0x80 || (byte >= 0xc2 && byte < 0xf5 && i + size <= name.size());
    for (std::size_t k = 1; isWhole && k < size; ++k)
    {
      isWhole = (static_cast<unsigned char>(name[i + k]) & 0xc0) == 0x80;
    }
    clean += isWhole ? (byte < 32 ? " " : name.substr(i, size)) : "?";
    i += isWhole ? size : 1;
  }
  return clean.empty() ? "values" : clean;
}

/// Corners that are no points, and cells that are no polygons, end here.
void Check(SurfaceFile& file)
{
  RequireCorners(file);
  for (std::size_t c = 0; c < file.NumberOfCells(); ++c)
  {
    if (file.Begin[c + 1] < file.Begin[c] + 3)
    {
      throw FileError("a face has fewer than three points; allowed: polygons");
    }
  }
  if (file.NumberOfCells() == 0 && file.Arrays.empty())
  {
    throw FileError("the surface has " + std::to_string(file.NumberOfPoints()) +
      " points and 0 faces; allowed: at least one of each");
  }
  if (file.NumberOfCells() > 0)
  {
    Spread(file, file.NumberOfPoints());
  }
  std::vector<FileArray> arrays;
  std::map<std::pair<std::string, bool>, int> counts; // of arrays of one name and place
  for (FileArray& array : file.Arrays)
  {
    const std::size_t rows = array.OnCells ? file.NumberOfCells() : file.NumberOfPoints();
    array.Name = CleanName(array.Name);
    const int count = ++counts[{ array.Name, array.OnCells }];
    array.Name += count > 1 ? " " + std::to_string(count) : "";
    if (file.NumberOfCells() == 0 || array.Rows() == rows)
    {
      arrays.push_back(std::move(array));
    }
    else
    {
      file.Warnings.push_back("the array " + array.Name + " has " + std::to_string(array.Rows()) +
        " rows and is left out; allowed: " + std::to_string(rows));
    }
  }
  file.Arrays = std::move(arrays);
}

} // namespace

void RequireCorners(const SurfaceFile& file)
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
}

void Spread(SurfaceFile& file, std::size_t points)
{
  const std::vector<std::int64_t> at = std::move(file.At);
  file.At.clear();
  for (FileArray& array : file.Arrays)
  {
    if (at.empty() || array.OnCells || array.Rows() != at.size())
    {
      continue;
    }
    const std::size_t columns = array.Components;
    std::vector<double> all(points * columns, array.Elsewhere);
    for (std::size_t row = 0; row < at.size(); ++row)
    {
      if (at[row] < 0 || at[row] >= static_cast<std::int64_t>(points))
      {
        throw FileError("a value is at point " + std::to_string(at[row]) + "; allowed: 0 to " +
          std::to_string(points) + " - 1");
      }
      std::copy_n(array.Numbers.begin() + static_cast<std::ptrdiff_t>(row * columns), columns,
        all.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(at[row]) * columns));
    }
    array.Numbers = std::move(all);
  }
}

SurfaceFile ReadFile(const std::string& name, const std::uint8_t* data, std::size_t size)
{
  if (size == 0)
  {
    throw FileError("the file is empty");
  }
  const Content content(data, size);
  SurfaceFile file;
  if (content.StartsWith("\x1f\x8b"))
  {
    const Bytes bytes = InflateGzip(content);
    if (bytes.empty())
    {
      throw FileError("the file is empty");
    }
    file = ReadByKind(name, Content(bytes.data(), bytes.size()));
  }
  else
  {
    file = ReadByKind(name, content);
  }
  Check(file);
  return file;
}

Bytes WriteFile(const std::string& name, const SurfaceFile& surface)
{
  const std::string ending = EndingOf(name);
  if (surface.NumberOfCells() == 0)
  {
    throw FileError(name + ": there are values alone; allowed: a surface");
  }
  const bool hasTriangles = surface.Corners.size() == 3 * surface.NumberOfCells();
  SurfaceFile cut;
  const SurfaceFile* triangles = &surface;
  if (!hasTriangles)
  {
    cut = surface; // formats of triangles have fans of the polygons
    cut.Corners.clear();
    cut.Begin = { 0 };
    for (std::size_t c = 0; c < surface.NumberOfCells(); ++c)
    {
      const std::int64_t* const cell = surface.Corners.data() + surface.Begin[c];
      for (std::size_t k = 2; k < surface.Begin[c + 1] - surface.Begin[c]; ++k)
      {
        cut.AddCell({ cell[0], cell[k - 1], cell[k] });
      }
    }
    triangles = &cut;
  }
  if (ending == "stl")
  {
    return WriteStl(*triangles);
  }
  if (ending == "gii")
  {
    return WriteGifti(*triangles);
  }
  if (ending == "3mf")
  {
    return WriteThreeMf(*triangles);
  }
  const std::pair<const char*, Bytes (*)(const SurfaceFile&)> writers[] = { { "ply", &WritePly },
    { "obj", &WriteObj }, { "off", &WriteOff }, { "vtk", &WriteVtkLegacy },
    { "csv", &WriteTable } };
  for (const auto& [known, write] : writers)
  {
    if (ending == known)
    {
      return write(surface);
    }
  }
  if (ending == "vtp" || ending == "vtu")
  {
    return WriteVtkXml(surface, ending == "vtu");
  }
  const std::string start = PlainName(name).substr(0, 3);
  if (start == "lh." || start == "rh.")
  {
    return WriteFreeSurfer(*triangles);
  }
  throw FileError(name +
    ": the name ends in no format that is written; allowed: .stl, .ply, .obj, "
    ".off, .vtp, .vtu, .vtk, .gii, .3mf, .csv, or lh. and rh. at its start");
}

} // namespace SurfaceDiffusion::Files
