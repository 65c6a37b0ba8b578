// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Reduction.h"
#include "Distributed/InterfaceExchange.h"

#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// The decomposition of a coarse level of multigrid, whose vertices are aggregates of vertices of a
/// finer one.
class CoarseDecomposition : public Reduction
{
public:
  /// finest: that of the surface, which must outlive this one. vertices: the exchange of `finer`.
  /// coarse, count: see Reduction::Coarsened().
  CoarseDecomposition(const Reduction& finest, const Reduction& finer,
    const InterfaceExchange& vertices, const std::vector<Index>& coarse, Index count);

  void Sum(double* numbers, Index count) const override { this->Finest.Sum(numbers, count); }
  void Max(double* numbers, Index count) const override { this->Finest.Max(numbers, count); }
  int Rank() const override { return this->Finest.Rank(); }
  std::vector<double> Gather(const std::vector<double>& here) const override
  {
    return this->Finest.Gather(here);
  }
  void AccumulateInterface(double* rows, Index columns) const override
  {
    this->Vertices.Accumulate(rows, columns);
  }
  void UpdateInterface(double* rows, Index columns) const override
  {
    this->Vertices.Update(rows, columns);
  }
  std::shared_ptr<const Reduction> Coarsened(
    const std::vector<Index>& coarse, Index count) const override
  {
    return std::make_shared<CoarseDecomposition>(
      this->Finest, *this, this->Vertices, coarse, count);
  }

private:
  const Reduction& Finest;
  InterfaceExchange Vertices;
};

} // namespace SurfaceDiffusion
