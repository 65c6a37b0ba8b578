// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

// Text of JSON for the page.
namespace SurfaceDiffusion::Json
{

inline std::string Quoted(const std::string& text)
{
  std::string quoted = "\"";
  for (const char c : text)
  {
    if (c == '"' || c == '\\')
    {
      quoted += '\\';
    }
    if (static_cast<unsigned char>(c) < 32)
    {
      char code[8];
      std::snprintf(code, sizeof(code), "\\u%04x", c);
      quoted += code;
      continue;
    }
    quoted += c;
  }
  return quoted + '"';
}

/// null for what is no finite number, which JSON does not have.
inline std::string Number(double number)
{
  char text[32] = "null";
  if (std::isfinite(number))
  {
    std::snprintf(text, sizeof(text), "%.17g", number);
  }
  return text;
}

inline const char* Bool(bool value)
{
  return value ? "true" : "false";
}

/// [a,b,...] of the texts that `write` makes of the items.
template <typename Items, typename Write>
std::string List(const Items& items, const Write& write)
{
  std::string text = "[";
  for (const auto& item : items)
  {
    text += text.size() > 1 ? "," : "";
    text += write(item);
  }
  return text + "]";
}

inline std::string List(const std::vector<double>& numbers)
{
  return List(numbers, Number);
}

} // namespace SurfaceDiffusion::Json
