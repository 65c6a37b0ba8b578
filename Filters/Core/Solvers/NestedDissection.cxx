// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/NestedDissection.h"

#include <Eigen/OrderingMethods>

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>

namespace SurfaceDiffusion
{

namespace
{

constexpr Index LargestLeaf = 200; // rows that minimum degree orders
constexpr double SmallestSide = 0.3; // of a part, beside its separator

class Dissection
{
public:
  explicit Dissection(const SparseMatrix& matrix)
    : Outer(matrix.outerIndexPtr())
    , Inner(matrix.innerIndexPtr())
    , Order(matrix.rows())
    , Label(matrix.rows(), 0)
    , Mark(matrix.rows(), -1)
  {
    std::iota(this->Order.begin(), this->Order.end(), 0);
    this->Parts.push_back({ 0, static_cast<Index>(matrix.rows()) });
    while (!this->Parts.empty())
    {
      const Part part = this->Parts.back();
      this->Parts.pop_back();
      this->Dissect(part);
    }
  }

  std::vector<Index> Places() const
  {
    std::vector<Index> places(this->Order.size());
    for (std::size_t k = 0; k < places.size(); ++k)
    {
      places[this->Order[k]] = static_cast<Index>(k);
    }
    return places;
  }

private:
  /// Rows Order[Begin] .. Order[End - 1], which end at these places.
  struct Part
  {
    Index Begin, End;
    Index Size() const { return this->End - this->Begin; }
  };

  void Dissect(const Part& part)
  {
    if (part.Size() <= LargestLeaf)
    {
      this->OrderByDegree(part);
      return;
    }
    const Index label = ++this->LastLabel;
    for (Index k = part.Begin; k < part.End; ++k)
    {
      this->Label[this->Order[k]] = label;
    }
    this->FindLevels(this->Order[part.Begin], label);
    if (static_cast<Index>(this->Found.size()) < part.Size())
    {
      this->SplitComponents(part, label);
      return;
    }
    this->FindLevels(this->Found.back(), label);
    const std::optional<std::size_t> level = this->ChooseLevel();
    if (!level)
    {
      this->OrderByDegree(part);
      return;
    }
    this->Separate(part, *level, label);
  }

  /// Found: all rows that are connected to `start` by rows of the label, level by level.
  void FindLevels(Index start, Index label)
  {
    this->Found.assign(1, start);
    this->LevelBegin.assign(1, 0);
    this->Label[start] = -label; // found
    for (std::size_t next = 0; next < this->Found.size();)
    {
      const std::size_t end = this->Found.size();
      this->LevelBegin.push_back(static_cast<Index>(end));
      for (; next < end; ++next)
      {
        const Index i = this->Found[next];
        for (Index slot = this->Outer[i]; slot < this->Outer[i + 1]; ++slot)
        {
          const Index j = this->Inner[slot];
          if (this->Label[j] == label)
          {
            this->Label[j] = -label;
            this->Found.push_back(j);
          }
        }
      }
    }
    for (const Index i : this->Found)
    {
      this->Label[i] = label;
    }
  }

  /// Each connected component becomes a part.
  void SplitComponents(const Part& part, Index label)
  {
    const std::vector<Index> rows(this->Order.begin() + part.Begin, this->Order.begin() + part.End);
    Index begin = part.Begin;
    for (const Index start : rows)
    {
      if (this->Label[start] != label)
      {
        continue;
      }
      this->FindLevels(start, label);
      for (const Index i : this->Found)
      {
        this->Label[i] = 0;
      }
      const Index end = begin + static_cast<Index>(this->Found.size());
      std::sort(this->Found.begin(), this->Found.end()); // as OrderByDegree() needs them
      std::copy(this->Found.begin(), this->Found.end(), this->Order.begin() + begin);
      this->Parts.push_back({ begin, end });
      begin = end;
    }
  }

  /// The level with the fewest rows that leaves enough on both sides, or the one in the middle.
  /// None if there is nothing on one side.
  std::optional<std::size_t> ChooseLevel() const
  {
    const double count = static_cast<double>(this->Found.size());
    const std::size_t levels = this->LevelBegin.size() - 1;
    std::optional<std::size_t> best;
    std::size_t middle = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t level = 0; level < levels; ++level)
    {
      const double below = this->LevelBegin[level];
      const double above = count - this->LevelBegin[level + 1];
      middle = below <= 0.5 * count ? level : middle;
      const double side = std::min(below, above) / count;
      const double cost = (count - below - above) * (2.0 - 2.0 * side);
      if (side >= SmallestSide && cost < least)
      {
        least = cost;
        best = level;
      }
    }
    if (!best && middle > 0 && middle + 1 < levels)
    {
      best = middle;
    }
    return best;
  }

  /// Order the part: what is below the level, what is above it, and its rows that have both.
  void Separate(const Part& part, std::size_t level, Index label)
  {
    const auto begin = this->Found.begin() + this->LevelBegin[level];
    const auto end = this->Found.begin() + this->LevelBegin[level + 1];
    const auto above = static_cast<Index>(this->Found.end() - end);
    std::for_each(end, this->Found.end(), [&](Index i) { this->Label[i] = -label; });
    const auto separator = std::partition(begin, end,
      [&](Index i)
      {
        return std::none_of(this->Inner + this->Outer[i], this->Inner + this->Outer[i + 1],
          [&](Index j) { return this->Label[j] == -label; });
      });
    auto place = this->Order.begin() + part.Begin;
    // In the order of the numbering, in which neighbours are near to each other in memory.
    const auto take = [&](auto first, auto last)
    {
      std::sort(first, last);
      place = std::copy(first, last, place);
    };
    take(this->Found.begin(), separator);
    const Index middle = static_cast<Index>(place - this->Order.begin());
    take(end, this->Found.end());
    take(separator, end);
    this->Parts.push_back({ part.Begin, middle });
    this->Parts.push_back({ middle, middle + above });
  }

  void OrderByDegree(const Part& part)
  {
    const Index n = part.Size();
    const std::vector<Index> rows(this->Order.begin() + part.Begin, this->Order.begin() + part.End);
    for (Index k = 0; k < n; ++k)
    {
      this->Mark[rows[k]] = k;
    }
    SparseMatrix graph(n, n);
    std::vector<Index> inner;
    for (Index k = 0; k < n; ++k)
    {
      for (Index slot = this->Outer[rows[k]]; slot < this->Outer[rows[k] + 1]; ++slot)
      {
        const Index neighbour = this->Mark[this->Inner[slot]];
        if (neighbour >= 0)
        {
          inner.push_back(neighbour);
        }
      }
      graph.outerIndexPtr()[k + 1] = static_cast<Index>(inner.size());
    }
    for (const Index row : rows)
    {
      this->Mark[row] = -1;
    }
    graph.resizeNonZeros(static_cast<Index>(inner.size()));
    std::copy(inner.begin(), inner.end(), graph.innerIndexPtr());
    std::fill_n(graph.valuePtr(), inner.size(), 1.0);
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, Index> order;
    Eigen::AMDOrdering<Index>()(graph, order);
    for (Index k = 0; k < n; ++k)
    {
      this->Order[part.Begin + k] = rows[order.indices()[k]];
    }
  }

  const Index* const Outer;
  const Index* const Inner;
  std::vector<Index> Order;
  std::vector<Index> Label; ///< of the part that was looked at last; negative: found
  std::vector<Index> Mark; ///< number in a leaf
  std::vector<Part> Parts; ///< still to be dissected
  std::vector<Index> Found, LevelBegin;
  Index LastLabel = 0;
};

} // namespace

std::vector<Index> NestedDissection(const SparseMatrix& matrix)
{
  return Dissection(matrix).Places();
}

bool IsRegular(const SparseMatrix& matrix)
{
  constexpr double nearlyAll = 0.98;
  constexpr Index entries = 7;
  const Index* const outer = matrix.outerIndexPtr();
  Index regular = 0;
  for (Index i = 0; i < static_cast<Index>(matrix.rows()); ++i)
  {
    regular += outer[i + 1] - outer[i] == entries;
  }
  return regular >= nearlyAll * static_cast<double>(matrix.rows());
}

bool IsAroundHubs(const SparseMatrix& matrix, const Reduction& overProcesses)
{
  constexpr double most = 0.5;
  constexpr Index many = 64; // of entries; poles of spheres have more, but few neighbours in all
  const Index* const outer = matrix.outerIndexPtr();
  Flags isAtHub = Flags::Constant(matrix.rows(), false);
  for (Index i = 0; i < static_cast<Index>(matrix.rows()); ++i)
  {
    if (outer[i + 1] - outer[i] > many)
    {
      for (SparseMatrix::InnerIterator a(matrix, i); a; ++a)
      {
        isAtHub[a.index()] = true;
      }
    }
  }
  return overProcesses.Sum(static_cast<double>(isAtHub.count())) >
    most * overProcesses.Sum(static_cast<double>(matrix.rows()));
}

} // namespace SurfaceDiffusion
