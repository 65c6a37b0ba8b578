// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/ReliefSolids.h"

#include "Core/Geometry/TriangleSides.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

constexpr double SmallestPart = 0.05; ///< of an edge that is cut

using Face = std::array<Index, 3>;
using Row3 = Eigen::RowVector3d;

class Divider
{
public:
  Divider(const Points& before, const Points& after, const Vector& levels)
    : Levels(levels)
  {
    for (Eigen::Index i = 0; i < before.rows(); ++i)
    {
      this->Add(before.row(i), after.row(i));
    }
  }

  ReliefSolids Divide(const Triangles& faces)
  {
    for (Index t = 0; t < static_cast<Index>(faces.rows()); ++t)
    {
      this->Cut({ faces(t, 0), faces(t, 1), faces(t, 2) });
    }
    this->DropPinches();
    std::array<std::vector<Face>, 2> solids;
    for (const Face& face : this->Rest)
    {
      solids[0].push_back(this->Top(face));
    }
    for (const auto& [a, b, c] : this->Raised)
    {
      solids[0].push_back({ a, b, c });
      solids[1].push_back(this->Top({ a, b, c }));
      solids[1].push_back({ a, c, b });
    }
    this->AddWalls(solids);
    ReliefSolids found;
    found.Places.resize(static_cast<Eigen::Index>(this->Places.size()), 3);
    for (std::size_t i = 0; i < this->Places.size(); ++i)
    {
      found.Places.row(static_cast<Eigen::Index>(i)) = this->Places[i];
    }
    found.Faces.resize(static_cast<Eigen::Index>(solids[0].size() + solids[1].size()), 3);
    Eigen::Index row = 0;
    for (const int isRaised : { 0, 1 })
    {
      for (const auto& [a, b, c] : solids[isRaised])
      {
        found.Faces.row(row++) << a, b, c;
        found.IsRaised.push_back(static_cast<char>(isRaised));
      }
    }
    return found;
  }

private:
  /// The number of a vertex before; TopOf has that of the same after, which is the same if it stays.
  Index Add(const Row3& before, const Row3& after)
  {
    const auto number = static_cast<Index>(this->Places.size());
    this->Places.push_back(before);
    this->TopOf.push_back(before == after ? number : number + 1);
    if (before != after)
    {
      this->Places.push_back(after);
      this->TopOf.push_back(number + 1);
    }
    this->Vertices.push_back(number);
    return number;
  }

  bool IsAbove(Index i) const { return this->Levels[i] > 0.0; }

  /// The vertex on the edge from i, above, to j, below: alike in both triangles.
  Index Between(Index i, Index j)
  {
    const auto known = this->OnEdges.find({ i, j });
    if (known != this->OnEdges.end())
    {
      return known->second;
    }
    const double part = std::clamp(
      this->Levels[i] / (this->Levels[i] - this->Levels[j]), SmallestPart, 1.0 - SmallestPart);
    const auto mix = [&](Index a, Index b) -> Row3
    { return (1.0 - part) * this->Places[a] + part * this->Places[b]; };
    const Index a = this->Vertices[i];
    const Index b = this->Vertices[j];
    const Index made = this->Add(mix(a, b), mix(this->TopOf[a], this->TopOf[b]));
    this->OnEdges[{ i, j }] = made;
    return made;
  }

  /// Into what is above and what is below.
  void Cut(Face corners)
  {
    const auto above =
      std::count_if(corners.begin(), corners.end(), [&](Index i) { return this->IsAbove(i); });
    const auto number = [&](int a) { return this->Vertices[corners[a]]; };
    if (above == 0 || above == 3)
    {
      this->Put(above == 3, { number(0), number(1), number(2) });
      return;
    }
    while (this->IsAbove(corners[0]) != (above == 1) || this->IsAbove(corners[1]) == (above == 1) ||
      this->IsAbove(corners[2]) == (above == 1))
    {
      std::rotate(corners.begin(), corners.begin() + 1, corners.end()); // the lone one first
    }
    const auto between = [&](int a)
    {
      return above == 1 ? this->Between(corners[0], corners[a])
                        : this->Between(corners[a], corners[0]);
    };
    const Index first = between(1);
    const Index last = between(2);
    this->Put(above == 1, { number(0), first, last });
    this->Put(above == 2, { first, number(1), number(2) });
    this->Put(above == 2, { first, number(2), last });
  }

  /// A triangle that the relief leaves where it is has nothing raised.
  void Put(bool isAbove, const Face& face)
  {
    const bool stays = this->Top(face) == face;
    (isAbove && !stays ? this->Raised : this->Rest).push_back(face);
  }

  Face Top(const Face& face) const
  {
    return { this->TopOf[face[0]], this->TopOf[face[1]], this->TopOf[face[2]] };
  }

  TriangleSides SidesOfRaised() const
  {
    Triangles rows(static_cast<Eigen::Index>(this->Raised.size()), 3);
    for (std::size_t t = 0; t < this->Raised.size(); ++t)
    {
      rows.row(static_cast<Eigen::Index>(t)) << this->Raised[t][0], this->Raised[t][1],
        this->Raised[t][2];
    }
    return SortSides(rows);
  }

  /// Raised triangles on both sides of an edge that stays would have it in common before and after,
  /// which is an edge of four triangles: they are no longer raised.
  void DropPinches()
  {
    const auto stays = [&](Index i) { return this->TopOf[i] == i; };
    std::vector<char> isDropped(this->Raised.size(), 0);
    ForEachEdge(this->SidesOfRaised(),
      [&](auto first, auto last)
      {
        if (last - first > 1 && stays(first->Low) && stays(first->High))
        {
          std::for_each(
            first, last, [&](const TriangleSide& side) { isDropped[side.Triangle] = 1; });
        }
      });
    std::vector<Face> kept;
    for (std::size_t t = 0; t < this->Raised.size(); ++t)
    {
      (isDropped[t] ? this->Rest : kept).push_back(this->Raised[t]);
    }
    this->Raised.swap(kept);
  }

  /// Between before and after, along the edges where the raised triangles end.
  void AddWalls(std::array<std::vector<Face>, 2>& solids) const
  {
    const auto add = [](std::vector<Face>& solid, const Face& face)
    {
      if (face[0] != face[1] && face[1] != face[2] && face[2] != face[0])
      {
        solid.push_back(face);
      }
    };
    ForEachEdge(this->SidesOfRaised(),
      [&](auto first, auto last)
      {
        if (last - first != 1)
        {
          return;
        }
        const Index i = first->Rises ? first->Low : first->High;
        const Index j = first->Rises ? first->High : first->Low;
        const Index above = this->TopOf[i];
        const Index beside = this->TopOf[j];
        add(solids[1], { beside, above, i });
        add(solids[1], { beside, i, j });
        add(solids[0], { i, above, beside });
        add(solids[0], { j, i, beside });
      });
  }

  const Vector& Levels;
  std::vector<Row3> Places;
  std::vector<Index> TopOf; ///< per place
  std::vector<Index> Vertices; ///< the place before of each vertex
  std::map<std::pair<Index, Index>, Index> OnEdges;
  std::vector<Face> Raised, Rest;
};

} // namespace

ReliefSolids DivideRelief(
  const Points& before, const Points& after, const Triangles& faces, const Vector& levels)
{
  return Divider(before, after, levels).Divide(faces);
}

} // namespace SurfaceDiffusion
