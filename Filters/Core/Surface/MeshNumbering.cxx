// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/MeshNumbering.h"

#include "Core/Foundation/DisjointSets.h"
#include "Core/Foundation/Grouping.h"
#include "Core/Surface/HilbertCurve.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

using Row3 = Eigen::RowVector3d;

/// The box around the points that triangles use.
struct BoundingBox
{
  Row3 Centre;
  double Scale; ///< a power of two in which the box is at most 2 long: the default LengthUnit()

  BoundingBox(const Eigen::Ref<const Points>& points, const Eigen::Ref<const Triangles>& triangles,
    const ParallelFor& parallel)
  {
    const auto count = static_cast<Index>(triangles.rows());
    const Row3 largest = Row3::Constant(std::numeric_limits<double>::max());
    std::vector<std::array<Row3, 2>> blocks(NumberOfBlocks(count), { largest, -largest });
    ForEachBlock(parallel, count,
      [&](Index block, Index begin, Index end)
      {
        Row3 low = largest;
        Row3 high = -largest;
        for (Index t = begin; t < end; ++t)
        {
          for (int a = 0; a < 3; ++a)
          {
            low = low.cwiseMin(points.row(triangles(t, a)));
            high = high.cwiseMax(points.row(triangles(t, a)));
          }
        }
        blocks[block] = { low, high };
      });
    Row3 low = largest;
    Row3 high = -largest;
    for (const auto& block : blocks)
    {
      low = low.cwiseMin(block[0]);
      high = high.cwiseMax(block[1]);
    }
    this->Centre = 0.5 * low + 0.5 * high;
    // Half the extent cannot overflow; the scale is the next power of two above it, if there is
    // one.
    const double extent = triangles.rows() > 0 ? (0.5 * high - 0.5 * low).maxCoeff() : 0.0;
    constexpr int largestExponent = std::numeric_limits<double>::max_exponent - 1;
    this->Scale = extent > 0.0 ? std::exp2(std::min(std::ilogb(extent) + 1, largestExponent)) : 1.0;
  }
};

/// Lay the triangle out in the plane. Y = 0 marks a degenerate one.
TriangleMesh::Shape LayOut(const Row3& p0, const Row3& p1, const Row3& p2)
{
  const Row3 e1 = p1 - p0;
  const Row3 e2 = p2 - p0;
  const double length = e1.norm();
  const double doubleArea = e1.cross(e2).norm();
  const double longest = std::max({ length, e2.norm(), (p2 - p1).norm() });
  constexpr double flat = 4.0 * std::numeric_limits<double>::epsilon();
  if (!(length > 0.0) || !(doubleArea > flat * longest * longest))
  {
    return { length, 0.0, 0.0 };
  }
  return { length, e1.dot(e2) / length, doubleArea / length };
}

/// Selects and numbers the triangles and vertices of a mesh, in stages.
class Numbering
{
public:
  Numbering(const Eigen::Ref<const Points>& points, const Eigen::Ref<const Triangles>& triangles,
    double lengthUnit, const ParallelFor& parallel)
    : InputPoints(points)
    , InputTriangles(triangles)
    , Box(points, triangles, parallel)
    , Parallel(parallel)
  {
    this->Mesh.LengthUnit = lengthUnit > 0.0 ? lengthUnit : this->Box.Scale;
  }

  /// Keep the triangles that are not degenerate.
  void SelectTriangles()
  {
    const auto count = static_cast<Index>(this->InputTriangles.rows());
    Buffer<char> isProper(count);
    ForEach(this->Parallel, count, [&](Index t) { isProper[t] = this->ShapeOf(t).Y > 0.0; });
    this->Selected = ListWhere(count, this->Parallel, [&](Index t) { return isProper[t] != 0; });
    this->Mesh.Diagnostics.DegenerateTriangles = count - static_cast<Index>(this->Selected.size());
  }

  void NumberVertices()
  {
    const Buffer<HilbertPlace> places = this->PlacesAlongCurve();
    this->Mesh.Diagnostics.IsolatedVertices =
      static_cast<Index>(this->InputPoints.rows()) - static_cast<Index>(places.size());
    this->NumberAlongCurve(places);
    this->NumberByComponent(places);
  }

  /// Triangles follow their smallest vertex.
  void SortTriangles()
  {
    const auto count = static_cast<Index>(this->Corners.rows());
    const Buffer<Index> order = GroupByKey(count, static_cast<Index>(this->Mesh.InputVertex.size()),
      this->Parallel,
      [&](Index t) {
        return this->Corners.row(t).minCoeff();
      }).Items;
    this->Mesh.InputTriangle.resize(count);
    this->Mesh.TriangleVertices.resize(count, 3);
    this->Mesh.Shapes = TriangleMesh::ShapeList(count);
    ForEach(this->Parallel, count,
      [&](Index t)
      {
        this->Mesh.InputTriangle[t] = this->Selected[order[t]];
        this->Mesh.TriangleVertices.row(t) = this->Corners.row(order[t]);
        const TriangleMesh::Shape shape = this->ShapeOf(this->Mesh.InputTriangle[t]);
        this->Mesh.Shapes.Set(t, shape.Length, shape.X, shape.Y);
      });
  }

  TriangleMesh::Contents Mesh;

private:
  /// Of a triangle of the input.
  TriangleMesh::Shape ShapeOf(Index inputTriangle) const
  {
    const auto corner = [&](int a) -> Row3
    {
      return (this->InputPoints.row(this->InputTriangles(inputTriangle, a)) - this->Box.Centre) /
        this->Mesh.LengthUnit;
    };
    return LayOut(corner(0), corner(1), corner(2));
  }

  /// The points that triangles use, in the order of the Hilbert curve.
  Buffer<HilbertPlace> PlacesAlongCurve() const
  {
    const auto inputCount = static_cast<Index>(this->InputPoints.rows());
    std::vector<std::atomic<char>> isUsed(inputCount);
    ForEach(this->Parallel, static_cast<Index>(this->Selected.size()),
      [&](Index t)
      {
        for (int a = 0; a < 3; ++a)
        {
          isUsed[this->InputTriangles(this->Selected[t], a)].store(1, std::memory_order_relaxed);
        }
      });
    const Buffer<Index> used = ListWhere(inputCount, this->Parallel,
      [&](Index i) { return isUsed[i].load(std::memory_order_relaxed) != 0; });
    Buffer<HilbertPlace> places(used.size());
    ForEach(this->Parallel, static_cast<Index>(places.size()),
      [&](Index i) {
        places[i] = { this->CurvePosition(used[i]), used[i] };
      });
    SortAlongCurve(places, this->Parallel);
    return places;
  }

  std::uint64_t CurvePosition(Index point) const
  {
    std::array<std::uint32_t, 3> cell;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double x =
        (this->InputPoints(point, axis) - this->Box.Centre[axis]) / this->Mesh.LengthUnit;
      cell[axis] = static_cast<std::uint32_t>(
        std::min(HilbertCells - 1.0, std::max(0.0, (0.5 * x + 0.5) * HilbertCells)));
    }
    return HilbertPosition(cell);
  }

  /// The corners of the triangles as places along the curve.
  void NumberAlongCurve(const Buffer<HilbertPlace>& places)
  {
    Buffer<Index> number(this->InputPoints.rows());
    ForEach(this->Parallel, static_cast<Index>(places.size()),
      [&](Index i) { number[places[i].Vertex] = i; });
    const auto triangleCount = static_cast<Index>(this->Selected.size());
    this->Corners.resize(triangleCount, 3);
    ForEach(this->Parallel, triangleCount,
      [&](Index t)
      {
        for (int a = 0; a < 3; ++a)
        {
          this->Corners(t, a) = number[this->InputTriangles(this->Selected[t], a)];
        }
      });
  }

  /// Renumber by connected component, in the order in which the curve meets them.
  void NumberByComponent(const Buffer<HilbertPlace>& places)
  {
    const auto count = static_cast<Index>(places.size());
    const auto triangleCount = static_cast<Index>(this->Corners.rows());
    DisjointSets connected(count);
    ForEach(this->Parallel, triangleCount,
      [&](Index t)
      {
        connected.Join(this->Corners(t, 0), this->Corners(t, 1));
        connected.Join(this->Corners(t, 1), this->Corners(t, 2));
      });
    const std::vector<Index> component = connected.Labels(this->Parallel);
    const Index components =
      component.empty() ? 0 : 1 + *std::max_element(component.begin(), component.end());
    Groups groups =
      GroupByKey(count, components, this->Parallel, [&](Index i) { return component[i]; });
    Buffer<Index> number(count);
    this->Mesh.InputVertex.resize(count);
    ForEach(this->Parallel, count,
      [&](Index i)
      {
        number[groups.Items[i]] = i;
        this->Mesh.InputVertex[i] = places[groups.Items[i]].Vertex;
      });
    this->Mesh.ComponentsBegin = std::move(groups.Begin);
    ForEach(this->Parallel, triangleCount,
      [&](Index t)
      {
        for (int a = 0; a < 3; ++a)
        {
          this->Corners(t, a) = number[this->Corners(t, a)];
        }
      });
  }

  const Eigen::Ref<const Points>& InputPoints;
  const Eigen::Ref<const Triangles>& InputTriangles;
  const BoundingBox Box;
  const ParallelFor& Parallel;
  Buffer<Index> Selected; ///< triangles of the input
  Triangles Corners; ///< of the selected triangles, in the order of the input
};

} // namespace

TriangleMesh::Contents NumberMesh(const Eigen::Ref<const Points>& points,
  const Eigen::Ref<const Triangles>& triangles, double lengthUnit, const ParallelFor& parallel,
  const ProgressMonitor& progress)
{
  Numbering numbering(points, triangles, lengthUnit, parallel);
  numbering.SelectTriangles();
  progress.Report(1.0 / 3.0);
  numbering.NumberVertices();
  numbering.SortTriangles();
  progress.Report(1.0);
  return std::move(numbering.Mesh);
}

} // namespace SurfaceDiffusion
