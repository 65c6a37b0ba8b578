// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace SurfaceDiffusion
{

/// The keyword in Python, and in the page, of a setting, array or word of a choice: "NumberOfTimeSteps"
/// is number_of_time_steps.
std::string PythonName(const std::string& name);

/// Settings of pipelines, which functions of arrays do not have.
bool IsOfPipelines(const std::string& setting);

} // namespace SurfaceDiffusion
