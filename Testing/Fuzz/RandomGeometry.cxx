// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RandomInput.h"

#include "Core/Geometry/DirectionField.h"
#include "Core/Geometry/SurfaceDenoising.h"

#include <vector>

namespace SurfaceDiffusion::Testing
{

namespace
{

void RunDirections(Bytes& bytes, const Assembler& assembler, const Points& points,
  const Triangles& triangles, const TangentVectors& frames)
{
  DirectionSettings settings;
  settings.Method = static_cast<DirectionMethod>(bytes.Below(4));
  settings.Perpendicular = bytes.Flip();
  settings.SmoothingLength = bytes.Flip() ? bytes.Size(3.0) : 0.0;
  settings.HintWeight = bytes.Size(6.0);
  const double angle = 10.0 * bytes.Short();
  if (HasFlatTriangles(assembler.Mesh()))
  {
    return;
  }
  TangentVectors field = MakeDirectionField(assembler, points, triangles,
    settings.Method == DirectionMethod::Hints ? frames : TangentVectors(0, 2), settings);
  RotateLines(field, angle);
  Require(field.rows() == assembler.Mesh().NumberOfTriangles(), "a triangle has no direction");
  for (const auto& d : field.rowwise())
  {
    Require(std::abs(d.norm() - 1.0) < 1e-9 || d.norm() == 0.0, "a direction is not one long");
  }
}

void RunDenoising(Bytes& bytes, const TriangleMesh& mesh, const Points& points)
{
  DenoisingSettings settings;
  const double length = (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
  settings.NoiseLevel = bytes.Flip() ? length * bytes.Size(3.0) : 0.0;
  settings.Type = static_cast<SurfaceType>(bytes.Below(3));
  settings.NoiseLength = bytes.Flip(4) ? bytes.Size(1.0) : 0.0;
  settings.CreaseAngle = bytes.Flip(4) ? 10.0 * bytes.Below(19) : 0.0;
  settings.DisplacementLimit = bytes.Flip(4) ? length * bytes.Size(3.0) : 0.0;
  std::vector<char> fixed;
  if (bytes.Flip())
  {
    fixed.resize(static_cast<std::size_t>(mesh.NumberOfVertices()));
    for (char& flag : fixed)
    {
      flag = bytes.Flip(4);
    }
  }
  DenoisingReport report;
  const Points moved = DenoiseSurface(mesh, points, fixed, settings, &report);
  Require(moved.rows() == points.rows() && moved.allFinite(), "a point is not finite");
  Require(std::isfinite(report.NoiseLevel) && report.NoiseLevel >= 0.0, "the noise has no level");
  for (std::size_t i = 0; i < fixed.size(); ++i)
  {
    const auto row = static_cast<Eigen::Index>(i);
    Require(!fixed[i] || moved.row(row) == points.row(row), "a fixed point has moved");
  }
}

} // namespace

void RunGeometry(Bytes& bytes, const Assembler& assembler, const Points& points,
  const Triangles& triangles, const TangentVectors& frames)
{
  RunDirections(bytes, assembler, points, triangles, frames);
  RunDenoising(bytes, assembler.Mesh(), points);
}

} // namespace SurfaceDiffusion::Testing
