// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Foundation/Partition.h"

namespace SurfaceDiffusion
{

void SumComponents(const Partition* partition, const std::vector<Index>& component, Values& sums)
{
  if (!partition)
  {
    return;
  }
  const std::vector<Index>& whole = partition->WholeComponent();
  Values all = Values::Zero(partition->NumberOfComponents(), sums.cols());
  for (std::size_t r = 0; r < component.size(); ++r)
  {
    all.row(whole[component[r]]) += sums.row(static_cast<Eigen::Index>(r));
  }
  partition->Sum(all.data(), static_cast<Index>(all.size()));
  for (std::size_t r = 0; r < component.size(); ++r)
  {
    sums.row(static_cast<Eigen::Index>(r)) = all.row(whole[component[r]]);
  }
}

} // namespace SurfaceDiffusion
