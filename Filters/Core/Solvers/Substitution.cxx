// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/Substitution.h"

#include "Core/Foundation/Columns.h"

#include <algorithm>

// A panel of columns is substituted with the widest vectors of the processor. Products and sums are
// rounded one by one (no fused operations), so that the bits do not depend on the processor.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__gnu_linux__)
#define SURFACEDIFFUSION_ANY_VECTORS                                                               \
  __attribute__((target_clones("avx512f", "avx2", "default"), optimize("fp-contract=off"), flatten))
#else
#define SURFACEDIFFUSION_ANY_VECTORS
#endif

namespace SurfaceDiffusion
{

namespace
{

/// Columns j .. j + Width - 1 of L, a panel of the factor.
template <int Width>
struct Panel
{
  Panel(const SparseFactor& l, Index j)
  {
    for (int a = 0; a < Width; ++a)
    {
      this->Below[a] = l.Entries + l.Begin[j + a] + (Width - 1 - a);
    }
    const Index last = j + Width - 1;
    this->Rows = l.Rows + l.Begin[last];
    this->Count = l.Begin[last + 1] - l.Begin[last];
  }
  /// The entry in row j + b of column j + a.
  double Within(int a, int b) const { return this->Below[a][b - Width]; }

  const double* Below[Width]; ///< per column, the entries in the rows below the panel
  const Index* Rows; ///< below the panel, the same for all columns
  Index Count; ///< of these rows
};

/// Call work(width) with the width of a panel as a number known to the compiler.
template <typename Work>
void ForWidth(Index width, const Work& work)
{
  ForNumber<SparseFactor::WidestPanel>(width,
    [&](auto number)
    {
      if constexpr (decltype(number)::value > 0)
      {
        work(number);
      }
    });
}

double* Row(double* w, Index i, int columns)
{
  return w + static_cast<std::ptrdiff_t>(i) * columns;
}

/// The part of W = L^-1 W that belongs to the columns j .. j + Width - 1 of L.
template <int K, int Width>
void Forward(const SparseFactor& factor, double* all, Index j, int columns)
{
  const ColumnCount<K> k(columns);
  const Panel<Width> panel(factor, j);
  double* w = Row(all, j, k);
  for (int a = 0; a < Width; ++a)
  {
    for (int b = a + 1; b < Width; ++b)
    {
      for (int c = 0; c < k; ++c)
      {
        w[b * k + c] -= panel.Within(a, b) * w[a * k + c];
      }
    }
  }
  ColumnRegisters<double, K, Width> registers;
  if (K > 0)
  {
    double* const fast = registers.Or(w);
    std::copy_n(w, Width * k, fast);
    w = fast;
  }
  for (Index s = 0; s < panel.Count; ++s)
  {
    double* wi = Row(all, panel.Rows[s], k);
    double l[Width];
    for (int a = 0; a < Width; ++a)
    {
      l[a] = panel.Below[a][s];
    }
    for (int c = 0; c < k; ++c)
    {
      double sum = wi[c];
      for (int a = 0; a < Width; ++a)
      {
        sum -= l[a] * w[a * k + c];
      }
      wi[c] = sum;
    }
  }
}

/// The rows j .. j + Width - 1 of W = L^-T D^-1 W.
template <int K, int Width>
void Backward(const SparseFactor& factor, double* all, Index j, int columns)
{
  const ColumnCount<K> k(columns);
  const Panel<Width> panel(factor, j);
  double* result = Row(all, j, k);
  ColumnRegisters<double, K, Width> registers;
  double* w = registers.Or(result);
  for (int a = 0; a < Width; ++a)
  {
    for (int c = 0; c < k; ++c)
    {
      w[a * k + c] = factor.InverseD[j + a] * result[a * k + c];
    }
  }
  for (Index s = 0; s < panel.Count; ++s)
  {
    const double* wi = Row(all, panel.Rows[s], k);
    for (int a = 0; a < Width; ++a)
    {
      const double l = panel.Below[a][s];
      for (int c = 0; c < k; ++c)
      {
        w[a * k + c] -= l * wi[c];
      }
    }
  }
  for (int a = Width - 1; a >= 0; --a)
  {
    for (int b = a + 1; b < Width; ++b)
    {
      for (int c = 0; c < k; ++c)
      {
        w[a * k + c] -= panel.Within(a, b) * w[b * k + c];
      }
    }
    for (int c = 0; c < k; ++c)
    {
      result[a * k + c] = w[a * k + c];
    }
  }
}

template <int K>
void Substitute(const SparseFactor& factor, double* w, int columns)
{
  const std::vector<Index>& panels = factor.Panels;
  for (std::size_t p = 0; p + 1 < panels.size(); ++p)
  {
    ForWidth(panels[p + 1] - panels[p],
      [&](auto width) { Forward<K, decltype(width)::value>(factor, w, panels[p], columns); });
  }
  for (std::size_t p = panels.size() - 1; p > 0; --p)
  {
    ForWidth(panels[p] - panels[p - 1],
      [&](auto width) { Backward<K, decltype(width)::value>(factor, w, panels[p - 1], columns); });
  }
}

SURFACEDIFFUSION_ANY_VECTORS void SubstituteColumnPanel(const SparseFactor& factor, double* w)
{
  Substitute<ColumnPanel>(factor, w, ColumnPanel);
}

} // namespace

template <int K>
void SubstituteRows(const SparseFactor& factor, double* w, int columns)
{
  if constexpr (K == ColumnPanel)
  {
    SubstituteColumnPanel(factor, w);
  }
  else
  {
    Substitute<K>(factor, w, columns);
  }
}

template void SubstituteRows<0>(const SparseFactor&, double*, int);
template void SubstituteRows<1>(const SparseFactor&, double*, int);
template void SubstituteRows<2>(const SparseFactor&, double*, int);
template void SubstituteRows<3>(const SparseFactor&, double*, int);
template void SubstituteRows<ColumnPanel>(const SparseFactor&, double*, int);

} // namespace SurfaceDiffusion
