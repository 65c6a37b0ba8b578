// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/CurvatureRun.h"
#include "Run/DenoisingRun.h"
#include "Run/DerivativesRun.h"
#include "Run/DirectionFieldRun.h"
#include "Run/DistanceRun.h"
#include "Run/HarmonicMapSettings.h"
#include "Run/HeatSettings.h"
#include "Run/History.h"
#include "Run/InterpolationSettings.h"
#include "Run/MumfordShahSettings.h"
#include "Run/RandomFieldRun.h"
#include "Run/ReliefRun.h"
#include "Run/SegmentationSettings.h"
#include "Run/TensorDiffusionSettings.h"
#include "Run/TextureSettings.h"
#include "Run/TotalVariationSettings.h"

#include <map>
#include <memory>
#include <string>
#include <vector>

// Every model in one call, for one surface that is given as arrays, in programs without VTK:
//
//   HeatSettings settings;
//   settings.FWHM = 6.0;
//   const Values smoothed = Heat(points, triangles, values, settings).Result;
//
// points: n x 3 coordinates. triangles: m x 3 rows of points. Fields have values (n x k) and what
// else a model reads: data on cells, a mask, fixed values, directions, ... Values alone may stand
// in place of Fields. The settings have the names, units, ranges and defaults of the properties of
// the filters for VTK, whose results these are. All functions throw std::runtime_error, whose text
// names each setting or array with its value and what is allowed.
//
// A program that solves again and again on one surface uses Run, which keeps the matrices and
// factors that have not changed.
namespace SurfaceDiffusion
{

/// What an array of a Solution is, besides its numbers.
struct ArrayTraits
{
  bool OnCells = false;
  bool IsOfData = false; ///< its name in VTK is that of the data, followed by its name here
  bool ArePoints = false; ///< the points of the surface, which have moved
};

/// The results of a model on one surface, under the names of the arrays and properties in VTK.
struct Solution
{
  /// The main result: that of the data, in their unit, with a row per point (per cell for data on
  /// cells, if the settings ask for results there). Of a texture u1, of a mesh the moved points.
  Values Result;
  /// All results at points or cells, the main one included. A result that is named after the data
  /// in VTK has its suffix as name, for instance "Diffused".
  std::map<std::string, Values> Arrays;
  std::map<std::string, ArrayTraits> Traits; ///< of Arrays
  std::map<std::string, std::shared_ptr<const SurfaceDiffusion::Curves>> Curves;
  std::map<std::string, Values> Numbers; ///< 1 x 1, or a matrix
  std::map<std::string, Values> Columns; ///< of tables, a row per region, and attributes of curves
  std::vector<Index> Turned; ///< the triangles whose orientation a relief has changed
  History Steps; ///< of models with time steps
  std::vector<std::string> Warnings;
};

/// One of the models by its name: how its settings and its run are made, and what it takes.
struct NamedSettings
{
  const char* Function; ///< its name in Python
  std::unique_ptr<Settings> (*Make)();
  /// Of a computation without time steps; null: the settings are RunSettings.
  std::unique_ptr<SurfaceRun> (*MakeRun)(const ParallelFor& parallel);
  const char* Data; ///< the name of its data in Python; empty: it takes none
  bool NeedsData;
  const char* Inputs; ///< the names of its other arrays in Python, separated by spaces
  /// Settings that are found from the data unless they are given, in Python: pairs of a setting and the
  /// switch that is off then, separated by spaces.
  const char* Found = "";
};

template <typename ModelSettings>
std::unique_ptr<Settings> MakeDefaults()
{
  return std::make_unique<ModelSettings>();
}

template <typename RunType>
std::unique_ptr<SurfaceRun> MakeSurfaceRun(const ParallelFor& parallel)
{
  return std::make_unique<RunType>(parallel);
}

/// All models.
inline const NamedSettings SettingsOfModels[] = { { "curvature", &MakeDefaults<CurvatureSettings>,
                                                    &MakeSurfaceRun<CurvatureRun>, "", false,
                                                    "mask roi" },
  { "denoise_mesh", &MakeDefaults<DenoisingRunSettings>, &MakeSurfaceRun<DenoisingRun>, "", false,
    "fixed creases" },
  { "derivatives", &MakeDefaults<DerivativesSettings>, &MakeSurfaceRun<DerivativesRun>, "values",
    true, "mask roi error" },
  { "direction_field", &MakeDefaults<DirectionFieldSettings>, &MakeSurfaceRun<DirectionFieldRun>,
    "", false, "hints" },
  { "distance", &MakeDefaults<DistanceSettings>, &MakeSurfaceRun<DistanceRun>, "sources", true,
    "start speed directions path_points mask roi" },
  { "harmonic_map", &MakeDefaults<HarmonicMapSettings>, nullptr, "vectors", false,
    "mask roi directions fixed fidelity" },
  { "heat", &MakeDefaults<HeatSettings>, nullptr, "values", true,
    "mask roi directions fixed fidelity" },
  { "intrinsic_tv", &MakeDefaults<TotalVariationSettings>, nullptr, "values", true,
    "mask roi directions fixed fidelity", "fidelity_weight automatic_fidelity" },
  { "mumford_shah", &MakeDefaults<MumfordShahSettings>, nullptr, "values", true,
    "mask roi directions fixed fidelity",
    "edge_threshold automatic_threshold smoothing_length automatic_threshold" },
  { "interpolate", &MakeDefaults<InterpolationSettings>, nullptr, "values", true,
    "mask roi directions fidelity", "smoothing automatic_smoothing" },
  { "random_field", &MakeDefaults<RandomFieldSettings>, &MakeSurfaceRun<RandomFieldRun>, "", false,
    "mask roi" },
  { "relief", &MakeDefaults<ReliefSettings>, &MakeSurfaceRun<ReliefRun>, "values", true, "mask" },
  { "segment", &MakeDefaults<SegmentationSettings>, nullptr, "values", true,
    "seeds terms mask roi fidelity", "means automatic_means fidelity_weight automatic_fidelity" },
  { "tensor_diffusion", &MakeDefaults<TensorDiffusionSettings>, nullptr, "values", true,
    "mask roi directions fixed fidelity" },
  { "turing_texture", &MakeDefaults<TextureSettings>, nullptr, "initial", false,
    "mask roi directions fixed rates" } };

/// The model of this name; null if there is none.
const NamedSettings* FindModel(const std::string& function);

/// The data of a call: Fields, or values at the points alone.
struct SurfaceData : Fields
{
  SurfaceData() = default;
  SurfaceData(const Fields& fields) // NOLINT(google-explicit-constructor)
    : Fields(fields)
  {
  }
  template <typename Derived>
  SurfaceData(const Eigen::DenseBase<Derived>& ofPoints) // NOLINT(google-explicit-constructor)
  {
    this->Data.Values = ofPoints.derived();
  }
};

/// Any of the models, with settings that its Make() has made.
Solution SolveModel(const NamedSettings& model, const Points& points, const Triangles& triangles,
  const SurfaceData& data, std::unique_ptr<Settings> settings,
  const ParallelFor& parallel = SerialFor(), const ProgressMonitor& progress = ProgressMonitor());

Solution SolveModel(const Points& points, const Triangles& triangles, const SurfaceData& data,
  std::shared_ptr<RunSettings> settings, const ParallelFor& parallel = SerialFor(),
  const ProgressMonitor& progress = ProgressMonitor());

/// (4), (16), (18): see vtkFVMHeatFilter.
inline Solution Heat(const Points& points, const Triangles& triangles, const SurfaceData& data,
  const HeatSettings& settings = {}, const ParallelFor& parallel = SerialFor())
{
  return SolveModel(points, triangles, data, std::make_shared<HeatSettings>(settings), parallel);
}

/// (2), (3), (17), (19): see vtkIntrinsicTVFilter.
inline Solution IntrinsicTV(const Points& points, const Triangles& triangles,
  const SurfaceData& data, const TotalVariationSettings& settings = {},
  const ParallelFor& parallel = SerialFor())
{
  return SolveModel(
    points, triangles, data, std::make_shared<TotalVariationSettings>(settings), parallel);
}

/// The flow of harmonic maps to the sphere, of n x 3 unit vectors: see vtkHarmonicMapFilter.
inline Solution HarmonicMapFlow(const Points& points, const Triangles& triangles,
  const SurfaceData& data, const HarmonicMapSettings& settings = {},
  const ParallelFor& parallel = SerialFor())
{
  return SolveModel(
    points, triangles, data, std::make_shared<HarmonicMapSettings>(settings), parallel);
}

/// Reaction and diffusion of two chemicals; data are optional: see vtkTuringTextureFilter.
inline Solution TuringTexture(const Points& points, const Triangles& triangles,
  const TextureSettings& settings = {}, const SurfaceData& data = {},
  const ParallelFor& parallel = SerialFor())
{
  return SolveModel(points, triangles, data, std::make_shared<TextureSettings>(settings), parallel);
}

/// Edges, and data that are smooth between them: see vtkMumfordShahFilter.
inline Solution MumfordShahEdges(const Points& points, const Triangles& triangles,
  const SurfaceData& data, const MumfordShahSettings& settings = {},
  const ParallelFor& parallel = SerialFor())
{
  return SolveModel(
    points, triangles, data, std::make_shared<MumfordShahSettings>(settings), parallel);
}

/// Regions with short boundaries: see vtkSurfaceSegmentationFilter.
inline Solution Segment(const Points& points, const Triangles& triangles, const SurfaceData& data,
  const SegmentationSettings& settings = {}, const ParallelFor& parallel = SerialFor())
{
  return SolveModel(
    points, triangles, data, std::make_shared<SegmentationSettings>(settings), parallel);
}

/// Smooth functions through the known values of data, or through data.Samples: see
/// vtkSurfaceInterpolationFilter.
inline Solution Interpolate(const Points& points, const Triangles& triangles,
  const SurfaceData& data, const InterpolationSettings& settings = {},
  const ParallelFor& parallel = SerialFor())
{
  return SolveModel(
    points, triangles, data, std::make_shared<InterpolationSettings>(settings), parallel);
}

/// Diffusion with a tensor that follows the data: see vtkTensorDiffusionFilter.
inline Solution TensorDiffusion(const Points& points, const Triangles& triangles,
  const SurfaceData& data, const TensorDiffusionSettings& settings = {},
  const ParallelFor& parallel = SerialFor())
{
  return SolveModel(
    points, triangles, data, std::make_shared<TensorDiffusionSettings>(settings), parallel);
}

/// A line field on the triangles, from the curvature or from data.Directions: see
/// vtkSurfaceDirectionFieldFilter.
Solution DirectionField(const Points& points, const Triangles& triangles,
  DirectionFieldSettings settings = {}, const SurfaceData& data = {},
  const ParallelFor& parallel = SerialFor());

/// Mean, Gaussian and principal curvatures: see vtkSurfaceCurvatureFilter.
Solution Curvature(const Points& points, const Triangles& triangles,
  CurvatureSettings settings = {}, const SurfaceData& data = {},
  const ParallelFor& parallel = SerialFor());

/// Gaussian random fields: see vtkSurfaceRandomFieldFilter.
Solution RandomFields(const Points& points, const Triangles& triangles,
  RandomFieldSettings settings = {}, const SurfaceData& data = {},
  const ParallelFor& parallel = SerialFor());

/// Gradient, divergence, curl or Laplacian of data, or the velocity of a wave from its arrival
/// times: see vtkSurfaceDerivativesFilter.
Solution Derivative(const Points& points, const Triangles& triangles, const SurfaceData& data,
  DerivativesSettings settings = {}, const ParallelFor& parallel = SerialFor());

/// Distances from the nonzero points of data or from data.Sources, or the arrival times of fronts
/// with data.Speeds: see vtkSurfaceDistanceFilter.
Solution Distance(const Points& points, const Triangles& triangles, const SurfaceData& data,
  DistanceSettings settings = {}, const ParallelFor& parallel = SerialFor());

/// The shortest path through places, and back to the first if it is closed: see
/// DistanceRun::FindPath(). Of data the mask, and of the settings the merging of points counts.
SurfacePath ShortestPath(const Points& points, const Triangles& triangles,
  const std::vector<SurfacePlace>& places, bool isClosed = false, const SurfaceData& data = {},
  DistanceSettings settings = {}, const ParallelFor& parallel = SerialFor());

/// The part of the surface within a distance of a place: see DistanceRun::FindDisk(). As ShortestPath().
SurfaceDisk DiskAround(const Points& points, const Triangles& triangles, const SurfacePlace& center,
  double radius, const SurfaceData& data = {}, DistanceSettings settings = {},
  const ParallelFor& parallel = SerialFor());

/// The smoothness of noise maps, as full widths at half maximum in the unit of the coordinates.
struct SmoothnessEstimate
{
  double OfAll; ///< of all columns together
  std::vector<double> OfColumns;
};

/// See NoiseWidth. maps: one row per point, NaN where a value is missing.
SmoothnessEstimate EstimateFWHM(
  const Points& points, const Triangles& triangles, const Values& maps, bool subtractsMean = true);

/// The values smoothed until their noise, smoothed alike, has the width `fwhm` to half a percent: see
/// WidthCorrection. noise: without rows it is the values minus their mean over the columns, and of a
/// single column the column itself. Throws if the noise is as smooth already, or cannot become so.
Values SmoothToFWHM(const Points& points, const Triangles& triangles, const Values& values,
  double fwhm, const Values& noise = Values(0, 0), const ParallelFor& parallel = SerialFor());

/// The surface without noise; points of data.Fixed, and creases by data.Seeds, stay: see
/// vtkSurfaceDenoisingFilter.
Solution DenoiseMesh(const Points& points, const Triangles& triangles,
  DenoisingRunSettings settings = {}, const SurfaceData& data = {},
  const ParallelFor& parallel = SerialFor());

} // namespace SurfaceDiffusion
