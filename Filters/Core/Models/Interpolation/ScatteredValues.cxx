// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Interpolation/RepeatedValues.h"

#include "Core/Foundation/DisjointSets.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// Vertices and coordinates in one order, without those that do not count.
using PlaceKey = std::array<std::pair<Index, double>, 3>;

PlaceKey Key(const SurfacePoint& place)
{
  PlaceKey key;
  for (std::size_t a = 0; a < 3; ++a)
  {
    const bool counts = place.Coordinates[a] != 0.0;
    key[a] = { counts ? place.Vertices[a] : -1, counts ? place.Coordinates[a] : 0.0 };
  }
  std::sort(key.begin(), key.end());
  return key;
}

/// Whether no coordinate differs by more than the tolerance; those that do not count are 0.
bool IsNear(const PlaceKey& a, const PlaceKey& b)
{
  const auto reaches = [](const PlaceKey& from, const PlaceKey& to)
  {
    return std::all_of(from.begin(), from.end(),
      [&](const std::pair<Index, double>& own)
      {
        const auto other = std::find_if(to.begin(), to.end(),
          [&](const std::pair<Index, double>& its) { return its.first == own.first; });
        const double coordinate = other != to.end() ? other->second : 0.0;
        return own.first < 0 || std::abs(own.second - coordinate) <= MergedValues::Tolerance;
      });
  };
  return reaches(a, b) && reaches(b, a);
}

/// Of sorted keys the first one of those that are near each other, directly or by others.
std::vector<Index> FirstOfNear(const std::vector<PlaceKey>& keys)
{
  DisjointSets sets(static_cast<Index>(keys.size()));
  // Places that are near have a vertex in common at which both have a coordinate above this one.
  constexpr double large = 0.3;
  std::vector<std::pair<std::pair<Index, double>, Index>> entries;
  for (Index i = 0; i < static_cast<Index>(keys.size()); ++i)
  {
    if (i > 0 && keys[i] == keys[i - 1])
    {
      sets.Join(i, i - 1);
      continue;
    }
    for (const std::pair<Index, double>& entry : keys[i])
    {
      if (entry.second > large)
      {
        entries.emplace_back(entry, i);
      }
    }
  }
  std::sort(entries.begin(), entries.end());
  for (auto a = entries.begin(); a != entries.end(); ++a)
  {
    for (auto b = a + 1; b != entries.end() && b->first.first == a->first.first &&
         b->first.second - a->first.second <= MergedValues::Tolerance;
         ++b)
    {
      if (IsNear(keys[a->second], keys[b->second]))
      {
        sets.Join(a->second, b->second);
      }
    }
  }
  std::vector<Index> first(keys.size());
  for (Index i = 0; i < static_cast<Index>(keys.size()); ++i)
  {
    first[i] = sets.Find(i);
  }
  return first;
}

/// The numbers of values with those of one place in succession, in an order that does not depend on
/// theirs, and where each place begins.
struct Grouping
{
  explicit Grouping(const ScatteredValues& given);

  std::vector<Index> Order;
  std::vector<Index> Begin = { 0 };
};

Grouping::Grouping(const ScatteredValues& given)
  : Order(given.Places.size())
{
  const Index count = given.Count();
  std::vector<Index>& order = this->Order;
  std::vector<PlaceKey> keys(count);
  std::transform(given.Places.begin(), given.Places.end(), keys.begin(), Key);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
    [&](Index a, Index b) { return keys[a] != keys[b] ? keys[a] < keys[b] : a < b; });
  std::vector<PlaceKey> sorted;
  for (const Index i : order)
  {
    sorted.push_back(keys[i]);
  }
  const std::vector<Index> first = FirstOfNear(sorted);
  std::vector<Index> place(count);
  for (Index i = 0; i < count; ++i)
  {
    place[order[i]] = first[i];
  }
  std::stable_sort(
    order.begin(), order.end(), [&](Index a, Index b) { return place[a] < place[b]; });
  for (Index i = 1; i <= count; ++i)
  {
    if (i == count || place[order[i]] != place[order[i - 1]])
    {
      this->Begin.push_back(i);
    }
  }
}

} // namespace

Index SurfacePoint::Vertex() const
{
  for (std::size_t a = 0; a < 3; ++a)
  {
    if (this->Coordinates[a] == 1.0)
    {
      return this->Vertices[a];
    }
  }
  return -1;
}

ScatteredValues ScatteredValues::AtVertices(const Values& f, const Flags& known)
{
  ScatteredValues data;
  const Eigen::Index count = known.count();
  data.Given.resize(count, f.cols());
  data.Weights = Vector::Ones(count);
  for (Index i = 0; i < static_cast<Index>(f.rows()); ++i)
  {
    if (known[i])
    {
      data.Given.row(data.Count()) = f.row(i);
      data.Places.push_back(SurfacePoint::AtVertex(i));
    }
  }
  return data;
}

Values ScatteredValues::AtPlaces(const Values& u) const
{
  Values values = Values::Zero(this->Count(), u.cols());
  for (Index i = 0; i < this->Count(); ++i)
  {
    const SurfacePoint& place = this->Places[i];
    for (std::size_t a = 0; a < 3; ++a)
    {
      if (place.Coordinates[a] != 0.0)
      {
        values.row(i) += place.Coordinates[a] * u.row(place.Vertices[a]);
      }
    }
  }
  return values;
}

MergedValues::MergedValues(const ScatteredValues& given)
{
  const Index count = given.Count();
  const Grouping groups(given);
  const std::vector<Index>& order = groups.Order;
  this->Rows.Given.resize(count, given.Given.cols());
  this->Rows.Weights.resize(count);
  this->RowOf.resize(static_cast<std::size_t>(count));
  for (std::size_t g = 1; g < groups.Begin.size(); ++g)
  {
    const Index begin = groups.Begin[g - 1];
    const Index end = groups.Begin[g];
    const auto row = static_cast<Eigen::Index>(this->Rows.Count());
    this->Rows.Places.push_back(given.Places[order[begin]]);
    for (Index i = begin; i < end; ++i)
    {
      this->RowOf[order[i]] = static_cast<Index>(row);
    }
    this->Rows.Given.row(row) = given.Given.row(order[begin]);
    this->Rows.Weights[row] = given.Weights[order[begin]];
    bool contradicts = false;
    for (Index i = begin + 1; i < end; ++i)
    {
      ++this->Repeated;
      const double weight = given.Weights[order[i]];
      contradicts = contradicts || given.Given.row(order[i]) != given.Given.row(order[begin]);
      this->Rows.Weights[row] += weight;
      this->Rows.Given.row(row) +=
        weight / this->Rows.Weights[row] * (given.Given.row(order[i]) - this->Rows.Given.row(row));
    }
    this->Contradicting += contradicts ? 1 : 0;
  }
  this->Rows.Given.conservativeResize(this->Rows.Count(), Eigen::NoChange);
  this->Rows.Weights.conservativeResize(this->Rows.Count());
}

RepeatedValues::RepeatedValues(const ScatteredValues& given, const MergedValues& merged)
  : RepeatedValues(merged.Rows)
{
  if (merged.Repeated == 0)
  {
    return;
  }
  const Grouping groups(given);
  Index copied = 0;
  for (Index place = 0; place < this->Count(); ++place)
  {
    const Index begin = groups.Begin[static_cast<std::size_t>(place)];
    const Index end = groups.Begin[static_cast<std::size_t>(place) + 1];
    this->Repeats[place] = end - begin - 1.0;
    for (Index i = begin; i < end && end - begin > 1; ++i)
    {
      const Index row = groups.Order[i];
      this->Scatter.row(place) +=
        given.Weights[row] * (given.Given.row(row) - this->Given.row(place)).cwiseAbs2();
    }
    copied += end - begin > 1 && this->Scatter.row(place).isZero(0.0) ? 1 : 0;
  }
  if (copied > merged.Contradicting)
  {
    this->Repeats.array() *= (this->Scatter.rowwise().sum().array() > 0.0).cast<double>();
  }
}

} // namespace SurfaceDiffusion
