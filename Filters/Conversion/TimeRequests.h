// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

class vtkInformation;
class vtkInformationVector;

namespace SurfaceDiffusion
{

struct RunSettings;

/// Declare the published times of the run at all output ports.
void PublishTimes(const RunSettings& settings, vtkInformationVector* outputs);

/// Ask for the input at its own first time if it has times, and at no time otherwise: the requested
/// time is a diffusion time, which has no meaning upstream.
void RequestFirstTime(vtkInformation* input);

/// The step that is requested from the output port that `request` comes from; the last one if no
/// time is requested.
int FindRequestedStep(
  const RunSettings& settings, vtkInformation* request, vtkInformationVector* outputs);

/// Set the time of the data at all output ports.
void SetDataTime(double time, vtkInformationVector* outputs);

} // namespace SurfaceDiffusion
