// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/ComponentMeshes.h"

#include "Core/Foundation/Grouping.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace SurfaceDiffusion
{

ComponentMeshes::ComponentMeshes(const TriangleMesh& mesh)
  : Whole(mesh)
{
  const std::vector<Index>& begin = mesh.ComponentsBegin();
  Groups groups = GroupByKey(mesh.NumberOfTriangles(), mesh.NumberOfComponents(), SerialFor(),
    [&](Index t)
    {
      const auto after =
        std::upper_bound(begin.begin(), begin.end(), mesh.TriangleVertices()(t, 0));
      return static_cast<Index>(after - begin.begin()) - 1;
    });
  this->Begin = std::move(groups.Begin);
  this->Triangles.assign(groups.Items.begin(), groups.Items.end());
}

std::vector<Index> ComponentMeshes::TrianglesOf(Index c) const
{
  return { this->Triangles.begin() + this->Begin[c], this->Triangles.begin() + this->Begin[c + 1] };
}

std::shared_ptr<TriangleMesh> ComponentMeshes::Make(Index c) const
{
  const TriangleMesh& mesh = this->Whole;
  const Index first = mesh.ComponentsBegin()[c];
  const Index last = mesh.ComponentsBegin()[c + 1];
  const std::vector<Index> triangles = this->TrianglesOf(c);
  const auto count = static_cast<Index>(triangles.size());
  TriangleMesh::Contents part;
  part.InputVertex.assign(mesh.InputVertex().begin() + first, mesh.InputVertex().begin() + last);
  part.ComponentsBegin = { 0, last - first };
  part.ControlAreas = mesh.ControlAreas().segment(first, last - first);
  part.LengthUnit = mesh.LengthUnit();
  const std::vector<Index>& boundary = mesh.BoundaryVertices();
  std::transform(std::lower_bound(boundary.begin(), boundary.end(), first),
    std::lower_bound(boundary.begin(), boundary.end(), last),
    std::back_inserter(part.BoundaryVertices), [&](Index i) { return i - first; });
  const bool hasEdges = mesh.TriangleEdges().rows() > 0;
  part.TriangleVertices.resize(count, 3);
  part.TriangleEdges.resize(hasEdges ? count : 0, 3);
  part.Shapes = TriangleMesh::ShapeList(count, mesh.Shapes().GetWeight());
  for (Index i = 0; i < count; ++i)
  {
    const Index t = triangles[i];
    const TriangleMesh::Shape s = mesh.Shapes()[t];
    part.Shapes.Set(i, s.Length, s.X, s.Y);
    part.TriangleVertices.row(i) = mesh.TriangleVertices().row(t).array() - first;
    if (hasEdges)
    {
      part.TriangleEdges.row(i) = mesh.TriangleEdges().row(t);
    }
    if (!mesh.InputTriangle().empty())
    {
      part.InputTriangle.push_back(mesh.InputTriangle()[t]);
    }
  }
  return std::make_shared<TriangleMesh>(std::move(part));
}

} // namespace SurfaceDiffusion
