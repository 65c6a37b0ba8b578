// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Conversion/SMPParallelFor.h"

#include "vtkSMPTools.h"

#include <cstdlib>
#include <mutex>
#include <string>

namespace SurfaceDiffusion
{

/// The threads of an update, during the life of this object: at most `number`, or all if it is 0.
///
/// VTK and ParaView as Debian builds them start with the back end Sequential. Unless a user chose it
/// in the environment, an update uses the threads of VTK's other back end, and the last of several
/// updates that run at the same time restores Sequential.
class ThreadScope
{
public:
  ThreadScope(int number, bool severalProcesses)
    : Limit(SMPParallelFor::LimitOfThisThread())
    , Before(this->Limit)
  {
    this->Limit = number;
    // Several processes divide the processors among them already.
    if (number != 1 && (number > 1 || !severalProcesses) && !std::getenv("VTK_SMP_BACKEND_IN_USE"))
    {
      const std::lock_guard<std::mutex> lock(Shared().Mutex);
      const bool sequential = std::string(vtkSMPTools::GetBackend()) == "Sequential";
      this->Threaded = Shared().Users > 0 || (sequential && vtkSMPTools::SetBackend("STDThread"));
      Shared().Users += this->Threaded ? 1 : 0;
    }
  }

  ~ThreadScope()
  {
    this->Limit = this->Before;
    if (this->Threaded)
    {
      const std::lock_guard<std::mutex> lock(Shared().Mutex);
      if (--Shared().Users == 0)
      {
        vtkSMPTools::SetBackend("Sequential");
      }
    }
  }

  ThreadScope(const ThreadScope&) = delete;
  ThreadScope& operator=(const ThreadScope&) = delete;

private:
  struct Updates
  {
    std::mutex Mutex;
    int Users = 0; ///< updates for which the back end was changed
  };
  static Updates& Shared()
  {
    static Updates updates;
    return updates;
  }

  int& Limit;
  const int Before;
  bool Threaded = false;
};

} // namespace SurfaceDiffusion
