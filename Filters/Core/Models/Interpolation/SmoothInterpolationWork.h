// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Interpolation/SmoothFit.h"
#include "Core/Models/Interpolation/SmoothInterpolation.h"
#include "Core/Solvers/NestedDissection.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace SurfaceDiffusion
{

/// What a fit needs beside the settings.
struct SmoothInterpolation::Work
{
  Work(const Assembler& assembler, const CornerWeights& coefficients, const Settings& settings,
    const ScatteredValues& values, const ParallelFor& parallel)
    : Data(values)
    , Energy(assembler, coefficients, settings.Kappa, settings.Rim, parallel)
    , Fit(Energy, Data.Rows, IsRegularMesh(assembler), parallel)
  {
  }

  static bool IsRegularMesh(const Assembler& assembler)
  {
    return IsRegular(ZeroMatrix(assembler.Pattern()));
  }

  /// mu beyond which the mean of the values is lost in the last digits of mu Q. Functions without
  /// energy are all that is left long before.
  double LargestSmoothing() const
  {
    constexpr double resolved = 1e-13;
    // Of an energy that no function has, round-off of any sign is left.
    const double energy = this->Energy.Matrix().diagonal().cwiseAbs().sum();
    return this->Data.Rows.Weights.sum() / (resolved * energy);
  }

  /// The component of a value.
  Index ComponentOf(Index row) const
  {
    return this->Component[this->Data.Rows.Places[row].Vertices[0]];
  }

  /// The largest magnitude of the values of a column.
  double SizeOf(Eigen::Index column) const
  {
    double size = 0.0;
    for (Index i = 0; i < this->Data.Rows.Count(); ++i)
    {
      const double given = this->Data.Rows.Given(i, column);
      size = std::max(size, std::abs(given + this->Origin(this->ComponentOf(i), column)));
    }
    return size;
  }

  MergedValues Data;
  SmoothnessEnergy Energy;
  SmoothFit Fit;
  Flags Open; ///< vertices of components without values, which are held at zero
  Index Parts = 0; ///< components with values
  double Area = 0.0; ///< of these components
  std::vector<Index> Component; ///< of each vertex
  Values Origin; ///< per component, from which values are measured
  Vector Weights; ///< of all values of a component
  Eigen::RowVectorXd Lowest, Highest; ///< of the values of a column
  Values Start;
  /// w^T B Q^-1 B^T w per component, for the weights w of the mean of its values; no entries: not known
  Vector EnergyOfMean;
};

} // namespace SurfaceDiffusion
