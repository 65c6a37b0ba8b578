// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geodesics/HeatDistance.h"

#include "Core/Geodesics/GeodesicDistance.h"
#include "Core/Operators/CotanWeights.h"
#include "Core/Solvers/NestedDissection.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// Heat below this has lost digits.
constexpr double LeastHeat = 1e-290;

/// Columns that are solved together.
constexpr std::size_t WidthOfPanel = 8;

/// The unit vector along the gradient of the values at the corners; zero if there is none.
Eigen::Vector2d UnitGradient(const TriangleMesh::Shape& s, const Eigen::Vector3d& u)
{
  constexpr double roundOff = 1e-12; // where values are equal but for it, it has the direction
  const double largest = u.cwiseAbs().maxCoeff();
  if (!(largest < Never && u.maxCoeff() - u.minCoeff() > roundOff * largest))
  {
    return Eigen::Vector2d::Zero();
  }
  // Scaled first: heat may be as small as 1e-290, and the squares of its slope are zero.
  const Eigen::Vector2d g = Gradient(s, u[0] / largest, u[1] / largest, u[2] / largest);
  const double length = std::hypot(g[0], g[1]);
  return length > 0.0 && length < Never ? Eigen::Vector2d(g / length) : Eigen::Vector2d::Zero();
}

/// The times of fast marching from the sources.
std::vector<double> MarchFrom(
  const std::shared_ptr<const TriangleMesh>& mesh, const std::vector<HeatSource>& sources)
{
  std::vector<FrontSource> fronts;
  for (std::size_t k = 0; k < sources.size(); ++k)
  {
    fronts.push_back({ sources[k].Vertex, sources[k].Distance, 0, static_cast<Index>(k), 0.0 });
  }
  return GeodesicDistance(mesh).Find(fronts, Never).Times;
}

} // namespace

HeatDistance::HeatDistance(std::shared_ptr<const Assembler> assembler, double m,
  const ParallelFor& parallel, const ProgressMonitor& progress)
  : Operators(std::move(assembler))
  , Parallel(parallel)
{
  const TriangleMesh& mesh = this->Operators->Mesh();
  const Index n = mesh.NumberOfVertices();
  if (n == 0)
  {
    return;
  }
  const double h = mesh.MeanEdgeLength();
  const CornerWeights cotangents = CotanWeights(mesh, parallel);
  const Assembler& operators = *this->Operators;
  SparseMatrix matrix = ZeroMatrix(operators.Pattern());
  const bool isRegular = IsRegular(matrix);
  constexpr double resolved = 1e-14;
  // The digits of heat that is far below the heat at the sources need a factor without gaps: one that
  // leaves out entries below round-off, as SparseFactor does, has wrong directions far away.
  operators.Fill(matrix, mesh.ControlAreas(), m * h * h, cotangents, nullptr, parallel);
  this->Heat.Compute(matrix, isRegular, resolved, parallel, progress.Part(0.0, 0.5));
  Flags pinned = Flags::Constant(n, false);
  for (Index c = 0; c < mesh.NumberOfComponents(); ++c)
  {
    this->Pinned.push_back(mesh.ComponentsBegin()[static_cast<std::size_t>(c)]);
    pinned[this->Pinned.back()] = true;
  }
  // 1 on the diagonal of pinned vertices, where cotangents may add up to zero
  operators.Fill(matrix, pinned.cast<double>().matrix(), 1.0, cotangents, nullptr, parallel);
  Values load(n, 1);
  operators.Constrain(matrix, pinned, Values::Zero(n, 1), load, parallel);
  this->Poisson.Compute(matrix, isRegular, resolved, parallel, progress.Part(0.5, 1.0));
}

Values HeatDistance::Find(
  const std::vector<std::vector<HeatSource>>& sets, const ProgressMonitor& progress) const
{
  Values distances = Values::Constant(
    this->Operators->Mesh().NumberOfVertices(), static_cast<Eigen::Index>(sets.size()), Never);
  for (std::size_t first = 0; first < sets.size() && distances.rows() > 0; first += WidthOfPanel)
  {
    const std::size_t count = std::min(WidthOfPanel, sets.size() - first);
    const double all = static_cast<double>(sets.size());
    this->FindPanel(&sets[first], distances, static_cast<Eigen::Index>(first),
      static_cast<Eigen::Index>(count), progress.Part(first / all, (first + count) / all));
  }
  return distances;
}

void HeatDistance::FindPanel(const std::vector<HeatSource>* sets, Values& distances,
  Eigen::Index first, Eigen::Index count, const ProgressMonitor& progress) const
{
  const TriangleMesh& mesh = this->Operators->Mesh();
  Values x = Values::Zero(mesh.NumberOfVertices(), count);
  for (Eigen::Index k = 0; k < count; ++k)
  {
    for (const HeatSource& source : sets[k])
    {
      // Not the sum: where samples of a line are dense, it would be hotter than elsewhere.
      x(source.Vertex, k) = std::max(x(source.Vertex, k), source.Share);
    }
  }
  this->Heat.Solve(x, this->Parallel);
  progress.Report(0.4);
  x = this->Directions(sets, x);
  progress.Report(0.6);
  this->Poisson.Solve(x, this->Parallel);
  progress.Report(1.0);
  for (Eigen::Index k = 0; k < count; ++k)
  {
    Vector distance = x.col(k);
    this->Shift(sets[k], distance);
    distances.col(first + k) = distance;
  }
}

/// The right-hand side of the Poisson problem: the sum over the triangles of area grad(phi_i) . X.
Values HeatDistance::Directions(const std::vector<HeatSource>* sets, const Values& heat) const
{
  const TriangleMesh& mesh = this->Operators->Mesh();
  const Index triangles = mesh.NumberOfTriangles();
  Values b = Values::Zero(heat.rows(), heat.cols());
  std::vector<Eigen::RowVector3d> parts(static_cast<std::size_t>(triangles));
  for (Eigen::Index k = 0; k < heat.cols(); ++k)
  {
    std::vector<double> times;
    // Components without a source have no heat, and count in any way.
    const bool isFar = (heat.col(k).array() < LeastHeat).any();
    if (isFar)
    {
      times = MarchFrom(this->Operators->SharedMesh(), sets[k]);
    }
    // Around sources the distance is known, and the heat has a gradient of any direction.
    std::vector<double> known(static_cast<std::size_t>(heat.rows()), Never);
    for (const HeatSource& source : sets[k])
    {
      double& distance = known[static_cast<std::size_t>(source.Vertex)];
      distance = std::min(distance, source.Distance);
    }
    ForEach(this->Parallel, triangles,
      [&](Index t)
      {
        const TriangleMesh::Shape shape = mesh.Shapes()[static_cast<std::size_t>(t)];
        Eigen::Vector3d u, d;
        for (int a = 0; a < 3; ++a)
        {
          const Index vertex = mesh.TriangleVertices()(t, a);
          u[a] = -heat(vertex, k);
          d[a] = known[static_cast<std::size_t>(vertex)];
        }
        if (isFar && !(u.maxCoeff() < -LeastHeat))
        {
          for (int a = 0; a < 3; ++a)
          {
            u[a] = times[static_cast<std::size_t>(mesh.TriangleVertices()(t, a))];
          }
        }
        const Eigen::Vector2d x = shape.Area() *
          (d.maxCoeff() < Never ? Gradient(shape, d[0], d[1], d[2]) : UnitGradient(shape, u));
        parts[static_cast<std::size_t>(t)] = { x.dot(Gradient(shape, 1.0, 0.0, 0.0)),
          x.dot(Gradient(shape, 0.0, 1.0, 0.0)), x.dot(Gradient(shape, 0.0, 0.0, 1.0)) };
      });
    ForEach(this->Parallel, mesh.NumberOfVertices(),
      [&](Index i)
      {
        for (Index e = mesh.VertexCornersBegin()[static_cast<std::size_t>(i)];
             e < mesh.VertexCornersBegin()[static_cast<std::size_t>(i) + 1]; ++e)
        {
          const Index corner = mesh.VertexCorners()[static_cast<std::size_t>(e)];
          b(i, k) += parts[static_cast<std::size_t>(corner / 3)][corner % 3];
        }
      });
  }
  for (const Index i : this->Pinned)
  {
    b.row(i).setZero();
  }
  return b;
}

/// Add the constant of each component, with which the vertices of the sources have their distances
/// on average.
void HeatDistance::Shift(const std::vector<HeatSource>& sources, Vector& distance) const
{
  const TriangleMesh& mesh = this->Operators->Mesh();
  std::vector<HeatSource> nearest = sources;
  std::sort(nearest.begin(), nearest.end(),
    [](const HeatSource& a, const HeatSource& b)
    { return std::make_pair(a.Vertex, a.Distance) < std::make_pair(b.Vertex, b.Distance); });
  nearest.erase(std::unique(nearest.begin(), nearest.end(),
                  [](const HeatSource& a, const HeatSource& b) { return a.Vertex == b.Vertex; }),
    nearest.end());
  auto source = nearest.begin();
  for (Index c = 0; c < mesh.NumberOfComponents(); ++c)
  {
    const Index begin = mesh.ComponentsBegin()[static_cast<std::size_t>(c)];
    const Index end = mesh.ComponentsBegin()[static_cast<std::size_t>(c) + 1];
    double sum = 0.0;
    Index count = 0;
    for (; source != nearest.end() && source->Vertex < end; ++source, ++count)
    {
      sum += distance[source->Vertex] - source->Distance;
    }
    auto rows = distance.segment(begin, end - begin);
    if (count == 0)
    {
      rows.setConstant(Never);
      continue;
    }
    rows.array() = (rows.array() - sum / count).max(0.0);
  }
}

} // namespace SurfaceDiffusion
