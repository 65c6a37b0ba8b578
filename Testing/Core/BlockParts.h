// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Meshes.h"

#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

/// Parts made of cubes, with the large triangles of CAD, and measures of surfaces.
namespace SurfaceDiffusion::Testing
{

using Block = std::array<int, 3>;

/// The boundary of unit cubes at whole places, two triangles per square, oriented outwards. Squares
/// between two cubes are left out, and vertices are shared.
inline Surface BlockPart(const std::set<Block>& blocks)
{
  std::vector<Eigen::RowVector3d> vertices;
  std::vector<std::array<Index, 3>> faces;
  std::map<Block, Index> numbers;
  const auto number = [&](const Block& place)
  {
    const auto found = numbers.emplace(place, static_cast<Index>(vertices.size()));
    if (found.second)
    {
      vertices.emplace_back(place[0], place[1], place[2]);
    }
    return found.first->second;
  };
  for (const Block& block : blocks)
  {
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      for (const int side : { 0, 1 })
      {
        Block beyond = block;
        beyond[axis] += 2 * side - 1;
        if (blocks.count(beyond) > 0)
        {
          continue;
        }
        std::array<Index, 4> corners{};
        for (std::size_t c = 0; c < 4; ++c)
        {
          Block place = block;
          place[axis] += side;
          place[(axis + 1) % 3] += c == 1 || c == 2;
          place[(axis + 2) % 3] += c >= 2;
          corners[c] = number(place);
        }
        if (side == 0)
        {
          std::swap(corners[1], corners[3]);
        }
        faces.push_back({ corners[0], corners[1], corners[2] });
        faces.push_back({ corners[0], corners[2], corners[3] });
      }
    }
  }
  return MakeSurface(vertices, faces);
}

inline Surface Cube(double size = 1.0)
{
  return Scaled(BlockPart({ { 0, 0, 0 } }), size);
}

/// A square with a square hole through it: genus 1.
inline Surface Frame()
{
  std::set<Block> blocks;
  for (int i = 0; i < 9; ++i)
  {
    blocks.insert({ i % 3, i / 3, 0 });
  }
  blocks.erase({ 1, 1, 0 });
  return BlockPart(blocks);
}

/// Two legs at a right angle, with one inner edge.
inline Surface Bracket()
{
  return BlockPart({ { 0, 0, 0 }, { 1, 0, 0 }, { 2, 0, 0 }, { 0, 1, 0 }, { 0, 2, 0 } });
}

/// A closed cylinder as CAD writes it: the sides as needles over the whole height, and caps that
/// are fans from a corner.
inline Surface ClosedCylinder(Index around, double radius, double height)
{
  std::vector<Eigen::RowVector3d> vertices;
  for (Index i = 0; i < 2 * around; ++i)
  {
    const double angle = 2.0 * Pi * (i % around) / around;
    vertices.emplace_back(
      radius * std::cos(angle), radius * std::sin(angle), i < around ? 0.0 : height);
  }
  std::vector<std::array<Index, 3>> faces;
  for (Index i = 0; i < around; ++i)
  {
    const Index next = (i + 1) % around;
    faces.push_back({ i, next, around + next });
    faces.push_back({ i, around + next, around + i });
  }
  for (Index i = 1; i + 1 < around; ++i)
  {
    faces.push_back({ 0, i + 1, i });
    faces.push_back({ around, around + i, around + i + 1 });
  }
  return MakeSurface(vertices, faces);
}

inline double AreaOf(const Points& points, const Triangles& faces)
{
  long double area = 0.0L; // of many terms, whose rounding would add up
  for (Eigen::Index t = 0; t < faces.rows(); ++t)
  {
    const Eigen::RowVector3d a = points.row(faces(t, 0));
    const Eigen::RowVector3d u = points.row(faces(t, 1)) - a;
    const Eigen::RowVector3d v = points.row(faces(t, 2)) - a;
    area += 0.5 * u.cross(v).norm();
  }
  return static_cast<double>(area);
}

inline double VolumeOf(const Points& points, const Triangles& faces)
{
  long double volume = 0.0L;
  const Eigen::RowVector3d center = points.colwise().mean();
  for (Eigen::Index t = 0; t < faces.rows(); ++t)
  {
    const Eigen::RowVector3d a = points.row(faces(t, 0)) - center;
    const Eigen::RowVector3d b = points.row(faces(t, 1)) - center;
    const Eigen::RowVector3d c = points.row(faces(t, 2)) - center;
    volume += a.dot(b.cross(c)) / 6.0;
  }
  return static_cast<double>(volume);
}

/// Per edge the number of its triangles.
inline std::map<std::pair<Index, Index>, int> EdgesOf(const Triangles& faces)
{
  std::map<std::pair<Index, Index>, int> edges;
  for (Eigen::Index t = 0; t < faces.rows(); ++t)
  {
    for (int a = 0; a < 3; ++a)
    {
      ++edges[std::minmax({ faces(t, a), faces(t, (a + 1) % 3) })];
    }
  }
  return edges;
}

} // namespace SurfaceDiffusion::Testing
