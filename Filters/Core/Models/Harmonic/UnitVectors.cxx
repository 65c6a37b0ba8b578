// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Harmonic/UnitVectors.h"

#include "Core/Foundation/SymmetricModes.h"
#include "Core/Surface/AllComponents.h"

#include <Eigen/Geometry>

#include <limits>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

/// A mean shorter than this says little about the direction of the vectors, and can mislead: that
/// of the normals of a closed surface with a hole points away from the hole.
constexpr double MinimumMeanLength = 0.5;

/// Sums over the known vectors of each component of the surface: area, A u, and of lines A u u^T.
Values SumKnown(const TriangleMesh& mesh, const PointData& data, bool lineField)
{
  const Eigen::Index m = data.Given.cols();
  Values sums = Values::Zero(mesh.NumberOfComponents(), 1 + m + (lineField ? m * m : 0));
  for (Index c = 0; c < mesh.NumberOfComponents(); ++c)
  {
    for (Index i = mesh.ComponentsBegin()[c]; i < mesh.ComponentsBegin()[c + 1]; ++i)
    {
      if (data.Missing[i])
      {
        continue;
      }
      const auto u = data.Given.row(i);
      sums(c, 0) += mesh.ControlAreas()[i];
      sums.row(c).segment(1, m) += mesh.ControlAreas()[i] * u;
      if (lineField)
      {
        Eigen::Map<Eigen::MatrixXd>(&sums(c, 1 + m), m, m) +=
          mesh.ControlAreas()[i] * (u.transpose() * u);
      }
    }
  }
  mesh.GetReduction().SumComponents(AllComponents(mesh), sums);
  return sums;
}

/// The direction that prevails, from a component's row of SumKnown(); zero if there is none.
Eigen::RowVectorXd PrevailingDirection(
  const Eigen::Ref<const Eigen::RowVectorXd>& sums, Eigen::Index m, bool lineField)
{
  const double area = sums[0];
  Eigen::RowVectorXd sum = sums.segment(1, m);
  if (lineField && area > 0.0)
  {
    const SymmetricModes axes(Eigen::Map<const Eigen::MatrixXd>(sums.data() + 1 + m, m, m));
    const bool decided =
      axes.Eigenvalues[m - 1] - axes.Eigenvalues[m - 2] > MinimumMeanLength * area;
    sum = decided ? Eigen::RowVectorXd(axes.Vectors.col(m - 1).transpose())
                  : Eigen::RowVectorXd(Eigen::RowVectorXd::Zero(m));
  }
  else if (!(sum.norm() > MinimumMeanLength * area))
  {
    sum.setZero();
  }
  Normalize(sum);
  return sum;
}

/// Of those neighbours of vertex i that have a direction.
Eigen::RowVectorXd SumOfNeighbours(
  const TriangleMesh& mesh, const Values& u, const Flags& known, bool lineField, Index i)
{
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(u.cols());
  for (Index c = mesh.VertexCornersBegin()[i]; c < mesh.VertexCornersBegin()[i + 1]; ++c)
  {
    const Index corner = mesh.VertexCorners()[c];
    for (const int step : { 1, 2 })
    {
      const Index j = mesh.OtherCorner(corner, step);
      if (known[j])
      {
        sum += (lineField && sum.dot(u.row(j)) < 0.0 ? -1.0 : 1.0) * u.row(j);
      }
    }
  }
  return sum;
}

} // namespace

void SpreadUnitVectors(const TriangleMesh& mesh, Values& u, Flags& known, bool lineField)
{
  const Reduction& reduction = mesh.GetReduction();
  std::vector<Index> open, left;
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    if (!known[i])
    {
      open.push_back(i);
    }
  }
  Values sums = Values::Zero(u.rows(), u.cols());
  while (reduction.Any(!open.empty()))
  {
    for (const Index i : open)
    {
      sums.row(i) = SumOfNeighbours(mesh, u, known, lineField, i);
    }
    reduction.Accumulate(sums);
    left.clear();
    for (const Index i : open)
    {
      known[i] = Normalize(sums.row(i));
      if (known[i])
      {
        u.row(i) = sums.row(i);
      }
      else
      {
        left.push_back(i);
      }
      sums.row(i).setZero();
    }
    const bool stuck = !reduction.Any(left.size() < open.size());
    for (std::size_t i = 0; stuck && i < left.size(); ++i)
    {
      known[left[i]] = true;
      u.row(left[i]) = Eigen::RowVectorXd::Unit(u.cols(), 0);
    }
    open.swap(left);
    if (stuck)
    {
      open.clear();
    }
  }
}

void FillMissingUnitVectors(const TriangleMesh& mesh, PointData& data, bool lineField,
  InitialFill fill, std::int64_t seed, const std::vector<std::int64_t>& ids)
{
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    if (!Normalize(data.Given.row(i)))
    {
      data.Given.row(i).setConstant(std::numeric_limits<double>::quiet_NaN());
      data.Missing[i] = true;
    }
  }
  const Flags undirected = data.Given.array().isNaN().rowwise().any();
  FillMissing(mesh, data, fill, seed, ids);
  if (!mesh.GetReduction().Any(data.Missing.any()))
  {
    return;
  }
  Flags known = !data.Missing;
  const Values sums = SumKnown(mesh, data, lineField);
  for (Index c = 0; c < mesh.NumberOfComponents(); ++c)
  {
    const Index begin = mesh.ComponentsBegin()[c];
    const Index end = mesh.ComponentsBegin()[c + 1];
    const Eigen::RowVectorXd mean = PrevailingDirection(sums.row(c), data.Given.cols(), lineField);
    for (Index i = begin; i < end; ++i)
    {
      const bool directed = fill == InitialFill::Input && !undirected[i]; // a unit vector already
      if (!data.Missing[i] || directed)
      {
        known[i] = true;
        continue;
      }
      if (fill != InitialFill::Noise)
      {
        data.Start.row(i) = mean;
      }
      known[i] = Normalize(data.Start.row(i));
    }
  }
  SpreadUnitVectors(mesh, data.Start, known, lineField);
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    if (undirected[i])
    {
      data.Given.row(i) = data.Start.row(i); // never read as data, but finite
    }
  }
}

void NormalizeFilled(PointData& data, const Values& instead)
{
  for (Index i = 0; i < static_cast<Index>(data.Start.rows()); ++i)
  {
    if (data.Missing[i] && !Normalize(data.Start.row(i)))
    {
      data.Start.row(i) = instead.row(i);
    }
  }
}

void ProjectIntoPlanes(const Values& normals, Values& vectors)
{
  constexpr double roundOff = 1e-12;
  for (Index i = 0; i < static_cast<Index>(vectors.rows()); ++i)
  {
    const Eigen::RowVectorXd whole = vectors.row(i);
    vectors.row(i) -= whole.dot(normals.row(i)) * normals.row(i);
    if (vectors.row(i).norm() <= roundOff * whole.norm())
    {
      vectors.row(i).setZero();
    }
  }
}

void NormalizeFilledInPlanes(const Values& normals, PointData& data)
{
  Values parts = data.Start;
  ProjectIntoPlanes(normals, parts);
  for (Index i = 0; i < static_cast<Index>(parts.rows()); ++i)
  {
    if (data.Missing[i])
    {
      if (!Normalize(parts.row(i)))
      {
        parts.row(i) = Eigen::Vector3d(normals.row(i)).unitOrthogonal();
      }
      data.Start.row(i) = parts.row(i);
    }
  }
}

} // namespace SurfaceDiffusion
