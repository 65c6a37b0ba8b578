// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"

#include <type_traits>

namespace SurfaceDiffusion
{

/// Call f(std::integral_constant<int, N>()) with N = number if 1 <= number <= Most, and with N = 0
/// otherwise: loops over N numbers that the compiler knows keep them in registers.
template <int Most, typename F>
decltype(auto) ForNumber(Eigen::Index number, const F& f)
{
  if constexpr (Most == 0)
  {
    return f(std::integral_constant<int, 0>());
  }
  else
  {
    if (number == Most)
    {
      return f(std::integral_constant<int, Most>());
    }
    return ForNumber<Most - 1>(number, f);
  }
}

/// Many columns are processed in panels of this number: a row of a panel is one line of the cache.
constexpr int ColumnPanel = 8;

/// The same for the columns of point data: one, two, three and a panel are known to the compiler,
/// and the template argument 0 stands for any number of them.
template <typename F>
decltype(auto) ForColumns(Eigen::Index columns, const F& f)
{
  if (columns == ColumnPanel)
  {
    return f(std::integral_constant<int, ColumnPanel>());
  }
  return ForNumber<3>(columns, f);
}

/// The number of columns in a template over them: K, or any number if K is 0. A type, so that K is
/// known to the compiler in lambdas too, which ParallelFor calls through a pointer.
template <int K>
struct ColumnCount
{
  explicit ColumnCount(Eigen::Index /*columns*/) {}
  constexpr operator int() const { return K; } // NOLINT(google-explicit-constructor)
};
template <>
struct ColumnCount<0>
{
  explicit ColumnCount(Eigen::Index columns)
    : Columns(static_cast<int>(columns))
  {
  }
  operator int() const { return this->Columns; } // NOLINT(google-explicit-constructor)

  int Columns;
};

/// Room in registers for Rows x K numbers. For any number of columns (K = 0) the numbers stay in
/// memory.
template <typename Number, int K, int Rows = 1>
class ColumnRegisters
{
public:
  /// The registers, or `memory` if K is 0.
  Number* Or(Number* memory) { return K > 0 ? this->Numbers : memory; }

private:
  Number Numbers[K > 0 ? Rows* K : 1];
};

} // namespace SurfaceDiffusion
