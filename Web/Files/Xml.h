// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Files/Content.h"

#include <utility>

namespace SurfaceDiffusion::Files
{

/// Goes through the tags of XML without a tree of them: files of one level may have millions. What a
/// document declares of itself, such as entities, has no effect.
class XmlReader
{
public:
  explicit XmlReader(std::string_view text)
    : All(text)
  {
  }

  /// Go to the next tag; false at the end. An empty element has two tags. Throws FileError.
  bool Next();
  bool IsEnd() const { return this->Ends; }
  std::string_view Name() const { return this->TagName; } ///< without prefix
  /// Empty if there is none.
  std::string Attribute(std::string_view name) const;
  /// Text or a section of CDATA between the last tag and this one.
  std::string_view Text() const { return this->Between; }
  /// What follows this tag.
  std::string_view Rest() const { return this->All.substr(this->Place); }

  /// Text with entities in place of signs as it is meant.
  static std::string Plain(std::string_view text);
  /// The reverse, for text and attributes.
  static std::string Escaped(std::string_view text);

private:
  void ReadTag();

  std::string_view All;
  std::size_t Place = 0;
  std::string_view TagName, Between;
  std::vector<std::pair<std::string_view, std::string_view>> Attributes;
  bool Ends = false, IsEmpty = false;
};

} // namespace SurfaceDiffusion::Files
