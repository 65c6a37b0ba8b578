// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geodesics/EikonalDistance.h"

#include "Core/Surface/EdgeRefinement.h"
#include "Core/Surface/IntrinsicDelaunay.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// The area of a component in squares of its longest edge, below which it is refined, and in squares
/// of the longest edge that stays then.
constexpr double FewSquares = 40.0;
constexpr double EnoughSquares = 1500.0;

/// Refinement ends with this many triangles, or four times the given ones.
constexpr Index EnoughTriangles = 50000;

/// r^2 - 1 + 1 / r^2, where r is the ratio of the largest speed in a triangle to the smallest one.
double StretchOf(const TriangleMesh::Shape& given, const TriangleMesh::Shape& image)
{
  const double along = image.Length / given.Length; // the map takes x to along x + shear y
  const double shear = (image.X - along * given.X) / given.Y;
  const double across = image.Y / given.Y;
  const double squares = along * along + shear * shear + across * across;
  const double ratios = squares / (along * across); // r + 1 / r
  return std::isfinite(ratios) ? ratios * ratios - 3.0 : 1.0;
}

/// Per vertex, the length up to which edges of its component stay: any, unless one of them is long.
/// Triangles that fronts see stretched have to be smaller.
std::vector<double> FindLengths(const TriangleMesh& mesh, const FrontShapes& shapes)
{
  const std::vector<Index>& begin = mesh.ComponentsBegin();
  const auto n = static_cast<std::size_t>(mesh.NumberOfVertices());
  std::vector<std::size_t> componentOf(n);
  for (std::size_t c = 0; c + 1 < begin.size(); ++c)
  {
    std::fill(componentOf.begin() + begin[c], componentOf.begin() + begin[c + 1], c);
  }
  std::vector<double> areas(begin.size(), 0.0);
  std::vector<double> longest(begin.size(), 0.0);
  std::vector<double> stretch(begin.size(), 1.0);
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const TriangleMesh::Shape shape = mesh.Shapes()[static_cast<std::size_t>(t)];
    const std::size_t c = componentOf[static_cast<std::size_t>(mesh.TriangleVertices()(t, 0))];
    areas[c] += shape.Area();
    longest[c] =
      std::max({ longest[c], shape.EdgeLength(0), shape.EdgeLength(1), shape.EdgeLength(2) });
    if (!shapes.empty())
    {
      stretch[c] = std::max(stretch[c], StretchOf(shape, shapes[static_cast<std::size_t>(t)]));
    }
  }
  std::vector<double> lengths(n);
  for (std::size_t i = 0; i < n; ++i)
  {
    const double area = areas[componentOf[i]];
    const double edge = longest[componentOf[i]];
    lengths[i] = FewSquares * edge * edge > area
      ? std::sqrt(area / (EnoughSquares * stretch[componentOf[i]]))
      : 2.0 * edge;
  }
  return lengths;
}

/// The barycentric coordinates of vertices of a refined surface in one of the given triangles.
class Coordinates
{
public:
  Coordinates(const RefinedSurface& refined, Eigen::RowVector3i corners)
    : Refined(refined)
    , Given(static_cast<Index>(refined.Vertices.rows() - refined.Parents.size()))
  {
    for (int a = 0; a < 3; ++a)
    {
      this->Known[corners[a]] = Eigen::Vector3d::Unit(a);
    }
  }

  const Eigen::Vector3d& Of(Index vertex)
  {
    const auto found = this->Known.find(vertex);
    if (found != this->Known.end())
    {
      return found->second;
    }
    const auto& [first, second] =
      this->Refined.Parents[static_cast<std::size_t>(vertex - this->Given)];
    const Eigen::Vector3d sum = this->Of(first) + this->Of(second);
    return this->Known[vertex] = 0.5 * sum;
  }

private:
  const RefinedSurface& Refined;
  Index Given;
  std::map<Index, Eigen::Vector3d> Known;
};

/// A point in a triangle, or on its edges and at its corners up to round-off.
std::array<double, 3> Inside(Eigen::Vector3d x)
{
  constexpr double roundOff = 1e-12;
  x = x.cwiseMax(0.0);
  x /= x.sum();
  Eigen::Index largest = 0;
  if (x.maxCoeff(&largest) > 1.0 - roundOff)
  {
    x = Eigen::Vector3d::Unit(largest);
  }
  return { x[0], x[1], x[2] };
}

} // namespace

EikonalDistance::EikonalDistance(std::shared_ptr<const TriangleMesh> mesh,
  std::shared_ptr<const TriangleMesh> delaunay, const Points& positions, FrontShapes shapes,
  const ParallelFor& parallel, const ProgressMonitor& progress)
  : Mesh(std::move(mesh))
  , Fine(this->Mesh)
  , Shapes(std::move(shapes))
{
  const bool isRefined = this->Refine(positions, parallel, progress);
  std::shared_ptr<const TriangleMesh> marched = std::move(delaunay);
  if (!this->Shapes.empty())
  {
    marched = this->Fine;
  }
  else if (isRefined)
  {
    marched =
      IntrinsicDelaunay(this->Fine, parallel, ProgressMonitor(), BoundaryEdges::Keep).Mesh();
  }
  this->Fronts = std::make_unique<const GeodesicDistance>(std::move(marched), this->Shapes);
}

/// Returns whether there are long edges.
bool EikonalDistance::Refine(
  const Points& positions, const ParallelFor& parallel, const ProgressMonitor& progress)
{
  const TriangleMesh& mesh = *this->Mesh;
  const std::vector<double> lengths = FindLengths(mesh, this->Shapes);
  bool hasLongEdges = false;
  for (Index t = 0; t < mesh.NumberOfTriangles() && !hasLongEdges; ++t)
  {
    const TriangleMesh::Shape shape = mesh.Shapes()[static_cast<std::size_t>(t)];
    hasLongEdges = std::max({ shape.EdgeLength(0), shape.EdgeLength(1), shape.EdgeLength(2) }) >
      lengths[static_cast<std::size_t>(mesh.TriangleVertices()(t, 0))];
  }
  if (!hasLongEdges)
  {
    return false;
  }
  // Each component in its own unit
  Points scaled = positions;
  for (Eigen::Index i = 0; i < scaled.rows(); ++i)
  {
    scaled.row(i) /= lengths[static_cast<std::size_t>(i)];
  }
  const Index most = std::max(EnoughTriangles,
    4 * std::min(mesh.NumberOfTriangles(), std::numeric_limits<Index>::max() / 64));
  const RefinedSurface refined = RefineEdges(scaled, mesh.TriangleVertices(), 1.0, most, progress);
  const Points places = InterpolateAtVertices(refined, positions);
  const auto fine =
    std::make_shared<const TriangleMesh>(places, refined.Faces, parallel, ProgressMonitor(), 1.0);
  this->Fine = fine;
  this->FineVertices.assign(static_cast<std::size_t>(mesh.NumberOfVertices()), -1);
  for (Index v = 0; v < fine->NumberOfVertices(); ++v)
  {
    const Index row = fine->InputVertex()[static_cast<std::size_t>(v)];
    if (row < mesh.NumberOfVertices())
    {
      this->FineVertices[static_cast<std::size_t>(row)] = v;
    }
  }
  this->Parts.resize(static_cast<std::size_t>(mesh.NumberOfTriangles()));
  for (Index f = 0; f < fine->NumberOfTriangles(); ++f)
  {
    const Index row = fine->InputTriangle()[static_cast<std::size_t>(f)];
    const Index t = refined.InputTriangle[static_cast<std::size_t>(row)];
    this->Parts[static_cast<std::size_t>(t)].push_back({ f, Eigen::Matrix3d::Zero() });
  }
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    Coordinates inTriangle(refined, mesh.TriangleVertices().row(t));
    for (Part& part : this->Parts[static_cast<std::size_t>(t)])
    {
      for (int a = 0; a < 3; ++a)
      {
        const auto vertex = static_cast<std::size_t>(fine->TriangleVertices()(part.Triangle, a));
        part.Corners.col(a) = inTriangle.Of(fine->InputVertex()[vertex]);
      }
    }
  }
  this->CutShapes();
  return true;
}

/// A linear map takes the parts of a triangle to those of its image.
void EikonalDistance::CutShapes()
{
  const FrontShapes given = std::move(this->Shapes);
  this->Shapes.clear();
  if (given.empty())
  {
    return;
  }
  this->Shapes.resize(static_cast<std::size_t>(this->Fine->NumberOfTriangles()));
  for (std::size_t t = 0; t < given.size(); ++t)
  {
    Eigen::Matrix<double, 2, 3> corners;
    corners << 0.0, given[t].Length, given[t].X, 0.0, 0.0, given[t].Y;
    for (const Part& part : this->Parts[t])
    {
      TriangleMesh::Shape& shape = this->Shapes[static_cast<std::size_t>(part.Triangle)];
      shape = given[t];
      if (!IsBarrier(given, static_cast<Index>(t)))
      {
        const Eigen::Matrix<double, 2, 3> places = corners * part.Corners;
        const Eigen::Vector2d first = places.col(1) - places.col(0);
        const Eigen::Vector2d second = places.col(2) - places.col(0);
        shape.Length = first.norm();
        shape.X = first.dot(second) / shape.Length;
        shape.Y = std::abs(first[0] * second[1] - first[1] * second[0]) / shape.Length;
      }
    }
  }
}

/// The parts of a piece in the triangles of the refined surface.
void EikonalDistance::AppendParts(const SourcePiece& piece, std::vector<SourcePiece>& pieces) const
{
  if (this->Parts.empty())
  {
    pieces.push_back(piece);
    return;
  }
  constexpr double roundOff = 1e-12;
  const std::vector<Part>& parts = this->Parts[static_cast<std::size_t>(piece.Triangle)];
  // The nearest corner that other triangles have, too: of a point there, and of a triangle without area
  Index nearest = -1; // of Fine
  double largest = 0.0;
  for (std::size_t a = 0; a < 3; ++a)
  {
    const Index v = this->FineVertices[static_cast<std::size_t>(
      this->Mesh->TriangleVertices()(piece.Triangle, static_cast<Eigen::Index>(a)))];
    if (v >= 0 && piece.From[a] > largest)
    {
      nearest = this->Fine->VertexCorners()[static_cast<std::size_t>(
        this->Fine->VertexCornersBegin()[static_cast<std::size_t>(v)])];
      largest = piece.From[a];
    }
  }
  if (nearest >= 0 && (parts.empty() || (largest == 1.0 && piece.From == piece.To)))
  {
    SourcePiece corner = piece;
    corner.Triangle = nearest / 3;
    corner.From = { 0.0, 0.0, 0.0 };
    corner.From[static_cast<std::size_t>(nearest % 3)] = 1.0;
    corner.To = corner.From;
    pieces.push_back(corner);
    return;
  }
  const Eigen::Map<const Eigen::Vector3d> from(piece.From.data());
  const Eigen::Map<const Eigen::Vector3d> to(piece.To.data());
  SourcePiece whole = piece; // where it is a point
  double deepest = -Never;
  for (const Part& part : parts)
  {
    const Eigen::Matrix3d inPart = part.Corners.inverse();
    const Eigen::Vector3d first = inPart * from;
    const Eigen::Vector3d last = inPart * to;
    double begin = 0.0;
    double end = 1.0;
    for (int a = 0; a < 3; ++a)
    {
      const double slope = last[a] - first[a];
      const double zero = -first[a] / slope;
      begin = slope > 0.0 ? std::max(begin, zero) : begin;
      end = slope < 0.0 ? std::min(end, zero) : end;
      end = slope == 0.0 && first[a] < -roundOff ? -Never : end;
    }
    if (first.minCoeff() > deepest)
    {
      deepest = first.minCoeff();
      whole.Triangle = part.Triangle;
      whole.From = whole.To = Inside(first);
    }
    if (piece.From != piece.To && end - begin > roundOff)
    {
      pieces.push_back({ part.Triangle, Inside(first + begin * (last - first)),
        Inside(first + end * (last - first)), begin == 0.0 ? piece.FromPoint : -1,
        end == 1.0 ? piece.ToPoint : -1, piece.Label });
    }
  }
  if (piece.From == piece.To && !parts.empty())
  {
    pieces.push_back(whole);
  }
}

GeodesicDistance::Arrival EikonalDistance::Find(const std::vector<SourcePiece>& sources,
  const std::vector<double>& starts, const ProgressMonitor& progress) const
{
  Index nextPoint = 0;
  for (const SourcePiece& piece : sources)
  {
    nextPoint = std::max({ nextPoint, piece.FromPoint + 1, piece.ToPoint + 1 });
  }
  std::vector<FrontSource> fronts;
  std::vector<Index> pieceOf;
  std::vector<SourcePiece> parts;
  for (std::size_t k = 0; k < sources.size(); ++k)
  {
    parts.clear();
    this->AppendParts(sources[k], parts);
    for (const SourcePiece& part : parts)
    {
      AppendFronts(*this->Fine, this->Shapes, part, nextPoint, fronts);
    }
    for (; pieceOf.size() < fronts.size(); pieceOf.push_back(static_cast<Index>(k)))
    {
      FrontSource& front = fronts[pieceOf.size()];
      front.Start = starts.empty() ? 0.0 : starts[k];
      front.Time += front.Start;
    }
  }
  const GeodesicDistance::Arrival found = this->Fronts->FindNearest(fronts, progress);
  const auto n = static_cast<std::size_t>(this->Mesh->NumberOfVertices());
  GeodesicDistance::Arrival arrival{ std::vector<double>(n, Never), std::vector<Index>(n, -1) };
  for (std::size_t i = 0; i < n; ++i)
  {
    const Index v = this->FineVertices.empty() ? static_cast<Index>(i) : this->FineVertices[i];
    const Index front = v < 0 ? -1 : found.Sources[static_cast<std::size_t>(v)];
    if (front >= 0)
    {
      arrival.Times[i] = found.Times[static_cast<std::size_t>(v)];
      arrival.Sources[i] = pieceOf[static_cast<std::size_t>(front)];
    }
  }
  return arrival;
}

std::vector<std::pair<Index, double>> EikonalDistance::FindNear(Index vertex, double cutoff,
  GeodesicDistance::Memory& memory, const ProgressMonitor& progress) const
{
  const Index source =
    this->FineVertices.empty() ? vertex : this->FineVertices[static_cast<std::size_t>(vertex)];
  if (source < 0) // its triangles have no area
  {
    return { { vertex, 0.0 } };
  }
  const std::vector<Index> touched =
    this->Fronts->FindNear({ { source, 0.0, 0, 0, 0.0 } }, cutoff, {}, memory, progress);
  std::vector<std::pair<Index, double>> near;
  for (const Index v : touched)
  {
    const Index i =
      this->FineVertices.empty() ? v : this->Fine->InputVertex()[static_cast<std::size_t>(v)];
    if (i < this->Mesh->NumberOfVertices())
    {
      near.emplace_back(i, memory.Found.Times[static_cast<std::size_t>(v)]);
    }
  }
  memory.Clear(touched);
  return near;
}

} // namespace SurfaceDiffusion
