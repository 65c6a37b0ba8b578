// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geodesics/ExactDistance.h"
#include "Meshes.h"

#include <limits>
#include <vector>

namespace SurfaceDiffusion::Testing
{

/// Exact distances on a surface, in its unit and numbering.
class ExactOn
{
public:
  struct Found
  {
    std::vector<double> Times; ///< infinite at points without triangles, too
    std::vector<Index> Sources;
    double operator[](Index i) const { return this->Times[static_cast<std::size_t>(i)]; }
  };

  explicit ExactOn(const Surface& s)
    : Mesh(std::make_shared<TriangleMesh>(s.Vertices, s.Faces))
    , Exact(Mesh)
    , Given(s)
    , VertexOf(static_cast<std::size_t>(s.NumberOfVertices()), -1)
    , TriangleOf(static_cast<std::size_t>(s.NumberOfTriangles()), -1)
  {
    for (Index i = 0; i < this->Mesh->NumberOfVertices(); ++i)
    {
      this->VertexOf[static_cast<std::size_t>(this->Mesh->InputVertex()[i])] = i;
    }
    for (Index t = 0; t < this->Mesh->NumberOfTriangles(); ++t)
    {
      this->TriangleOf[static_cast<std::size_t>(this->Mesh->InputTriangle()[t])] = t;
    }
  }

  /// A point of the surface as a source.
  SourcePiece At(Index vertex) const
  {
    const Index v = this->VertexOf[static_cast<std::size_t>(vertex)];
    const Index corner =
      this->Mesh->VertexCorners()[static_cast<std::size_t>(this->Mesh->VertexCornersBegin()[v])];
    SourcePiece piece;
    piece.Triangle = corner / 3;
    piece.From[static_cast<std::size_t>(corner % 3)] = 1.0;
    piece.To = piece.From;
    return piece;
  }
  /// A straight piece of a triangle; barycentric coordinates in the order of its points.
  SourcePiece At(
    Index triangle, const std::array<double, 3>& from, const std::array<double, 3>& to) const
  {
    SourcePiece piece;
    piece.Triangle = this->TriangleOf[static_cast<std::size_t>(triangle)];
    for (std::size_t a = 0; a < 3; ++a)
    {
      for (std::size_t b = 0; b < 3; ++b)
      {
        if (this->VertexOf[static_cast<std::size_t>(
              this->Given.Faces(triangle, static_cast<Index>(b)))] ==
          this->Mesh->TriangleVertices()(piece.Triangle, static_cast<Index>(a)))
        {
          piece.From[a] = from[b];
          piece.To[a] = to[b];
        }
      }
    }
    return piece;
  }

  Found From(const std::vector<SourcePiece>& pieces,
    double cutoff = std::numeric_limits<double>::infinity(),
    const ProgressMonitor& progress = ProgressMonitor()) const
  {
    const double unit = this->Mesh->LengthUnit();
    const auto arrival = this->Exact.Find(pieces, cutoff / unit, progress);
    Found found{ std::vector<double>(
                   this->VertexOf.size(), std::numeric_limits<double>::infinity()),
      std::vector<Index>(this->VertexOf.size(), -1) };
    for (std::size_t v = 0; v < arrival.Times.size(); ++v)
    {
      const auto i = static_cast<std::size_t>(this->Mesh->InputVertex()[v]);
      found.Times[i] = arrival.Times[v] * unit;
      found.Sources[i] = arrival.Sources[v];
    }
    return found;
  }
  Found From(Index vertex) const { return this->From({ this->At(vertex) }); }

private:
  std::shared_ptr<const TriangleMesh> Mesh;
  ExactDistance Exact;
  Surface Given;
  std::vector<Index> VertexOf, TriangleOf;
};

} // namespace SurfaceDiffusion::Testing
