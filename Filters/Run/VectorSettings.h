// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Vectors/TangentDiffusion.h"
#include "Run/Fields.h"
#include "Run/RunSettings.h"

namespace SurfaceDiffusion
{

struct RunResult;

/// The settings of data that may be vectors.
struct VectorSettings
{
  VectorType Type = VectorType::Automatic;
  VectorLaplacian Laplacian = VectorLaplacian::Connection;
  SurfaceDiffusion::NormalPart NormalPart = SurfaceDiffusion::NormalPart::Drop;

  void Visit(SettingVisitor& visitor);
  /// isDirected: whether there is a diffusion tensor.
  void CheckTogether(const FieldSummary* fields, const RunSettings& settings, bool isDirected,
    Problems& problems) const;
};

/// The part of the surface, by area, on which the data are three floating-point numbers that are known
/// and not all 0, and that on which the vectors of these lie within 5 degrees of the surface. There is
/// none if the data are the coordinates.
struct TangentShare
{
  double Known = 0.0, Tangent = 0.0, Normal = 0.0; ///< Normal: within 5 degrees of the normal

  void Merge(const TangentShare& other)
  {
    this->Known += other.Known;
    this->Tangent += other.Tangent;
    this->Normal += other.Normal;
  }
  bool AreTangent() const { return this->Known > 0.0 && this->Tangent >= 0.9 * this->Known; }
  bool AreNormal() const { return this->Known > 0.0 && this->Normal >= 0.9 * this->Known; }
  /// Too many for chance, and too few for tangent vectors.
  bool IsPartly() const
  {
    return this->Known > 0.0 && !this->AreTangent() && this->Tangent >= 0.5 * this->Known;
  }
};

/// Collective.
TangentShare MeasureTangents(const Surface& surface, const Fields& fields,
  const Reduction& processes, const ParallelFor& parallel);

/// Of the known data of vertices. Collective.
TangentShare MeasureTangents(
  const TangentPlanes& planes, const PointData& data, const Reduction& processes);

/// Says that VectorType Automatic took the data for tangent vectors, or that they are partly.
void WarnOfVectors(const Word& name, const TangentShare& share, bool areTangent, RunResult& result);

/// Of vectors at cells the parts in the planes of the cells, of length 1 if they are unit vectors.
void ProjectIntoCells(const Surface& surface, const CellTransfer& cells, bool areUnitVectors,
  Values& vectors, const ParallelFor& parallel);

} // namespace SurfaceDiffusion
