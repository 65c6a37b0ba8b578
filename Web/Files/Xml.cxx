// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Files/Xml.h"

#include <algorithm>

namespace SurfaceDiffusion::Files
{

namespace
{

bool IsSpace(char c)
{
  return c == ' ' || (c >= '\t' && c <= '\r');
}

} // namespace

bool XmlReader::Next()
{
  if (this->IsEmpty)
  {
    this->IsEmpty = false;
    this->Ends = true;
    this->Between = {};
    return true;
  }
  this->Between = {};
  const std::string_view text = this->All;
  while (true)
  {
    const std::size_t open = text.find('<', this->Place);
    if (this->Between.find_first_not_of(" \t\r\n") == std::string_view::npos)
    {
      this->Between = text.substr(this->Place, open - this->Place);
    }
    if (open == std::string_view::npos)
    {
      return false;
    }
    this->Place = open;
    const auto skip = [&](std::string_view start, std::string_view end)
    {
      if (text.substr(open, start.size()) != start)
      {
        return false;
      }
      const std::size_t found = text.find(end, open + start.size());
      if (found == std::string_view::npos)
      {
        throw FileError("its XML ends too early");
      }
      if (start == "<![CDATA[")
      {
        this->Between = text.substr(open + start.size(), found - open - start.size());
      }
      this->Place = found + end.size();
      return true;
    };
    if (!skip("<!--", "-->") && !skip("<![CDATA[", "]]>") && !skip("<?", "?>") && !skip("<!", ">"))
    {
      this->ReadTag();
      return true;
    }
  }
}

void XmlReader::ReadTag()
{
  const std::string_view text = this->All;
  std::size_t at = this->Place + 1;
  const auto peek = [&]() { return at < text.size() ? text[at] : '\0'; };
  const auto skipSpace = [&]
  {
    while (IsSpace(peek()))
    {
      ++at;
    }
  };
  const auto readName = [&]
  {
    const std::size_t start = at;
    while (at < text.size() && !IsSpace(text[at]) && text[at] != '>' && text[at] != '/' &&
      text[at] != '=')
    {
      ++at;
    }
    return text.substr(start, at - start);
  };
  this->Ends = peek() == '/';
  at += this->Ends ? 1 : 0;
  this->TagName = readName();
  this->TagName.remove_prefix(std::min(this->TagName.find(':') + 1, this->TagName.size()));
  this->Attributes.clear();
  while (true)
  {
    skipSpace();
    if (peek() == '>')
    {
      this->Place = at + 1;
      return;
    }
    if (peek() == '/' && at + 1 < text.size() && text[at + 1] == '>')
    {
      this->IsEmpty = true;
      this->Place = at + 2;
      return;
    }
    const std::string_view name = readName();
    skipSpace();
    const bool isPair = peek() == '=';
    at += isPair ? 1 : 0;
    skipSpace();
    const char quote = peek();
    const std::size_t end =
      isPair && (quote == '"' || quote == '\'') ? text.find(quote, at + 1) : std::string_view::npos;
    if (name.empty() || end == std::string_view::npos)
    {
      throw FileError("its XML is damaged after " + Quote(this->TagName));
    }
    this->Attributes.emplace_back(name, text.substr(at + 1, end - at - 1));
    at = end + 1;
  }
}

std::string XmlReader::Attribute(std::string_view name) const
{
  for (const auto& [key, value] : this->Attributes)
  {
    if (key == name)
    {
      return Plain(value);
    }
  }
  return {};
}

std::string XmlReader::Plain(std::string_view text)
{
  constexpr std::pair<std::string_view, char> entities[] = { { "&lt;", '<' }, { "&gt;", '>' },
    { "&quot;", '"' }, { "&apos;", '\'' }, { "&amp;", '&' }, { "&#10;", '\n' }, { "&#9;", '\t' } };
  std::string plain;
  for (std::size_t at = 0; at < text.size();)
  {
    const auto found = std::find_if(std::begin(entities), std::end(entities),
      [&](const auto& entity) { return text.substr(at, entity.first.size()) == entity.first; });
    const bool isEntity = found != std::end(entities);
    plain += isEntity ? found->second : text[at];
    at += isEntity ? found->first.size() : 1;
  }
  return plain;
}

std::string XmlReader::Escaped(std::string_view text)
{
  std::string escaped;
  for (const char c : text)
  {
    switch (c)
    {
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '&':
        escaped += "&amp;";
        break;
      default:
        escaped += static_cast<unsigned char>(c) < 32 ? ' ' : c;
    }
  }
  return escaped;
}

} // namespace SurfaceDiffusion::Files
