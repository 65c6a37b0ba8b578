// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Interpolation/ScatteredValues.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// Vertices and coordinates in one order, without those that do not count.
std::array<std::pair<Index, double>, 3> Key(const SurfacePoint& place)
{
  std::array<std::pair<Index, double>, 3> key;
  for (std::size_t a = 0; a < 3; ++a)
  {
    const bool counts = place.Coordinates[a] != 0.0;
    key[a] = { counts ? place.Vertices[a] : -1, counts ? place.Coordinates[a] : 0.0 };
  }
  std::sort(key.begin(), key.end());
  return key;
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

MergedValues::MergedValues(const ScatteredValues& given)
{
  const Index count = given.Count();
  std::vector<std::array<std::pair<Index, double>, 3>> keys(count);
  std::transform(given.Places.begin(), given.Places.end(), keys.begin(), Key);
  std::vector<Index> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
    [&](Index a, Index b) { return keys[a] != keys[b] ? keys[a] < keys[b] : a < b; });
  this->Rows.Given.resize(count, given.Given.cols());
  this->Rows.Weights.resize(count);
  for (Index begin = 0, end = 0; begin < count; begin = end)
  {
    while (end < count && keys[order[end]] == keys[order[begin]])
    {
      ++end;
    }
    const auto row = static_cast<Eigen::Index>(this->Rows.Count());
    this->Rows.Places.push_back(given.Places[order[begin]]);
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

} // namespace SurfaceDiffusion
