// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/Fingerprint.h"
#include "Run/PointSamples.h"
#include "Run/Settings.h"

#include <memory>

class vtkAlgorithm;
class vtkDataObject;
class vtkMultiProcessController;

namespace SurfaceDiffusion
{

/// The arrays that SetInputArrayToProcess() chooses on points with values.
struct PointInputIndices
{
  int Values;
  int Weights;
};

/// The points of a vtkPointSet with the chosen values and weights; those of all processes together.
/// Null, with problems, if the data are of another type or have no such array. Collective.
std::shared_ptr<const PointSamples> ReadPointSamples(vtkAlgorithm* filter, vtkDataObject* data,
  const PointInputIndices& indices, vtkMultiProcessController* controller, Problems& problems);

/// Add the hash of everything in it.
void AddSamples(Fingerprint& fingerprint, const PointSamples& samples);

} // namespace SurfaceDiffusion
