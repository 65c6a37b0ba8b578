// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/Settings.h"

#include <stdexcept>

namespace SurfaceDiffusion
{

/// The message of an error, with the settings that may be its remedy.
Sentence ExplainError(Settings& settings, const std::runtime_error& error);

/// The message after the settings that may be the cause because their squares may be too large or
/// too small for a double. Without any, the message as it is.
Sentence NameExtremes(Settings& settings, const Sentence& message);

/// work(), whose errors name the settings that may be their cause or their remedy.
template <typename Work>
void NamingSettings(Settings& settings, const Work& work)
{
  try
  {
    work();
  }
  catch (const std::runtime_error& error)
  {
    throw InputError(NameExtremes(settings, ExplainError(settings, error)));
  }
}

} // namespace SurfaceDiffusion
