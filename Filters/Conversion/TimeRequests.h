// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/RunSettings.h"
#include "vtkSurfaceDiffusionNamespace.h"

#include <optional>
#include <vector>

VTK_ABI_NAMESPACE_BEGIN
class vtkInformation;
class vtkInformationVector;
VTK_ABI_NAMESPACE_END

namespace SurfaceDiffusion
{

/// Declare the published times of a run that ends at step `last` at all output ports.
void PublishTimes(const TimeSettings& settings, int last, vtkInformationVector* outputs);

/// Ask for the input at its own first time if it has times, and at no time otherwise: the requested
/// time is a diffusion time, which has no meaning upstream.
void RequestFirstTime(vtkInformation* input);

/// The warning that an input with several times is taken at its first one; otherwise none.
std::vector<Sentence> DescribeUnusedTimes(vtkInformation* input);

/// The time that is requested from the output port that `request` comes from.
std::optional<double> FindRequestedTime(vtkInformation* request, vtkInformationVector* outputs);

/// The step for a requested time of a run that ends at step `last`, which answers no time, too.
int FindStep(const TimeSettings& settings, const std::optional<double>& time, int last);

/// Set the time of the data at all output ports.
void SetDataTime(double time, vtkInformationVector* outputs);

/// The last step of a run, which may have ended early, with the settings of that run.
class RunLength
{
public:
  /// The last step of a run with these settings, as far as it is known.
  int Find(TimeSettings& settings) const;
  /// Remember the last step. Returns whether it was another one.
  bool Set(TimeSettings& settings, int last);

private:
  SettingsSnapshot Surface, Model;
  int NumberOfSteps = -1;
  int LastStep = -1;
};

} // namespace SurfaceDiffusion
