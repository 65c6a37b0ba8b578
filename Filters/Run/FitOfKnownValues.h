// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Interpolation/InterpolationModel.h"
#include "Run/ModelInputs.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

/// The model with what its data were.
class FitOfKnownValues : public InterpolationModel
{
public:
  FitOfKnownValues(std::shared_ptr<const Assembler> assembler, CornerWeights coefficients,
    KnownValues known, const SmoothInterpolation::Settings& settings, const ParallelFor& parallel,
    bool isRobust)
    : InterpolationModel(std::move(assembler), std::move(coefficients), std::move(known.Values),
        settings, parallel, isRobust)
    , AreSamples(known.AreSamples)
    , Rows(std::move(known.Rows))
    , NumberOfRows(known.NumberOfRows)
    , Where(known.AreSamples ? Place::PerSample
          : known.OnCells    ? Place::PerCell
                             : Place::PerPoint)
    , NameOfSamples(std::move(known.SamplesName))
  {
  }

  const bool AreSamples;
  const std::vector<Eigen::Index> Rows; ///< of the data, per value
  const Eigen::Index NumberOfRows;
  const Place Where; ///< the data are
  const std::string NameOfSamples;
};

} // namespace SurfaceDiffusion
