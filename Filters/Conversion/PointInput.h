// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/Fingerprint.h"
#include "Run/PointSamples.h"
#include "Run/Settings.h"
#include "vtkSurfaceDiffusionNamespace.h"

#include <memory>
#include <string>

VTK_ABI_NAMESPACE_BEGIN
class vtkDataObject;
class vtkInformation;
class vtkInformationVector;
class vtkMultiProcessController;
class vtkPointSet;
VTK_ABI_NAMESPACE_END

namespace SurfaceDiffusion
{

/// Describe a port that takes a vtkPointSet or nothing. It also lets other data through, for an error
/// whose message says what to do.
void DescribePointPort(vtkInformation* info);

/// The data on a port; null without any.
vtkDataObject* FindOptionalInput(vtkInformationVector** inputs, int port);

/// The coordinates of all points.
Points ReadPlaces(vtkPointSet* points);

/// The names of point arrays of points with values.
struct PointInputNames
{
  const std::string& Values; ///< empty: the active scalars
  const std::string& Weights; ///< empty: 1 everywhere
};

/// The points of a vtkPointSet with the chosen values and weights; those of all processes together.
/// The values of hidden points are NaN, which is no value. Null, with problems, if the data are of
/// another type, have no such array, or no points that are not hidden. Collective.
std::shared_ptr<const PointSamples> ReadPointSamples(vtkDataObject* data,
  const PointInputNames& names, vtkMultiProcessController* controller, Problems& problems);

/// Add the hash of everything in it.
void AddSamples(Fingerprint& fingerprint, const PointSamples& samples);

} // namespace SurfaceDiffusion
