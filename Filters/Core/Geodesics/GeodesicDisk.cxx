// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geodesics/GeodesicDisk.h"

#include "Core/Geodesics/WindowFront.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <unordered_map>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

using Eigen::Vector2d;

/// The largest part of the longest edge of a triangle that a point of it is away from the nearest corner.
const double Farthest = 1.0 / std::sqrt(3.0);

using EdgeOfNodes = std::pair<Index, Index>;

EdgeOfNodes EdgeKey(Index i, Index j)
{
  return { std::min(i, j), std::max(i, j) };
}

double LongestEdge(const EdgeFrames& frames, Index triangle)
{
  return std::max({ frames[3 * triangle].Length, frames[3 * triangle + 1].Length,
    frames[3 * triangle + 2].Length });
}

/// The distances within triangles that are marked, from the windows that go over them.
class DistancesWithin
{
public:
  DistancesWithin(const TriangleMesh& mesh, const EdgeFrames& frames, const MeshPlace& center,
    double radius, double margin, const ProgressMonitor& progress)
    : Mesh(mesh)
    , Frames(frames)
    , Front(mesh, frames, radius + margin)
  {
    // Windows of all triangles would be too many: those that come to them are found first.
    std::vector<char> isMet(static_cast<std::size_t>(mesh.NumberOfTriangles()), 0);
    this->Front.Watched.assign(isMet.size(), 1);
    this->Front.AddSource({ center.Triangle, center.At, center.At }, 0);
    this->Front.Run(progress.Part(0.0, 0.5),
      [&](Index edge, const std::vector<GeodesicWindow>&)
      { isMet[static_cast<std::size_t>(edge / 3)] = 1; });
    for (const auto& [triangle, piece] : this->Front.Pieces)
    {
      isMet[static_cast<std::size_t>(triangle)] = 1;
    }
    for (const Index v : this->Front.Reached)
    {
      for (Index k = mesh.VertexCornersBegin()[static_cast<std::size_t>(v)];
           k < mesh.VertexCornersBegin()[static_cast<std::size_t>(v) + 1]; ++k)
      {
        isMet[static_cast<std::size_t>(mesh.VertexCorners()[static_cast<std::size_t>(k)] / 3)] = 1;
      }
    }
    for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
    {
      const auto row = static_cast<std::size_t>(t);
      double largest = 0.0;
      for (Index corner = 3 * t; corner < 3 * t + 3; ++corner)
      {
        largest = std::max(largest, this->TimeAt(corner));
      }
      const bool isWithin = largest <= radius - Farthest * LongestEdge(frames, t);
      this->Front.Watched[row] = isMet[row] && !isWithin ? 1 : 0;
      if (isMet[row])
      {
        (isWithin ? this->Within : this->Band).push_back(t);
      }
    }
    this->Front.Clear();
    this->Front.AddSource({ center.Triangle, center.At, center.At }, 0);
    this->Front.Run(progress.Part(0.5, 0.9),
      [&](Index edge, const std::vector<GeodesicWindow>& windows)
      {
        auto& list = this->Windows[edge];
        list.insert(list.end(), windows.begin(), windows.end());
      });
  }

  /// The distance, or a larger one where it is above radius + margin.
  double At(const MeshPlace& place) const
  {
    double least = Never;
    for (Index edge = 3 * place.Triangle; edge < 3 * place.Triangle + 3; ++edge)
    {
      const Vector2d x = this->Frames.PlaceOn(edge, place.At);
      least = std::min(least, this->TimeAt(CornerAfter(edge, 1)) + x.norm());
      const auto windows = this->Windows.find(edge);
      if (windows != this->Windows.end())
      {
        for (const GeodesicWindow& w : windows->second)
        {
          least = std::min(least, w.Beyond(x[0], x[1]));
        }
      }
    }
    return std::min(least, this->Front.FindNearestPiece(place).Distance);
  }

  std::vector<Index> Within; ///< triangles that are in the disk as a whole
  std::vector<Index> Band; ///< triangles that its boundary may cross

private:
  double TimeAt(Index corner) const
  {
    return this->Front
      .Times[static_cast<std::size_t>(this->Mesh.TriangleVertices().data()[corner])];
  }

  const TriangleMesh& Mesh;
  const EdgeFrames& Frames;
  WindowFront Front;
  std::unordered_map<Index, std::vector<GeodesicWindow>> Windows; ///< per edge
};

/// Triangles that are bisected near the boundary of the disk, as far as needed.
class BandBisection
{
public:
  struct Piece
  {
    Index Triangle;
    std::array<Index, 3> Nodes;
    std::array<std::array<double, 3>, 3> At; ///< barycentric coordinates of the nodes
    std::array<double, 3> Lengths; ///< of the edges opposite
    double Area;
  };

  BandBisection(const TriangleMesh& mesh, const EdgeFrames& frames,
    const DistancesWithin& distances, double radius, double length)
    : Distances(distances)
    , Radius(radius)
    , Length(length)
  {
    std::vector<Piece> waiting;
    for (const Index t : distances.Band)
    {
      Piece piece{ t, {}, { { { 1.0, 0.0, 0.0 }, { 0.0, 1.0, 0.0 }, { 0.0, 0.0, 1.0 } } }, {},
        mesh.Shapes()[static_cast<std::size_t>(t)].Area() };
      for (std::size_t a = 0; a < 3; ++a)
      {
        const Index corner = 3 * t + static_cast<Index>(a);
        const Index vertex = mesh.TriangleVertices().data()[corner];
        piece.Nodes[a] = this->NodeBetween(vertex, vertex);
        piece.Lengths[a] = frames[corner].Length;
        this->Find(piece, a);
      }
      waiting.push_back(piece);
    }
    while (!waiting.empty())
    {
      const Piece piece = waiting.back();
      waiting.pop_back();
      this->Divide(piece, waiting);
    }
  }

  double AreaWithin = 0.0; ///< of pieces that are in the disk as a whole
  std::vector<Piece> Pieces; ///< that its boundary may cross
  double At(Index node) const { return this->Times[static_cast<std::size_t>(node)]; }

private:
  /// The node in the middle of two nodes, or at a vertex as both.
  Index NodeBetween(Index i, Index j)
  {
    const auto found = (i == j ? this->OfVertices : this->OfEdges)
                         .emplace(EdgeKey(i, j), static_cast<Index>(this->Times.size()));
    if (found.second)
    {
      this->Times.push_back(-1.0);
    }
    return found.first->second;
  }
  void Find(const Piece& piece, std::size_t a)
  {
    double& time = this->Times[static_cast<std::size_t>(piece.Nodes[a])];
    time = time < 0.0 ? this->Distances.At({ piece.Triangle, piece.At[a] }) : time;
  }

  /// The piece is kept, or its longest edge is bisected. Edges are bisected until they are short, so that
  /// pieces on both sides of one have the same nodes.
  void Divide(const Piece& piece, std::vector<Piece>& waiting)
  {
    double least = Never, most = 0.0;
    for (const Index node : piece.Nodes)
    {
      least = std::min(least, this->At(node));
      most = std::max(most, this->At(node));
    }
    const double longest = *std::max_element(piece.Lengths.begin(), piece.Lengths.end());
    if (least > this->Radius + Farthest * longest)
    {
      return;
    }
    if (most < this->Radius - Farthest * longest)
    {
      this->AreaWithin += piece.Area;
      return;
    }
    if (longest <= this->Length)
    {
      this->Pieces.push_back(piece);
      return;
    }
    const auto a = static_cast<std::size_t>(
      std::max_element(piece.Lengths.begin(), piece.Lengths.end()) - piece.Lengths.begin());
    const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
    const Index middle = this->NodeBetween(piece.Nodes[b], piece.Nodes[c]);
    std::array<double, 3> at{};
    for (std::size_t k = 0; k < 3; ++k)
    {
      at[k] = 0.5 * (piece.At[b][k] + piece.At[c][k]);
    }
    // The median
    const double squares =
      2.0 * (piece.Lengths[b] * piece.Lengths[b] + piece.Lengths[c] * piece.Lengths[c]) -
      piece.Lengths[a] * piece.Lengths[a];
    const double median = 0.5 * std::sqrt(std::max(0.0, squares));
    for (const std::size_t replaced : { b, c })
    {
      const std::size_t other = replaced == b ? c : b;
      Piece half = piece;
      half.Nodes[replaced] = middle;
      half.At[replaced] = at;
      half.Lengths[a] = 0.5 * piece.Lengths[a];
      half.Lengths[other] = median; // between the apex and the middle
      half.Area = 0.5 * piece.Area;
      this->Find(half, replaced);
      waiting.push_back(half);
    }
  }

  const DistancesWithin& Distances;
  double Radius, Length;
  std::map<EdgeOfNodes, Index> OfVertices, OfEdges;
  std::vector<double> Times; ///< per node
};

/// Straight parts of the boundary, which begin and end on edges between nodes.
class Chains
{
public:
  void Add(
    const EdgeOfNodes& from, const MeshPlace& begin, const EdgeOfNodes& to, const MeshPlace& end)
  {
    this->At[from].push_back(this->Parts.size());
    this->At[to].push_back(this->Parts.size());
    this->Parts.push_back({ { from, to }, { begin, end } });
  }

  /// Those that meet in pairs as curves, first the ones that end somewhere.
  std::vector<std::vector<MeshPlace>> Join()
  {
    std::vector<std::vector<MeshPlace>> curves;
    for (const bool areOpen : { true, false })
    {
      for (std::size_t k = 0; k < this->Parts.size(); ++k)
      {
        for (const std::size_t first : { 0, 1 })
        {
          const bool ends = this->At[this->Parts[k].Edges[first]].size() != 2;
          if (!this->Parts[k].IsUsed && (ends || !areOpen))
          {
            curves.push_back(this->Follow(k, first));
          }
        }
      }
    }
    return curves;
  }

private:
  struct Part
  {
    std::array<EdgeOfNodes, 2> Edges;
    std::array<MeshPlace, 2> Places;
    bool IsUsed = false;
  };

  std::vector<MeshPlace> Follow(std::size_t k, std::size_t first)
  {
    std::vector<MeshPlace> curve{ this->Parts[k].Places[first] };
    while (true)
    {
      Part& part = this->Parts[k];
      part.IsUsed = true;
      curve.push_back(part.Places[1 - first]);
      const EdgeOfNodes edge = part.Edges[1 - first];
      const std::vector<std::size_t>& here = this->At[edge];
      const std::size_t next = here.size() == 2 && here[0] == k ? here[1] : here[0];
      if (here.size() != 2 || this->Parts[next].IsUsed)
      {
        return curve;
      }
      k = next;
      first = this->Parts[k].Edges[0] == edge ? 0 : 1;
    }
  }

  std::vector<Part> Parts;
  std::map<EdgeOfNodes, std::vector<std::size_t>> At;
};

} // namespace

GeodesicDisk::GeodesicDisk(const TriangleMesh& mesh, const EdgeFrames& frames,
  const MeshPlace& center, double radius, const ProgressMonitor& progress)
{
  constexpr double pieces = 16.0;
  const double length = radius / pieces;
  const DistancesWithin distances(mesh, frames, center, radius, 2.0 * length, progress);
  for (const Index t : distances.Within)
  {
    this->TotalArea += mesh.Shapes()[static_cast<std::size_t>(t)].Area();
  }
  const BandBisection bisection(mesh, frames, distances, radius, length);
  this->TotalArea += bisection.AreaWithin;
  Chains chains;
  for (const BandBisection::Piece& piece : bisection.Pieces)
  {
    const auto isWithin = [&](std::size_t a) { return bisection.At(piece.Nodes[a]) <= radius; };
    const int count = int(isWithin(0)) + int(isWithin(1)) + int(isWithin(2));
    if (count == 0 || count == 3)
    {
      this->TotalArea += count == 3 ? piece.Area : 0.0;
      continue;
    }
    // The boundary leaves the edges at the corner that is alone, at these shares of them.
    const bool outer = count == 2;
    const std::size_t a = isWithin(0) != outer ? 0 : isWithin(1) != outer ? 1 : 2;
    EdgeOfNodes edges[2];
    MeshPlace places[2] = { { piece.Triangle, {} }, { piece.Triangle, {} } };
    double part = 1.0;
    for (const std::size_t k : { 0, 1 })
    {
      const std::size_t b = (a + 1 + k) % 3;
      const double alone = bisection.At(piece.Nodes[a]), other = bisection.At(piece.Nodes[b]);
      const double share = (radius - alone) / (other - alone);
      for (std::size_t i = 0; i < 3; ++i)
      {
        places[k].At[i] = (1.0 - share) * piece.At[a][i] + share * piece.At[b][i];
      }
      edges[k] = EdgeKey(piece.Nodes[a], piece.Nodes[b]);
      part *= share;
    }
    this->TotalArea += piece.Area * (outer ? 1.0 - part : part);
    chains.Add(edges[0], places[0], edges[1], places[1]);
  }
  this->Curves = chains.Join();
}

} // namespace SurfaceDiffusion
