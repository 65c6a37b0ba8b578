// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Files/Gifti.h"

#include "Files/Inflate.h"
#include "Files/Xml.h"

#include <limits>

namespace SurfaceDiffusion::Files
{

namespace
{

struct DataArray
{
  std::string Intent, Type, Encoding, Name;
  bool IsBigEndian = false, ColumnsFirst = false;
  std::vector<std::uint64_t> Sizes;
};

DataArray Describe(const XmlReader& xml)
{
  DataArray array;
  array.Intent = xml.Attribute("Intent");
  array.Type = xml.Attribute("DataType");
  array.Encoding = xml.Attribute("Encoding");
  array.IsBigEndian = xml.Attribute("Endian") == "BigEndian";
  array.ColumnsFirst = xml.Attribute("ArrayIndexingOrder") == "ColumnMajorOrder";
  const std::string dimensions = xml.Attribute("Dimensionality");
  const std::int64_t count = ToInteger(dimensions);
  if (count < 1 || count > 2)
  {
    throw FileError("an array has " + dimensions + " dimensions; allowed: 1 or 2");
  }
  for (std::int64_t k = 0; k < count; ++k)
  {
    const std::int64_t size = ToInteger(xml.Attribute("Dim" + std::to_string(k)));
    if (size < 0 || size > std::numeric_limits<std::int32_t>::max())
    {
      throw FileError("an array has the size " + std::to_string(size));
    }
    array.Sizes.push_back(static_cast<std::uint64_t>(size));
  }
  return array;
}

NumberType TypeOf(const std::string& word)
{
  constexpr std::pair<const char*, NumberType> types[] = {
    { "NIFTI_TYPE_UINT8", NumberType::UInt8 }, { "NIFTI_TYPE_INT8", NumberType::Int8 },
    { "NIFTI_TYPE_INT16", NumberType::Int16 }, { "NIFTI_TYPE_UINT16", NumberType::UInt16 },
    { "NIFTI_TYPE_INT32", NumberType::Int32 }, { "NIFTI_TYPE_UINT32", NumberType::UInt32 },
    { "NIFTI_TYPE_FLOAT32", NumberType::Float32 }, { "NIFTI_TYPE_FLOAT64", NumberType::Float64 }
  };
  for (const auto& [name, type] : types)
  {
    if (word == name)
    {
      return type;
    }
  }
  throw FileError(Quote(word) + " is no type; allowed: NIFTI_TYPE_INT32, NIFTI_TYPE_FLOAT32, ...");
}

std::vector<double> ReadData(const DataArray& array, std::string_view text)
{
  std::uint64_t count = 1;
  for (const std::uint64_t size : array.Sizes)
  {
    count *= size;
  }
  const NumberType type = TypeOf(array.Type);
  std::vector<double> numbers;
  if (array.Encoding == "ASCII")
  {
    Content content(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    for (std::string_view word = content.ReadWord(); !word.empty(); word = content.ReadWord())
    {
      const double number = ToNumber(word);
      numbers.push_back(
        type == NumberType::Float32 ? static_cast<double>(static_cast<float>(number)) : number);
    }
  }
  else if (array.Encoding == "Base64Binary" || array.Encoding == "GZipBase64Binary")
  {
    Bytes bytes = DecodeBase64(text, text.size());
    if (array.Encoding[0] == 'G')
    {
      bytes = Inflate(bytes.data(), bytes.size(), count * SizeOf(type), true);
    }
    Content content(bytes.data(), bytes.size());
    numbers = ReadNumbers(content, bytes.size() / SizeOf(type), type, array.IsBigEndian);
  }
  else
  {
    throw FileError(Quote(array.Encoding) +
      " is no encoding that is read; allowed: ASCII, Base64Binary, GZipBase64Binary");
  }
  if (numbers.size() != count)
  {
    throw FileError("an array announces " + std::to_string(count) + " numbers and has " +
      std::to_string(numbers.size()));
  }
  if (array.ColumnsFirst && array.Sizes.size() == 2)
  {
    std::vector<double> rows(numbers.size());
    const auto n = static_cast<std::size_t>(array.Sizes[0]);
    const auto m = static_cast<std::size_t>(array.Sizes[1]);
    for (std::size_t i = 0; i < numbers.size(); ++i)
    {
      rows[i % n * m + i / n] = numbers[i];
    }
    return rows;
  }
  return numbers;
}

void Take(
  const DataArray& array, std::vector<double> numbers, const std::string& name, SurfaceFile& file)
{
  const auto columns = static_cast<std::size_t>(array.Sizes.size() == 2 ? array.Sizes[1] : 1);
  const bool arePoints = array.Intent == "NIFTI_INTENT_POINTSET";
  if (arePoints || array.Intent == "NIFTI_INTENT_TRIANGLE")
  {
    if (columns != 3)
    {
      throw FileError(
        Quote(array.Intent) + " has " + std::to_string(columns) + " columns; allowed: 3");
    }
    if (arePoints)
    {
      file.Points = std::move(numbers);
      return;
    }
    for (std::size_t i = 0; i < numbers.size(); i += 3)
    {
      for (std::size_t k = 0; k < 3; ++k)
      {
        file.Corners.push_back(ToIndex(numbers[i + k]));
      }
      file.Begin.push_back(file.Corners.size());
    }
    return;
  }
  if (array.Intent == "NIFTI_INTENT_NODE_INDEX")
  {
    for (const double number : numbers)
    {
      file.At.push_back(ToIndex(number));
    }
    return;
  }
  if (numbers.empty())
  {
    return;
  }
  FileArray values{ array.Name.empty() ? name : array.Name, false, columns };
  values.Numbers = std::move(numbers);
  file.Arrays.push_back(std::move(values));
}

} // namespace

SurfaceFile ReadGifti(Content content, const std::string& name)
{
  XmlReader xml(content.Text());
  SurfaceFile file;
  file.Kind = "GIFTI";
  file.Unit = "mm";
  DataArray array;
  std::string key;
  std::vector<double> numbers;
  bool isInArray = false;
  while (xml.Next())
  {
    if (!xml.IsEnd())
    {
      if (xml.Name() == "DataArray")
      {
        array = Describe(xml);
        isInArray = true;
      }
      continue;
    }
    if (xml.Name() == "Name")
    {
      key = xml.Text();
    }
    else if (xml.Name() == "Value" && isInArray && key == "Name")
    {
      array.Name = XmlReader::Plain(xml.Text());
    }
    else if (xml.Name() == "Data" && isInArray)
    {
      numbers = ReadData(array, xml.Text());
    }
    else if (xml.Name() == "DataArray" && isInArray)
    {
      isInArray = false;
      Take(array, std::move(numbers), name, file);
      numbers.clear();
    }
  }
  return file;
}

namespace
{

template <typename To, typename Numbers>
void WriteArray(Writer& writer, const char* intent, const char* type, std::size_t columns,
  const std::string& name, const Numbers& numbers)
{
  Writer bytes;
  for (const auto number : numbers)
  {
    bytes.Binary(static_cast<To>(number));
  }
  writer.Text(std::string("<DataArray Intent=\"NIFTI_INTENT_") + intent +
    "\" DataType=\"NIFTI_TYPE_" + type +
    "\" ArrayIndexingOrder=\"RowMajorOrder\" Dimensionality=\"" + (columns > 1 ? "2" : "1") +
    "\" Dim0=\"" + std::to_string(numbers.size() / columns) + "\" " +
    (columns > 1 ? "Dim1=\"" + std::to_string(columns) + "\" " : std::string()) +
    "Encoding=\"Base64Binary\" Endian=\"LittleEndian\" ExternalFileName=\"\" "
    "ExternalFileOffset=\"\">\n<MetaData>");
  if (!name.empty())
  {
    writer.Text("<MD><Name>Name</Name><Value>" + XmlReader::Escaped(name) + "</Value></MD>");
  }
  writer.Text("</MetaData>\n<Data>");
  writer.Text(EncodeBase64(bytes.Written.data(), bytes.Written.size()));
  writer.Text("</Data>\n</DataArray>\n");
}

} // namespace

Bytes WriteGifti(const SurfaceFile& surface)
{
  std::vector<const FileArray*> arrays;
  for (const FileArray& array : surface.Arrays)
  {
    if (!array.OnCells)
    {
      arrays.push_back(&array);
    }
  }
  Writer writer;
  writer.Text("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<GIFTI Version=\"1.0\" "
              "NumberOfDataArrays=\"" +
    std::to_string(2 + arrays.size()) + "\">\n<MetaData/>\n<LabelTable/>\n");
  WriteArray<float>(writer, "POINTSET", "FLOAT32", 3, "", surface.Points);
  WriteArray<std::int32_t>(writer, "TRIANGLE", "INT32", 3, "", surface.Corners);
  for (const FileArray* const array : arrays)
  {
    WriteArray<float>(writer, "SHAPE", "FLOAT32", array->Components, array->Name, array->Numbers);
  }
  writer.Text("</GIFTI>\n");
  return writer.Written;
}

} // namespace SurfaceDiffusion::Files
