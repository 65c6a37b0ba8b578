// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Statistics/MeasuredVertices.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

/// Per vertex: the measured one that it belongs to; -1 where none can be reached.
std::vector<Index> FindOwners(
  const SparsePattern& pattern, const Points& points, const Flags& isBetween)
{
  const auto comesBefore = [&](Index a, Index b)
  {
    return std::lexicographical_compare(points.row(a).data(), points.row(a).data() + 3,
      points.row(b).data(), points.row(b).data() + 3);
  };
  std::vector<Index> owners(static_cast<std::size_t>(isBetween.size()), -1);
  std::vector<Index> front, next;
  for (Index i = 0; i < static_cast<Index>(isBetween.size()); ++i)
  {
    if (!isBetween[i])
    {
      owners[static_cast<std::size_t>(i)] = i;
      front.push_back(i);
    }
  }
  std::vector<std::pair<Index, Index>> reached; // a vertex and a measured one, of one more edge
  while (!front.empty())
  {
    reached.clear();
    for (const Index i : front)
    {
      for (Index slot = pattern.Outer[i]; slot < pattern.Outer[i + 1]; ++slot)
      {
        const Index j = pattern.Inner[slot];
        if (owners[static_cast<std::size_t>(j)] < 0)
        {
          reached.emplace_back(j, owners[static_cast<std::size_t>(i)]);
        }
      }
    }
    next.clear();
    for (const auto& [vertex, measured] : reached)
    {
      Index& owner = owners[static_cast<std::size_t>(vertex)];
      if (owner < 0)
      {
        next.push_back(vertex);
      }
      owner = owner < 0 || comesBefore(measured, owner) ? measured : owner;
    }
    front.swap(next);
  }
  return owners;
}

} // namespace

MeasuredVertices FindMeasuredVertices(
  const SparsePattern& pattern, const Points& points, Flags isBetween)
{
  const std::vector<Index> owners = FindOwners(pattern, points, isBetween);
  std::vector<std::array<Index, 2>> pairs;
  for (Index i = 0; i < pattern.NumberOfRows(); ++i)
  {
    const Index owner = owners[static_cast<std::size_t>(i)];
    for (Index slot = pattern.Outer[i]; owner >= 0 && slot < pattern.Outer[i + 1]; ++slot)
    {
      const Index other = owners[static_cast<std::size_t>(pattern.Inner[slot])];
      if (other >= 0 && other != owner)
      {
        pairs.push_back({ owner, other });
      }
    }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  MeasuredVertices measured;
  measured.IsBetween = std::move(isBetween);
  measured.Neighbours.Outer.assign(static_cast<std::size_t>(pattern.NumberOfRows()) + 1, 0);
  measured.Neighbours.Inner = Buffer<Index>(pairs.size());
  for (std::size_t k = 0; k < pairs.size(); ++k)
  {
    ++measured.Neighbours.Outer[static_cast<std::size_t>(pairs[k][0]) + 1];
    measured.Neighbours.Inner[k] = pairs[k][1];
  }
  for (std::size_t i = 1; i < measured.Neighbours.Outer.size(); ++i)
  {
    measured.Neighbours.Outer[i] += measured.Neighbours.Outer[i - 1];
  }
  return measured;
}

} // namespace SurfaceDiffusion
