// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/ModelInputs.h"

namespace SurfaceDiffusion
{

/// The traits that models of given data share.
void DescribeData(const DataSettings& settings, ModelTraits& traits);

/// Fill the start on missing vertices, note whether there are any, and hold the known values if
/// the settings say so.
void PrepareData(const DataSettings& settings, ModelInputs& inputs, RunResult& result);

/// The start on missing vertices becomes harmonic if `harmonic` is true and any is missing.
void FillHarmonicallyIf(bool harmonic, ModelInputs& inputs, RunResult& result);

/// The last part of PrepareData(), for models that fill the start by themselves.
void CompletePreparation(const DataSettings& settings, ModelInputs& inputs, RunResult& result);

/// The cotan weights times the constant diffusivities of the settings: the weights of (12).
CornerWeights MakeWeights(const DataSettings& settings, const ModelInputs& inputs);

/// White noise of cells is correlated between the vertices of a cell, so that EstimateNoise()
/// between neighbours is too low at vertices. This factor mends that. 0 if it is not known.
double FindCellNoiseGain(const ModelInputs& inputs);

/// The standard deviation at measured vertices over that of white noise of the data.
double NoiseGain(const ModelInputs& inputs);

/// The standard deviation at vertices, in ValueUnit, of white noise of the data, in array units.
double NoiseAtVertices(const ModelInputs& inputs, double noiseLevel);

/// One column of the data, or all of them.
PointData DataOfColumns(const PointData& data, Eigen::Index first, Eigen::Index count);

/// A warning if the noise of columns that a model couples by one norm differs by more than a factor
/// of 5, since edges of the larger ones drown those of the others. apart: the way to have them apart.
void WarnOfUnlikeColumns(const ModelInputs& inputs, const Sentence& apart, RunResult& result);

/// The mean fidelity factor of the known vertices, by area; 1 without factors. An automatic weight
/// is divided by it, so that factors such as 1/s^2 may have any unit.
double MeanFidelityFactor(const TriangleMesh& mesh, const PointData& data);

} // namespace SurfaceDiffusion
