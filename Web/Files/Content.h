// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Files/SurfaceFile.h"

#include <cstring>
#include <string_view>

namespace SurfaceDiffusion::Files
{

/// Bytes of a file that are read one after another. Nothing beyond their end is read.
class Content
{
public:
  Content(const std::uint8_t* data, std::size_t size)
    : Data(data)
    , Size(size)
  {
  }

  std::size_t Left() const { return this->Size - this->Place; }
  const std::uint8_t* Here() const { return this->Data + this->Place; }
  std::string_view Text() const
  {
    return { reinterpret_cast<const char*>(this->Here()), this->Left() };
  }
  bool StartsWith(std::string_view start) const
  {
    return this->Text().substr(0, start.size()) == start;
  }

  /// The next bytes, which are passed. Throws FileError.
  const std::uint8_t* Take(std::uint64_t count)
  {
    if (count > this->Left())
    {
      throw FileError("it ends too early");
    }
    const std::uint8_t* const found = this->Here();
    this->Place += static_cast<std::size_t>(count);
    return found;
  }

  /// A number of the machine's type.
  template <typename T>
  T Read(bool bigEndian)
  {
    return Decode<T>(this->Take(sizeof(T)), bigEndian);
  }

  template <typename T>
  static T Decode(const std::uint8_t* from, bool bigEndian)
  {
    std::uint8_t bytes[sizeof(T)];
    for (std::size_t i = 0; i < sizeof(T); ++i)
    {
      bytes[i] = from[bigEndian ? sizeof(T) - 1 - i : i];
    }
    T number;
    std::memcpy(&number, bytes, sizeof(T)); // all machines that compile this are little-endian
    return number;
  }

  /// The rest of the line without its end, which is passed; false at the end of the bytes.
  bool ReadLine(std::string_view& line);
  /// The next word between white space, which may be in a later line; empty at the end.
  std::string_view ReadWord();

private:
  const std::uint8_t* Data;
  std::size_t Size;
  std::size_t Place = 0;
};

/// The words of a line, without what follows the sign of a comment (0: there are no comments).
std::vector<std::string_view> SplitWords(std::string_view line, char comment = 0);

/// A part of a text for an error, as one line.
std::string Quote(std::string_view text);

///@{
/// The whole word as a number. Throws FileError.
double ToNumber(std::string_view word);
std::int64_t ToInteger(std::string_view word);
///@}

/// The number of a point; -1 for numbers that are none.
inline std::int64_t ToIndex(double number)
{
  return number >= 0.0 && number < 4e9 ? static_cast<std::int64_t>(number) : -1;
}

std::string LowerCase(std::string_view text);

/// The types of numbers in binary files.
enum class NumberType
{
  Int8,
  UInt8,
  Int16,
  UInt16,
  Int32,
  UInt32,
  Int64,
  UInt64,
  Float32,
  Float64
};

std::size_t SizeOf(NumberType type);
double ReadNumber(const std::uint8_t* from, NumberType type, bool bigEndian);
/// As many as the bytes have. Throws FileError unless they are there.
std::vector<double> ReadNumbers(
  Content& content, std::uint64_t count, NumberType type, bool bigEndian);

/// A count that a file declares, of things of at least `size` bytes of the content each. Throws
/// FileError if the content has not so many bytes.
std::size_t CheckCount(
  std::int64_t declared, std::size_t size, const Content& content, const char* what);

/// Text that grows.
class Writer
{
public:
  void Text(std::string_view text);
  /// A number with as many digits as it needs, as words in a line.
  void Number(double number);
  template <typename T>
  void Binary(T number, bool bigEndian = false)
  {
    std::uint8_t bytes[sizeof(T)];
    std::memcpy(bytes, &number, sizeof(T));
    for (std::size_t i = 0; i < sizeof(T); ++i)
    {
      this->Written.push_back(bytes[bigEndian ? sizeof(T) - 1 - i : i]);
    }
  }
  Bytes Written;
};

} // namespace SurfaceDiffusion::Files
