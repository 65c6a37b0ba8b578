// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

namespace SurfaceDiffusion
{

constexpr const char* OutOfMemoryMessage = "not enough memory";

/// The processes that compute one run together. This base class is a single process. All calls but
/// IsShared() and IsRoot() are collective.
class ProcessGroup
{
public:
  virtual ~ProcessGroup() = default;

  virtual bool IsShared() const { return false; }
  /// Whether this process reports for all of them.
  virtual bool IsRoot() const { return true; }
  /// The numbers of all processes, in the order of processes.
  virtual std::vector<double> GatherAll(const std::vector<double>& mine) const { return mine; }
  /// The first message that is not empty.
  virtual std::string FirstMessage(const std::string& mine) const { return mine; }

  bool Any(bool here) const
  {
    if (!this->IsShared())
    {
      return here;
    }
    for (const double other : this->GatherAll({ here ? 1.0 : 0.0 }))
    {
      here = here || other != 0.0;
    }
    return here;
  }

  double Sum(double here) const
  {
    double sum = 0.0;
    for (const double other : this->GatherAll({ here }))
    {
      sum += other;
    }
    return sum;
  }

  /// Do work that calls no other process. If it throws in one process, it throws in all of them.
  template <typename Work>
  void RunCollectively(const Work& work) const
  {
    if (!this->IsShared())
    {
      work();
      return;
    }
    std::string failure;
    try
    {
      work();
    }
    catch (const std::bad_alloc&)
    {
      failure = OutOfMemoryMessage;
    }
    catch (const std::exception& error)
    {
      failure = error.what();
    }
    failure = this->FirstMessage(failure);
    if (!failure.empty())
    {
      throw std::runtime_error(failure);
    }
  }
};

} // namespace SurfaceDiffusion
