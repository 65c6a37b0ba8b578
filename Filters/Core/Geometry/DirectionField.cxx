// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/DirectionField.h"

#include "Core/Geometry/PrincipalDirections.h"
#include "Core/Geometry/SmoothLineField.h"
#include "Core/Solvers/SolverChoice.h"
#include "Core/Surface/TangentVectors.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// A solver for systems whose modes are as long as the surface.
std::unique_ptr<LinearSolver> MakeSolverFor(
  Eigen::Index size, double solves, bool allowMultigrid, const ParallelFor& parallel)
{
  SolverTask task;
  task.NumberOfVertices = static_cast<Index>(size);
  task.DiffusionNumber.reset();
  task.NumberOfSolves = solves;
  task.AllowMultigrid = allowMultigrid;
  std::unique_ptr<LinearSolver> solver = MakeSolver(SolverMethod::Automatic, task, parallel);
  IterationLimits limits;
  limits.Tolerance = 1e-8; // of directions more can't be seen
  limits.MaximumNumberOfIterations = 20000;
  solver->SetLimits(limits);
  return solver;
}

/// Per triangle, (v_1 + i v_2)^2 of a vector field v that is smooth in space and has no symmetry: it
/// chooses where curvature does not, as on a sphere or a plane, by the places of the points and not
/// by their numbers.
TangentVectors SquaresOfFixedLines(const TriangleMesh& mesh, const Eigen::Ref<const Points>& points,
  const Eigen::Ref<const Triangles>& triangles, const ParallelFor& parallel)
{
  const auto corner = [&](Index t, int a) -> Eigen::Vector3d
  { return points.row(triangles(mesh.InputTriangle()[t], a)).transpose(); };
  Eigen::AlignedBox3d box;
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    for (int a = 0; a < 3; ++a)
    {
      box.extend(corner(t, a));
    }
  }
  const Eigen::Vector3d main(1.0, 0.2, 0.1);
  Eigen::Matrix3d slope;
  slope << 0.07, -0.13, 0.19, 0.23, 0.05, -0.11, -0.17, 0.29, 0.03;
  TangentVectors squares(mesh.NumberOfTriangles(), 2);
  ForEach(parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      const Eigen::Vector3d middle = (corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3.0;
      const Eigen::Vector3d v = main + slope * (middle - box.center()) / box.diagonal().norm();
      const Eigen::Vector2d line = TriangleAxes(mesh, points, triangles, t).transpose() * v;
      squares.row(t) << line[0] * line[0] - line[1] * line[1], 2.0 * line[0] * line[1];
    });
  return squares;
}

/// Add a little of the fixed lines to lines and their weights.
void AddFixedLines(const TangentVectors& squares, TangentVectors& lines, Vector& weights,
  const ParallelFor& parallel)
{
  constexpr double share = 1e-6;
  ForEach(parallel, static_cast<Index>(lines.rows()),
    [&](Index t)
    {
      const Eigen::RowVector2d line = lines.row(t);
      const Eigen::RowVector2d square(
        line[0] * line[0] - line[1] * line[1], 2.0 * line[0] * line[1]);
      const Eigen::RowVector2d sum = weights[t] * square + share * squares.row(t);
      const double angle = 0.5 * std::atan2(sum[1], sum[0]);
      weights[t] = sum.norm();
      lines.row(t) << std::cos(angle), std::sin(angle);
    });
}

} // namespace

TangentVectors MakeDirectionField(const Assembler& assembler,
  const Eigen::Ref<const Points>& points, const Eigen::Ref<const Triangles>& triangles,
  const Eigen::Ref<const TangentVectors>& hints, const DirectionSettings& settings,
  const ParallelFor& parallel, const ProgressMonitor& progress, LineFieldReport* report)
{
  LineFieldReport found;
  double missed = 0.0;
  const TriangleMesh& mesh = assembler.Mesh();
  const double quarterTurn = 0.5 * std::acos(-1.0);
  TangentVectors lines = hints;
  Vector weights = Vector::Ones(mesh.NumberOfTriangles());
  if (settings.Method != DirectionMethod::Hints)
  {
    const auto solver = MakeSolverFor(mesh.NumberOfVertices(), 4.0, true, parallel);
    PrincipalDirections principal = FindPrincipalDirections(assembler, points, triangles,
      settings.SmoothingLength, *solver, parallel, progress.Part(0.0, 0.3));
    missed = principal.MissedResidual;
    lines = std::move(principal.MinimumCurvature);
    const double mean = principal.Difference.size() > 0 ? principal.Difference.mean() : 0.0;
    weights = principal.Difference / (mean > 0.0 ? mean : 1.0);
    if (settings.Method == DirectionMethod::Smooth)
    {
      AddFixedLines(
        SquaresOfFixedLines(mesh, points, triangles, parallel), lines, weights, parallel);
    }
    RotateLines(lines, settings.Perpendicular ? quarterTurn : 0.0, parallel);
  }
  if (settings.Method != DirectionMethod::PrincipalCurvature && mesh.NumberOfTriangles() > 0)
  {
    const LineFieldOperator laplacian(assembler.SharedMesh());
    progress.Report(0.4);
    const auto solver = MakeSolverFor(laplacian.Mass().size(), 15.0, false, parallel);
    lines = settings.Method == DirectionMethod::Smooth
      ? SmoothestLineField(laplacian, lines, weights, *solver, progress.Part(0.4, 1.0), &found,
          settings.MaximumNumberOfSteps)
      : LineFieldFromHints(laplacian, lines, settings.HintWeight * weights, *solver,
          progress.Part(0.4, 1.0), &found);
  }
  progress.Report(1.0);
  if (report)
  {
    *report = found;
    report->MissedResidual = std::max(missed, found.MissedResidual);
  }
  return lines;
}

void RotateLines(TangentVectors& lines, double angle, const ParallelFor& parallel)
{
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  ForEach(parallel, static_cast<Index>(lines.rows()),
    [&](Index t)
    {
      const Eigen::RowVector2d d = lines.row(t);
      lines.row(t) << c * d[0] - s * d[1], s * d[0] + c * d[1];
    });
}

} // namespace SurfaceDiffusion
