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
