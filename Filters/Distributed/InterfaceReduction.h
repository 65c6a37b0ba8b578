// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Reduction.h"
#include "Distributed/InterfaceExchange.h"

#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// What the decompositions of a surface and of the coarse levels of multigrid have in common: the
/// exchange of the rows of InterfaceVertices().
class InterfaceReduction : public Reduction
{
public:
  void AccumulateInterface(double* rows, Index columns) const override
  {
    this->Vertices.Accumulate(rows, columns);
  }
  void UpdateInterface(double* rows, Index columns) const override
  {
    this->Vertices.Update(rows, columns);
  }
  std::shared_ptr<const Reduction> Coarsened(
    const std::vector<Index>& coarse, Index count) const override;

protected:
  explicit InterfaceReduction(InterfaceExchange vertices)
    : Reduction(Reduction::Kind::Distributed)
    , Vertices(std::move(vertices))
  {
  }

  /// The decomposition of the surface.
  virtual const Reduction& Finest() const { return *this; }

  InterfaceExchange Vertices;
};

} // namespace SurfaceDiffusion
