// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/InterfaceExchange.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <set>

namespace SurfaceDiffusion
{

bool InterfaceExchange::Add(Index item, const std::vector<int>& holders)
{
  const int owner = holders.front();
  if (owner != this->Members.Rank())
  {
    this->Foreign[owner].push_back(item);
    return false;
  }
  for (std::size_t h = 1; h < holders.size(); ++h)
  {
    this->Owned[holders[h]].push_back(item);
  }
  return true;
}

void InterfaceExchange::Update(double* rows, Index columns) const
{
  const auto row = [&](Index item) { return rows + static_cast<std::ptrdiff_t>(item) * columns; };
  ExchangeRows(
    this->Members, this->Owned, this->Foreign, columns,
    [&](Index item, double* numbers) { std::copy_n(row(item), columns, numbers); },
    [&](Index item, const double* numbers) { std::copy_n(numbers, columns, row(item)); });
}

void InterfaceExchange::Accumulate(double* rows, Index columns) const
{
  const auto row = [&](Index item) { return rows + static_cast<std::ptrdiff_t>(item) * columns; };
  ExchangeRows(
    this->Members, this->Foreign, this->Owned, columns,
    [&](Index item, double* numbers) { std::copy_n(row(item), columns, numbers); },
    [&](Index item, const double* numbers)
    { std::transform(numbers, numbers + columns, row(item), row(item), std::plus<double>()); });
  this->Update(rows, columns);
}

InterfaceExchange InterfaceExchange::Coarsened(const std::vector<Index>& coarse) const
{
  const auto coarsen = [&](const std::map<int, std::vector<Index>>& fine)
  {
    std::map<int, std::vector<Index>> result;
    for (const auto& [process, items] : fine)
    {
      std::set<Index> seen;
      for (const Index item : items)
      {
        if (coarse[item] >= 0 && seen.insert(coarse[item]).second)
        {
          result[process].push_back(coarse[item]);
        }
      }
    }
    return result;
  };
  InterfaceExchange result(this->Members);
  result.Owned = coarsen(this->Owned);
  result.Foreign = coarsen(this->Foreign);
  return result;
}

} // namespace SurfaceDiffusion
