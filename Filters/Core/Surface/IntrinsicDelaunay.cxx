// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/IntrinsicDelaunay.h"

#include "Core/Surface/TangentVectors.h"

#include <cmath>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// A symmetric tensor in a triangle's axes: xx, xy, yy.
using Tensor = Eigen::Vector3d;

/// The tensor in axes turned by `angle`.
Tensor InTurnedAxes(const Tensor& t, double angle)
{
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return { c * c * t[0] + 2.0 * c * s * t[1] + s * s * t[2],
    -c * s * t[0] + (c * c - s * s) * t[1] + c * s * t[2],
    s * s * t[0] - 2.0 * c * s * t[1] + c * c * t[2] };
}

/// The tensor in the axes of the back of its triangle: along the edge to corner 2, and mirrored.
Tensor OnTheBack(const Tensor& front, const TriangleMesh::Shape& shape)
{
  Tensor back = InTurnedAxes(front, std::atan2(shape.Y, shape.X));
  back[1] = -back[1];
  return back;
}

} // namespace

IntrinsicDelaunay::IntrinsicDelaunay(std::shared_ptr<const TriangleMesh> mesh,
  const ParallelFor& parallel, const ProgressMonitor& progress, BoundaryEdges boundary)
  : Input(std::move(mesh))
{
  IntrinsicTriangulation triangulation(*this->Input, boundary, parallel);
  this->FlipEdges(triangulation, parallel, progress);
  this->EdgeFlips.shrink_to_fit();
  this->EdgesLeft = static_cast<Index>(Sum(parallel, triangulation.NumberOfSides(),
    [&](Index side)
    { return triangulation.Twin(side) > side && !triangulation.IsDelaunay(side) ? 1.0 : 0.0; }));
  this->Triangulation = triangulation.MakeMesh(*this->Input, parallel);
}

void IntrinsicDelaunay::FlipEdges(IntrinsicTriangulation& triangulation,
  const ParallelFor& parallel, const ProgressMonitor& progress)
{
  // All sides are looked at from the last to the first, and after a flip the sides that it changes
  // once more. Most need no flip, which is found out on all threads before.
  const Index sides = triangulation.NumberOfSides();
  Buffer<char> isToCheck(sides);
  ForEach(parallel, sides, [&](Index side) { isToCheck[side] = !triangulation.IsDelaunay(side); });
  Index left = sides; // those before are still to be looked at
  std::vector<Index> again;
  std::vector<char> isAgain(sides, 0);
  const auto takeSide = [&]() -> Index
  {
    if (!again.empty())
    {
      const Index side = again.back();
      again.pop_back();
      isAgain[side] = 0;
      return side;
    }
    while (left > 0 && !isToCheck[left - 1])
    {
      --left;
    }
    return --left;
  };
  // Flips end: each lowers an energy of finitely many triangulations (Bobenko and Springborn).
  // Round-off in the lengths of needles can still flip some edges in circles, and a strip of n
  // needles needs of the order of n^2 flips. The edges that are left are counted.
  constexpr std::size_t maxChecksPerSide = 50;
  constexpr std::size_t checksBetweenReports = 65536;
  const std::size_t maxChecks = maxChecksPerSide * isToCheck.size();
  IntrinsicTriangulation::EdgeFlip flip;
  for (std::size_t checks = 0; checks < maxChecks; ++checks)
  {
    if (checks % checksBetweenReports == 0)
    {
      progress.Report(0.5);
    }
    const Index side = takeSide();
    if (side < 0)
    {
      return;
    }
    if (triangulation.IsDelaunay(side) || !triangulation.Flip(side, flip))
    {
      continue;
    }
    this->EdgeFlips.push_back(flip);
    for (const Index t : { flip.Side / 3, flip.Twin / 3 })
    {
      for (Index changed = 3 * t; changed < 3 * t + 3; ++changed)
      {
        isToCheck[changed] = 1;
        if (changed >= left && !isAgain[changed])
        {
          isAgain[changed] = 1;
          again.push_back(changed);
        }
      }
    }
  }
}

TangentVectors IntrinsicDelaunay::Transport(const Eigen::Ref<const TangentVectors>& lines) const
{
  // Area times the mean of d d^T.
  std::vector<Tensor> tensors(this->Triangulation->NumberOfTriangles());
  const auto inputCount = static_cast<std::size_t>(this->Input->NumberOfTriangles());
  for (std::size_t t = 0; t < tensors.size(); ++t)
  {
    const auto input = static_cast<Index>(t % inputCount);
    const TriangleMesh::Shape shape = this->Input->Shapes()[input];
    const double dx = lines(input, 0);
    const double dy = lines(input, 1);
    const Tensor front = shape.Area() * Tensor(dx * dx, dx * dy, dy * dy);
    tensors[t] = t < inputCount ? front : OnTheBack(front, shape);
  }
  for (const IntrinsicTriangulation::EdgeFlip& flip : this->EdgeFlips)
  {
    Tensor& left = tensors[flip.Side / 3];
    Tensor& right = tensors[flip.Twin / 3];
    // The second triangle's own side of the edge runs the other way, which a tensor does not see.
    const Tensor sum = InTurnedAxes(left, flip.FirstAngle) + InTurnedAxes(right, flip.SecondAngle);
    left = flip.LeftShare * InTurnedAxes(sum, flip.LeftAngle);
    right = (1.0 - flip.LeftShare) * InTurnedAxes(sum, flip.RightAngle);
  }
  TangentVectors transported(static_cast<Eigen::Index>(tensors.size()), 2);
  for (std::size_t t = 0; t < tensors.size(); ++t)
  {
    transported.row(static_cast<Eigen::Index>(t)) =
      MainAxis(tensors[t][0], tensors[t][1], tensors[t][2]);
  }
  return transported;
}

} // namespace SurfaceDiffusion
