// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Files/ThreeMf.h"

#include "Files/Inflate.h"
#include "Files/Xml.h"

#include <algorithm>
#include <array>
#include <map>

namespace SurfaceDiffusion::Files
{

namespace
{

using Transform = std::array<double, 12>; ///< rows of x, y, z and of the shift

struct Placed
{
  std::string Object;
  Transform At = { 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0 };
};

struct Object
{
  std::vector<double> Points;
  std::vector<std::int64_t> Corners;
  std::vector<Placed> Components;
};

struct Model
{
  std::map<std::string, Object> Objects;
  std::vector<Placed> Items;
  std::string Unit;
};

constexpr std::uint32_t EntryMark = 0x02014b50;
constexpr std::uint32_t LocalMark = 0x04034b50;
constexpr std::uint32_t EndMark = 0x06054b50;

/// The bytes of the first file of the archive whose name has this end.
Bytes FindInArchive(Content content, std::string_view ending)
{
  // The end of the archive has a comment of at most 65535 bytes.
  const std::size_t size = content.Left();
  const std::uint8_t* const all = content.Here();
  for (std::size_t back = 22; back <= std::min<std::size_t>(size, 65557); ++back)
  {
    if (Content::Decode<std::uint32_t>(all + size - back, false) != EndMark)
    {
      continue;
    }
    Content end(all + size - back, back);
    end.Take(16);
    const auto directory = end.Read<std::uint32_t>(false);
    if (directory > size)
    {
      break;
    }
    Content entries(all + directory, size - directory);
    while (entries.Left() >= 46 && entries.Read<std::uint32_t>(false) == EntryMark)
    {
      const std::uint8_t* const entry = entries.Take(42) - 4;
      const auto number16 = [&](std::size_t at)
      { return Content::Decode<std::uint16_t>(entry + at, false); };
      const auto number32 = [&](std::size_t at)
      { return Content::Decode<std::uint32_t>(entry + at, false); };
      const std::size_t length = number16(28);
      const std::string_view name(reinterpret_cast<const char*>(entries.Take(length)), length);
      entries.Take(std::uint64_t{ number16(30) } + number16(32));
      if (name.size() < ending.size() ||
        LowerCase(name.substr(name.size() - ending.size())) != ending)
      {
        continue;
      }
      const std::uint32_t start = number32(42);
      const std::uint32_t packed = number32(20);
      if (start > size)
      {
        break;
      }
      Content local(all + start, size - start);
      if (local.Read<std::uint32_t>(false) != LocalMark)
      {
        break;
      }
      const std::uint8_t* const head = local.Take(26) - 4;
      local.Take(std::uint64_t{ Content::Decode<std::uint16_t>(head + 26, false) } +
        Content::Decode<std::uint16_t>(head + 28, false));
      const std::uint8_t* const from = local.Take(packed);
      const int method = number16(10);
      if ((number16(8) & 1) != 0 || (method != 0 && method != 8))
      {
        throw FileError("its model is encrypted, or compressed in another way than by deflate");
      }
      return method == 0 ? Bytes(from, from + packed) : Inflate(from, packed, number32(24), false);
    }
    break;
  }
  throw FileError("an archive of files without the model of a 3MF file, or a damaged one");
}

Transform ReadTransform(const std::string& text)
{
  Transform transform = Placed().At;
  const std::vector<std::string_view> words = SplitWords(text);
  if (!words.empty() && words.size() != transform.size())
  {
    throw FileError("a transform has " + std::to_string(words.size()) + " numbers; allowed: 12");
  }
  for (std::size_t k = 0; k < words.size(); ++k)
  {
    transform[k] = ToNumber(words[k]);
  }
  return transform;
}

Model ReadModel(std::string_view text)
{
  XmlReader xml(text);
  Model model;
  Object* object = nullptr;
  while (xml.Next())
  {
    if (xml.IsEnd())
    {
      object = xml.Name() == "object" ? nullptr : object;
      continue;
    }
    if (xml.Name() == "model")
    {
      model.Unit = xml.Attribute("unit");
    }
    else if (xml.Name() == "object")
    {
      object = &model.Objects[xml.Attribute("id")];
    }
    else if (xml.Name() == "item")
    {
      model.Items.push_back(
        { xml.Attribute("objectid"), ReadTransform(xml.Attribute("transform")) });
    }
    else if (object && xml.Name() == "component")
    {
      object->Components.push_back(
        { xml.Attribute("objectid"), ReadTransform(xml.Attribute("transform")) });
    }
    else if (object && xml.Name() == "vertex")
    {
      for (const char* const axis : { "x", "y", "z" })
      {
        object->Points.push_back(ToNumber(xml.Attribute(axis)));
      }
    }
    else if (object && xml.Name() == "triangle")
    {
      for (const char* const corner : { "v1", "v2", "v3" })
      {
        const std::int64_t point = ToInteger(xml.Attribute(corner));
        if (point < 0 || static_cast<std::size_t>(point) >= object->Points.size() / 3)
        {
          throw FileError("a face refers to point " + std::to_string(point) + "; allowed: 0 to " +
            std::to_string(static_cast<std::int64_t>(object->Points.size() / 3) - 1));
        }
        object->Corners.push_back(point);
      }
    }
  }
  return model;
}

/// Points are rows that are multiplied by the transform.
std::array<double, 3> Apply(const Transform& transform, const double* x)
{
  std::array<double, 3> moved{};
  for (std::size_t k = 0; k < 3; ++k)
  {
    moved[k] =
      x[0] * transform[k] + x[1] * transform[3 + k] + x[2] * transform[6 + k] + transform[9 + k];
  }
  return moved;
}

/// Place an object, and those that it is made of. A small file can repeat objects many times, which
/// has bounds: in levels, in points and triangles, and in objects, of which `left` may still come.
void Place(const Model& model, const std::string& id, const std::vector<Transform>& transforms,
  std::size_t& left, SurfaceFile& file)
{
  constexpr std::size_t most = 5000000; // points, and triangles
  constexpr std::size_t levels = 4;
  const auto found = model.Objects.find(id);
  if (found == model.Objects.end())
  {
    throw FileError("there is no object " + Quote(id));
  }
  const Object& object = found->second;
  const auto first = static_cast<std::int64_t>(file.NumberOfPoints());
  const auto isTooMuch = [&](std::size_t sum, std::size_t own)
  { return sum + own > std::max(most, own); };
  if (left-- == 0 || transforms.size() > levels ||
    isTooMuch(file.NumberOfPoints(), object.Points.size() / 3) ||
    isTooMuch(file.NumberOfCells(), object.Corners.size() / 3))
  {
    throw FileError("its objects are made of too many others; allowed: 5 million points in all");
  }
  for (std::size_t i = 0; i + 2 < object.Points.size(); i += 3)
  {
    std::array<double, 3> x{ object.Points[i], object.Points[i + 1], object.Points[i + 2] };
    for (auto transform = transforms.rbegin(); transform != transforms.rend(); ++transform)
    {
      x = Apply(*transform, x.data());
    }
    file.Points.insert(file.Points.end(), x.begin(), x.end());
  }
  for (std::size_t k = 0; k + 2 < object.Corners.size(); k += 3)
  {
    file.AddCell(
      { first + object.Corners[k], first + object.Corners[k + 1], first + object.Corners[k + 2] });
  }
  for (const Placed& component : object.Components)
  {
    std::vector<Transform> inner = transforms;
    inner.push_back(component.At);
    Place(model, component.Object, inner, left, file);
  }
}

} // namespace

SurfaceFile ReadThreeMf(Content content)
{
  const Bytes text = FindInArchive(content, ".model");
  const Model model = ReadModel({ reinterpret_cast<const char*>(text.data()), text.size() });
  SurfaceFile file;
  file.Kind = "3MF";
  constexpr std::pair<std::string_view, const char*> units[] = { { "", "mm" },
    { "millimeter", "mm" }, { "micron", "um" }, { "centimeter", "cm" }, { "meter", "m" },
    { "inch", "in" }, { "foot", "ft" } };
  for (const auto& [name, unit] : units)
  {
    file.Unit = model.Unit == name ? unit : file.Unit;
  }
  std::size_t left = 10000;
  for (const Placed& item : model.Items)
  {
    Place(model, item.Object, { item.At }, left, file);
  }
  for (auto object = model.Objects.begin(); model.Items.empty() && object != model.Objects.end();
       ++object)
  {
    Place(model, object->first, { Placed().At }, left, file);
  }
  return file;
}

namespace
{

std::uint32_t Checksum(std::string_view text)
{
  std::uint32_t sum = 0xffffffffU;
  for (const char c : text)
  {
    sum ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit)
    {
      sum = sum >> 1 ^ ((sum & 1U) != 0 ? 0xedb88320U : 0U);
    }
  }
  return ~sum;
}

/// An archive of files that are not compressed.
Bytes WriteArchive(const std::vector<std::pair<std::string, std::string>>& files)
{
  Writer writer;
  Writer directory;
  for (const auto& [name, text] : files)
  {
    const auto start = static_cast<std::uint32_t>(writer.Written.size());
    const std::uint32_t sum = Checksum(text);
    const auto describe = [&, size = static_cast<std::uint32_t>(text.size()),
                            length = static_cast<std::uint16_t>(name.size())](Writer& to)
    {
      for (const std::uint16_t number : { 20, 0, 0, 0, 33 }) // version, flags, method, time, date
      {
        to.Binary(number);
      }
      to.Binary(sum);
      to.Binary(size);
      to.Binary(size);
      to.Binary(length);
      to.Binary(std::uint16_t{ 0 });
    };
    writer.Binary(LocalMark);
    describe(writer);
    writer.Text(name);
    writer.Text(text);
    directory.Binary(EntryMark);
    directory.Binary(std::uint16_t{ 20 });
    describe(directory);
    for (int k = 0; k < 3; ++k)
    {
      directory.Binary(std::uint16_t{ 0 });
    }
    directory.Binary(std::uint32_t{ 0 });
    directory.Binary(start);
    directory.Text(name);
  }
  const auto start = static_cast<std::uint32_t>(writer.Written.size());
  writer.Written.insert(writer.Written.end(), directory.Written.begin(), directory.Written.end());
  writer.Binary(EndMark);
  writer.Binary(std::uint32_t{ 0 });
  writer.Binary(static_cast<std::uint16_t>(files.size()));
  writer.Binary(static_cast<std::uint16_t>(files.size()));
  writer.Binary(static_cast<std::uint32_t>(directory.Written.size()));
  writer.Binary(start);
  writer.Binary(std::uint16_t{ 0 });
  return writer.Written;
}

} // namespace

Bytes WriteThreeMf(const SurfaceFile& surface)
{
  Writer model;
  model.Text("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"millimeter\" "
             "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n<resources>\n"
             "<object id=\"1\" type=\"model\">\n<mesh>\n<vertices>\n");
  for (std::size_t i = 0; i < surface.NumberOfPoints(); ++i)
  {
    model.Text("<vertex x=\"");
    model.Number(surface.Points[3 * i]);
    model.Text("\" y=\"");
    model.Number(surface.Points[3 * i + 1]);
    model.Text("\" z=\"");
    model.Number(surface.Points[3 * i + 2]);
    model.Text("\"/>\n");
  }
  model.Text("</vertices>\n<triangles>\n");
  for (std::size_t c = 0; c < surface.NumberOfCells(); ++c)
  {
    const std::int64_t* const corners = surface.Corners.data() + surface.Begin[c];
    model.Text("<triangle v1=\"" + std::to_string(corners[0]) + "\" v2=\"" +
      std::to_string(corners[1]) + "\" v3=\"" + std::to_string(corners[2]) + "\"/>\n");
  }
  model.Text("</triangles>\n</mesh>\n</object>\n</resources>\n<build>\n<item objectid=\"1\"/>\n"
             "</build>\n</model>\n");
  return WriteArchive({ { "[Content_Types].xml",
                          "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Types "
                          "xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">"
                          "<Default Extension=\"rels\" "
                          "ContentType=\"application/"
                          "vnd.openxmlformats-package.relationships+xml\"/>"
                          "<Default Extension=\"model\" "
                          "ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/>"
                          "</Types>\n" },
    { "_rels/.rels",
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Relationships "
      "xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\"><Relationship "
      "Id=\"rel0\" Target=\"/3D/3dmodel.model\" "
      "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>\n" },
    { "3D/3dmodel.model", { model.Written.begin(), model.Written.end() } } });
}

} // namespace SurfaceDiffusion::Files
