// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/Substitution.h"

#include "Core/Foundation/Columns.h"

#include <algorithm>

namespace SurfaceDiffusion
{

namespace
{

/// A panel of L; see FactorPanels.
template <int Width>
struct Panel
{
  Panel(const FactorPanels& l, Index number)
    : First(l.FirstColumn(number))
    , Within(l.EntriesOf(number))
    , Below(this->Within + Width * (Width - 1) / 2)
    , Rows(l.RowsOf(number))
    , Count(l.NumberOfRows(number))
  {
  }
  /// The entry in row First + b of column First + a, a < b.
  double At(int b, int a) const { return this->Within[b * (b - 1) / 2 + a]; }

  const Index First; ///< column
  const double* Within; ///< the entries in the panel's own rows
  const double* Below; ///< those in the rows below
  const Index* Rows; ///< below the panel
  Index Count; ///< of these rows
};

/// Call work(width) with the width of a panel as a number known to the compiler.
template <typename Work>
void ForWidth(Index width, const Work& work)
{
  ForNumber<FactorPanels::Widest>(width,
    [&](auto number)
    {
      if constexpr (decltype(number)::value > 0)
      {
        work(number);
      }
    });
}

template <int K>
double* PlaceOfRow(double* w, Index i)
{
  return w + static_cast<std::ptrdiff_t>(i) * K;
}

/// The part of W = L^-1 W that belongs to a panel of L.
template <int K, int Width>
void Forward(const SparseFactor& factor, double* all, Index number)
{
  const Panel<Width> panel(factor.L, number);
  double* const result = PlaceOfRow<K>(all, panel.First);
  double w[Width * K];
  for (int c = 0; c < Width * K; ++c)
  {
    w[c] = result[c];
  }
  for (int b = 1; b < Width; ++b)
  {
    for (int a = 0; a < b; ++a)
    {
      const double l = panel.At(b, a);
      for (int c = 0; c < K; ++c)
      {
        w[b * K + c] -= l * w[a * K + c];
      }
    }
  }
  if (Width > 1)
  {
    for (int c = 0; c < Width * K; ++c)
    {
      result[c] = w[c];
    }
  }
  for (Index s = 0; s < panel.Count; ++s)
  {
    double* const wi = PlaceOfRow<K>(all, panel.Rows[s]);
    double l[Width];
    for (int a = 0; a < Width; ++a)
    {
      l[a] = panel.Below[static_cast<std::ptrdiff_t>(s) * Width + a];
    }
    for (int c = 0; c < K; ++c)
    {
      double sum = wi[c];
      for (int a = 0; a < Width; ++a)
      {
        sum -= l[a] * w[a * K + c];
      }
      wi[c] = sum;
    }
  }
}

/// The rows of W = L^-T D^-1 W that are the columns of a panel of L.
template <int K, int Width>
void Backward(const SparseFactor& factor, double* all, Index number)
{
  const Panel<Width> panel(factor.L, number);
  double* const result = PlaceOfRow<K>(all, panel.First);
  double w[Width * K];
  for (int a = 0; a < Width; ++a)
  {
    for (int c = 0; c < K; ++c)
    {
      w[a * K + c] = factor.InverseD[panel.First + a] * result[a * K + c];
    }
  }
  for (Index s = 0; s < panel.Count; ++s)
  {
    const double* const wi = PlaceOfRow<K>(all, panel.Rows[s]);
    for (int a = 0; a < Width; ++a)
    {
      const double l = panel.Below[static_cast<std::ptrdiff_t>(s) * Width + a];
      for (int c = 0; c < K; ++c)
      {
        w[a * K + c] -= l * wi[c];
      }
    }
  }
  for (int a = Width - 1; a >= 0; --a)
  {
    for (int b = a + 1; b < Width; ++b)
    {
      const double l = panel.At(b, a);
      for (int c = 0; c < K; ++c)
      {
        w[a * K + c] -= l * w[b * K + c];
      }
    }
  }
  for (int c = 0; c < Width * K; ++c)
  {
    result[c] = w[c];
  }
}

template <int K>
void Substitute(const SparseFactor& factor, double* w)
{
  for (Index p = 0; p < factor.L.Count(); ++p)
  {
    ForWidth(
      factor.L.Width(p), [&](auto width) { Forward<K, decltype(width)::value>(factor, w, p); });
  }
  for (Index p = factor.L.Count() - 1; p >= 0; --p)
  {
    ForWidth(
      factor.L.Width(p), [&](auto width) { Backward<K, decltype(width)::value>(factor, w, p); });
  }
}

// An attribute of a template is not portable: a function for each number of columns.
SURFACEDIFFUSION_ANY_VECTORS void SubstituteHalfPanel(const SparseFactor& factor, double* w)
{
  Substitute<HalfPanel>(factor, w);
}

SURFACEDIFFUSION_ANY_VECTORS void SubstituteColumnPanel(const SparseFactor& factor, double* w)
{
  Substitute<ColumnPanel>(factor, w);
}

} // namespace

template <int K>
void SubstituteRows(const SparseFactor& factor, double* w)
{
  if constexpr (K == ColumnPanel)
  {
    SubstituteColumnPanel(factor, w);
  }
  else if constexpr (K == HalfPanel)
  {
    SubstituteHalfPanel(factor, w);
  }
  else
  {
    Substitute<K>(factor, w);
  }
}

template void SubstituteRows<1>(const SparseFactor&, double*);
template void SubstituteRows<2>(const SparseFactor&, double*);
template void SubstituteRows<3>(const SparseFactor&, double*);
template void SubstituteRows<HalfPanel>(const SparseFactor&, double*);
template void SubstituteRows<ColumnPanel>(const SparseFactor&, double*);

} // namespace SurfaceDiffusion
