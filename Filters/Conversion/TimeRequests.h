// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

class vtkInformation;
class vtkInformationVector;

namespace SurfaceDiffusion
{

struct TimeSettings;

/// Declare the published times of a run that ends at step `last` at all output ports.
void PublishTimes(const TimeSettings& settings, int last, vtkInformationVector* outputs);

/// Ask for the input at its own first time if it has times, and at no time otherwise: the requested
/// time is a diffusion time, which has no meaning upstream.
void RequestFirstTime(vtkInformation* input);

/// The time that is requested from the output port that `request` comes from, with
/// GenerateTimeSteps.
std::optional<double> FindRequestedTime(
  const TimeSettings& settings, vtkInformation* request, vtkInformationVector* outputs);

/// The step for a requested time of a run that ends at step `last`, which answers no time, too.
int FindStep(const TimeSettings& settings, const std::optional<double>& time, int last);

/// Set the time of the data at all output ports.
void SetDataTime(double time, vtkInformationVector* outputs);

} // namespace SurfaceDiffusion
