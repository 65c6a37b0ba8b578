// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/MeshNumbering.h"

#include "Core/Foundation/DisjointSets.h"
#include "Core/Foundation/Offsets.h"
#include "Core/Surface/HilbertCurve.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
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

  BoundingBox(const Eigen::Ref<const Points>& points, const Eigen::Ref<const Triangles>& triangles)
  {
    Row3 low = Row3::Constant(std::numeric_limits<double>::max());
    Row3 high = -low;
    for (Eigen::Index t = 0; t < triangles.rows(); ++t)
    {
      for (int a = 0; a < 3; ++a)
      {
        low = low.cwiseMin(points.row(triangles(t, a)));
        high = high.cwiseMax(points.row(triangles(t, a)));
      }
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
    , Box(points, triangles)
    , Parallel(parallel)
  {
    this->Mesh.LengthUnit = lengthUnit > 0.0 ? lengthUnit : this->Box.Scale;
  }

  /// Lay all triangles out and keep those that are not degenerate.
  void SelectTriangles()
  {
    const auto count = static_cast<Index>(this->InputTriangles.rows());
    std::vector<TriangleMesh::Shape> shapes(count);
    ForEach(this->Parallel, count,
      [&](Index t)
      {
        const auto corner = [&](int a) -> Row3
        {
          return (this->InputPoints.row(this->InputTriangles(t, a)) - this->Box.Centre) /
            this->Mesh.LengthUnit;
        };
        shapes[t] = LayOut(corner(0), corner(1), corner(2));
      });
    this->Mesh.InputTriangle.reserve(count);
    this->Mesh.Shapes.reserve(count);
    for (Index t = 0; t < count; ++t)
    {
      if (shapes[t].Y > 0.0)
      {
        this->Mesh.InputTriangle.push_back(t);
        this->Mesh.Shapes.push_back(shapes[t]);
      }
    }
    this->Mesh.Diagnostics.DegenerateTriangles =
      count - static_cast<Index>(this->Mesh.InputTriangle.size());
  }

  void NumberVertices()
  {
    const std::vector<HilbertPlace> places = this->PlacesAlongCurve();
    this->Mesh.Diagnostics.IsolatedVertices =
      static_cast<Index>(this->InputPoints.rows()) - static_cast<Index>(places.size());
    this->NumberAlongCurve(places);
    this->NumberByComponent(places);
  }

  /// Triangles follow their smallest vertex.
  void SortTriangles()
  {
    const Triangles& corners = this->Corners;
    const auto triangleCount = static_cast<Index>(corners.rows());
    std::vector<Index> begin(this->Mesh.InputVertex.size() + 1, 0);
    for (Index t = 0; t < triangleCount; ++t)
    {
      ++begin[corners.row(t).minCoeff()];
    }
    CountsToOffsets(begin);
    std::vector<Index> sortedTriangles(triangleCount);
    std::vector<TriangleMesh::Shape> sortedShapes(triangleCount);
    this->Mesh.TriangleVertices.resize(triangleCount, 3);
    for (Index t = 0; t < triangleCount; ++t)
    {
      const Index place = begin[corners.row(t).minCoeff()]++;
      sortedTriangles[place] = this->Mesh.InputTriangle[t];
      sortedShapes[place] = this->Mesh.Shapes[t];
      this->Mesh.TriangleVertices.row(place) = corners.row(t);
    }
    this->Mesh.InputTriangle.swap(sortedTriangles);
    this->Mesh.Shapes.swap(sortedShapes);
  }

  TriangleMesh::Contents Mesh;

private:
  /// The points that triangles use, in the order of the Hilbert curve.
  std::vector<HilbertPlace> PlacesAlongCurve() const
  {
    const auto inputCount = static_cast<Index>(this->InputPoints.rows());
    std::vector<char> used(inputCount, 0);
    for (const Index t : this->Mesh.InputTriangle)
    {
      for (int a = 0; a < 3; ++a)
      {
        used[this->InputTriangles(t, a)] = 1;
      }
    }
    std::vector<HilbertPlace> places;
    places.reserve(inputCount);
    for (Index i = 0; i < inputCount; ++i)
    {
      if (used[i])
      {
        places.push_back({ 0, i });
      }
    }
    ForEach(this->Parallel, static_cast<Index>(places.size()),
      [&](Index i) { places[i].Position = this->CurvePosition(places[i].Vertex); });
    SortAlongCurve(places);
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
  void NumberAlongCurve(const std::vector<HilbertPlace>& places)
  {
    std::vector<Index> number(this->InputPoints.rows(), -1);
    for (std::size_t i = 0; i < places.size(); ++i)
    {
      number[places[i].Vertex] = static_cast<Index>(i);
    }
    const auto triangleCount = static_cast<Index>(this->Mesh.InputTriangle.size());
    this->Corners.resize(triangleCount, 3);
    for (Index t = 0; t < triangleCount; ++t)
    {
      for (int a = 0; a < 3; ++a)
      {
        this->Corners(t, a) = number[this->InputTriangles(this->Mesh.InputTriangle[t], a)];
      }
    }
  }

  /// Renumber by connected component, in the order in which the curve meets them.
  void NumberByComponent(const std::vector<HilbertPlace>& places)
  {
    const auto count = static_cast<Index>(places.size());
    DisjointSets connected(count);
    for (const auto& corners : this->Corners.rowwise())
    {
      connected.Join(corners[0], corners[1]);
      connected.Join(corners[1], corners[2]);
    }
    const std::vector<Index> component = connected.Labels();
    std::vector<Index>& begin = this->Mesh.ComponentsBegin;
    begin.assign(1, 0);
    for (const Index c : component)
    {
      begin.resize(std::max<std::size_t>(begin.size(), c + 2), 0);
      ++begin[c];
    }
    CountsToOffsets(begin);
    std::vector<Index> next = begin;
    std::vector<Index> number(count);
    this->Mesh.InputVertex.resize(count);
    for (Index i = 0; i < count; ++i)
    {
      number[i] = next[component[i]]++;
      this->Mesh.InputVertex[number[i]] = places[i].Vertex;
    }
    Index* const corners = this->Corners.data();
    std::transform(
      corners, corners + this->Corners.size(), corners, [&](Index place) { return number[place]; });
  }

  const Eigen::Ref<const Points>& InputPoints;
  const Eigen::Ref<const Triangles>& InputTriangles;
  const BoundingBox Box;
  const ParallelFor& Parallel;
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
