// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkMultiProcessController.h"

#include <cstddef>
#include <string>
#include <vector>

namespace SurfaceDiffusion
{

/// The processes that share a surface; without a controller it is this one alone. All calls but
/// Rank() and Count() are collective.
class Processes
{
public:
  explicit Processes(vtkMultiProcessController* controller)
    : Shared(controller && controller->GetNumberOfProcesses() > 1 ? controller : nullptr)
  {
  }

  int Count() const { return this->Shared ? this->Shared->GetNumberOfProcesses() : 1; }
  int Rank() const { return this->Shared ? this->Shared->GetLocalProcessId() : 0; }
  /// Null where there is one process.
  vtkMultiProcessController* Controller() const { return this->Shared; }

  /// Everybody's numbers, one process after the other.
  std::vector<double> GatherAll(const std::vector<double>& mine) const
  {
    if (!this->Shared)
    {
      return mine;
    }
    const auto length = static_cast<vtkIdType>(mine.size());
    std::vector<vtkIdType> lengths(this->Count()), offsets(this->Count());
    this->Shared->AllGather(&length, lengths.data(), 1);
    vtkIdType sum = 0;
    for (int p = 0; p < this->Count(); ++p)
    {
      offsets[p] = sum;
      sum += lengths[p];
    }
    std::vector<double> all(static_cast<std::size_t>(sum));
    this->Shared->AllGatherV(mine.data(), all.data(), length, lengths.data(), offsets.data());
    return all;
  }

  /// Whether it holds in one of the processes.
  bool Any(bool mine) const
  {
    int any = mine ? 1 : 0;
    if (this->Shared)
    {
      const int here = any;
      this->Shared->AllReduce(&here, &any, 1, vtkCommunicator::MAX_OP);
    }
    return any != 0;
  }

  /// The first message that is not empty, for everybody.
  std::string FirstMessage(const std::string& mine) const
  {
    if (!this->Any(!mine.empty()))
    {
      return std::string();
    }
    std::vector<double> letters(mine.begin(), mine.end());
    letters.push_back(0.0); // ends it
    std::string first;
    for (const double letter : this->GatherAll(letters))
    {
      if (letter != 0.0)
      {
        first += static_cast<char>(letter);
      }
      else if (!first.empty())
      {
        break;
      }
    }
    return first;
  }

  void Broadcast(double* values, vtkIdType count) const
  {
    if (this->Shared)
    {
      this->Shared->Broadcast(values, count, 0);
    }
  }

private:
  vtkMultiProcessController* Shared;
};

} // namespace SurfaceDiffusion
