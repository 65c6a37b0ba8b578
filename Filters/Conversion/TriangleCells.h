// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"

#include <cstddef>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

/// The cell of a surface that each of its triangles is, or is a part of.
class TriangleCells
{
public:
  TriangleCells() = default;
  explicit TriangleCells(std::vector<Index> cells)
    : Listed(std::move(cells))
    , Count(this->Listed.size())
  {
  }
  /// Triangles that are cells themselves, `first` and those after it: no list is kept.
  TriangleCells(Index first, Index count)
    : First(first)
    , Count(static_cast<std::size_t>(count))
  {
  }

  std::size_t Size() const { return this->Count; }
  Index operator[](std::size_t t) const
  {
    return this->Listed.empty() ? this->First + static_cast<Index>(t) : this->Listed[t];
  }

private:
  std::vector<Index> Listed;
  Index First = 0;
  std::size_t Count = 0;
};

} // namespace SurfaceDiffusion
