// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "UnitVectors.h"

#include <Eigen/Eigenvalues>

#include <limits>

namespace SurfaceDiffusion
{

namespace
{

/// A mean shorter than this tells little about where the vectors point, and can mislead: that of
/// the normals of a closed surface with a hole points away from the hole.
constexpr double Undecided = 0.5;

/// The direction that prevails among the known vectors of the vertices begin .. end; zero where
/// there is none.
Eigen::RowVectorXd PrevailingDirection(
  const TriangleMesh& mesh, const PointData& data, bool lineField, Index begin, Index end)
{
  const Eigen::Index m = data.Given.cols();
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(m);
  Eigen::MatrixXd tensor = Eigen::MatrixXd::Zero(m, m);
  double area = 0.0;
  for (Index i = begin; i < end; ++i)
  {
    if (!data.Missing[i])
    {
      const auto u = data.Given.row(i);
      area += mesh.ControlAreas()[i];
      sum += mesh.ControlAreas()[i] * u;
      if (lineField)
      {
        tensor += mesh.ControlAreas()[i] * (u.transpose() * u);
      }
    }
  }
  if (lineField && area > 0.0)
  {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(tensor);
    const bool decided = axes.eigenvalues()[m - 1] - axes.eigenvalues()[m - 2] > Undecided * area;
    sum = decided ? Eigen::RowVectorXd(axes.eigenvectors().col(m - 1).transpose())
                  : Eigen::RowVectorXd(Eigen::RowVectorXd::Zero(m));
  }
  else if (!(sum.norm() > Undecided * area))
  {
    sum.setZero();
  }
  Normalize(sum);
  return sum;
}

/// Give every vertex of begin .. end that has no direction yet the sum of its neighbours' that
/// have one, ring by ring from the rim inwards; e_1 where nothing is known.
void SpreadInwards(
  const TriangleMesh& mesh, Values& u, Flags& known, bool lineField, Index begin, Index end)
{
  std::vector<Index> ring, open;
  for (Index i = begin; i < end; ++i)
  {
    if (!known[i])
    {
      open.push_back(i);
    }
  }
  while (!open.empty())
  {
    ring.clear();
    std::vector<Index> left;
    for (const Index i : open)
    {
      Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(u.cols());
      for (Index c = mesh.VertexCornersBegin()[i]; c < mesh.VertexCornersBegin()[i + 1]; ++c)
      {
        const Index corner = mesh.VertexCorners()[c];
        for (const int step : { 1, 2 })
        {
          const Index j = mesh.TriangleVertices()(corner / 3, (corner % 3 + step) % 3);
          if (known[j])
          {
            sum += (lineField && sum.dot(u.row(j)) < 0.0 ? -1.0 : 1.0) * u.row(j);
          }
        }
      }
      if (Normalize(sum))
      {
        u.row(i) = sum;
        ring.push_back(i);
      }
      else
      {
        left.push_back(i);
      }
    }
    if (ring.empty()) // nothing known, or neighbours that cancel exactly
    {
      u.row(left.back()) = Eigen::RowVectorXd::Unit(u.cols(), 0);
      ring.push_back(left.back());
      left.pop_back();
    }
    for (const Index i : ring)
    {
      known[i] = true;
    }
    open.swap(left);
  }
}

} // namespace

void PrepareUnitVectors(const TriangleMesh& mesh, PointData& data, bool lineField, InitialFill fill,
  std::int64_t seed, const std::vector<std::int64_t>& ids)
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
  if (!data.Missing.any())
  {
    return;
  }
  Flags known = !data.Missing;
  for (Index c = 0; c < mesh.NumberOfComponents(); ++c)
  {
    const Index begin = mesh.ComponentsBegin()[c];
    const Index end = mesh.ComponentsBegin()[c + 1];
    const Eigen::RowVectorXd mean = PrevailingDirection(mesh, data, lineField, begin, end);
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
    SpreadInwards(mesh, data.Start, known, lineField, begin, end);
  }
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    if (undirected[i])
    {
      data.Given.row(i) = data.Start.row(i); // never read as data, but finite
    }
  }
}

} // namespace SurfaceDiffusion
