// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Interpolation/InfluenceSpectrum.h"
#include "Core/Models/Interpolation/SmoothFit.h"
#include "Core/Models/Interpolation/SmoothInterpolation.h"
#include "Core/Solvers/NestedDissection.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace SurfaceDiffusion
{

/// What the fit of a connected component needs beside the settings.
struct SmoothInterpolation::Work
{
  Work(const Assembler& assembler, const CornerWeights& coefficients, const Settings& settings,
    const RepeatedValues& values, const ParallelFor& parallel)
    : Rows(values)
    , Energy(assembler, coefficients, settings.Kappa, settings.Rim, parallel)
    , Fit(Energy, Rows, IsRegularMesh(assembler), parallel)
    , Area(assembler.Mesh().ControlAreas().sum())
    , None(Flags::Constant(assembler.Mesh().NumberOfVertices(), false))
    , TotalWeight(values.Weights.sum())
  {
    // Values are measured from their mean: the errors of a solve are relative to the contrast then.
    this->Origin = Eigen::RowVectorXd::Zero(values.Given.cols());
    for (Index i = 0; i < values.Count(); ++i)
    {
      this->Origin += values.Weights[i] / this->TotalWeight * values.Given.row(i);
    }
    this->Rows.Given.rowwise() -= this->Origin;
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
    // Tension is little beside the values.
    const double bend = std::max(resolved * energy, 1e5 * this->Energy.GetTension());
    return this->TotalWeight / bend;
  }

  /// What is round-off of a column: `share` of its largest magnitude or, if it comes from functions
  /// that the energy or the tension all but lets free, of its contrast.
  double RoundOff(Eigen::Index column, double share, bool isOfFree) const
  {
    const auto values = this->Rows.Given.col(column).array();
    return std::max(share * (values + this->Origin[column]).abs().maxCoeff(),
      isOfFree ? 1e-5 * values.abs().maxCoeff() : 0.0);
  }

  RepeatedValues Rows;
  SmoothnessEnergy Energy;
  SmoothFit Fit;
  double Area;
  Flags None; ///< no vertex
  Eigen::RowVectorXd Origin; ///< from which values are measured
  double TotalWeight; ///< of the values
  Index Open = 0; ///< functions without energy that the values leave open
  /// Those that the values determine; 0: not known.
  Index Determined = 0;
  Eigen::RowVectorXd Lowest, Highest; ///< the bounds of a column
  Values Start;
  /// w^T B Q^-1 B^T w for the weights w of the mean of the values; negative: not known
  double EnergyOfMean = -1.0;
  /// Of all columns, if mu is found and eigenvectors are known; null otherwise
  const InfluenceSpectrum* Spectrum = nullptr;
};

} // namespace SurfaceDiffusion
