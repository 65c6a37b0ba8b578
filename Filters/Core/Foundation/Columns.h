// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"

#include <algorithm>
#include <type_traits>

// A function with this attribute, and all that is inlined into it, is compiled for several widths
// of vectors, of which the widest is used. No operations are fused, so that all have the same bits.
// clang leaves functions out that only such functions call (22.1), and has one width.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__gnu_linux__) &&   \
  !defined(__SANITIZE_THREAD__) // it is not set up yet when the width is chosen
#define SURFACEDIFFUSION_ANY_VECTORS                                                               \
  __attribute__((target_clones("avx512f", "avx2", "default"), optimize("fp-contract=off"), flatten))
#else
#define SURFACEDIFFUSION_ANY_VECTORS
#endif

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

/// Many columns are processed in panels of this number. A wider panel shares each pass over a
/// matrix or a factor among more columns, but its rows stay in the cache for a shorter time.
constexpr int ColumnPanel = 16;
constexpr int HalfPanel = ColumnPanel / 2;

/// The same for the columns of point data: one, two, three, half a panel and a panel are known to
/// the compiler, and the template argument 0 stands for any number of them.
template <typename F>
decltype(auto) ForColumns(Eigen::Index columns, const F& f)
{
  if (columns == ColumnPanel)
  {
    return f(std::integral_constant<int, ColumnPanel>());
  }
  if (columns == HalfPanel)
  {
    return f(std::integral_constant<int, HalfPanel>());
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

/// Copy K numbers, or `count` of them if K is 0. The compiler need not know that the arrays are
/// apart.
template <int K>
void CopyColumns(const double* from, double* to, int count)
{
  if (K == 0)
  {
    std::copy_n(from, count, to);
    return;
  }
  double numbers[K > 0 ? K : 1]; // std::copy_n is a call here
  for (int k = 0; k < K; ++k)
  {
    numbers[k] = from[k];
  }
  for (int k = 0; k < K; ++k)
  {
    to[k] = numbers[k];
  }
}

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
