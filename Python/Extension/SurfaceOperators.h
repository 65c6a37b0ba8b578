// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "InputData.h"

#include <memory>
#include <optional>

namespace SurfaceDiffusion
{

/// The matrices of a surface as arrays of Python, in coordinate units. Rows and columns are the
/// points of the input; those of points that no triangle uses are empty.
class SurfaceOperators
{
public:
  /// joinShortEdges: for modes, not for matrices, in which every point keeps its row.
  SurfaceOperators(std::shared_ptr<const InputSurface> surface,
    const std::optional<FlagArray>& mask, bool maskOnFaces, bool intrinsicDelaunay,
    bool joinShortEdges, const nanobind::object& progress);

  /// The control areas (n).
  nanobind::object Masses() const;
  /// data, indices and indptr of K. diffusivity: D, a row of nine numbers per face.
  nanobind::tuple Stiffness(const std::optional<DoubleArray>& diffusivity) const;
  /// data, indices and indptr of the gradient, rows 3 t to 3 t + 2 for triangle t of
  /// InputSurface::GetTriangles(). Only without intrinsicDelaunay.
  nanobind::tuple Gradient() const;
  /// The eigenvalues (count) and the modes (n, count).
  nanobind::tuple Modes(const std::optional<DoubleArray>& diffusivity, Index count,
    const nanobind::object& progress) const;
  Index NumberOfVertices() const { return this->Built->Mesh().NumberOfVertices(); }
  const SurfaceDiagnostics& Diagnostics() const { return this->Built->Diagnostics(); }

private:
  CornerWeights Coefficients(const std::optional<DoubleArray>& diffusivity) const;

  std::shared_ptr<const InputSurface> Input;
  std::unique_ptr<const Surface> Built;
};

} // namespace SurfaceDiffusion
