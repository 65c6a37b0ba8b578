// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Operators/Assembler.h"
#include "Core/Operators/CotanWeights.h"
#include "Core/Surface/TangentVectors.h"

#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace SurfaceDiffusion::Testing
{

inline void Require(bool holds, const char* violated)
{
  if (!holds)
  {
    throw std::logic_error(violated);
  }
}

/// Reads numbers from bytes, and zeros after the last byte.
class Bytes
{
public:
  Bytes(const std::uint8_t* bytes, std::size_t count)
    : Next(bytes)
    , End(bytes + count)
  {
  }
  int Below(int limit) { return this->Byte() % limit; }
  bool Flip(int oneIn = 2) { return this->Below(oneIn) == 1; }
  /// One of a few values in [-1, 1], so that many are equal.
  double Short() { return (this->Byte() - 128) / 128.0; }
  /// A positive number of any size between 10^-span and 10^span.
  double Size(double span) { return std::pow(10.0, span * this->Short()); }

private:
  std::uint8_t Byte() { return this->Next == this->End ? 0 : *this->Next++; }

  const std::uint8_t* Next;
  const std::uint8_t* End;
};

/// Cotangents so large that nothing is left of the numbers to which they are added. Those of an
/// intrinsic triangulation may be small, but it keeps the control areas of the drawn triangles.
inline bool HasFlatTriangles(const TriangleMesh& mesh)
{
  constexpr double large = 1e8;
  Vector areas = Vector::Zero(mesh.NumberOfVertices());
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    for (int a = 0; a < 3; ++a)
    {
      areas[mesh.TriangleVertices()(t, a)] += mesh.Shapes()[t].Area() / 3.0;
    }
  }
  const CornerWeights c = CotanWeights(mesh);
  return (c.size() > 0 && c.cwiseAbs().maxCoeff() > large) ||
    (areas.array() > large * mesh.ControlAreas().array()).any();
}

/// Direction fields and mesh denoising, whose results are not states of a model.
void RunGeometry(Bytes& bytes, const Assembler& assembler, const Points& points,
  const Triangles& triangles, const TangentVectors& frames);

} // namespace SurfaceDiffusion::Testing
