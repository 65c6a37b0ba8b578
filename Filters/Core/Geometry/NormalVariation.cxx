// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/NormalVariation.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// r of the energy: it keeps slopes of triangles without neighbours at 0.
constexpr double Ridge = 1e-4;

/// The axes of a triangle: along its first edge, and to the left of it.
struct Axes
{
  Axes(const TriangleMesh& mesh, const Points& points, const FaceGeometry& geometry, Index f)
  {
    const auto corners = mesh.TriangleVertices().row(f);
    this->First = (points.row(corners[1]) - points.row(corners[0])).normalized();
    this->Second = Eigen::RowVector3d(geometry.Normals.row(f)).cross(this->First);
  }
  Eigen::Vector2d operator()(const Eigen::RowVector3d& v) const
  {
    return { this->First.dot(v), this->Second.dot(v) };
  }

  Eigen::RowVector3d First, Second;
};

Eigen::Vector2d ToTheLeft(const Eigen::Vector2d& v)
{
  return { -v[1], v[0] };
}

/// The edge of triangle f with the vertices of triangle g: the corner opposite of it, or -1.
int CornerOpposite(const Triangles& triangles, Index f, Index g)
{
  int opposite = -1;
  int shared = 0;
  for (int a = 0; a < 3; ++a)
  {
    const Index v = triangles(f, a);
    const bool isShared =
      v == triangles(g, 0) || v == triangles(g, 1) || v == triangles(g, 2);
    shared += isShared;
    opposite = isShared ? opposite : a;
  }
  return shared == 2 ? opposite : -1;
}

/// The projection on a ball around 0.
template <typename V>
V Bounded(const V& v, double radius)
{
  const double length = v.norm();
  return length > radius ? V(radius / length * v) : v;
}

} // namespace

NormalVariation::NormalVariation(
  const FaceGraph& graph, double unit, const ParallelFor& parallel)
  : Graph(graph)
  , Unit(unit)
  , Parallel(parallel)
  , EdgesOf(static_cast<std::size_t>(graph.NumberOfFaces()), { -1, -1, -1 })
{
  this->ListEdges();
}

void NormalVariation::ListEdges()
{
  const Triangles& triangles = this->Graph.Mesh.TriangleVertices();
  const IndexLists& across = this->Graph.Across;
  // the only neighbour opposite a corner; -1: none or several
  const auto onlyNeighbour = [&](Index f, int corner)
  {
    Index found = -1;
    for (Offset k = across.Begin[f]; k < across.Begin[f + 1]; ++k)
    {
      if (CornerOpposite(triangles, f, across.Entries[k]) == corner)
      {
        if (found >= 0)
        {
          return Index(-1);
        }
        found = across.Entries[k];
      }
    }
    return found;
  };
  for (Index f = 0; f < this->Graph.NumberOfFaces(); ++f)
  {
    for (int a = 0; a < 3; ++a)
    {
      const Index g = onlyNeighbour(f, a);
      if (g > f)
      {
        const int b = CornerOpposite(triangles, g, f);
        this->EdgesOf[f][a] = this->EdgesOf[g][b] = static_cast<Index>(this->Edges.size());
        Edge edge;
        edge.Faces = { f, g };
        this->Edges.push_back(edge);
      }
    }
  }
}

void NormalVariation::SetPlaces(const Points& points, const FaceGeometry& geometry)
{
  const TriangleMesh& mesh = this->Graph.Mesh;
  const double meanArea = geometry.Areas.mean();
  this->Areas = (geometry.Areas / meanArea).cwiseMax(Ridge);
  ForEach(this->Parallel, static_cast<Index>(this->Edges.size()),
    [&](Index e)
    {
      Edge& edge = this->Edges[e];
      const Index f = edge.Faces[0];
      const int a = CornerOpposite(mesh.TriangleVertices(), f, edge.Faces[1]);
      const Eigen::RowVector3d first = points.row(mesh.TriangleVertices()(f, (a + 1) % 3));
      const Eigen::RowVector3d last = points.row(mesh.TriangleVertices()(f, (a + 2) % 3));
      const Eigen::RowVector3d middle = 0.5 * (first + last);
      edge.Length = (last - first).norm() / this->Unit;
      for (int side = 0; side < 2; ++side)
      {
        const Index t = edge.Faces[side];
        const Axes axes(mesh, points, geometry, t);
        edge.Middle.col(side) = axes(middle - geometry.Centroids.row(t)) / this->Unit;
        edge.Along.col(side) = axes(last - first).normalized();
        edge.Side[side] =
          ToTheLeft(edge.Along.col(side)).dot(edge.Middle.col(side)) > 0.0 ? 1.0 : -1.0;
      }
    });
}

void NormalVariation::SetWeights(const Points& normals, double range)
{
  ForEach(this->Parallel, static_cast<Index>(this->Edges.size()),
    [&](Index e)
    {
      Edge& edge = this->Edges[e];
      const double square =
        (normals.row(edge.Faces[0]) - normals.row(edge.Faces[1])).squaredNorm();
      edge.Weight = 1.0 / (1.0 + square / (range * range));
    });
}

/// What the differences at the edge have from one of the triangles is Factor() times its block.
NormalVariation::Block NormalVariation::Factor(const Edge& edge, int side) const
{
  const double sign = side == 0 ? 1.0 : -1.0;
  const Eigen::Vector2d out = edge.Side[side] * ToTheLeft(edge.Along.col(side));
  Block factor;
  factor << sign, sign * edge.Middle(0, side), sign * edge.Middle(1, side), //
    0.0, sign * edge.Along(0, side), sign * edge.Along(1, side), //
    0.0, out[0], out[1];
  return factor;
}

NormalVariation::Block NormalVariation::Differences(
  const Edge& edge, const std::vector<Block>& x) const
{
  return this->Factor(edge, 0) * x[edge.Faces[0]] + this->Factor(edge, 1) * x[edge.Faces[1]];
}

/// The multipliers: v in the balls of the radii w a1 and w a0.
NormalVariation::Block NormalVariation::Shrunk(const Edge& edge, const Block& v) const
{
  Block bounded;
  bounded.row(0) =
    Bounded(Eigen::RowVector3d(v.row(0)), edge.Weight * this->Settings.First);
  bounded.bottomRows<2>() = Bounded(
    Eigen::Matrix<double, 2, 3>(v.bottomRows<2>()), edge.Weight * this->Settings.Second);
  return bounded;
}

void NormalVariation::Assemble()
{
  const Index count = this->Graph.NumberOfFaces();
  ForEach(this->Parallel, static_cast<Index>(this->Edges.size()),
    [&](Index e)
    {
      const Edge& edge = this->Edges[e];
      this->Coupling[e] =
        edge.Length * this->Factor(edge, 0).transpose() * this->Factor(edge, 1);
    });
  ForEach(this->Parallel, count,
    [&](Index f)
    {
      Block diagonal = Eigen::Vector3d(this->Areas[f], Ridge, Ridge).asDiagonal();
      for (const Index e : this->EdgesOf[f])
      {
        if (e >= 0)
        {
          const Edge& edge = this->Edges[e];
          const Block factor = this->Factor(edge, edge.Faces[0] == f ? 0 : 1);
          diagonal += edge.Length * factor.transpose() * factor;
        }
      }
      this->Diagonal[f] = diagonal;
      this->Inverse[f] = diagonal.inverse();
    });
}

Points NormalVariation::Minimize(const Points& given, const NormalVariationSettings& settings,
  const ProgressMonitor& progress)
{
  const Index count = this->Graph.NumberOfFaces();
  const auto size = static_cast<std::size_t>(count);
  this->Settings = settings;
  if (this->State.empty())
  {
    this->Given.assign(size, Block::Zero());
    for (Index f = 0; f < count; ++f)
    {
      this->Given[f].row(0) = given.row(f);
    }
    this->State = this->Given;
    this->Split.assign(this->Edges.size(), Block::Zero());
    this->Coupling.resize(this->Edges.size());
    for (std::vector<Block>* const list :
      { &this->Diagonal, &this->Inverse, &this->Residual, &this->Direction, &this->Product })
    {
      list->resize(size);
    }
  }
  for (Index f = 0; f < count; ++f)
  {
    this->Given[f].row(0) = given.row(f);
  }
  this->Assemble();
  for (int iteration = 0; iteration < settings.Iterations; ++iteration)
  {
    progress.Report(static_cast<double>(iteration) / settings.Iterations);
    ForEach(this->Parallel, static_cast<Index>(this->Edges.size()),
      [&](Index e)
      {
        const Edge& edge = this->Edges[e];
        this->Split[e] =
          this->Differences(edge, this->State) + this->Shrunk(edge, this->Split[e]);
      });
    this->Solve(settings.SolverSteps);
  }
  Points normals(count, 3);
  for (Index f = 0; f < count; ++f)
  {
    normals.row(f) = this->State[f].row(0);
  }
  return normals;
}

/// Conjugate gradients on M x + D^T L D x = M d + D^T L (v - 2 b), with the multipliers b of v.
void NormalVariation::Solve(int steps)
{
  const Index count = this->Graph.NumberOfFaces();
  const auto multiply = [&](const std::vector<Block>& x, Index f)
  {
    Block y = this->Diagonal[f] * x[f];
    for (const Index e : this->EdgesOf[f])
    {
      if (e >= 0)
      {
        const auto& [first, second] = this->Edges[e].Faces;
        y += first == f ? Block(this->Coupling[e] * x[second])
                        : Block(this->Coupling[e].transpose() * x[first]);
      }
    }
    return y;
  };
  const auto product = [](const Block& a, const Block& b) { return a.cwiseProduct(b).sum(); };
  double rz = Sum(this->Parallel, count,
    [&](Index f)
    {
      Block r = this->Areas[f] * this->Given[f] - multiply(this->State, f);
      for (const Index e : this->EdgesOf[f])
      {
        if (e >= 0)
        {
          const Edge& edge = this->Edges[e];
          const Block& v = this->Split[e];
          r += edge.Length * this->Factor(edge, edge.Faces[0] == f ? 0 : 1).transpose() *
            (v - 2.0 * this->Shrunk(edge, v));
        }
      }
      this->Residual[f] = r;
      this->Direction[f] = this->Inverse[f] * r;
      return product(r, this->Direction[f]);
    });
  for (int step = 0; step < steps && rz > 0.0; ++step)
  {
    const double curvature = Sum(this->Parallel, count,
      [&](Index f)
      {
        this->Product[f] = multiply(this->Direction, f);
        return product(this->Direction[f], this->Product[f]);
      });
    if (!(curvature > 0.0))
    {
      break;
    }
    const double length = rz / curvature;
    const double next = Sum(this->Parallel, count,
      [&](Index f)
      {
        this->State[f] += length * this->Direction[f];
        this->Residual[f] -= length * this->Product[f];
        this->Product[f] = this->Inverse[f] * this->Residual[f];
        return product(this->Residual[f], this->Product[f]);
      });
    if (step + 1 < steps)
    {
      ForEach(this->Parallel, count,
        [&](Index f)
        { this->Direction[f] = this->Product[f] + next / rz * this->Direction[f]; });
    }
    rz = next;
  }
}

NormalVariation::Energy NormalVariation::MeasureEnergy() const
{
  const auto count = static_cast<Index>(this->Edges.size());
  const double variation = Sum(this->Parallel, count,
    [&](Index e)
    {
      const Edge& edge = this->Edges[e];
      const Block v = this->Differences(edge, this->State);
      return edge.Length * edge.Weight *
        (this->Settings.First * v.row(0).norm() + this->Settings.Second * v.bottomRows<2>().norm());
    });
  double squares = 0.0;
  double dual = 0.0;
  for (Index f = 0; f < this->Graph.NumberOfFaces(); ++f)
  {
    Block force = Block::Zero(); // D^T of the multipliers
    for (const Index e : this->EdgesOf[f])
    {
      if (e >= 0)
      {
        const Edge& edge = this->Edges[e];
        force += edge.Length * this->Factor(edge, edge.Faces[0] == f ? 0 : 1).transpose() *
          this->Shrunk(edge, this->Split[e]);
      }
    }
    const double area = this->Areas[f];
    const Block& x = this->State[f];
    squares += 0.5 * area * (x.row(0) - this->Given[f].row(0)).squaredNorm() +
      0.5 * Ridge * x.bottomRows<2>().squaredNorm();
    dual += force.row(0).dot(this->Given[f].row(0)) - 0.5 * force.bottomRows<2>().squaredNorm() / Ridge;
    dual -= 0.5 * force.row(0).squaredNorm() / area;
  }
  return { variation + squares, variation + squares - dual };
}

} // namespace SurfaceDiffusion
