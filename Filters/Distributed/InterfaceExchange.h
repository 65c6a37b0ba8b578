// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"
#include "Distributed/Processes.h"

#include <map>
#include <set>
#include <vector>

namespace SurfaceDiffusion
{

/// Exchanges rows of numbers with other processes: `sent` and `received` list items by the other
/// process, which lists the same ones in the same order. The process sends `columns` numbers for
/// every item in `sent`, which read(item, numbers) fills in, and gives those it gets for the items
/// in `received` to write(item, numbers). Collective.
template <typename Item, typename Read, typename Write>
void ExchangeRows(const Processes& processes, const std::map<int, std::vector<Item>>& sent,
  const std::map<int, std::vector<Item>>& received, std::size_t columns, const Read& read,
  const Write& write)
{
  constexpr int tag = 7403;
  static const std::vector<Item> none;
  const auto itemsOf = [](const std::map<int, std::vector<Item>>& items,
                         int process) -> const std::vector<Item>&
  {
    const auto found = items.find(process);
    return found == items.end() ? none : found->second;
  };
  std::set<int> partners;
  for (const auto* items : { &sent, &received })
  {
    for (const auto& entry : *items)
    {
      partners.insert(entry.first);
    }
  }
  std::vector<double> numbers;
  const auto send = [&](int other)
  {
    const std::vector<Item>& items = itemsOf(sent, other);
    numbers.resize(items.size() * columns);
    for (std::size_t i = 0; i < items.size(); ++i)
    {
      read(items[i], numbers.data() + i * columns);
    }
    if (!numbers.empty())
    {
      processes.Controller()->Send(
        numbers.data(), static_cast<vtkIdType>(numbers.size()), other, tag);
    }
  };
  const auto receive = [&](int other)
  {
    const std::vector<Item>& items = itemsOf(received, other);
    numbers.resize(items.size() * columns);
    if (!numbers.empty())
    {
      processes.Controller()->Receive(
        numbers.data(), static_cast<vtkIdType>(numbers.size()), other, tag);
    }
    for (std::size_t i = 0; i < items.size(); ++i)
    {
      write(items[i], numbers.data() + i * columns);
    }
  };
  processes.ForEachPartner({ partners.begin(), partners.end() }, send, receive);
}

/// The vertices or edges of a process that other processes have too, and the exchange of rows of
/// numbers, one row per item. The process of lowest rank that has an item owns it.
class InterfaceExchange
{
public:
  explicit InterfaceExchange(const Processes& processes)
    : Members(processes)
  {
  }

  /// holders: the processes that have the item, ascending. Items are added in an order that all
  /// processes agree on. Returns whether this process owns the item.
  bool Add(Index item, const std::vector<int>& holders);

  /// Other processes get the rows of the owners.
  void Update(double* rows, Index columns) const;

  /// Each row becomes the sum over the processes. Owners add the rows of the others, ordered by
  /// rank, and send the sums back.
  void Accumulate(double* rows, Index columns) const;

  /// Of other items: coarse[item] is the one that the item is a part of, or negative if it is a
  /// part of none, for all processes alike.
  InterfaceExchange Coarsened(const std::vector<Index>& coarse) const;

private:
  Processes Members;
  /// By the other process: those that this process owns and the other has too, and those that the
  /// other owns. Both processes list them in the same order.
  std::map<int, std::vector<Index>> Owned, Foreign;
};

} // namespace SurfaceDiffusion
