// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/Relief.h"

#include "Core/Geometry/Bodies.h"
#include "Core/Geometry/SelfIntersections.h"
#include "Core/Geometry/TriangleTree.h"
#include "Core/Geometry/Walls.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

using Vector3 = Eigen::Vector3d;

/// The longest d: at edges sharper than 60 degrees relief is lower.
constexpr double LongestDirection = 2.0;
/// Principal parts of normals below this, over the largest, are of one smooth surface.
constexpr double SharpPart = 1e-3;
/// Relief over the radius of the largest ball.
constexpr double PartOfBall = 0.5;
/// Halvings of heights where triangles cross; then they are 0.
constexpr int Halvings = 4;
constexpr int MaximumRounds = 12;

Vector3 PlaceOf(const Points& points, Index vertex)
{
  return points.row(vertex).transpose();
}

Vector3 DoubledNormal(const Points& points, const Triangles& faces, Index t)
{
  const Vector3 a = PlaceOf(points, faces(t, 0));
  return (PlaceOf(points, faces(t, 1)) - a).cross(PlaceOf(points, faces(t, 2)) - a);
}

/// Unit normals, 0 for triangles of no area.
Points UnitNormals(const Points& points, const Triangles& faces, const ParallelFor& parallel)
{
  Points normals(faces.rows(), 3);
  ForEach(parallel, static_cast<Index>(faces.rows()),
    [&](Index t)
    { normals.row(t) = DoubledNormal(points, faces, t).stableNormalized().transpose(); });
  return normals;
}

double VolumeOf(const Points& points, const Triangles& faces)
{
  const Eigen::RowVector3d center = points.colwise().mean();
  double volume = 0.0;
  for (Index t = 0; t < static_cast<Index>(faces.rows()); ++t)
  {
    volume +=
      (PlaceOf(points, faces(t, 0)) - center.transpose()).dot(DoubledNormal(points, faces, t));
  }
  return volume / 6.0;
}

double AngleAt(const Vector3& at, const Vector3& p, const Vector3& q)
{
  return std::atan2((p - at).cross(q - at).norm(), (p - at).dot(q - at));
}

/// The vectors d of MakeRelief(), 0 at vertices without normal.
Points FindDirections(
  const Points& points, const Triangles& faces, const Points& normals, const ParallelFor& parallel)
{
  struct Sums
  {
    Eigen::Matrix3d Products = Eigen::Matrix3d::Zero();
    Vector3 Normals = Vector3::Zero();
  };
  std::vector<Sums> sums(static_cast<std::size_t>(points.rows()));
  for (Index t = 0; t < static_cast<Index>(faces.rows()); ++t)
  {
    const Vector3 normal = normals.row(t).transpose();
    for (int a = 0; a < 3; ++a)
    {
      const double angle = AngleAt(PlaceOf(points, faces(t, a)),
        PlaceOf(points, faces(t, (a + 1) % 3)), PlaceOf(points, faces(t, (a + 2) % 3)));
      Sums& sum = sums[static_cast<std::size_t>(faces(t, a))];
      sum.Products += angle * normal * normal.transpose();
      sum.Normals += angle * normal;
    }
  }
  Points directions = Points::Zero(points.rows(), 3);
  ForEach(parallel, static_cast<Index>(points.rows()),
    [&](Index i)
    {
      const Sums& sum = sums[static_cast<std::size_t>(i)];
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> parts(sum.Products);
      const Vector3 values = parts.eigenvalues();
      Vector3 direction = Vector3::Zero();
      for (int k = 0; k < 3; ++k)
      {
        if (values[k] > SharpPart * values[2])
        {
          const Vector3 axis = parts.eigenvectors().col(k);
          direction += axis * (axis.dot(sum.Normals) / values[k]);
        }
      }
      const double length = direction.norm();
      directions.row(i) =
        (length > LongestDirection ? LongestDirection / length : 1.0) * direction.transpose();
    });
  return directions;
}

/// The factor from 0 to 1 by which a vertex moves, so that its path is at most PartOfBall of the
/// radius of the largest empty ball.
double PartInBall(const TriangleTree& tree, const Points& points, const Triangles& faces,
  Index vertex, const Vector3& path)
{
  const double length = path.norm();
  if (!(length > 0.0))
  {
    return 1.0;
  }
  const Vector3 place = PlaceOf(points, vertex);
  const Vector3 axis = path / length;
  const double largest = length / PartOfBall;
  double radius = largest;
  const auto enters = [&](const TriangleTree::Box& box)
  { return box.squaredExteriorDistance(place + radius * axis) < radius * radius; };
  tree.Visit(enters,
    [&](Index t)
    {
      if (faces(t, 0) == vertex || faces(t, 1) == vertex || faces(t, 2) == vertex)
      {
        return;
      }
      constexpr int shrinkings = 20; // each touches the triangle nearer to where the ball does
      for (int k = 0; k < shrinkings && radius > 0.0; ++k)
      {
        const Vector3 nearest = NearestInTriangle(place + radius * axis,
          PlaceOf(points, faces(t, 0)), PlaceOf(points, faces(t, 1)), PlaceOf(points, faces(t, 2)));
        const Vector3 offset = nearest - place;
        const double rise = offset.dot(axis);
        // The ball of this radius has `nearest` on its boundary.
        const double touching = rise > 0.0 ? offset.squaredNorm() / (2.0 * rise) : radius;
        if (!(touching < radius * (1.0 - 1e-6)))
        {
          return;
        }
        radius = touching;
      }
    });
  return radius / largest;
}

Index CountSet(const std::vector<char>& flags)
{
  return static_cast<Index>(std::count_if(flags.begin(), flags.end(), [](char f) { return f; }));
}

} // namespace

Vector ReliefHeights(const Points& points, const Triangles& triangles, const Vector& values,
  const ReliefProfile& profile)
{
  if (!profile.TwoLevels)
  {
    return (profile.Base + profile.Height * values.array()).matrix();
  }
  // Gradients at vertices, weighted by area: of a triangle with edges e_a opposite its corners, the
  // sum over corners of u_a n x e_a, over twice the area.
  Points gradients = Points::Zero(points.rows(), 3);
  Vector areas = Vector::Zero(points.rows());
  for (Index t = 0; t < static_cast<Index>(triangles.rows()); ++t)
  {
    const Vector3 normal = DoubledNormal(points, triangles, t);
    const double area = normal.norm();
    if (!(area > 0.0))
    {
      continue;
    }
    Vector3 sum = Vector3::Zero();
    for (int a = 0; a < 3; ++a)
    {
      const Vector3 side =
        PlaceOf(points, triangles(t, (a + 2) % 3)) - PlaceOf(points, triangles(t, (a + 1) % 3));
      sum += values[triangles(t, a)] * normal.cross(side);
    }
    for (int a = 0; a < 3; ++a)
    {
      gradients.row(triangles(t, a)) += sum.transpose() / area;
      areas[triangles(t, a)] += area;
    }
  }
  Vector heights(values.size());
  for (Eigen::Index i = 0; i < values.size(); ++i)
  {
    const double above = values[i] - profile.Threshold;
    const double rise = areas[i] > 0.0 ? gradients.row(i).norm() / areas[i] * profile.Flank : 0.0;
    const double part = rise > 0.0 ? std::clamp(0.5 + above / rise, 0.0, 1.0)
                                   : (above > 0.0      ? 1.0
                                         : above < 0.0 ? 0.0
                                                       : 0.5);
    heights[i] = profile.Base + profile.Height * part;
  }
  return heights;
}

std::vector<char> FindOverhangs(
  const Points& points, const Triangles& triangles, const Eigen::Vector3d& up, double degrees)
{
  constexpr double roundOff = 1e-9; // faces at the angle itself have relief
  Triangles faces = triangles;
  TurnOutwards(points, faces);
  const double steepest = std::sin(degrees * std::acos(-1.0) / 180.0) + roundOff;
  const Vector3 down = -up.stableNormalized();
  std::vector<char> overhangs(static_cast<std::size_t>(points.rows()), 0);
  for (Index t = 0; t < static_cast<Index>(faces.rows()); ++t)
  {
    if (DoubledNormal(points, faces, t).stableNormalized().dot(down) > steepest)
    {
      for (int a = 0; a < 3; ++a)
      {
        overhangs[static_cast<std::size_t>(faces(t, a))] = 1;
      }
    }
  }
  return overhangs;
}

Relief MakeRelief(const Points& points, const Triangles& triangles, const Vector& heights,
  const ParallelFor& parallel, const ProgressMonitor& progress)
{
  Relief relief;
  const std::vector<Index> firsts = FindFirsts(triangles);
  Triangles faces(triangles.rows(), 3);
  std::vector<Index> places(firsts.size()); // of the first ones among faces
  Index distinct = 0;
  for (std::size_t t = 0; t < firsts.size(); ++t)
  {
    if (firsts[t] == static_cast<Index>(t))
    {
      places[t] = distinct;
      faces.row(distinct++) = triangles.row(static_cast<Index>(t));
    }
  }
  faces.conservativeResize(distinct, 3);
  relief.RepeatedTriangles = static_cast<Index>(firsts.size()) - distinct;
  const auto count = static_cast<Index>(points.rows());
  TurnOutwards(points, faces);
  const Bodies bodies = FindBodies(points, faces, parallel);
  relief.OpenEdges = bodies.Edges.Open;
  relief.NonManifoldEdges = bodies.Edges.NonManifold;
  relief.OverlappingBodies = bodies.Overlaps;
  relief.Faces.resize(triangles.rows(), 3);
  for (std::size_t t = 0; t < firsts.size(); ++t)
  {
    relief.Faces.row(static_cast<Index>(t)) =
      faces.row(places[static_cast<std::size_t>(firsts[t])]);
  }
  progress.Report(0.1);
  const Points normals = UnitNormals(points, faces, parallel);
  const Points directions = FindDirections(points, faces, normals, parallel);
  relief.Heights = heights;
  Vector& used = relief.Heights;
  {
    const TriangleTree tree(points, faces);
    ForEach(parallel, count,
      [&](Index i)
      {
        const Vector3 path = heights[i] * directions.row(i).transpose();
        used[i] = bodies.Edges.IsRim[static_cast<std::size_t>(i)] ||
            bodies.IsInside[static_cast<std::size_t>(i)]
          ? 0.0
          : heights[i] * PartInBall(tree, points, faces, i, path);
      });
  }
  progress.Report(0.3);
  const std::vector<char> crossesBefore =
    FindSelfIntersections(points, faces, parallel, progress.Part(0.3, 0.5));
  relief.CrossingTrianglesBefore = CountSet(crossesBefore);
  std::vector<char> timesHalved(static_cast<std::size_t>(count), 0);
  for (int round = 0;; ++round)
  {
    relief.Places = points + (directions.array().colwise() * used.array()).matrix();
    const std::vector<char> crosses =
      FindSelfIntersections(relief.Places, faces, parallel, progress.Part(0.5, 0.9));
    relief.CrossingTriangles = CountSet(crosses);
    std::vector<char> isLowered(static_cast<std::size_t>(count), 0);
    for (Index t = 0; t < static_cast<Index>(faces.rows()); ++t)
    {
      for (int a = 0; a < 3; ++a)
      {
        char& lowered = isLowered[static_cast<std::size_t>(faces(t, a))];
        lowered = lowered ||
          (crosses[static_cast<std::size_t>(t)] && !crossesBefore[static_cast<std::size_t>(t)] &&
            used[faces(t, a)] != 0.0);
      }
    }
    if (round == MaximumRounds || CountSet(isLowered) == 0)
    {
      break;
    }
    for (Index i = 0; i < count; ++i)
    {
      if (isLowered[static_cast<std::size_t>(i)])
      {
        used[i] = ++timesHalved[static_cast<std::size_t>(i)] > Halvings ? 0.0 : 0.5 * used[i];
      }
    }
  }
  for (Index i = 0; i < count; ++i)
  {
    relief.LoweredVertices += used[i] != heights[i];
  }
  relief.VolumeChange = VolumeOf(relief.Places, faces) - VolumeOf(points, faces);
  relief.Walls = FindWalls(points, relief.Places, faces, normals, directions, parallel);
  relief.SmallestWall = relief.Walls.empty()
    ? std::numeric_limits<double>::infinity()
    : *std::min_element(relief.Walls.begin(), relief.Walls.end());
  progress.Report(1.0);
  return relief;
}

} // namespace SurfaceDiffusion
