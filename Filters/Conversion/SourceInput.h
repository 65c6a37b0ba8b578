// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/DistanceSources.h"
#include "Run/Fingerprint.h"
#include "Run/Settings.h"
#include "vtkSurfaceDiffusionNamespace.h"

#include <memory>

VTK_ABI_NAMESPACE_BEGIN
class vtkDataObject;
class vtkMultiProcessController;
VTK_ABI_NAMESPACE_END

namespace SurfaceDiffusion
{

/// The points and lines of a vtkPointSet, those of all processes together. Hidden points and lines
/// take no part, nor do lines with a hidden point. Null, with a problem, if the data are of another
/// type or have no points that take part. name: of the input, for problems. Collective.
std::shared_ptr<const SourceShapes> ReadSources(
  vtkDataObject* data, const char* name, vtkMultiProcessController* controller, Problems& problems);

/// Add the hash of everything in it.
void AddSources(Fingerprint& fingerprint, const SourceShapes& sources);

} // namespace SurfaceDiffusion
