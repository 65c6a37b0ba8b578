// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Fields/RandomField.h"
#include "Core/Statistics/NoiseWidth.h"
#include "InputData.h"

#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

/// An array (n, k) of float64 that is written, one row per point of a surface.
using ColumnArray =
  nanobind::ndarray<double, nanobind::ndim<2>, nanobind::device::cpu, nanobind::c_contig>;

/// Random fields on a surface and filters of its data, as arrays of Python in coordinate units.
class SurfaceFields
{
public:
  SurfaceFields(std::shared_ptr<const InputSurface> surface, const std::optional<FlagArray>& mask,
    bool maskOnFaces, bool merges, double tolerance, const nanobind::object& progress);

  /// Take the covariance: Gaussian of the full width at half maximum `width` if nu is 0, and
  /// otherwise Matern's with nu and the range `width`, or `ranges` of points; white noise of variance 1 at
  /// each point if both are 0. The last one is kept. shares: whether the variances are found with those of narrower Gaussian
  /// fields before.
  void Prepare(double width, double nu, bool unitVariance, const nanobind::object& progress,
    bool shares, const std::optional<FactorArray>& ranges);
  /// Forget what the variances of wider fields would need.
  void EndSharing() { this->Poles = SharedPoles(); }
  /// Write fields first, first + 1, ... to the columns; NaN at points that take no part. Returns the
  /// largest relative residual of solves above their tolerance.
  double Draw(std::int64_t seed, std::int64_t first, const ColumnArray& fields,
    const nanobind::object& progress);

  /// The columns b, weights of points, become those of which b* F F* b are the covariances of the weighted
  /// sums of fields: see RandomField::ApplyTransposed(). Returns as Draw().
  double ApplyTransposed(const ColumnArray& weights, const nanobind::object& progress);

  /// Filter the columns by scale. wavelengths: per point. NaN at points that take no part.
  double FilterScales(const ColumnArray& values, const FactorArray& wavelengths, int order,
    const nanobind::object& progress) const;

  /// The same of data at the faces of the surface, one row per face. NaN at faces that take no part.
  double FilterScalesOfFaces(const ColumnArray& values, const FactorArray& wavelengths, int order,
    const nanobind::object& progress) const;
  /// The areas of the faces in LengthUnit()^2; 0 for those that take no part.
  nanobind::object FaceAreas() const;

  /// Add the columns, NaN where a value is missing, to an estimate of their smoothness.
  void AddTo(NoiseWidth& widths, const ColumnArray& values) const;
  const TriangleMesh& Mesh() const { return this->Built->Mesh(); }

  Index NumberOfVertices() const { return this->Built->Mesh().NumberOfVertices(); }
  const SurfaceDiagnostics& Diagnostics() const { return this->Built->Diagnostics(); }
  /// The control areas (n) in LengthUnit()^2; 0 at points that take no part.
  nanobind::object Areas() const;
  double LengthUnit() const { return this->Built->Mesh().LengthUnit(); }
  /// h, the mean length of the edges, as long as the given areas of points say.
  double MeanEdgeLength() const;

private:
  /// In the unit of the mesh, of the lengths of points.
  Vector LengthsOfVertices(const FactorArray& lengths) const;
  /// Do what `run` does to columns in panels of vertices and write them.
  template <typename Run>
  double InPanels(const ColumnArray& columns, const nanobind::object& progress, const Run& run);
  /// The face of each triangle of the mesh's input.
  std::vector<Index> FacesOfTriangles() const;
  Values Read(const ColumnArray& columns, Eigen::Index first, Eigen::Index count) const;
  void Write(const Values& ofVertices, Eigen::Index first, const ColumnArray& columns) const;

  std::shared_ptr<const InputSurface> Input;
  std::unique_ptr<const Surface> Built;
  std::unique_ptr<RandomField> Field;
  bool InUse = false;
  std::map<std::tuple<double, double, bool>, Vector>
    Deviations; ///< of fields with variance 1, by width, nu, and whether they were shared
  std::tuple<double, double, bool, bool, std::vector<double>> Prepared; ///< of Field
  SharedPoles Poles;
};

} // namespace SurfaceDiffusion
