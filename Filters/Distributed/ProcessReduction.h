// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Reduction.h"
#include "Distributed/Processes.h"

#include <algorithm>
#include <vector>

namespace SurfaceDiffusion
{

/// The processes of a run that work together, apart from any surface: it has no vertices. Sums are
/// taken in the order of the processes.
class ProcessReduction : public Reduction
{
public:
  /// controller: of several processes.
  explicit ProcessReduction(vtkMultiProcessController* controller)
    : Reduction(Reduction::Kind::Distributed)
    , Members(controller)
  {
  }

  using Reduction::Sum;
  void Sum(double* numbers, Index count) const override
  {
    this->Combine(numbers, count, [](double a, double b) { return a + b; });
  }
  void Max(double* numbers, Index count) const override
  {
    this->Combine(numbers, count, [](double a, double b) { return std::max(a, b); });
  }
  int Rank() const override { return this->Members.Rank(); }
  std::vector<double> Gather(const std::vector<double>& here) const override
  {
    return this->Members.GatherAll(here);
  }

private:
  template <typename F>
  void Combine(double* numbers, Index count, const F& f) const
  {
    const std::vector<double> all =
      this->Members.GatherAll(std::vector<double>(numbers, numbers + count));
    std::copy_n(all.begin(), count, numbers);
    for (std::size_t i = static_cast<std::size_t>(count); i < all.size(); ++i)
    {
      double& number = numbers[i % static_cast<std::size_t>(count)];
      number = f(number, all[i]);
    }
  }

  const Processes Members;
};

} // namespace SurfaceDiffusion
