// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "InputData.h"
#include "Run/Outputs.h"
#include "Run/WarningLog.h"

#include <nanobind/nanobind.h>

#include <map>
#include <string>
#include <vector>

namespace SurfaceDiffusion
{

/// A dict for each output: its name, place, type, role, shape, and for curves where each begins and
/// the rows of its corners. block: of a model; null if there is none.
nanobind::list ListOutputs(
  const OutputList& outputs, const Run::Block* block = nullptr, const ModelTraits& traits = {});

/// Write an output of a run on `input`. first: the column of `output` from which on the columns of
/// the output are written, and no others; -1: all columns.
void WriteOutput(const Output& from, OutputSource& source, const PythonFields& input,
  const OutputArray& output, int first);

/// A dict of the numbers of a run on all its surfaces: each a list of rows.
nanobind::dict ListNumbers(const std::map<std::string, Values>& numbers);

///@{
/// The words of each warning.
nanobind::list ListSentences(const std::vector<Warning>& warnings);
nanobind::list ListSentences(const std::vector<Sentence>& sentences);
///@}

} // namespace SurfaceDiffusion
