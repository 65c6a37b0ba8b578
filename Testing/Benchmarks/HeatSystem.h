// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "MeshFiles.h"
#include "Meshes.h"

#include "Core/Operators/Assembler.h"
#include "Core/Operators/CotanWeights.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <map>
#include <memory>
#include <utility>
#include <vector>

/// Surfaces and matrices of the benchmarks of linear diffusion.
namespace SurfaceDiffusion::Testing
{

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

/// One scanned surface with sizes that grow by a factor of four. Levels 0 to 4 have 11,112; 44,460;
/// 177,852; 711,420; 2,845,692 vertices. Without mesh files: icospheres of 10,242 to 2,621,442.
inline const Surface& SurfaceOfLevel(int level)
{
  static std::map<int, Surface> surfaces;
  auto found = surfaces.find(level);
  if (found == surfaces.end())
  {
    const Surface s = !HaveMeshFiles() ? Icosphere(5 + level)
      : level == 0                     ? Subdivided(ReadMeshFile("elephant"), 1)
                                       : Subdivided(ReadMeshFile("refined_elephant"), level - 1);
    found = surfaces.emplace(level, s).first;
  }
  return found->second;
}

/// The system of a backward Euler step with dt = number h^2, where h is the mean edge length.
struct HeatSystem
{
  std::shared_ptr<const TriangleMesh> Mesh;
  std::shared_ptr<const Assembler> Operators;
  CornerWeights Coefficients;
  SparseMatrix Matrix;

  explicit HeatSystem(const Surface& s) // the values of Matrix are zero
    : Mesh(MakeMesh(s))
    , Operators(std::make_shared<Assembler>(this->Mesh))
    , Coefficients(CotanWeights(*this->Mesh))
    , Matrix(ZeroMatrix(this->Operators->Pattern()))
  {
  }

  HeatSystem(const Surface& s, double number)
    : HeatSystem(s)
  {
    this->SetDiffusionNumber(number);
  }

  void SetDiffusionNumber(double number)
  {
    const double h = this->Mesh->TotalEdgeLength() / this->Mesh->NumberOfEdges();
    this->Operators->Fill(
      this->Matrix, this->Mesh->ControlAreas(), number * h * h, this->Coefficients);
  }

  Values RightHandSide(const Values& u) const
  {
    return this->Mesh->ControlAreas().asDiagonal() * u;
  }
};

inline void CountVertices(benchmark::State& state, double vertices)
{
  state.counters["vertices"] = vertices;
  state.counters["ns/vertex"] = benchmark::Counter(
    vertices * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// Counts the minimum memory traffic of an iteration.
inline void CountBytes(benchmark::State& state, double bytes)
{
  state.counters["bytes"] = bytes;
  state.counters["GB/s"] =
    benchmark::Counter(bytes * 1e-9, benchmark::Counter::kIsIterationInvariantRate);
}

/// The minimum memory traffic of a product with `columns` columns: the matrix once, each vector
/// once.
inline double BytesOfProduct(const SparseMatrix& matrix, double columns)
{
  return 12.0 * static_cast<double>(matrix.nonZeros()) +
    (4.0 + 16.0 * columns) * static_cast<double>(matrix.rows());
}

} // namespace SurfaceDiffusion::Testing
