// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <random>

namespace FilterTest
{

/// Random choices that are the same on every platform for the same seed.
class Dice
{
public:
  explicit Dice(unsigned int seed)
    : Random(seed)
  {
  }
  int Below(int limit) { return static_cast<int>(this->Random() % limit); }
  bool Flip(int oneIn = 2) { return this->Below(oneIn) == 0; }
  double Unit() { return this->Random() / 4294967296.0; }
  /// A positive number, all orders of magnitude in the range alike.
  double Logarithmic(double low, double high) { return low * std::pow(high / low, this->Unit()); }

private:
  std::mt19937 Random;
};

} // namespace FilterTest
