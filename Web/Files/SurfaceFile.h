// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

// Readers and writers of surfaces and values, in memory. The memory that a reader allocates is at most
// proportional to the size of the file: counts that a file declares are not trusted. An error message is
// one sentence.
namespace SurfaceDiffusion::Files
{

/// A file that cannot be read or written; one line.
struct FileError : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

using Bytes = std::vector<std::uint8_t>;

/// Numbers at points or cells.
struct FileArray
{
  std::string Name = {};
  bool OnCells = false;
  std::size_t Components = 1;
  std::vector<double> Numbers = {}; ///< row after row
  bool AreBytes = false; ///< unsigned char, as colours are
  /// At points without a value, if the file has values at some of them.
  double Elsewhere = std::numeric_limits<double>::quiet_NaN();

  std::size_t Rows() const { return this->Numbers.size() / this->Components; }
};

/// A surface, or values alone, for which there are no points.
struct SurfaceFile
{
  std::string Kind = {}; ///< the format
  std::vector<double> Points = {}; ///< three coordinates each
  std::vector<std::int64_t> Corners = {}; ///< of all cells
  std::vector<std::size_t> Begin = { 0 }; ///< per cell the first of its corners; the end of all
  bool AreLines = false; ///< cells are lines, which .vtp alone is written with
  std::vector<FileArray> Arrays = {};
  std::vector<std::int64_t> At = {}; ///< the points that arrays have a row of; empty: all
  std::string Unit = {}; ///< of the coordinates; empty: the file does not say
  std::vector<std::string> Warnings = {};

  std::size_t NumberOfPoints() const { return this->Points.size() / 3; }
  std::size_t NumberOfCells() const { return this->Begin.size() - 1; }
  void AddCell(const std::vector<std::int64_t>& corners)
  {
    this->Corners.insert(this->Corners.end(), corners.begin(), corners.end());
    this->Begin.push_back(this->Corners.size());
  }
};

/// Throw FileError on corners that are no points.
void RequireCorners(const SurfaceFile& file);

/// Give arrays that have rows of some points one of each point of a surface. Throws FileError.
void Spread(SurfaceFile& file, std::size_t points);

/// Read a file by its content; the name decides where the content does not. Throws FileError.
SurfaceFile ReadFile(const std::string& name, const std::uint8_t* data, std::size_t size);

/// The surface in the format that the name ends in. Throws FileError.
Bytes WriteFile(const std::string& name, const SurfaceFile& surface);

} // namespace SurfaceDiffusion::Files
