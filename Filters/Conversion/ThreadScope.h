// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Conversion/SMPParallelFor.h"

#include "vtkSMPTools.h"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <string>
#include <thread>

namespace SurfaceDiffusion
{

/// The threads of an update, during the life of this object: at most `number`, or all if it is 0.
///
/// VTK and ParaView as Debian builds them start with the back end Sequential. Unless a user has
/// chosen it, the loops of an update run on threads of its own, which end with it. VTK's back end
/// is never changed: that is not thread safe, and other filters that run at the same time would
/// lose what they had stored per thread.
class ThreadScope
{
public:
  ThreadScope(int number, bool severalProcesses)
  {
    this->Team.Limit = number;
    if (number == 1)
    {
      this->Team.Own = 1;
    }
    else if (MayReplaceBackEnd())
    {
      // Several processes divide the processors among them already.
      this->Team.Own = severalProcesses && number == 0 ? 1 : NumberOfOwnThreads(number);
    }
  }

private:
  /// Whether the back end is Sequential and nobody has chosen it: it is VTK's default, the
  /// environment names no back end, and no update has found another one before.
  static bool MayReplaceBackEnd()
  {
    static std::atomic<bool> hasChanged{ false };
    const bool isDefault = VTK_SMP_DEFAULT_IMPLEMENTATION_SEQUENTIAL != 0;
    if (!isDefault || std::string(vtkSMPTools::GetBackend()) != "Sequential")
    {
      hasChanged = true;
    }
    return !hasChanged && !std::getenv("VTK_SMP_BACKEND_IN_USE");
  }

  /// vtkSMPTools::Initialize(), the maximum of LocalScope(), and VTK_SMP_MAX_THREADS limit these
  /// threads, too.
  static int NumberOfOwnThreads(int number)
  {
    int threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    const int desired =
      vtk::detail::smp::vtkSMPToolsAPI::GetInstance().GetInternalDesiredNumberOfThread();
    for (const int limit : { number, desired })
    {
      threads = limit > 0 ? std::min(threads, limit) : threads;
    }
    return threads;
  }

  SMPParallelFor::Team Team;
  const SMPParallelFor::TeamScope Scope{ this->Team };
};

} // namespace SurfaceDiffusion
