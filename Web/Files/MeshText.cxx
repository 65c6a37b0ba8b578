// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Files/MeshText.h"

#include <algorithm>
#include <cstdlib>

namespace SurfaceDiffusion::Files
{

namespace
{

/// Lines with words, without comments.
class Lines
{
public:
  explicit Lines(Content content)
    : Text(content)
  {
  }
  /// The words of the next line that has some; none at the end.
  std::vector<std::string_view> Next()
  {
    std::vector<std::string_view> words;
    std::string_view line;
    while (words.empty() && this->Text.ReadLine(line))
    {
      ++this->Number;
      words = SplitWords(line, '#');
    }
    return words;
  }
  FileError Error(const std::string& problem) const
  {
    return FileError("line " + std::to_string(this->Number) + " " + problem);
  }
  const Content& Left() const { return this->Text; }

private:
  Content Text;
  std::size_t Number = 0;
};

std::string_view WithoutMark(std::string_view word)
{
  return word.substr(0, 3) == "\xef\xbb\xbf" ? word.substr(3) : word;
}

/// The prefixes of OFF: texture coordinates, colours, normals. Their end is the rest of the word.
bool TakePrefix(std::string_view& word, std::string_view prefix)
{
  const bool starts = word.substr(0, prefix.size()) == prefix;
  word.remove_prefix(starts ? prefix.size() : 0);
  return starts;
}

struct OffHeader
{
  std::size_t Vertices = 0, Faces = 0, Size = 3;
};

/// byLines: each vertex and each face has a line of its own. Otherwise several may be in one line, and
/// only the last line of a face has an end that counts, after its colour.
void ReadOffRows(Lines lines, const OffHeader& header, bool byLines, SurfaceFile& file)
{
  std::vector<std::string_view> row;
  std::size_t next = 0;
  const auto word = [&](bool mayBreak)
  {
    if (next >= row.size() && mayBreak)
    {
      row = lines.Next();
      next = 0;
    }
    if (next >= row.size())
    {
      throw row.empty()
        ? FileError(std::to_string(header.Vertices) + " vertices and " +
            std::to_string(header.Faces) + " faces are announced, but the file ends before them")
        : lines.Error("has too few numbers");
    }
    return row[next++];
  };
  for (std::size_t i = 0; i < header.Vertices; ++i)
  {
    for (std::size_t k = 0; k < (byLines ? 3 : header.Size); ++k)
    {
      const double number = ToNumber(word(k == 0 || !byLines));
      if (k < 3)
      {
        file.Points.push_back(number);
      }
    }
    next = byLines ? row.size() : next;
  }
  std::vector<std::int64_t> corners;
  for (std::size_t f = 0; f < header.Faces; ++f)
  {
    const std::int64_t size = ToInteger(word(true));
    if (size < 3 || static_cast<std::uint64_t>(size) > lines.Left().Left() + row.size())
    {
      throw lines.Error("is no face: it has " + std::to_string(size) + " corners");
    }
    corners.clear();
    for (std::int64_t k = 0; k < size; ++k)
    {
      corners.push_back(ToInteger(word(!byLines)));
    }
    file.AddCell(corners);
    next = row.size();
  }
}

} // namespace

bool IsOff(const Content& content)
{
  std::vector<std::string_view> words = Lines(content).Next();
  std::string_view word = words.empty() ? std::string_view() : WithoutMark(words[0]);
  for (const char* const prefix : { "ST", "C", "N", "4", "n" })
  {
    TakePrefix(word, prefix);
  }
  return TakePrefix(word, "OFF") && word.find_first_not_of("0123456789") == std::string_view::npos;
}

SurfaceFile ReadOff(Content content)
{
  Lines lines(content);
  std::vector<std::string_view> words = lines.Next();
  std::string_view key = WithoutMark(words[0]);
  OffHeader header;
  header.Size += TakePrefix(key, "ST") ? 2 : 0;
  header.Size += TakePrefix(key, "C") ? 4 : 0;
  header.Size += TakePrefix(key, "N") ? 3 : 0;
  if (key[0] != 'O')
  {
    throw FileError(
      Quote(words[0]) + ": vertices with other than three coordinates; allowed: OFF, COFF, NOFF");
  }
  TakePrefix(key, "OFF");
  words.erase(words.begin());
  if (!key.empty())
  {
    words.insert(words.begin(), key); // "OFF8 6 12" is found in collections of meshes
  }
  if (words.empty())
  {
    words = lines.Next();
  }
  if (words.size() < 2)
  {
    throw FileError("the counts of vertices and faces are missing");
  }
  header.Vertices = CheckCount(ToInteger(words[0]), 6, lines.Left(), "vertices");
  header.Faces = CheckCount(ToInteger(words[1]), 8, lines.Left(), "faces");

  SurfaceFile file;
  file.Kind = "OFF";
  try
  {
    ReadOffRows(lines, header, true, file);
  }
  catch (const FileError& problem)
  {
    try
    {
      file = SurfaceFile{ file.Kind };
      ReadOffRows(lines, header, false, file);
    }
    catch (const FileError&)
    {
      throw problem;
    }
  }
  return file;
}

bool IsObj(const Content& content)
{
  Lines lines(content);
  for (std::vector<std::string_view> words = lines.Next(); !words.empty(); words = lines.Next())
  {
    if (words[0] == "v" && words.size() >= 4)
    {
      return true;
    }
    if (words[0].find_first_not_of("abcdefghijklmnopqrstuvwxyz_\xef\xbb\xbf") !=
      std::string_view::npos)
    {
      return false;
    }
  }
  return false;
}

SurfaceFile ReadObj(Content content)
{
  SurfaceFile file;
  file.Kind = "OBJ";
  FileArray colors{ "RGB", false, 3 };
  std::vector<std::int64_t> corners;
  std::string_view line;
  std::string whole; // lines that end in a backslash go on in the next one
  std::size_t number = 0;
  while (content.ReadLine(line))
  {
    ++number;
    const std::size_t last = line.find_last_not_of(" \t");
    const std::size_t first = line.find_first_not_of(" \t");
    const bool isComment = whole.empty() && first != std::string_view::npos && line[first] == '#';
    if (!isComment && last != std::string_view::npos && line[last] == '\\')
    {
      whole += std::string(line.substr(0, last)) + " ";
      continue;
    }
    whole += whole.empty() ? "" : std::string(line);
    const std::string joined = std::move(whole);
    whole.clear();
    const std::vector<std::string_view> words = SplitWords(joined.empty() ? line : joined, '#');
    const auto problem = [&](const char* text)
    { return FileError("line " + std::to_string(number) + " " + text); };
    if (!words.empty() && words[0] == "v")
    {
      if (words.size() < 4)
      {
        throw problem("is no vertex");
      }
      for (int k = 1; k < 4; ++k)
      {
        file.Points.push_back(ToNumber(words[static_cast<std::size_t>(k)]));
      }
      for (std::size_t k = 4; words.size() >= 7 && k < 7; ++k)
      {
        colors.Numbers.push_back(ToNumber(words[k]));
      }
    }
    else if (!words.empty() && words[0] == "f")
    {
      if (words.size() < 4)
      {
        throw problem("is no face");
      }
      corners.clear();
      for (std::size_t k = 1; k < words.size(); ++k)
      {
        const std::int64_t corner = ToInteger(words[k].substr(0, words[k].find('/')));
        if (corner == 0)
        {
          throw problem("has the corner 0; numbers of vertices start at 1");
        }
        // Negative numbers count from the last vertex so far.
        corners.push_back(
          corner > 0 ? corner - 1 : static_cast<std::int64_t>(file.NumberOfPoints()) + corner);
      }
      file.AddCell(corners);
    }
  }
  if (colors.Numbers.size() == file.Points.size() && !colors.Numbers.empty())
  {
    file.Arrays.push_back(std::move(colors));
  }
  return file;
}

const FileArray* FindColors(const SurfaceFile& surface)
{
  for (auto array = surface.Arrays.rbegin(); array != surface.Arrays.rend(); ++array)
  {
    if (!array->OnCells && array->AreBytes && (array->Components == 3 || array->Components == 4))
    {
      return &*array;
    }
  }
  return nullptr;
}

Bytes WriteOff(const SurfaceFile& surface)
{
  Writer writer;
  writer.Text("OFF\n" + std::to_string(surface.NumberOfPoints()) + " " +
    std::to_string(surface.NumberOfCells()) + " 0\n");
  for (std::size_t i = 0; i < surface.Points.size(); ++i)
  {
    writer.Number(surface.Points[i]);
    writer.Text(i % 3 == 2 ? "\n" : " ");
  }
  for (std::size_t c = 0; c < surface.NumberOfCells(); ++c)
  {
    writer.Text(std::to_string(surface.Begin[c + 1] - surface.Begin[c]));
    for (std::size_t k = surface.Begin[c]; k < surface.Begin[c + 1]; ++k)
    {
      writer.Text(" " + std::to_string(surface.Corners[k]));
    }
    writer.Text("\n");
  }
  return writer.Written;
}

Bytes WriteObj(const SurfaceFile& surface)
{
  Writer writer;
  const FileArray* const colors = FindColors(surface);
  for (std::size_t i = 0; i < surface.NumberOfPoints(); ++i)
  {
    writer.Text("v");
    for (std::size_t k = 0; k < 3; ++k)
    {
      writer.Text(" ");
      writer.Number(surface.Points[3 * i + k]);
    }
    for (std::size_t k = 0; colors && k < 3; ++k)
    {
      writer.Text(" ");
      writer.Number(static_cast<double>(
        static_cast<float>(colors->Numbers[colors->Components * i + k] / 255.0)));
    }
    writer.Text("\n");
  }
  for (std::size_t c = 0; c < surface.NumberOfCells(); ++c)
  {
    writer.Text("f");
    for (std::size_t k = surface.Begin[c]; k < surface.Begin[c + 1]; ++k)
    {
      writer.Text(" " + std::to_string(surface.Corners[k] + 1));
    }
    writer.Text("\n");
  }
  return writer.Written;
}

} // namespace SurfaceDiffusion::Files
