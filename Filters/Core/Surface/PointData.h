// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"

#include <memory>
#include <utility>

namespace SurfaceDiffusion
{

struct MeasuredVertices;

/// The data of a model on the vertices of a surface, all finite: values, initial state and
/// Dirichlet conditions. Missing values have been filled in Start; Given is not read at those
/// vertices.
struct PointData
{
  Values Given; ///< f, n x k
  Values Start; ///< u at t = 0, n x k
  Flags Missing; ///< the hole of the data, where chi = 0: no fidelity term
  Flags Fixed; ///< Dirichlet condition: u keeps its Start
  Vector FidelityFactors; ///< w >= 0, by which lambda is multiplied; empty: 1 everywhere
  std::shared_ptr<const MeasuredVertices> Measured; ///< null: the data of all vertices were

  /// w chi at vertex i.
  double FidelityFactor(Index i) const
  {
    if (this->Missing[i])
    {
      return 0.0;
    }
    return this->FidelityFactors.size() > 0 ? this->FidelityFactors[i] : 1.0;
  }

  /// Data that are known everywhere, without Dirichlet conditions.
  static PointData FromValues(Values f)
  {
    PointData data;
    data.Missing = Flags::Constant(f.rows(), false);
    data.Fixed = data.Missing;
    data.Start = f;
    data.Given = std::move(f);
    return data;
  }
};

} // namespace SurfaceDiffusion
