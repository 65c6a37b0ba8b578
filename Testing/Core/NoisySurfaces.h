// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Random.h"
#include "Meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

/// Surfaces with noise, and measures of their distance from those without.
namespace SurfaceDiffusion::Testing
{

/// The closed surface of an L-shaped block of unit cubes: n x n x n without a quarter.
inline Surface LBlock(Index n)
{
  const auto inside = [n](Index x, Index y, Index z)
  {
    const bool inCube = std::min({ x, y, z }) >= 0 && std::max({ x, y, z }) < n;
    return inCube && (x < n / 2 || y < n / 2);
  };
  std::vector<Eigen::RowVector3d> vertices;
  std::vector<std::array<Index, 3>> faces;
  std::map<std::array<Index, 3>, Index> numbers;
  const auto number = [&](const std::array<Index, 3>& corner)
  {
    const auto found = numbers.emplace(corner, static_cast<Index>(vertices.size()));
    if (found.second)
    {
      vertices.emplace_back(corner[0], corner[1], corner[2]);
    }
    return found.first->second;
  };
  const auto addSide = [&](std::array<Index, 3> origin, int axis, bool high)
  {
    origin[axis] += high;
    std::array<Index, 3> a = origin, b = origin, c = origin;
    a[(axis + 1) % 3] += 1;
    b[(axis + 1) % 3] += 1;
    b[(axis + 2) % 3] += 1;
    c[(axis + 2) % 3] += 1;
    std::array<Index, 4> quad{ number(origin), number(a), number(b), number(c) };
    if (!high)
    {
      std::swap(quad[1], quad[3]);
    }
    faces.push_back({ quad[0], quad[1], quad[2] });
    faces.push_back({ quad[0], quad[2], quad[3] });
  };
  for (Index x = 0; x < n; ++x)
  {
    for (Index y = 0; y < n; ++y)
    {
      for (Index z = 0; z < n; ++z)
      {
        for (int axis = 0; axis < 3 && inside(x, y, z); ++axis)
        {
          for (const int step : { -1, 1 })
          {
            std::array<Index, 3> next{ x, y, z };
            next[axis] += step;
            if (!inside(next[0], next[1], next[2]))
            {
              addSide({ x, y, z }, axis, step > 0);
            }
          }
        }
      }
    }
  }
  return MakeSurface(vertices, faces);
}

/// The vector area of a triangle.
inline Eigen::RowVector3d VectorArea(const Surface& s, Index t)
{
  const Eigen::RowVector3d a = s.Vertices.row(s.Faces(t, 0));
  const Eigen::RowVector3d b = s.Vertices.row(s.Faces(t, 1));
  const Eigen::RowVector3d c = s.Vertices.row(s.Faces(t, 2));
  return 0.5 * (b - a).cross(c - a);
}

inline double Volume(const Surface& s)
{
  double volume = 0.0;
  for (Index t = 0; t < s.NumberOfTriangles(); ++t)
  {
    volume += VectorArea(s, t).dot(s.Vertices.row(s.Faces(t, 0))) / 3.0;
  }
  return volume;
}

inline Eigen::RowVector3d FaceNormal(const Surface& s, Index t)
{
  return VectorArea(s, t).normalized();
}

/// Mean angle, in degrees, between the triangles of two surfaces, of those that isOne(t) selects.
template <typename IsOne>
double MeanAngle(const Surface& a, const Surface& b, const IsOne& isOne)
{
  double sum = 0.0;
  Index count = 0;
  for (Index t = 0; t < a.NumberOfTriangles(); ++t)
  {
    if (isOne(t))
    {
      sum += std::acos(std::clamp(FaceNormal(a, t).dot(FaceNormal(b, t)), -1.0, 1.0));
      ++count;
    }
  }
  return sum / count * 180.0 / Pi;
}

inline double MeanAngle(const Surface& a, const Surface& b)
{
  return MeanAngle(a, b, [](Index) { return true; });
}

inline Index NumberOfFlippedFaces(const Surface& s, const Surface& truth)
{
  Index flipped = 0;
  for (Index t = 0; t < s.NumberOfTriangles(); ++t)
  {
    flipped += FaceNormal(s, t).dot(FaceNormal(truth, t)) < 0.0;
  }
  return flipped;
}

/// Gaussian noise of standard deviation `amount`, in mean edge lengths, along the vertex normals,
/// at a random fraction of the vertices.
inline Surface NoisyAlongNormals(Surface s, double amount, double fraction = 1.0)
{
  const TriangleMesh mesh(s.Vertices, s.Faces);
  const double h = mesh.TotalEdgeLength() / mesh.NumberOfEdges() * mesh.LengthUnit();
  Points normals = Points::Zero(s.NumberOfVertices(), 3);
  for (Index t = 0; t < s.NumberOfTriangles(); ++t)
  {
    for (int k = 0; k < 3; ++k)
    {
      normals.row(s.Faces(t, k)) += VectorArea(s, t);
    }
  }
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    const double u = 1.0 - UniformRandom(11, 0, i);
    const double gauss =
      std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * Pi * UniformRandom(11, 1, i));
    if (UniformRandom(11, 2, i) < fraction)
    {
      s.Vertices.row(i) += amount * h * gauss * normals.row(i).normalized();
    }
  }
  return s;
}

/// Where: the share of the waves at a point of the torus.
template <typename Where>
Surface RoughTorus(Index across, const Where& where)
{
  Surface rough = Torus(2 * across, across);
  for (Index i = 0; i < rough.NumberOfVertices(); ++i)
  {
    const Eigen::RowVector3d p = rough.Vertices.row(i);
    const Eigen::RowVector3d centre = 2.0 * Eigen::RowVector3d(p[0], p[1], 0.0).normalized();
    rough.Vertices.row(i) += 0.15 * where(p) * std::sin(7.0 * p[0]) *
      std::cos(6.0 * p[1] + 3.0 * p[2]) * (p - centre).normalized();
  }
  return rough;
}

inline Surface RoughTorus(Index across)
{
  return RoughTorus(across, [](const Eigen::RowVector3d&) { return 1.0; });
}

/// Its waves are in x > 0.
inline Surface HalfRoughTorus(Index across)
{
  return RoughTorus(across, [](const Eigen::RowVector3d& p) { return std::clamp(p[0], 0.0, 1.0); });
}

} // namespace SurfaceDiffusion::Testing
