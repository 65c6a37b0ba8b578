// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Files/Inflate.h"

#include <algorithm>
#include <limits>

// stb_image has a small decoder of zlib's streams, which writes to memory of a given size.
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#define STBI_NO_LINEAR
#define STBI_NO_HDR
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#include <stb/stb_image.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace SurfaceDiffusion::Files
{

Bytes Inflate(const std::uint8_t* data, std::size_t size, std::uint64_t expected, bool hasHeader)
{
  constexpr std::uint64_t expansion = 1032; // of the format, at most
  constexpr std::uint64_t largest = std::numeric_limits<int>::max();
  if (expected > expansion * (std::uint64_t{ size } + 1) || expected > largest ||
    size > largest - 4)
  {
    throw FileError(std::to_string(size) + " compressed bytes are announced to become " +
      std::to_string(expected));
  }
  if (expected == 0)
  {
    return {};
  }
  Bytes bytes(static_cast<std::size_t>(expected));
  Bytes
    padded; // the decoder looks ahead, to the checksum that only streams of zlib have at their end
  if (!hasHeader)
  {
    padded.assign(data, data + size);
    padded.resize(size + 4);
    data = padded.data();
    size = padded.size();
  }
  const auto* const from = reinterpret_cast<const char*>(data);
  auto* const to = reinterpret_cast<char*>(bytes.data());
  const auto room = static_cast<int>(expected);
  const auto count = static_cast<int>(size);
  const int found = hasHeader ? stbi_zlib_decode_buffer(to, room, from, count)
                              : stbi_zlib_decode_noheader_buffer(to, room, from, count);
  if (found != room)
  {
    throw FileError("its compressed data are damaged");
  }
  return bytes;
}

Bytes InflateGzip(Content content)
{
  const std::uint8_t* const header = content.Take(10);
  const int flags = header[3];
  if (header[2] != 8)
  {
    throw FileError("it is compressed in another way than gzip's");
  }
  if ((flags & 4) != 0)
  {
    content.Take(content.Read<std::uint16_t>(false));
  }
  for (const int isText : { flags & 8, flags & 16 })
  {
    while (isText != 0 && *content.Take(1) != 0)
    {
    }
  }
  content.Take((flags & 2) != 0 ? 2 : 0);
  if (content.Left() < 8)
  {
    throw FileError("it ends too early");
  }
  const std::size_t size = content.Left() - 8;
  const auto expected = Content::Decode<std::uint32_t>(content.Here() + size + 4, false);
  return Inflate(content.Here(), size, expected, false);
}

Bytes DecodeBase64(std::string_view& text, std::size_t limit)
{
  Bytes bytes;
  bytes.reserve(std::min(limit + 3, text.size() / 4 * 3 + 3));
  std::uint32_t group = 0;
  int digits = 0;
  int ends = 0;
  std::size_t at = 0;
  for (; at < text.size() && bytes.size() < limit; ++at)
  {
    const char c = text[at];
    int digit = 0;
    if (c >= 'A' && c <= 'Z')
    {
      digit = c - 'A';
    }
    else if (c >= 'a' && c <= 'z')
    {
      digit = c - 'a' + 26;
    }
    else if (c >= '0' && c <= '9')
    {
      digit = c - '0' + 52;
    }
    else if (c == '+' || c == '/')
    {
      digit = c == '+' ? 62 : 63;
    }
    else if (c == '=')
    {
      ++ends;
    }
    else if (c == ' ' || (c >= '\t' && c <= '\r'))
    {
      continue;
    }
    else
    {
      throw FileError(Quote(text.substr(at, 1)) + " is no digit of base 64");
    }
    group = group << 6 | static_cast<std::uint32_t>(digit);
    if (++digits == 4)
    {
      for (int k = 0; k < 3 - ends; ++k)
      {
        bytes.push_back(static_cast<std::uint8_t>(group >> (16 - 8 * k)));
      }
      digits = 0;
      ends = 0;
      group = 0;
    }
  }
  text.remove_prefix(at);
  bytes.resize(std::min(bytes.size(), limit));
  return bytes;
}

std::string EncodeBase64(const std::uint8_t* data, std::size_t size)
{
  constexpr char alphabet[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((size + 2) / 3 * 4);
  for (std::size_t i = 0; i < size; i += 3)
  {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
    {
      group = group << 8 | (i + k < size ? data[i + k] : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k)
    {
      text += i + k <= size ? alphabet[group >> (18 - 6 * k) & 63] : '=';
    }
  }
  return text;
}

} // namespace SurfaceDiffusion::Files
