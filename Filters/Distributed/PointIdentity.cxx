// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/PointIdentity.h"

#include "Core/Foundation/Random.h"

#include "vtkBoundingBox.h"
#include "vtkCellArray.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkMath.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <numeric>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// Automatic tolerance, in diagonals of the bounding box: what single precision may lose.
constexpr double AutomaticTolerance = 1e-6;

/// A piece in the table that all processes have.
struct PieceEntry
{
  int Process;
  int Surface;
  vtkIdType Points;
  vtkIdType FirstLabel;
  vtkBoundingBox Box;
};

/// A point that may be in other pieces too.
struct Candidate
{
  int Piece; ///< in the table
  int Surface;
  vtkIdType Label;
  bool Open; ///< on the edge of its piece, or of no cell of its own
  bool Ghost; ///< a copy: of no cell of its own, or flagged
  std::array<double, 3> Place; ///< or the global id and zeros
};
constexpr int NumbersPerCandidate = 7;

vtkDataArray* GlobalIds(vtkPolyData* data)
{
  vtkDataArray* ids = data->GetPointData()->GetGlobalIds();
  const bool usable = ids && ids->GetNumberOfComponents() == 1 &&
    ids->GetNumberOfTuples() == data->GetNumberOfPoints();
  return usable ? ids : nullptr;
}

std::vector<PieceEntry> MakeTable(
  const Processes& processes, const std::vector<SurfacePiece>& pieces)
{
  constexpr std::size_t width = 9;
  std::vector<double> mine;
  for (const SurfacePiece& piece : pieces)
  {
    double bounds[6];
    piece.Input->GetBounds(bounds);
    mine.push_back(processes.Rank());
    mine.push_back(piece.Surface);
    mine.push_back(static_cast<double>(piece.Input->GetNumberOfPoints()));
    mine.insert(mine.end(), bounds, bounds + 6);
  }
  const std::vector<double> all = processes.GatherAll(mine);
  std::vector<PieceEntry> table;
  vtkIdType first = 0;
  for (std::size_t i = 0; i < all.size(); i += width)
  {
    const auto points = static_cast<vtkIdType>(all[i + 2]);
    table.push_back({ static_cast<int>(all[i]), static_cast<int>(all[i + 1]), points, first,
      vtkBoundingBox(&all[i + 3]) });
    first += points;
  }
  return table;
}

/// Which points the cells of a piece itself use, and which of them lie on edges of one triangle.
class OpenPoints
{
public:
  /// candidates: the points that matter.
  OpenPoints(vtkPolyData* data, const std::vector<char>& candidates)
    : Candidates(candidates)
    , Used(candidates.size(), 0)
    , OnEdge(candidates.size(), 0)
  {
    vtkUnsignedCharArray* const ghosts = data->GetCellGhostArray();
    const bool known = ghosts && ghosts->GetNumberOfTuples() == data->GetNumberOfCells();
    const unsigned char* const flags = known ? ghosts->GetPointer(0) : nullptr;
    vtkIdType cell = data->GetNumberOfVerts() + data->GetNumberOfLines();
    this->AddCells(data->GetPolys(), flags ? flags + cell : nullptr, false);
    cell += data->GetNumberOfPolys();
    this->AddCells(data->GetStrips(), flags ? flags + cell : nullptr, true);
    std::sort(this->Edges.begin(), this->Edges.end());
    for (std::size_t begin = 0, end = 0; begin < this->Edges.size(); begin = end)
    {
      while (end < this->Edges.size() && this->Edges[end] == this->Edges[begin])
      {
        ++end;
      }
      if (end == begin + 1)
      {
        this->OnEdge[this->Edges[begin].first] = this->OnEdge[this->Edges[begin].second] = 1;
      }
    }
  }

  bool IsUsed(vtkIdType point) const { return this->Used[point] != 0; }
  bool IsOnEdge(vtkIdType point) const { return this->OnEdge[point] != 0; }

private:
  void AddCells(vtkCellArray* cells, const unsigned char* ghosts, bool strips)
  {
    constexpr unsigned char absent =
      vtkDataSetAttributes::DUPLICATECELL | vtkDataSetAttributes::HIDDENCELL;
    const vtkIdType count = cells ? cells->GetNumberOfCells() : 0;
    const auto points = static_cast<vtkIdType>(this->Candidates.size());
    for (vtkIdType c = 0; c < count; ++c)
    {
      vtkIdType size = 0;
      const vtkIdType* ids = nullptr;
      cells->GetCellAtId(c, size, ids);
      if ((ghosts && (ghosts[c] & absent)) ||
        std::any_of(ids, ids + size, [&](vtkIdType id) { return id < 0 || id >= points; }))
      {
        continue; // bad ids are an error, told later with others of its kind
      }
      for (vtkIdType i = 0; i < size; ++i)
      {
        this->Used[ids[i]] = 1;
      }
      for (vtkIdType i = 0; strips && i + 2 < size; ++i)
      {
        const vtkIdType corners[3] = { ids[i], ids[i + 1], ids[i + 2] };
        this->AddPolygon(3, corners);
      }
      if (!strips)
      {
        this->AddPolygon(size, ids);
      }
    }
  }

  void AddPolygon(vtkIdType size, const vtkIdType* ids)
  {
    for (vtkIdType i = 0; i < size; ++i)
    {
      const vtkIdType a = ids[i];
      const vtkIdType b = ids[(i + 1) % size];
      if (this->Candidates[a] || this->Candidates[b])
      {
        this->Edges.emplace_back(std::min(a, b), std::max(a, b));
      }
    }
  }

  const std::vector<char>& Candidates;
  std::vector<char> Used, OnEdge;
  std::vector<std::pair<vtkIdType, vtkIdType>> Edges;
};

/// The points of a piece that lie within the bounding box of another piece of the same surface.
void AppendCandidates(const SurfacePiece& piece, std::size_t entry,
  const std::vector<PieceEntry>& table, double tolerance, bool byId, std::vector<double>& numbers)
{
  vtkPolyData* const data = piece.Input;
  const vtkIdType count = data->GetNumberOfPoints();
  std::vector<char> candidates(count, 0);
  for (std::size_t other = 0; other < table.size(); ++other)
  {
    vtkBoundingBox box = table[other].Box;
    if (other == entry || table[other].Surface != piece.Surface || !box.IsValid())
    {
      continue;
    }
    box.Inflate(tolerance);
    for (vtkIdType i = 0; i < count; ++i)
    {
      const double* const x = data->GetPoint(i);
      const bool finite = std::all_of(x, x + 3, [](double value) { return std::isfinite(value); });
      candidates[i] = candidates[i] || (finite && box.ContainsPoint(x));
    }
  }
  const OpenPoints open(data, candidates);
  vtkUnsignedCharArray* const ghosts = data->GetPointGhostArray();
  vtkDataArray* const ids = byId ? GlobalIds(data) : nullptr;
  for (vtkIdType i = 0; i < count; ++i)
  {
    if (!candidates[i])
    {
      continue;
    }
    const bool flagged = ghosts && ghosts->GetNumberOfTuples() == count &&
      (ghosts->GetValue(i) & vtkDataSetAttributes::DUPLICATEPOINT);
    double place[3] = { 0.0, 0.0, 0.0 };
    if (ids)
    {
      place[0] = ids->GetComponent(i, 0);
    }
    else
    {
      data->GetPoint(i, place);
    }
    const bool used = open.IsUsed(i);
    numbers.push_back(static_cast<double>(entry));
    numbers.push_back(static_cast<double>(i));
    numbers.push_back(!used || open.IsOnEdge(i) ? 1.0 : 0.0);
    numbers.push_back(!used || flagged ? 1.0 : 0.0);
    for (const double x : place)
    {
      numbers.push_back(x + 0.0); // -0 is 0
    }
  }
}

using Group = std::vector<std::size_t>; // of candidates

/// Calls take(group) for the candidates of each place of each surface, in the order of pieces.
template <typename Take>
void ForEachPlace(
  const std::vector<Candidate>& candidates, const std::vector<std::size_t>& among, const Take& take)
{
  const auto key = [&](std::size_t c)
  { return std::make_pair(candidates[c].Surface, candidates[c].Place); };
  std::vector<std::size_t> order = among;
  std::sort(order.begin(), order.end(),
    [&](std::size_t a, std::size_t b)
    { return key(a) != key(b) ? key(a) < key(b) : candidates[a].Label < candidates[b].Label; });
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end)
  {
    while (end < order.size() && key(order[end]) == key(order[begin]))
    {
      ++end;
    }
    take(Group(order.begin() + begin, order.begin() + end));
  }
}

/// Joins the points of one place: of each piece the k-th with the k-th of the others.
class Joiner
{
public:
  Joiner(const std::vector<Candidate>& candidates, bool needsOpen)
    : Candidates(candidates)
    , NeedsOpen(needsOpen)
    , Owner(candidates.size())
  {
    std::iota(this->Owner.begin(), this->Owner.end(), std::size_t(0));
  }

  /// group: of one place, ordered by label. Tells which of them found no other.
  void Join(const Group& group, std::vector<std::size_t>& alone)
  {
    std::map<std::pair<int, bool>, std::size_t> seen; // piece, ghost: how many so far
    std::map<std::size_t, Group> ordinals;
    for (const std::size_t c : group)
    {
      const Candidate& candidate = this->Candidates[c];
      ordinals[seen[{ candidate.Piece, candidate.Ghost }]++].push_back(c);
    }
    for (const auto& ordinal : ordinals)
    {
      const Group& members = ordinal.second;
      const bool several = std::any_of(members.begin(), members.end(),
        [&](std::size_t c)
        { return this->Candidates[c].Piece != this->Candidates[members.front()].Piece; });
      const bool open = std::any_of(
        members.begin(), members.end(), [&](std::size_t c) { return this->Candidates[c].Open; });
      if (!several || (this->NeedsOpen && !open))
      {
        alone.insert(alone.end(), members.begin(), members.end());
        continue;
      }
      // The first that is no copy owns the point.
      const auto original = std::find_if(
        members.begin(), members.end(), [&](std::size_t c) { return !this->Candidates[c].Ghost; });
      const std::size_t owner = original == members.end() ? members.front() : *original;
      for (const std::size_t c : members)
      {
        this->Owner[c] = owner;
      }
    }
  }

  vtkIdType LabelOf(std::size_t c) const { return this->Candidates[this->Owner[c]].Label; }
  std::size_t OwnerOf(std::size_t c) const { return this->Owner[c]; }

private:
  const std::vector<Candidate>& Candidates;
  const bool NeedsOpen;
  std::vector<std::size_t> Owner;
};

/// Gives candidates that lie within the tolerance of each other one place: that of the first.
void ShareNearPlaces(
  std::vector<Candidate>& candidates, const std::vector<std::size_t>& among, double tolerance)
{
  using Cell = std::array<double, 4>; // surface, and the cube of a grid of the tolerance's width
  const auto cellOf = [&](const Candidate& candidate)
  {
    Cell cell{ static_cast<double>(candidate.Surface), 0.0, 0.0, 0.0 };
    for (int k = 0; k < 3; ++k)
    {
      cell[k + 1] = std::floor(candidate.Place[k] / tolerance);
    }
    return cell;
  };
  std::map<Cell, std::vector<std::size_t>> firsts;
  for (const std::size_t c : among)
  {
    const Cell centre = cellOf(candidates[c]);
    const std::size_t* nearest = nullptr;
    double distance = tolerance * tolerance;
    for (int n = 0; n < 27; ++n)
    {
      const int shift[3] = { n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1 };
      const auto found = firsts.find(
        { centre[0], centre[1] + shift[0], centre[2] + shift[1], centre[3] + shift[2] });
      if (found == firsts.end())
      {
        continue;
      }
      for (const std::size_t& first : found->second)
      {
        const double d = vtkMath::Distance2BetweenPoints(
          candidates[first].Place.data(), candidates[c].Place.data());
        if (d <= distance)
        {
          distance = d;
          nearest = &first;
        }
      }
    }
    if (nearest)
    {
      candidates[c].Place = candidates[*nearest].Place;
    }
    else
    {
      firsts[centre].push_back(c);
    }
  }
}

/// Positive, and small enough for a double to hold.
std::int64_t HashOfPlace(const double* place)
{
  std::uint64_t hash = 0;
  for (int k = 0; k < 3; ++k)
  {
    const double x = place[k] + 0.0; // -0 is 0
    std::uint64_t bits = 0;
    std::memcpy(&bits, &x, sizeof(bits));
    hash = SurfaceDiffusion::MixBits(hash ^ bits);
  }
  return static_cast<std::int64_t>(hash >> 12);
}

} // namespace

std::vector<PointIdentity> FindIdentity(
  const Processes& processes, const std::vector<SurfacePiece>& pieces, double tolerance)
{
  const std::vector<PieceEntry> table = MakeTable(processes, pieces);
  const bool byId = !processes.Any(std::any_of(pieces.begin(), pieces.end(),
    [](const SurfacePiece& piece)
    { return piece.Input->GetNumberOfPoints() > 0 && !GlobalIds(piece.Input); }));
  if (tolerance < 0.0 || !std::isfinite(tolerance))
  {
    vtkBoundingBox all;
    for (const PieceEntry& entry : table)
    {
      all.AddBox(entry.Box);
    }
    tolerance = all.IsValid() ? AutomaticTolerance * all.GetDiagonalLength() : 0.0;
  }

  // What all processes have to know of each other's points
  const auto mine = static_cast<std::size_t>(
    std::find_if(table.begin(), table.end(),
      [&](const PieceEntry& entry) { return entry.Process == processes.Rank(); }) -
    table.begin());
  std::vector<double> numbers;
  for (std::size_t p = 0; p < pieces.size(); ++p)
  {
    AppendCandidates(pieces[p], mine + p, table, tolerance, byId, numbers);
  }
  numbers = processes.GatherAll(numbers);
  std::vector<Candidate> candidates;
  candidates.reserve(numbers.size() / NumbersPerCandidate);
  for (std::size_t i = 0; i < numbers.size(); i += NumbersPerCandidate)
  {
    const auto entry = static_cast<int>(numbers[i]);
    candidates.push_back({ entry, table[entry].Surface,
      table[entry].FirstLabel + static_cast<vtkIdType>(numbers[i + 1]), numbers[i + 2] != 0.0,
      numbers[i + 3] != 0.0, { numbers[i + 4], numbers[i + 5], numbers[i + 6] } });
  }

  // Everybody joins all of them, in the same way.
  Joiner joiner(candidates, !byId);
  std::vector<std::size_t> all(candidates.size()), alone, apart;
  std::iota(all.begin(), all.end(), std::size_t(0));
  ForEachPlace(candidates, all, [&](const Group& group) { joiner.Join(group, alone); });
  if (!byId && tolerance > 0.0)
  {
    std::sort(alone.begin(), alone.end());
    ShareNearPlaces(candidates, alone, tolerance);
    ForEachPlace(candidates, alone, [&](const Group& group) { joiner.Join(group, apart); });
  }

  std::vector<PointIdentity> identities(pieces.size());
  for (std::size_t p = 0; p < pieces.size(); ++p)
  {
    PointIdentity& identity = identities[p];
    vtkPolyData* const data = pieces[p].Input;
    identity.FirstLabel = table[mine + p].FirstLabel;
    identity.Labels.resize(data->GetNumberOfPoints());
    identity.Ids.resize(data->GetNumberOfPoints());
    std::iota(identity.Labels.begin(), identity.Labels.end(), identity.FirstLabel);
    vtkDataArray* const ids = byId ? GlobalIds(data) : nullptr;
    for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
    {
      identity.Ids[i] =
        ids ? static_cast<std::int64_t>(ids->GetComponent(i, 0)) : HashOfPlace(data->GetPoint(i));
    }
  }
  for (std::size_t c = 0; c < candidates.size(); ++c)
  {
    const auto entry = static_cast<std::size_t>(candidates[c].Piece);
    if (entry >= mine && entry < mine + pieces.size())
    {
      PointIdentity& identity = identities[entry - mine];
      const auto i = static_cast<std::size_t>(candidates[c].Label - identity.FirstLabel);
      identity.Labels[i] = joiner.LabelOf(c);
    }
  }
  return identities;
}

} // namespace SurfaceDiffusion
