// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"
#include "Core/Operators/SparsePattern.h"
#include "Core/Surface/TriangleMesh.h"

#include <cstddef>
#include <vector>

namespace SurfaceDiffusion
{

/// The vertices at a distance of a number of edges.
class Rings
{
public:
  explicit Rings(const SparsePattern& pattern)
    : Outer(pattern.Outer.data())
    , Inner(pattern.Inner.data())
    , VisitedBy(static_cast<std::size_t>(pattern.NumberOfRows()), -1)
  {
  }

  const std::vector<Index>& Find(Index centre, int edges)
  {
    this->Ring.assign(1, centre);
    this->VisitedBy[centre] = centre; // each centre is asked for once
    for (int edge = 0; edge < edges; ++edge)
    {
      this->Next.clear();
      for (const Index i : this->Ring)
      {
        for (Index slot = this->Outer[i]; slot < this->Outer[i + 1]; ++slot)
        {
          const Index j = this->Inner[slot];
          if (this->VisitedBy[j] != centre)
          {
            this->VisitedBy[j] = centre;
            this->Next.push_back(j);
          }
        }
      }
      this->Ring.swap(this->Next);
    }
    return this->Ring;
  }

private:
  const Index* Outer;
  const Index* Inner;
  std::vector<Index> VisitedBy, Ring, Next;
};

/// A linear function, in the tangent plane of a vertex, fitted to known values around it: its value at
/// the vertex is the sum of Weights times the values at Known.
struct LinearFit
{
  std::vector<Index> Known;
  Vector Weights; ///< none if the places do not determine a function
};

/// The fit to the vertices at a distance of `edges` edges that are not missing. points: of the input.
LinearFit FitAround(Index vertex, int edges, const TriangleMesh& mesh, Rings& rings,
  const Eigen::Ref<const Points>& points, const Flags& missing);

/// 1.4826 times the median of absolute deviations: the standard deviation of Gaussian ones. Reorders
/// them.
double RobustDeviation(std::vector<double>& deviations);

} // namespace SurfaceDiffusion
