// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Domain.h"
#include "Files/SurfaceFile.h"
#include "Run/Solve.h"

#include <emscripten/val.h>

#include <functional>
#include <string>
#include <vector>

namespace SurfaceDiffusion
{

/// The models and their settings as JSON, in the words of the package for numpy.
std::string DescribeModels();

/// The words of a text with single spaces.
std::vector<std::string> WordsOf(const char* text);

/// Give settings the values of a JavaScript object, by their names in Python. Throws
/// std::runtime_error on names that are neither settings nor among `others`, and on other types.
void AssignSettings(const NamedSettings& model, Settings& settings, const emscripten::val& given,
  const std::vector<std::string>& others);

/// The shortest paths of a result with their lengths; none: no cells.
Files::SurfaceFile PathsOf(const Solution& solution);
/// [{length, start, points}]; start: the place of the path's point in the order of path_points.
std::string PathsAsJson(const Files::SurfaceFile& paths);

/// One surface with its arrays, and the results of the last run on it. All functions throw
/// std::runtime_error with one line.
class Engine
{
public:
  /// Take the surface of a file, or add the values of one to the surface that is there. Returns what
  /// there is as JSON.
  std::string Open(const std::string& name, const Files::Bytes& content);
  /// Run a model. given: {array, association, any setting and input by its name in Python}. Returns
  /// what there is as JSON.
  std::string Run(const std::string& model, const emscripten::val& given,
    const ProgressMonitor::Callback& progress);
  /// The surface with the results, in the format that the name ends in. A pattern is its colours, too.
  Files::Bytes Write(const std::string& name) const;

  /// The paths of the last run, lines as .vtp.
  Files::Bytes WritePaths(const std::string& name) const
  {
    return Files::WriteFile(name, this->Paths);
  }

  const Domain& Surface() const { return this->Given; }
  /// That the last results belong to.
  const Domain& ResultSurface() const { return this->Fine.IsRefined ? this->Fine : this->Given; }
  /// association: "point" or "cell".
  const Files::FileArray& Array(const std::string& name, const std::string& association) const;
  const Files::FileArray& ResultArray(const std::string& name) const;
  /// Null if they are those of the surface.
  const double* ResultPoints() const;

private:
  std::string Describe() const;
  void TakeSurface(Files::SurfaceFile file);
  Files::SurfaceFile WithResults() const;
  void AddValues(Files::SurfaceFile file);
  const Files::FileArray* Find(const std::string& name, const std::string& association) const;
  /// The surface that a run works on, by refine_to and maximum_number_of_triangles.
  const Domain& Refine(const emscripten::val& given, const Settings& settings,
    const ProgressMonitor& progress, std::vector<std::string>& warnings);
  /// dataName: gets the name of the data; excludes: whether a region of interest was given.
  SurfaceData ReadInputs(const NamedSettings& model, const emscripten::val& given,
    const Domain& domain, std::string& dataName, bool& excludes) const;
  /// Whether the name is that of values beside the surface, which the data are then.
  bool ReadSamples(const NamedSettings& model, const std::string& name, std::string& dataName,
    SurfaceData& data) const;
  void TakeResults(const Solution& solution, const std::string& dataName);

  Files::SurfaceFile File;
  Domain Given;
  Domain Fine; ///< of the last run, if it refined the surface
  std::vector<Files::FileArray> Results;
  std::vector<double> MovedPoints;
  Files::SurfaceFile Paths;
  std::string Pattern; ///< the name of the result that is one; empty: none
  std::vector<Index> Turned; ///< the triangles that a relief has turned
  Files::SurfaceFile Samples; ///< places with values, beside the surface
};

} // namespace SurfaceDiffusion
