// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkMultiProcessController.h"

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <iterator>
#include <map>
#include <vector>

namespace SurfaceDiffusion
{

/// The processes of a vtkMultiProcessController; without a controller, this process alone. All
/// calls but Rank(), Count(), Controller() and Exchange() are collective.
class Processes
{
public:
  explicit Processes(vtkMultiProcessController* controller)
    : Shared(controller && controller->GetNumberOfProcesses() > 1 ? controller : nullptr)
  {
  }

  int Count() const { return this->Shared ? this->Shared->GetNumberOfProcesses() : 1; }
  int Rank() const { return this->Shared ? this->Shared->GetLocalProcessId() : 0; }
  /// Null if there is one process.
  vtkMultiProcessController* Controller() const { return this->Shared; }

  /// The values of all processes, ordered by rank, in every process. T is a type that
  /// vtkMultiProcessController sends: char, int, vtkIdType, double.
  template <typename T>
  std::vector<T> GatherAll(const std::vector<T>& here) const
  {
    std::vector<vtkIdType> lengths = this->GatherLengths(here.size());
    return this->GatherAll(here, lengths);
  }
  template <typename T>
  std::vector<T> GatherAll(std::initializer_list<T> here) const
  {
    return this->GatherAll(std::vector<T>(here));
  }

  /// The same with a vector per process.
  template <typename T>
  std::vector<std::vector<T>> GatherPerProcess(const std::vector<T>& here) const
  {
    std::vector<vtkIdType> lengths = this->GatherLengths(here.size());
    const std::vector<T> all = this->GatherAll(here, lengths);
    std::vector<std::vector<T>> perProcess;
    auto begin = all.begin();
    for (const vtkIdType length : lengths)
    {
      perProcess.emplace_back(begin, begin + length);
      begin += length;
    }
    return perProcess;
  }

  /// Messages between this process and each of the partners, which are ascending and name this
  /// process too: send(other) to it, receive(other) from it. All send down, to lower ranks, before
  /// they receive from higher ones, and then up. So no message waits for those of other pairs, as
  /// long as MPI buffers it. One that MPI holds back until its receiver is ready waits for messages
  /// to lower ranks only on the way down and to higher ones only on the way up, so that no
  /// processes wait for each other.
  template <typename Send, typename Receive>
  void ForEachPartner(
    const std::vector<int>& partners, const Send& send, const Receive& receive) const
  {
    const auto higher = std::lower_bound(partners.begin(), partners.end(), this->Rank());
    std::for_each(partners.begin(), higher, send);
    std::for_each(higher, partners.end(), receive);
    const auto lower = std::make_reverse_iterator(higher);
    std::for_each(partners.rbegin(), lower, send);
    std::for_each(lower, partners.rend(), receive);
  }

  /// Exchanges a vector with each of the partners, see ForEachPartner(): those that they sent, by
  /// partner.
  template <typename T>
  std::map<int, std::vector<T>> Exchange(
    const std::vector<int>& partners, const std::map<int, std::vector<T>>& sent) const
  {
    constexpr int tag = 7404;
    std::map<int, std::vector<T>> received;
    const auto send = [&](int other)
    {
      const auto found = sent.find(other);
      const vtkIdType length =
        found == sent.end() ? 0 : static_cast<vtkIdType>(found->second.size());
      this->Shared->Send(&length, 1, other, tag);
      if (length > 0)
      {
        this->Shared->Send(found->second.data(), length, other, tag);
      }
    };
    const auto receive = [&](int other)
    {
      vtkIdType length = 0;
      this->Shared->Receive(&length, 1, other, tag);
      std::vector<T>& there = received[other];
      there.resize(static_cast<std::size_t>(length));
      if (length > 0)
      {
        this->Shared->Receive(there.data(), length, other, tag);
      }
    };
    this->ForEachPartner(partners, send, receive);
    return received;
  }

  /// True if it is true in one of the processes.
  bool Any(bool here) const
  {
    const int mine = here ? 1 : 0;
    int any = mine;
    if (this->Shared)
    {
      this->Shared->AllReduce(&mine, &any, 1, vtkCommunicator::MAX_OP);
    }
    return any != 0;
  }

  /// Every process gets the values of process 0.
  void Broadcast(double* values, vtkIdType count) const
  {
    if (this->Shared)
    {
      this->Shared->Broadcast(values, count, 0);
    }
  }

private:
  std::vector<vtkIdType> GatherLengths(std::size_t here) const
  {
    const auto length = static_cast<vtkIdType>(here);
    std::vector<vtkIdType> lengths(this->Count(), length);
    if (this->Shared)
    {
      this->Shared->AllGather(&length, lengths.data(), 1);
    }
    return lengths;
  }

  template <typename T>
  std::vector<T> GatherAll(const std::vector<T>& here, std::vector<vtkIdType>& lengths) const
  {
    if (!this->Shared)
    {
      return here;
    }
    std::vector<vtkIdType> offsets;
    vtkIdType sum = 0;
    for (const vtkIdType length : lengths)
    {
      offsets.push_back(sum);
      sum += length;
    }
    std::vector<T> all(static_cast<std::size_t>(sum));
    if (sum > 0)
    {
      this->Shared->AllGatherV(here.data(), all.data(), static_cast<vtkIdType>(here.size()),
        lengths.data(), offsets.data());
    }
    return all;
  }

  vtkMultiProcessController* Shared;
};

} // namespace SurfaceDiffusion
