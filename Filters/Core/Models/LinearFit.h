// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"
#include "Core/Operators/Assembler.h"
#include "Core/Operators/Rings.h"

#include <vector>

namespace SurfaceDiffusion
{

/// The data of a range of vertices: whole connected components. InputPoints has rows as in
/// TriangleMesh::InputVertex.
struct FitData
{
  const Assembler& Operators;
  const Eigen::Ref<const Points>& InputPoints;
  const Values& Given;
  VertexRange Range;
  Flags Missing; ///< per vertex of the range

  bool IsMissing(Index vertex) const { return this->Missing[vertex - this->Range.Begin] != 0; }
  Rings MakeRings() const { return Rings(this->Operators.Pattern(), this->Range); }
};

/// A linear function, in the tangent plane of a vertex, fitted to known values around it: its value at
/// the vertex is the sum of Weights times the values at Known.
struct LinearFit
{
  std::vector<Index> Known;
  Vector Weights; ///< none if the places do not determine a function
};

/// The fit to the vertices at a distance of `edges` edges that are not missing.
LinearFit FitAround(Index vertex, int edges, Rings& rings, const FitData& data);

/// 1.4826 times the median of absolute deviations: the standard deviation of Gaussian ones. Reorders
/// them.
double RobustDeviation(std::vector<double>& deviations);

} // namespace SurfaceDiffusion
