// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/SurfaceParts.h"

#include "Core/Foundation/Grouping.h"
#include "Core/Geometry/TriangleOrientation.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>

namespace SurfaceDiffusion
{

namespace
{

/// The vertices from which on a component is a part of its own.
constexpr Index LargeComponent = 200;

using Row3 = Eigen::RowVector3d;

bool IsBefore(const Row3& a, const Row3& b)
{
  return std::tie(a[0], a[1], a[2]) < std::tie(b[0], b[1], b[2]);
}

/// The first sum of two other corners, over the triangles around a vertex.
Row3 FirstOppositeEdge(const TriangleMesh& mesh, const Points& points, Index vertex)
{
  const auto sum = [&](Index k) -> Row3
  {
    const Index corner = mesh.VertexCorners()[k];
    return points.row(mesh.OtherCorner(corner, 1)) + points.row(mesh.OtherCorner(corner, 2));
  };
  Row3 first = sum(mesh.VertexCornersBegin()[vertex]);
  for (Index k = mesh.VertexCornersBegin()[vertex]; k < mesh.VertexCornersBegin()[vertex + 1]; ++k)
  {
    const Row3 other = sum(k);
    first = IsBefore(other, first) ? other : first;
  }
  return first;
}

/// Vertices `begin` to `end` in the order of their coordinates.
std::vector<Index> SortVertices(
  const TriangleMesh& mesh, const Points& points, Index begin, Index end)
{
  std::vector<Index> vertices(static_cast<std::size_t>(end - begin));
  std::iota(vertices.begin(), vertices.end(), begin);
  const auto isBefore = [&](Index i, Index j) { return IsBefore(points.row(i), points.row(j)); };
  std::sort(vertices.begin(), vertices.end(), isBefore);
  for (auto first = vertices.begin(); first != vertices.end();)
  {
    const auto last = std::find_if(
      first, vertices.end(), [&](Index i) { return points.row(i) != points.row(*first); });
    if (last - first > 1)
    {
      std::sort(first, last,
        [&](Index i, Index j) {
          return IsBefore(FirstOppositeEdge(mesh, points, i), FirstOppositeEdge(mesh, points, j));
        });
    }
    first = last;
  }
  return vertices;
}

using Face = std::array<Index, 3>;

/// The same triangle from its smallest number on.
Face FromSmallest(Face face)
{
  std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
  return face;
}

void SortFaces(std::vector<Face>& faces)
{
  for (Face& face : faces)
  {
    face = FromSmallest(face);
  }
  std::sort(faces.begin(), faces.end(),
    [](const Face& a, const Face& b)
    {
      const auto key = [](const Face& f)
      { return std::make_tuple(f[0], std::min(f[1], f[2]), std::max(f[1], f[2]), f[1]); };
      return key(a) < key(b);
    });
}

/// The triangles of each connected component.
Groups GroupTriangles(const TriangleMesh& mesh, const ParallelFor& parallel)
{
  const std::vector<Index>& begin = mesh.ComponentsBegin();
  std::vector<Index> component(static_cast<std::size_t>(mesh.NumberOfVertices()));
  for (Index c = 0; c < mesh.NumberOfComponents(); ++c)
  {
    std::fill(component.begin() + begin[c], component.begin() + begin[c + 1], c);
  }
  return GroupByKey(mesh.NumberOfTriangles(), mesh.NumberOfComponents(), parallel,
    [&](Index t) { return component[mesh.TriangleVertices()(t, 0)]; });
}

/// Collects the components of one part.
class PartBuilder
{
public:
  PartBuilder(const TriangleMesh& mesh, const Points& points, bool isCoarse)
    : Mesh(mesh)
    , Given(points)
    , IsCoarse(isCoarse)
    , Number(static_cast<std::size_t>(mesh.NumberOfVertices()))
  {
  }

  /// triangles: those of the component.
  void Add(Index component, const Index* triangles, Index count)
  {
    const std::vector<Index> vertices = SortVertices(this->Mesh, this->Given,
      this->Mesh.ComponentsBegin()[component], this->Mesh.ComponentsBegin()[component + 1]);
    const auto size = static_cast<Index>(vertices.size());
    Points places(size, 3);
    for (Index i = 0; i < size; ++i)
    {
      this->Number[vertices[i]] = i;
      places.row(i) = this->Given.row(vertices[i]) - this->Given.row(vertices[0]);
    }
    std::vector<Face> faces(static_cast<std::size_t>(count));
    for (Index k = 0; k < count; ++k)
    {
      for (int a = 0; a < 3; ++a)
      {
        faces[k][a] = this->Number[this->Mesh.TriangleVertices()(triangles[k], a)];
      }
    }
    SortFaces(faces);
    const auto first = static_cast<Index>(this->Vertices.size());
    this->Vertices.insert(this->Vertices.end(), vertices.begin(), vertices.end());
    for (Index i = 0; i < size; ++i)
    {
      this->Places.emplace_back(places.row(i));
    }
    for (const Face& f : faces)
    {
      this->Faces.push_back({ first + f[0], first + f[1], first + f[2] });
    }
    ++this->Components;
  }

  bool IsEmpty() const { return this->Faces.empty(); }

  /// The components that were added since the last call.
  SurfacePart Take()
  {
    SurfacePart part;
    part.Places.resize(static_cast<Index>(this->Vertices.size()), 3);
    for (std::size_t i = 0; i < this->Vertices.size(); ++i)
    {
      part.Places.row(i) = this->Places[i];
    }
    part.Vertices.swap(this->Vertices);
    part.Faces.resize(static_cast<Index>(this->Faces.size()), 3);
    for (std::size_t t = 0; t < this->Faces.size(); ++t)
    {
      part.Faces.row(t) << this->Faces[t][0], this->Faces[t][1], this->Faces[t][2];
    }
    part.Components = this->Components;
    part.IsCoarse = this->IsCoarse;
    this->Components = 0;
    OrientTriangles(part.Places, part.Faces);
    this->Places.clear();
    this->Faces.clear();
    this->Vertices.clear();
    return part;
  }

private:
  const TriangleMesh& Mesh;
  const Points& Given;
  const bool IsCoarse;
  std::vector<Index> Number; ///< per vertex: its place among those of its component
  std::vector<Index> Vertices;
  std::vector<Row3> Places;
  std::vector<Face> Faces;
  Index Components = 0;
};

} // namespace

std::vector<SurfacePart> DivideSurface(
  const TriangleMesh& mesh, const Points& points, const ParallelFor& parallel)
{
  const Groups triangles = GroupTriangles(mesh, parallel);
  std::vector<SurfacePart> parts;
  PartBuilder small(mesh, points, true);
  PartBuilder large(mesh, points, false);
  for (Index c = 0; c < mesh.NumberOfComponents(); ++c)
  {
    const Index count = triangles.Begin[c + 1] - triangles.Begin[c];
    const bool isLarge =
      mesh.ComponentsBegin()[c + 1] - mesh.ComponentsBegin()[c] >= LargeComponent;
    if (count > 0)
    {
      (isLarge ? large : small).Add(c, triangles.Items.data() + triangles.Begin[c], count);
    }
    if (isLarge && !large.IsEmpty())
    {
      parts.push_back(large.Take());
    }
  }
  if (!small.IsEmpty())
  {
    parts.push_back(small.Take());
  }
  return parts;
}

} // namespace SurfaceDiffusion
