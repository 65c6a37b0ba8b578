// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Columns.h"
#include "Core/Foundation/ProgressMonitor.h"

namespace SurfaceDiffusion
{

/// Call f(panel, progress) with the columns of u in panels of ColumnPanel, and put back what it makes of
/// each.
template <typename F>
void ForEachPanel(Values& u, const ProgressMonitor& progress, const F& f)
{
  const auto share = [&](Eigen::Index column)
  { return static_cast<double>(column) / static_cast<double>(u.cols()); };
  for (Eigen::Index first = 0; first < u.cols(); first += ColumnPanel)
  {
    const Eigen::Index count = std::min<Eigen::Index>(ColumnPanel, u.cols() - first);
    Values panel = u.middleCols(first, count);
    f(panel, progress.Part(share(first), share(first + count)));
    u.middleCols(first, count) = panel;
  }
}

} // namespace SurfaceDiffusion
