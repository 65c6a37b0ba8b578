// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/Settings.h"

#include <nanobind/nanobind.h>

#include <memory>
#include <string>

namespace SurfaceDiffusion
{

struct FieldSummary;
struct RunSettings;

/// The settings of a model by the name of its Python function, with their defaults.
std::unique_ptr<Settings> MakeSettings(const std::string& model);

/// The same of a model of arrays, which a Run computes.
std::unique_ptr<RunSettings> MakeRunSettings(const std::string& model);

/// One dict per setting: name, unit, documentation, is_of_output, kind, default, allowed and words.
nanobind::list ListSettings(Settings& settings);

/// The settings that are found from the data unless they are given, and the switch of each: see
/// NamedSettings::Found.
nanobind::dict ListFound(const std::string& model);

/// Set those settings that the dict has: a number, a bool, or the index of a word.
void AssignSettings(Settings& settings, const nanobind::dict& values);

/// The problems of settings, of single ones and with the inputs, as lists of words. fields: null if
/// only those of single settings are asked for.
nanobind::list FindProblems(
  const std::string& model, const nanobind::dict& values, const FieldSummary* fields);

/// The times that a model with these settings publishes to a pipeline, in a run that ends at step
/// `last`, or after all steps for -1: a dict of times, time_step and number_of_steps. None without
/// times, and if there are problems with the settings.
nanobind::object FindTimes(const std::string& model, const nanobind::dict& values, int last);

/// The time step that a model with these settings takes.
double FindTimeStep(const std::string& model, const nanobind::dict& values);

/// ModelTraits::ColumnsAreIndependent.
bool HasIndependentColumns(const std::string& model, const nanobind::dict& values);

/// The step of the last published time at or before `time`, of a run that ends at step `last`.
int FindStep(const std::string& model, const nanobind::dict& values, double time, int last);

/// A tuple of kind, spelling, name and value for each word.
nanobind::list ListWords(const Sentence& sentence);

} // namespace SurfaceDiffusion
