// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/Processes.h"
#include "Run/ProcessGroup.h"

#include <string>
#include <vector>

namespace SurfaceDiffusion
{

/// The processes of a vtkMultiProcessController, for a run.
class SharedProcessGroup : public ProcessGroup
{
public:
  explicit SharedProcessGroup(vtkMultiProcessController* controller)
    : Members(controller)
  {
  }

  bool IsShared() const override { return this->Members.Count() > 1; }
  bool IsRoot() const override { return this->Members.Rank() == 0; }
  std::vector<double> GatherAll(const std::vector<double>& mine) const override
  {
    return this->Members.GatherAll(mine);
  }
  std::string FirstMessage(const std::string& mine) const override
  {
    return this->Members.FirstMessage(mine);
  }
  const Processes& GetProcesses() const { return this->Members; }

private:
  const Processes Members;
};

} // namespace SurfaceDiffusion
