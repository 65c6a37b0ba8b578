// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/ModelInputs.h"

#include <functional>
#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

class HeatBlur;
class TangentPlanes;

/// Makes the model of some columns of the data with a fidelity weight in units of the numerics.
using FidelityModelMaker = std::function<std::unique_ptr<Model>(PointData data, double fidelity)>;

/// How AutomaticFidelity seeks its weights.
struct FidelityTask
{
  double NoiseLevel = 0.0; ///< in array units; 0: estimated
  /// Whether weights are 1/length^2, and the first guess 1/h^2; otherwise 1/length and 1/h.
  bool StartsByArea = true;
  bool IsStartOverNoise = false; ///< whether the first guess is that over the noise
  int Steps = 1; ///< the states that are compared with the data are those after so many
  bool ColumnsShareWeight = true; ///< false: each has its own
  double CellNoiseGain = 0.0; ///< of data on cells, see FindCellNoiseGain()
  bool IsLinear = false; ///< whether models have any number of columns that do not mix
  /// Of data that are tangent vectors, of which noise along the normal is left out; null: they are not.
  const TangentPlanes* Planes = nullptr;
  HeatBlur* Blur = nullptr; ///< applied to a state before it is compared; may be null
};

/// Fidelity weights of columns and connected components.
struct FidelityWeights
{
  /// Of each column, or one of all, in units of the numerics: that of the component with the most
  /// vertices.
  std::vector<double> OfColumns;
  /// n x as many: those of the other components over it, by which the fidelity factors of the data
  /// are multiplied, infinite in one that is held; no row if there is one component.
  Values Factors = {};

  /// The models with these weights.
  std::unique_ptr<Model> MakeModels(PointData data, const FidelityModelMaker& makeModel) const;
};

/// The fidelity weights of the smallest estimated error (see RiskSearch), or at which the states
/// differ from the data by the noise (discrepancy principle) where that is correlated, in each column and connected component by its own noise: a component and a column
/// come out as if they were alone. A component without enough points to estimate noise from has the
/// noise of all. Warns in `result` if the noise is correlated, if the data are smooth between
/// neighbours (see NeighbourVariation; not for data on cells), and if no weight leaves the noise,
/// each in one line, which gives the numbers of the first column and the largest component.
FidelityWeights FindFidelity(const ModelInputs& inputs, const FidelityTask& task,
  const FidelityModelMaker& makeModel, RunResult& result);

} // namespace SurfaceDiffusion
