// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/NonlinearDiffusion.h"
#include "Core/Models/TotalVariation/CrouzeixRaviart.h"
#include "Core/Models/TotalVariation/TotalVariationFlow.h"
#include "Core/Surface/TangentVectors.h"
#include "Meshes.h"

#include <cmath>
#include <memory>
#include <utility>

namespace SurfaceDiffusion::Testing
{

/// Settings of NonlinearDiffusion for total variation, with times and weights in coordinate units
/// and beta in (1/h)^2.
inline NonlinearDiffusion::Settings LaggedSettings(
  const TriangleMesh& mesh, double timeStep, double fidelity = 0.0, double beta = 1e-6)
{
  NonlinearDiffusion::Settings settings;
  settings.TimeStep = timeStep / mesh.LengthUnit();
  settings.Fidelity = fidelity * mesh.LengthUnit();
  settings.Along.Beta = beta / (MeanEdge(mesh) * MeanEdge(mesh));
  settings.Across = settings.Along;
  return settings;
}

inline std::unique_ptr<NonlinearDiffusion> MakeLagged(std::shared_ptr<const Assembler> assembler,
  PointData data, const NonlinearDiffusion::Settings& settings,
  std::shared_ptr<LinearSolver> solver = MakeCholeskySolver(),
  const ParallelFor& parallel = SerialFor())
{
  return std::make_unique<NonlinearDiffusion>(
    std::move(assembler), TangentVectors(), std::move(data), settings, std::move(solver), parallel);
}

/// Settings of TotalVariationFlow with times and weights in coordinate units; steady without a time
/// step.
inline TotalVariationFlow::Settings ExactSettings(
  const TriangleMesh& mesh, double timeStep, double fidelity = 0.0, double tolerance = 1e-4)
{
  TotalVariationFlow::Settings settings;
  settings.SteadyState = timeStep == 0.0;
  settings.TimeStep = timeStep / mesh.LengthUnit();
  settings.Fidelity = fidelity * mesh.LengthUnit();
  settings.StopTolerance = tolerance;
  return settings;
}

inline std::unique_ptr<TotalVariationFlow> MakeExact(std::shared_ptr<const Assembler> assembler,
  PointData data, const TotalVariationFlow::Settings& settings,
  const ParallelFor& parallel = SerialFor())
{
  return std::make_unique<TotalVariationFlow>(
    std::move(assembler), TangentVectors(), std::move(data), settings, parallel);
}

/// The exact flow on edges, started from point data.
inline std::unique_ptr<Model> MakeOnEdges(std::shared_ptr<const Assembler> assembler,
  PointData data, const TotalVariationFlow::Settings& settings,
  const ParallelFor& parallel = SerialFor())
{
  const auto edges = std::make_shared<MedialMesh>(assembler->Mesh());
  const auto onEdges = std::make_shared<Assembler>(edges->Edges(), parallel);
  TotalCorrection conserved;
  if (settings.Norm == FidelityNorm::L2 || settings.Fidelity == 0.0)
  {
    conserved = TotalCorrection(assembler->Mesh(), data, settings.Fidelity > 0.0, parallel);
  }
  return std::make_unique<CrouzeixRaviartModel>(
    std::move(assembler), edges, std::move(data), std::move(conserved),
    [&](PointData edgeData) { return MakeExact(onEdges, std::move(edgeData), settings, parallel); },
    parallel);
}

/// A frame from a fixed vector on each triangle.
inline TangentVectors SkewFrames(const TriangleMesh& mesh, const Surface& s)
{
  const Points directions = Eigen::RowVector3d(1.0, 2.0, 3.0).replicate(s.NumberOfTriangles(), 1);
  return TangentVectorsFromTriangleVectors(mesh, s.Vertices, s.Faces, directions);
}

/// 1 within `angle` of the north pole of a unit sphere, 0 elsewhere.
inline Values Cap(const TriangleMesh& mesh, const Surface& s, double angle)
{
  return Sample(mesh, s,
    [&](const Eigen::RowVector3d& x) { return std::acos(x[2] / x.norm()) < angle ? 1.0 : 0.0; });
}

/// Means over the vertices at least 0.25 from the edge of the cap, inside and outside.
struct Plateaus
{
  double Inside = 0.0, Outside = 0.0;
};

inline Plateaus MeasurePlateaus(
  const TriangleMesh& mesh, const Surface& s, const Values& u, double angle)
{
  Plateaus sum;
  int inside = 0, outside = 0;
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    const Eigen::RowVector3d x = s.Vertices.row(mesh.InputVertex()[i]);
    const double theta = std::acos(x[2] / x.norm());
    if (theta < angle - 0.25)
    {
      sum.Inside += u(i, 0);
      ++inside;
    }
    else if (theta > angle + 0.25)
    {
      sum.Outside += u(i, 0);
      ++outside;
    }
  }
  return { sum.Inside / inside, sum.Outside / outside };
}

/// After TV flow for `time` of a cap of height 1; 1/lambda in place of time for its steady state
/// with fidelity.
inline Plateaus ExactPlateaus(double angle, double time)
{
  return { 1.0 - time / std::tan(0.5 * angle), time * std::tan(0.5 * angle) };
}

/// The larger of the relative errors of both plateaus.
inline double PlateauError(const Plateaus& computed, const Plateaus& exact)
{
  return std::max(std::abs(computed.Inside / exact.Inside - 1.0),
    std::abs(computed.Outside / exact.Outside - 1.0));
}

} // namespace SurfaceDiffusion::Testing
