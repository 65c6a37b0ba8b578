// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/Settings.h"

#include <nanobind/nanobind.h>

#include <memory>
#include <string>

namespace SurfaceDiffusion
{

struct RunSettings;

/// The settings of a model by the name of its Python function, with their defaults.
std::unique_ptr<Settings> MakeSettings(const std::string& model);

/// The same of a model of arrays, which a Run computes.
std::unique_ptr<RunSettings> MakeRunSettings(const std::string& model);

/// One dict per setting: name, unit, documentation, kind, default, allowed and words.
nanobind::list ListSettings(Settings& settings);

/// Set those settings that the dict has: a number, a bool, or the index of a word.
void AssignSettings(Settings& settings, const nanobind::dict& values);

/// A tuple of kind, spelling, name and value for each word.
nanobind::list ListWords(const Sentence& sentence);

} // namespace SurfaceDiffusion
