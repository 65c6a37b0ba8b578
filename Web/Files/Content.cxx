// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Files/Content.h"

#include <fast_float/fast_float.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdio>
#include <cstdlib>

namespace SurfaceDiffusion::Files
{

namespace
{

bool IsSpace(char c)
{
  return c == ' ' || (c >= '\t' && c <= '\r');
}

} // namespace

bool Content::ReadLine(std::string_view& line)
{
  const std::string_view text = this->Text();
  if (text.empty())
  {
    return false;
  }
  const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
  line = text.substr(0, end);
  const bool isPair = text.substr(end, 2) == "\r\n";
  this->Place += std::min(end + (isPair ? 2 : 1), text.size());
  return true;
}

std::string_view Content::ReadWord()
{
  const std::string_view text = this->Text();
  std::size_t start = 0;
  while (start < text.size() && IsSpace(text[start]))
  {
    ++start;
  }
  std::size_t end = start;
  while (end < text.size() && !IsSpace(text[end]))
  {
    ++end;
  }
  this->Place += end;
  return text.substr(start, end - start);
}

std::vector<std::string_view> SplitWords(std::string_view line, char comment)
{
  if (comment != 0)
  {
    line = line.substr(0, line.find(comment));
  }
  std::vector<std::string_view> words;
  std::size_t at = 0;
  while (at < line.size())
  {
    while (at < line.size() && IsSpace(line[at]))
    {
      ++at;
    }
    const std::size_t start = at;
    while (at < line.size() && !IsSpace(line[at]))
    {
      ++at;
    }
    if (at > start)
    {
      words.push_back(line.substr(start, at - start));
    }
  }
  return words;
}

std::string Quote(std::string_view text)
{
  std::string quoted = "'";
  for (const char c : text.substr(0, 40))
  {
    const auto code = static_cast<unsigned char>(c);
    quoted += code >= 32 && code < 127 ? c : '?';
  }
  return quoted + "'";
}

double ToNumber(std::string_view word)
{
  if (!word.empty() && word.front() == '+')
  {
    word.remove_prefix(1);
  }
  double number = 0.0;
  const char* const end = word.data() + word.size();
  const auto found = fast_float::from_chars(word.data(), end, number);
  if (found.ec != std::errc() || found.ptr != end)
  {
    throw FileError(Quote(word) + " is no number");
  }
  return number;
}

std::int64_t ToInteger(std::string_view word)
{
  if (!word.empty() && word.front() == '+')
  {
    word.remove_prefix(1);
  }
  std::int64_t number = 0;
  const char* const end = word.data() + word.size();
  const auto found = std::from_chars(word.data(), end, number);
  if (found.ec != std::errc() || found.ptr != end)
  {
    throw FileError(Quote(word) + " is no whole number");
  }
  return number;
}

std::string LowerCase(std::string_view text)
{
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

std::size_t SizeOf(NumberType type)
{
  constexpr std::size_t sizes[] = { 1, 1, 2, 2, 4, 4, 8, 8, 4, 8 };
  return sizes[static_cast<int>(type)];
}

double ReadNumber(const std::uint8_t* from, NumberType type, bool bigEndian)
{
  switch (type)
  {
    case NumberType::Int8:
      return Content::Decode<std::int8_t>(from, bigEndian);
    case NumberType::UInt8:
      return *from;
    case NumberType::Int16:
      return Content::Decode<std::int16_t>(from, bigEndian);
    case NumberType::UInt16:
      return Content::Decode<std::uint16_t>(from, bigEndian);
    case NumberType::Int32:
      return Content::Decode<std::int32_t>(from, bigEndian);
    case NumberType::UInt32:
      return Content::Decode<std::uint32_t>(from, bigEndian);
    case NumberType::Int64:
      return static_cast<double>(Content::Decode<std::int64_t>(from, bigEndian));
    case NumberType::UInt64:
      return static_cast<double>(Content::Decode<std::uint64_t>(from, bigEndian));
    case NumberType::Float32:
      return Content::Decode<float>(from, bigEndian);
    default:
      return Content::Decode<double>(from, bigEndian);
  }
}

std::vector<double> ReadNumbers(
  Content& content, std::uint64_t count, NumberType type, bool bigEndian)
{
  if (count > content.Left() / SizeOf(type))
  {
    throw FileError("it ends too early");
  }
  const std::uint8_t* const from = content.Take(count * SizeOf(type));
  std::vector<double> numbers(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    numbers[i] = ReadNumber(from + i * SizeOf(type), type, bigEndian);
  }
  return numbers;
}

std::size_t CheckCount(
  std::int64_t declared, std::size_t size, const Content& content, const char* what)
{
  if (declared < 0 || static_cast<std::uint64_t>(declared) > content.Left() / size)
  {
    throw FileError(std::to_string(declared) + " " + what + " are announced, but only " +
      std::to_string(content.Left()) + " bytes follow");
  }
  return static_cast<std::size_t>(declared);
}

void Writer::Text(std::string_view text)
{
  this->Written.insert(this->Written.end(), text.begin(), text.end());
}

void Writer::Number(double number)
{
  char text[40];
  // The fewest digits that give the same number again
  for (const int digits : { 7, 15, 16, 17 })
  {
    const int length = std::snprintf(text, sizeof(text), "%.*g", digits, number);
    if (digits == 17 || std::strtod(text, nullptr) == number)
    {
      this->Text({ text, static_cast<std::size_t>(length) });
      return;
    }
  }
}

} // namespace SurfaceDiffusion::Files
