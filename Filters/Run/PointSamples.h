// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Interpolation/ScatteredValues.h"
#include "Run/Sentence.h"

#include <array>
#include <string>
#include <vector>

namespace SurfaceDiffusion
{

class Surface;
class CellTransfer;
struct Fields;
struct SurfaceArrays;

/// Values at points anywhere in space, which stand for the nearest points of a surface.
struct PointSamples
{
  SurfaceDiffusion::Points Places; ///< m x 3, coordinates
  Values Given; ///< m x k, array units; a row with NaN does not count
  std::vector<double> Weights; ///< per row, 0 or more; empty: 1 everywhere
  std::string Name; ///< of the array
};

/// The nearest point of a surface to a sample.
struct ProjectedSample
{
  std::array<Index, 3> Points = { -1, -1, -1 }; ///< of the input
  std::array<double, 3> Coordinates = { 0.0, 0.0, 0.0 }; ///< barycentric
  double Distance = 0.0; ///< coordinate units
  bool IsExcluded = false; ///< in a triangle that takes no part
};

/// Projects fields.Samples to all triangles of a surface, those that the mask excludes included.
/// Then fields.Data stands for the values wherever a run asks where data are known, and of which
/// size they are: at the points of the triangles that the samples are in, NaN elsewhere. Those
/// excluded, and those farther than maximumDistance (0: none), do not count. Throws InputError on
/// values and weights that are not allowed, and if no value is left.
void ProjectSamples(const SurfaceArrays& arrays, double maximumDistance, Fields& fields);

/// The values that a smooth function takes on a surface.
struct KnownValues
{
  ScatteredValues Values; ///< in units of the numerics
  Index TooFar = 0; ///< samples beyond the largest distance
  Points SamplePlaces; ///< of the samples that have a value
  std::vector<double> SampleDistances; ///< their distances from the surface, in coordinate units
  Index Outside = 0; ///< samples in excluded triangles
  std::vector<Eigen::Index> Rows; ///< of the data, per value
  Eigen::Index NumberOfRows = 0; ///< of the data
  bool OnCells = false; ///< the data are
  std::string SamplesName; ///< empty unless they are samples
  bool AreSamples = false;
};

/// The known values of the fields, divided by `unit`: of samples at their places, of points at
/// their vertices, and of cells in their middle, where linear functions have the value of
/// CellTransfer::ToCells() if cells are flat. Equal values of merged points count
/// once. Fidelity factors are the weights; values of weight 0 do not count. cells: the cell of each
/// row of surface.MakeTriangles(), of data on cells.
KnownValues FindKnownValues(
  const Surface& surface, const Fields& fields, bool inpaint, double unit, double maximumDistance);

} // namespace SurfaceDiffusion
