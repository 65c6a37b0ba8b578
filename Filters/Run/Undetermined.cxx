// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/Undetermined.h"

#include "Core/Surface/AllComponents.h"

#include <algorithm>

namespace SurfaceDiffusion
{

namespace
{

/// Per row of the data.
std::vector<char> FindKnownRows(const Fields& fields, bool inpaint, bool unitVectors)
{
  std::vector<char> known(static_cast<std::size_t>(fields.Data.Values.rows()), 0);
  for (Eigen::Index i = 0; i < fields.Data.Values.rows(); ++i)
  {
    const auto row = fields.Data.Values.row(i);
    known[static_cast<std::size_t>(i)] = !IsSet(fields.Missing, i) && !row.hasNaN() &&
      !fields.IsLeftOut(i, inpaint) && !(unitVectors && row.isZero(0.0));
  }
  return known;
}

/// Marks of points or cells, and the components of the mesh that have them.
class ComponentMarks
{
public:
  ComponentMarks(const Surface& surface, const Fields& fields)
    : OnSurface(surface)
    , Given(fields)
    , Mesh(surface.InputMesh())
    , ComponentOf(static_cast<std::size_t>(Mesh.NumberOfVertices()))
  {
    for (Index c = 0; c < this->Mesh.NumberOfComponents(); ++c)
    {
      for (Index v = this->Mesh.ComponentsBegin()[c]; v < this->Mesh.ComponentsBegin()[c + 1]; ++v)
      {
        this->ComponentOf[static_cast<std::size_t>(v)] = c;
      }
    }
  }

  /// Call f(component, i) for each point or cell i that takes part.
  template <typename F>
  void ForEach(bool onCells, const F& f) const
  {
    if (!onCells)
    {
      for (Index i = 0; i < static_cast<Index>(this->OnSurface.Points().rows()); ++i)
      {
        const Index v = this->OnSurface.VertexOf(i);
        if (v >= 0)
        {
          f(this->ComponentOf[static_cast<std::size_t>(v)], static_cast<std::size_t>(i));
        }
      }
      return;
    }
    for (Index t = 0; t < this->Mesh.NumberOfTriangles(); ++t)
    {
      const Index row = this->Mesh.InputTriangle()[static_cast<std::size_t>(t)];
      const Index cell =
        this->Given.Cells[static_cast<std::size_t>(this->OnSurface.InputTriangle(row))];
      f(this->ComponentOf[static_cast<std::size_t>(this->Mesh.TriangleVertices()(t, 0))],
        static_cast<std::size_t>(cell));
    }
  }

  /// Count the marks of each component in a column of `counts`.
  template <typename T>
  void Count(const Located<std::vector<T>>& marks, Values& counts) const
  {
    if (!marks.Values.empty())
    {
      this->ForEach(marks.OnCells,
        [&](Index c, std::size_t i) { counts(c, 0) += marks.Values[i] != 0 ? 1.0 : 0.0; });
    }
  }

private:
  const Surface& OnSurface;
  const Fields& Given;
  const TriangleMesh& Mesh;
  std::vector<Index> ComponentOf; ///< per vertex
};

} // namespace

Undetermined FindUndetermined(const Surface& surface, const Fields& fields, bool inpaint,
  bool unitVectors, const Reduction& processes)
{
  Undetermined found;
  if (!processes.Any(fields.Data.Values.cols() > 0))
  {
    return found;
  }
  const std::vector<char> known = FindKnownRows(fields, inpaint, unitVectors);
  const bool allKnown = std::find(known.begin(), known.end(), 0) == known.end();
  if (!processes.Any(!allKnown))
  {
    found.HasKnown = !known.empty();
    return found;
  }
  // of a component: known points or cells; vertices, in this process and in all
  const TriangleMesh& mesh = surface.InputMesh();
  const Reduction& reduction = mesh.GetReduction();
  const Index components = mesh.NumberOfComponents();
  Values counts = Values::Zero(components, 2);
  const ComponentMarks marks(surface, fields);
  marks.Count(Located<std::vector<char>>{ known, fields.Data.OnCells }, counts);
  marks.Count(fields.Fixed, counts);
  marks.Count(fields.Seeds, counts);
  for (Index c = 0; c < components; ++c)
  {
    counts(c, 1) = mesh.ComponentsBegin()[c + 1] - mesh.ComponentsBegin()[c];
  }
  const Vector verticesHere = counts.col(1);
  reduction.SumComponents(AllComponents(mesh), counts);

  for (Index c = 0; c < components; ++c)
  {
    found.HasKnown = found.HasKnown || counts(c, 0) > 0.0;
    // Each process that has a part of the component counts its share of it.
    found.NumberOfComponents += counts(c, 0) > 0.0 ? 0.0 : verticesHere[c] / counts(c, 1);
  }
  if (!reduction.Any(found.NumberOfComponents > 0.0))
  {
    return found;
  }
  const auto mark = [&](bool onCells, std::vector<char>& flags)
  { marks.ForEach(onCells, [&](Index c, std::size_t i) { flags[i] = !(counts(c, 0) > 0.0); }); };
  found.Points.assign(static_cast<std::size_t>(surface.Points().rows()), 0);
  mark(false, found.Points);
  if (fields.Data.OnCells)
  {
    found.Cells.assign(static_cast<std::size_t>(fields.NumberOfCells), 0);
    mark(true, found.Cells);
  }
  return found;
}

} // namespace SurfaceDiffusion
