// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

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

/// The name of a setting in Python: "NumberOfTimeSteps" is number_of_time_steps.
std::string PythonName(const std::string& setting);

/// Give settings the values of a JavaScript object, by their names in Python. Throws
/// std::runtime_error on names that are neither settings nor among `others`, and on other types.
void AssignSettings(const NamedSettings& model, Settings& settings, const emscripten::val& given,
  const std::vector<std::string>& others);

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
  /// The surface with the results, in the format that the name ends in.
  Files::Bytes Write(const std::string& name) const;

  const SurfaceDiffusion::Points& Points() const { return this->Coordinates; }
  const SurfaceDiffusion::Triangles& Triangles() const { return this->TriangleRows; }
  const std::vector<Index>& CellOfTriangle() const { return this->Cells; }
  /// association: "point" or "cell".
  const Files::FileArray& Array(const std::string& name, const std::string& association) const;
  const Files::FileArray& ResultArray(const std::string& name) const;
  /// Null if they have not moved.
  const std::vector<double>* ResultPoints() const
  {
    return this->MovedPoints.empty() ? nullptr : &this->MovedPoints;
  }

private:
  std::string Describe() const;
  void TakeSurface(Files::SurfaceFile file);
  void AddValues(Files::SurfaceFile file);
  const Files::FileArray* Find(const std::string& name, const std::string& association) const;
  SurfaceData ReadInputs(const NamedSettings& model, const emscripten::val& given,
    std::string& dataName, bool& excludes) const;
  void TakeResults(const Solution& solution, const std::string& dataName);

  Files::SurfaceFile File;
  SurfaceDiffusion::Points Coordinates;
  SurfaceDiffusion::Triangles TriangleRows;
  std::vector<Index> Cells; ///< the cell of each triangle
  std::vector<Files::FileArray> Results;
  std::vector<double> MovedPoints;
  std::vector<Index> Turned; ///< the triangles that a relief has turned
};

} // namespace SurfaceDiffusion
