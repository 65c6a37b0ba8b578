// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/SupernodalFactor.h"

#include <Eigen/Dense>

#include <algorithm>
#include <numeric>

namespace SurfaceDiffusion
{

namespace
{

/// A matrix in tiles of its rows.
std::vector<double> ToTiles(const Eigen::Ref<const Eigen::MatrixXd>& matrix)
{
  const auto rows = static_cast<Index>(matrix.rows());
  const std::ptrdiff_t tile = TileRows * static_cast<std::ptrdiff_t>(matrix.cols());
  std::vector<double> tiles(static_cast<std::size_t>(NumberOfTiles(rows) * tile), 0.0);
  for (Eigen::Index p = 0; p < matrix.cols(); ++p)
  {
    for (Index i = 0; i < rows; ++i)
    {
      tiles[static_cast<std::size_t>(i / TileRows * tile + p * TileRows + i % TileRows)] =
        matrix(i, p);
    }
  }
  return tiles;
}

/// c - a b^T.
void SubtractProduct(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, Eigen::MatrixXd& c,
  const ParallelFor& parallel)
{
  const auto depth = static_cast<Index>(a.cols());
  const auto columns = static_cast<Index>(c.cols());
  const std::vector<double> left = ToTiles(a);
  const std::vector<double> right = ToTiles(b);
  std::vector<double> result = ToTiles(c);
  const std::ptrdiff_t tile = static_cast<std::ptrdiff_t>(TileRows) * depth;
  const std::ptrdiff_t to = static_cast<std::ptrdiff_t>(TileRows) * columns;
  const double* const leftTiles = left.data();
  const double* const rightTiles = right.data();
  double* const resultTiles = result.data();
  const auto multiply = [&](Index i)
  {
    for (Index j = 0; j < columns; j += TileRows)
    {
      SubtractTileProducts(leftTiles + i * tile, 0, rightTiles + j / TileRows * tile, depth,
        resultTiles + i * to + j * TileRows, 0, 1, columns - j);
    }
  };
  const Index tiles = NumberOfTiles(static_cast<Index>(c.rows()));
  constexpr double few = 1e6;
  const bool isLarge = static_cast<double>(c.size()) * depth > few;
  ForEachTask(isLarge ? parallel : SerialFor(), tiles, multiply);
  for (Eigen::Index j = 0; j < c.cols(); ++j)
  {
    for (Index i = 0; i < static_cast<Index>(c.rows()); ++i)
    {
      c(i, j) = result[static_cast<std::size_t>(i / TileRows * to + j * TileRows + i % TileRows)];
    }
  }
}

} // namespace

Vector SupernodalFactor::InverseDiagonal(const ParallelFor& parallel,
  const ProgressMonitor& progress, std::vector<InverseEntry>* others) const
{
  const Supernodes& nodes = this->Nodes;
  const Index count = nodes.Count();
  std::vector<std::vector<InverseEntry*>> othersOf(static_cast<std::size_t>(others ? count : 0));
  for (std::size_t e = 0; others && e < others->size(); ++e)
  {
    InverseEntry& entry = (*others)[e];
    const Index earlier = std::min(nodes.Place[entry.Row], nodes.Place[entry.Column]);
    const auto after = std::upper_bound(nodes.First.begin(), nodes.First.begin() + count, earlier);
    othersOf[static_cast<std::size_t>(after - nodes.First.begin()) - 1].push_back(&entry);
  }
  std::vector<Eigen::MatrixXd> inverse(count); // in the rows of a supernode: pivots, rows below
  Vector diagonal(static_cast<Eigen::Index>(nodes.Place.size()));
  double done = 0.0;
  const double operations = std::accumulate(nodes.Operations.begin(), nodes.Operations.end(), 0.0);
  constexpr Index often = 64; // supernodes
  for (Index s = count - 1; s >= 0; --s)
  {
    if (s % often == 0 || nodes.Operations[s] > operations / often)
    {
      progress.Report(std::min(1.0, done / operations));
    }
    done += nodes.Operations[s];
    const Index k = nodes.Pivots(s);
    const Index r = nodes.RowsBelow(s);
    const Index first = nodes.First[s];
    const std::ptrdiff_t tile = static_cast<std::ptrdiff_t>(TileRows) * k;
    const double* const panel = this->Panel(s);
    const auto entry = [&](Index tileOfRow, Index row, Index column)
    { return panel[(tileOfRow + row / TileRows) * tile + column * TileRows + row % TileRows]; };
    Eigen::MatrixXd l(k, k);
    Eigen::MatrixXd lBelow(r, k);
    for (Index p = 0; p < k; ++p)
    {
      for (Index i = 0; i < k; ++i)
      {
        l(i, p) = i >= p ? entry(0, i, p) : 0.0;
      }
      for (Index i = 0; i < r; ++i)
      {
        lBelow(i, p) = entry(this->DiagonalTiles(s), i, p);
      }
    }
    // With Y = L_B L^-1 of the rows B below: Z_B = -Z_BB Y and Z = (L L^T)^-1 - Y^T Z_B.
    Eigen::MatrixXd all(k + r, k + r);
    const Eigen::MatrixXd half =
      l.triangularView<Eigen::Lower>().solve(Eigen::MatrixXd::Identity(k, k));
    Eigen::MatrixXd own = Eigen::MatrixXd::Zero(k, k);
    const Eigen::MatrixXd halfTransposed = half.transpose();
    SubtractProduct(halfTransposed, halfTransposed, own, parallel);
    own = -own;
    if (r > 0)
    {
      const Index parent = nodes.Parent[s];
      const Index parentFirst = nodes.First[parent];
      const Index parentPivots = nodes.Pivots(parent);
      const Index* const rows = nodes.Below(s);
      const Index* const parentRows = nodes.Below(parent);
      std::vector<Index> place(r);
      for (Index i = 0, at = 0; i < r; ++i)
      {
        if (rows[i] < parentFirst + parentPivots)
        {
          place[i] = rows[i] - parentFirst;
          continue;
        }
        while (parentRows[at] < rows[i])
        {
          ++at;
        }
        place[i] = parentPivots + at;
      }
      const Eigen::MatrixXd& known = inverse[parent];
      Eigen::MatrixXd below(r, r);
      for (Index j = 0; j < r; ++j)
      {
        for (Index i = 0; i < r; ++i)
        {
          below(i, j) = known(place[i], place[j]);
        }
      }
      Eigen::MatrixXd y = Eigen::MatrixXd::Zero(r, k);
      SubtractProduct(lBelow, halfTransposed, y, parallel);
      y = -y;
      const Eigen::MatrixXd yTransposed = y.transpose();
      Eigen::MatrixXd beside = Eigen::MatrixXd::Zero(r, k);
      SubtractProduct(below, yTransposed, beside, parallel);
      const Eigen::MatrixXd besideTransposed = beside.transpose();
      SubtractProduct(yTransposed, besideTransposed, own, parallel);
      all.bottomRightCorner(r, r) = below;
      all.bottomLeftCorner(r, k) = beside;
      all.topRightCorner(k, r) = besideTransposed;
      if (nodes.ChildrenBegin[parent] < nodes.ChildrenBegin[parent + 1] &&
        nodes.Children[nodes.ChildrenBegin[parent]] == s)
      {
        inverse[parent].resize(0, 0); // its first child is the last one that reads it
      }
    }
    all.topLeftCorner(k, k) = own;
    for (Index p = 0; p < k; ++p)
    {
      diagonal[nodes.RowAt[first + p]] = own(p, p);
    }
    const auto inRows = [&](Index row) -> Index
    {
      const Index at = nodes.Place[row];
      return at < first + k ? at - first
                            : k +
          static_cast<Index>(
            std::lower_bound(nodes.Below(s), nodes.Below(s) + r, at) - nodes.Below(s));
    };
    for (std::size_t e = 0; others && e < othersOf[s].size(); ++e)
    {
      InverseEntry& other = *othersOf[s][e];
      other.Value = all(inRows(other.Row), inRows(other.Column));
    }
    if (nodes.ChildrenBegin[s] < nodes.ChildrenBegin[s + 1])
    {
      inverse[s] = std::move(all);
    }
  }
  return diagonal;
}

} // namespace SurfaceDiffusion
