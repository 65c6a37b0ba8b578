// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Random.h"
#include "Core/Operators/Assembler.h"
#include "Core/Surface/TriangleMesh.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

/// Surfaces with known solutions, for the tests of the core.
namespace SurfaceDiffusion::Testing
{

const double Pi = std::acos(-1.0);

/// The input of a TriangleMesh.
struct Surface
{
  Points Vertices;
  Triangles Faces;

  Index NumberOfVertices() const { return static_cast<Index>(this->Vertices.rows()); }
  Index NumberOfTriangles() const { return static_cast<Index>(this->Faces.rows()); }
};

inline Surface MakeSurface(
  const std::vector<Eigen::RowVector3d>& vertices, const std::vector<std::array<Index, 3>>& faces)
{
  Surface s{ Points(vertices.size(), 3), Triangles(faces.size(), 3) };
  for (std::size_t i = 0; i < vertices.size(); ++i)
  {
    s.Vertices.row(static_cast<Eigen::Index>(i)) = vertices[i];
  }
  for (std::size_t t = 0; t < faces.size(); ++t)
  {
    s.Faces.row(static_cast<Eigen::Index>(t)) << faces[t][0], faces[t][1], faces[t][2];
  }
  return s;
}

// --- Changes of a surface ---

inline Surface Scaled(Surface s, double factor)
{
  s.Vertices *= factor;
  return s;
}

inline Surface Moved(Surface s, const Eigen::RowVector3d& offset)
{
  s.Vertices.rowwise() += offset;
  return s;
}

/// Rotated about a skew axis, so that no edge is parallel to a coordinate axis.
inline Surface Rotated(Surface s, double angle = 1.0)
{
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(angle, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
  s.Vertices = (s.Vertices * turn.transpose()).eval();
  return s;
}

/// All triangles with the opposite orientation.
inline Surface Flipped(Surface s)
{
  s.Faces.col(1).swap(s.Faces.col(2));
  return s;
}

/// Two surfaces side by side in one list.
inline Surface Joined(const Surface& a, const Surface& b)
{
  Surface s{ Points(a.Vertices.rows() + b.Vertices.rows(), 3),
    Triangles(a.Faces.rows() + b.Faces.rows(), 3) };
  s.Vertices << a.Vertices, b.Vertices;
  s.Faces << a.Faces, (b.Faces.array() + a.NumberOfVertices()).matrix();
  return s;
}

/// A permutation of 0 .. count - 1: the same for the same seed everywhere.
inline std::vector<Index> Permutation(Index count, std::int64_t seed)
{
  std::vector<Index> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
    [&](Index a, Index b) { return UniformRandom(seed, 0, a) < UniformRandom(seed, 0, b); });
  return order;
}

/// Vertex i of `s` becomes vertex numbers[i]; the triangles are permuted and their corners
/// rotated.
inline Surface Renumbered(const Surface& s, const std::vector<Index>& numbers)
{
  Surface result = s;
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    result.Vertices.row(numbers[i]) = s.Vertices.row(i);
  }
  const std::vector<Index> place = Permutation(s.NumberOfTriangles(), 99);
  for (Index t = 0; t < s.NumberOfTriangles(); ++t)
  {
    for (int a = 0; a < 3; ++a)
    {
      result.Faces(place[t], a) = numbers[s.Faces(t, (a + t) % 3)];
    }
  }
  return result;
}

// --- Closed surfaces ---

/// Icosahedron, every edge halved `subdivisions` times, pushed out to the sphere and rotated:
/// 10 4^s + 2 vertices, edges about 1.2 radius / 2^s.
inline Surface Icosphere(int subdivisions, double radius = 1.0)
{
  const double g = 0.5 * (1.0 + std::sqrt(5.0));
  std::vector<Eigen::RowVector3d> vertices = { { -1, g, 0 }, { 1, g, 0 }, { -1, -g, 0 },
    { 1, -g, 0 }, { 0, -1, g }, { 0, 1, g }, { 0, -1, -g }, { 0, 1, -g }, { g, 0, -1 }, { g, 0, 1 },
    { -g, 0, -1 }, { -g, 0, 1 } };
  std::vector<std::array<Index, 3>> faces = { { 0, 11, 5 }, { 0, 5, 1 }, { 0, 1, 7 }, { 0, 7, 10 },
    { 0, 10, 11 }, { 1, 5, 9 }, { 5, 11, 4 }, { 11, 10, 2 }, { 10, 7, 6 }, { 7, 1, 8 }, { 3, 9, 4 },
    { 3, 4, 2 }, { 3, 2, 6 }, { 3, 6, 8 }, { 3, 8, 9 }, { 4, 9, 5 }, { 2, 4, 11 }, { 6, 2, 10 },
    { 8, 6, 7 }, { 9, 8, 1 } };
  for (auto& v : vertices)
  {
    v *= radius / v.norm();
  }
  for (int s = 0; s < subdivisions; ++s)
  {
    std::map<std::pair<Index, Index>, Index> middles;
    const auto middle = [&](Index a, Index b)
    {
      const auto found = middles.emplace(std::minmax(a, b), static_cast<Index>(vertices.size()));
      if (found.second)
      {
        const Eigen::RowVector3d sum = vertices[a] + vertices[b];
        vertices.push_back(sum * (radius / sum.norm()));
      }
      return found.first->second;
    };
    std::vector<std::array<Index, 3>> finer;
    finer.reserve(4 * faces.size());
    for (const auto& f : faces)
    {
      const Index a = middle(f[1], f[2]), b = middle(f[2], f[0]), c = middle(f[0], f[1]);
      finer.insert(finer.end(), { { f[0], c, b }, { c, f[1], a }, { b, a, f[2] }, { a, b, c } });
    }
    faces.swap(finer);
  }
  return Rotated(MakeSurface(vertices, faces));
}

/// Vertices of a grid of columns x rows cells, (columns + 1)(rows + 1) of them, row by row; each
/// cell cut along alternating diagonals.
inline std::vector<std::array<Index, 3>> GridFaces(Index columns, Index rows)
{
  std::vector<std::array<Index, 3>> faces;
  for (Index j = 0; j < rows; ++j)
  {
    for (Index i = 0; i < columns; ++i)
    {
      const Index a = j * (columns + 1) + i, b = a + 1, c = a + columns + 1, d = c + 1;
      if ((i + j) % 2 == 0)
      {
        faces.insert(faces.end(), { { a, b, d }, { a, d, c } });
      }
      else
      {
        faces.insert(faces.end(), { { a, b, c }, { b, d, c } });
      }
    }
  }
  return faces;
}

/// Replace vertex numbers, to glue the borders of a grid together.
inline void Renumber(std::vector<std::array<Index, 3>>& faces, const std::vector<Index>& number)
{
  for (auto& f : faces)
  {
    for (Index& v : f)
    {
      v = number[v];
    }
  }
}

/// The surface with every edge bisected, `times` times. The geometry is unchanged.
inline Surface Subdivided(Surface s, int times)
{
  for (; times > 0; --times)
  {
    const Index n = s.NumberOfVertices();
    std::vector<std::pair<Index, Index>> edges;
    edges.reserve(3 * static_cast<std::size_t>(s.NumberOfTriangles()));
    const auto edge = [&](Index t, int a) {
      return std::minmax({ s.Faces(t, (a + 1) % 3), s.Faces(t, (a + 2) % 3) });
    };
    for (Index t = 0; t < s.NumberOfTriangles(); ++t)
    {
      for (int a = 0; a < 3; ++a)
      {
        edges.push_back(edge(t, a));
      }
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    Surface finer{ Points(n + edges.size(), 3), Triangles(4 * s.NumberOfTriangles(), 3) };
    finer.Vertices.topRows(n) = s.Vertices;
    for (std::size_t e = 0; e < edges.size(); ++e)
    {
      finer.Vertices.row(n + static_cast<Index>(e)) =
        0.5 * (s.Vertices.row(edges[e].first) + s.Vertices.row(edges[e].second));
    }
    for (Index t = 0; t < s.NumberOfTriangles(); ++t)
    {
      Index m[3];
      for (int a = 0; a < 3; ++a)
      {
        m[a] = n +
          static_cast<Index>(
            std::lower_bound(edges.begin(), edges.end(), edge(t, a)) - edges.begin());
      }
      const auto f = s.Faces.row(t);
      finer.Faces.row(4 * t) << f[0], m[2], m[1];
      finer.Faces.row(4 * t + 1) << m[2], f[1], m[0];
      finer.Faces.row(4 * t + 2) << m[1], m[0], f[2];
      finer.Faces.row(4 * t + 3) << m[0], m[1], m[2];
    }
    s = std::move(finer);
  }
  return s;
}

/// Torus about the z axis: genus 1. around and across must be even.
inline Surface Torus(Index around, Index across, double majorRadius = 2.0, double minorRadius = 1.0)
{
  std::vector<Eigen::RowVector3d> vertices;
  std::vector<Index> number;
  for (Index j = 0; j <= across; ++j)
  {
    for (Index i = 0; i <= around; ++i)
    {
      number.push_back((j % across) * around + i % around);
      if (i < around && j < across)
      {
        const double p = 2.0 * Pi * i / around, q = 2.0 * Pi * j / across;
        const double r = majorRadius + minorRadius * std::cos(q);
        vertices.emplace_back(r * std::cos(p), r * std::sin(p), minorRadius * std::sin(q));
      }
    }
  }
  auto faces = GridFaces(around, across);
  Renumber(faces, number);
  return MakeSurface(vertices, faces);
}

/// Four triangles: the smallest closed surface.
inline Surface Tetrahedron()
{
  return MakeSurface({ { 1, 1, 1 }, { 1, -1, -1 }, { -1, 1, -1 }, { -1, -1, 1 } },
    { { 0, 1, 2 }, { 0, 3, 1 }, { 0, 2, 3 }, { 1, 3, 2 } });
}

// --- Open surfaces ---

/// The rectangle [0, length] x [0, width] in the plane z = 0.
inline Surface Strip(Index columns, Index rows, double length = 1.0, double width = 1.0)
{
  std::vector<Eigen::RowVector3d> vertices;
  for (Index j = 0; j <= rows; ++j)
  {
    for (Index i = 0; i <= columns; ++i)
    {
      vertices.emplace_back(length * i / columns, width * j / rows, 0.0);
    }
  }
  return MakeSurface(vertices, GridFaces(columns, rows));
}

/// The square [-half, half]^2 in the plane z = 0, cells x cells.
inline Surface Plate(Index cells, double half)
{
  return Moved(Strip(cells, cells, 2.0 * half, 2.0 * half), { -half, -half, 0.0 });
}

/// Triangulated disk about the origin: `rings` rings, ring r with 6 r vertices.
inline Surface Disk(Index rings, double radius = 1.0)
{
  std::vector<Eigen::RowVector3d> vertices = { { 0, 0, 0 } };
  std::vector<std::array<Index, 3>> faces;
  Index inner = 0;
  for (Index r = 1; r <= rings; ++r)
  {
    const Index outer = static_cast<Index>(vertices.size());
    for (Index i = 0; i < 6 * r; ++i)
    {
      const double angle = 2.0 * Pi * i / (6.0 * r);
      vertices.emplace_back(
        radius * r / rings * std::cos(angle), radius * r / rings * std::sin(angle), 0.0);
    }
    for (Index sector = 0; sector < 6; ++sector)
    {
      for (Index i = 0; i < r; ++i)
      {
        const Index o = outer + (sector * r + i) % (6 * r);
        const Index oNext = outer + (sector * r + i + 1) % (6 * r);
        const auto onInner = [&](Index j)
        { return r == 1 ? 0 : inner + (sector * (r - 1) + j) % (6 * (r - 1)); };
        faces.push_back({ o, oNext, onInner(i) });
        if (i + 1 < r)
        {
          faces.push_back({ onInner(i), oNext, onInner(i + 1) });
        }
      }
    }
    inner = outer;
  }
  return MakeSurface(vertices, faces);
}

/// Open cylinder about the z axis, 0 <= z <= length. around must be even.
inline Surface Cylinder(Index around, Index along, double radius = 1.0, double length = 2.0)
{
  std::vector<Eigen::RowVector3d> vertices;
  std::vector<Index> number;
  for (Index j = 0; j <= along; ++j)
  {
    for (Index i = 0; i <= around; ++i)
    {
      number.push_back(j * around + i % around);
      if (i < around)
      {
        const double p = 2.0 * Pi * i / around;
        vertices.emplace_back(radius * std::cos(p), radius * std::sin(p), length * j / along);
      }
    }
  }
  auto faces = GridFaces(around, along);
  Renumber(faces, number);
  return MakeSurface(vertices, faces);
}

/// Moebius band: one-sided, so that no consistent orientation exists.
inline Surface Moebius(Index around, Index across, double radius = 2.0, double halfWidth = 0.5)
{
  std::vector<Eigen::RowVector3d> vertices;
  std::vector<Index> number;
  for (Index j = 0; j <= across; ++j)
  {
    for (Index i = 0; i <= around; ++i)
    {
      number.push_back(i < around ? j * around + i : (across - j) * around);
      if (i < around)
      {
        const double p = 2.0 * Pi * i / around;
        const double w = halfWidth * (2.0 * j / across - 1.0);
        const double r = radius + w * std::cos(0.5 * p);
        vertices.emplace_back(r * std::cos(p), r * std::sin(p), w * std::sin(0.5 * p));
      }
    }
  }
  auto faces = GridFaces(around, across);
  Renumber(faces, number);
  return MakeSurface(vertices, faces);
}

/// Three unit half-plates on one common line of `cells` edges: as many non-manifold edges.
inline Surface ThreeFins(Index cells)
{
  std::vector<Eigen::RowVector3d> vertices;
  std::vector<std::array<Index, 3>> faces;
  for (int fin = 0; fin < 3; ++fin)
  {
    const double angle = 2.0 * Pi * fin / 3.0;
    std::vector<Index> number;
    for (Index j = 0; j <= cells; ++j)
    {
      for (Index i = 0; i <= cells; ++i)
      {
        const double x = static_cast<double>(i) / cells;
        const double y = static_cast<double>(j) / cells;
        number.push_back(j == 0 && fin > 0 ? i : static_cast<Index>(vertices.size()));
        if (number.back() == static_cast<Index>(vertices.size()))
        {
          vertices.emplace_back(x, y * std::cos(angle), y * std::sin(angle));
        }
      }
    }
    auto sheet = GridFaces(cells, cells);
    Renumber(sheet, number);
    faces.insert(faces.end(), sheet.begin(), sheet.end());
  }
  return MakeSurface(vertices, faces);
}

/// Inner vertices of a flat surface moved within its plane by up to `amount`: irregular, partly
/// obtuse triangles.
inline Surface Jittered(Surface s, double amount, double xLow, double xHigh, double yLow,
  double yHigh, std::int64_t seed = 1)
{
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    auto v = s.Vertices.row(i);
    if (v[0] > xLow && v[0] < xHigh && v[1] > yLow && v[1] < yHigh)
    {
      v[0] += amount * (2.0 * UniformRandom(seed, 0, i) - 1.0);
      v[1] += amount * (2.0 * UniformRandom(seed, 1, i) - 1.0);
    }
  }
  return s;
}

// --- Meshes and fields on them ---

inline std::shared_ptr<const TriangleMesh> MakeMesh(const Surface& s)
{
  return std::make_shared<TriangleMesh>(s.Vertices, s.Faces);
}

inline std::shared_ptr<const Assembler> MakeAssembler(const Surface& s)
{
  return std::make_shared<Assembler>(MakeMesh(s));
}

/// f(x) at the vertices of the mesh, one column; f takes a row of three coordinates.
template <typename F>
Values Sample(const TriangleMesh& mesh, const Surface& s, const F& f)
{
  Values u(mesh.NumberOfVertices(), 1);
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    u(i, 0) = f(Eigen::RowVector3d(s.Vertices.row(mesh.InputVertex()[i])));
  }
  return u;
}

/// Uniform random numbers in [-1, 1), tied to the input's numbering.
inline Values Noise(const TriangleMesh& mesh, Eigen::Index columns = 1, std::int64_t seed = 7)
{
  Values u(mesh.NumberOfVertices(), columns);
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    for (Eigen::Index k = 0; k < columns; ++k)
    {
      u(i, k) = 2.0 * UniformRandom(seed, k, mesh.InputVertex()[i]) - 1.0;
    }
  }
  return u;
}

/// Rows back in the numbering of the surface; vertices that are not in the mesh are 0.
inline Values ToInput(const TriangleMesh& mesh, const Values& u, Index inputCount)
{
  Values result = Values::Zero(inputCount, u.cols());
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    result.row(mesh.InputVertex()[i]) = u.row(i);
  }
  return result;
}

/// Root of the area-weighted mean square of u.
inline double RootMeanSquare(const TriangleMesh& mesh, const Values& u)
{
  const Vector& areas = mesh.ControlAreas();
  return std::sqrt(areas.dot(u.rowwise().squaredNorm()) / areas.sum());
}

/// Order of convergence between two errors when the step shrinks by `factor`.
inline double ObservedOrder(double coarseError, double fineError, double factor = 2.0)
{
  return std::log(coarseError / fineError) / std::log(factor);
}

/// The mean edge length, in coordinate units over LengthUnit().
inline double MeanEdge(const TriangleMesh& mesh)
{
  return mesh.TotalEdgeLength() / mesh.NumberOfEdges();
}

} // namespace SurfaceDiffusion::Testing
