// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/TotalVariation/SlicedSplitting.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>

namespace SurfaceDiffusion
{

namespace
{

constexpr Index Lanes = SlicedSplitting<float>::Lanes;
static_assert(BlockSize % Lanes == 0, "a slice is in one block");

/// Balance(): where r |p| is larger than the first r falls, where it is smaller than the second r
/// rises. Measured on caps, patterns, waves, ramps and colours with weak and strong fidelity: the
/// goal 0.3 is best, goals of 3 and more leave edges where they are for hundreds of iterations. The
/// more vertices flat regions have, the larger their best r: scales up to 16 are better than up to
/// 8 on large surfaces, as long as the quadratic problems are solved well enough.
constexpr double LargestBalanced = 0.6;
constexpr double SmallestBalanced = 0.15;
constexpr double MostScale = 16.0; ///< and 1 / MostScale the least

/// What Update() knows of all slices.
template <typename Number>
struct Iteration
{
  const double* U;
  int Columns;
  bool IsJoint;
  Number Relaxation;
  Number Growth;
  bool HasP;
};

template <typename Number>
void SumSquares(const Number* w, int components, Number (&squares)[Lanes])
{
  std::fill_n(squares, Lanes, Number(0));
  for (int c = 0; c < components; ++c)
  {
    for (Index l = 0; l < Lanes; ++l)
    {
      squares[l] += w[c * Lanes + l] * w[c * Lanes + l];
    }
  }
}

/// w += gain S grad u of column k.
template <typename Slice, typename Number>
void AddGradient(const Slice& slice, const double* u, int columns, Number gain, Number* w)
{
  for (Index l = 0; l < Lanes; ++l)
  {
    const double at0 = u[static_cast<std::ptrdiff_t>(slice.Vertices[0][l]) * columns];
    const double at1 = u[static_cast<std::ptrdiff_t>(slice.Vertices[1][l]) * columns];
    const double at2 = u[static_cast<std::ptrdiff_t>(slice.Vertices[2][l]) * columns];
    const Number a = gain * static_cast<Number>(at1 - at0);
    const Number b = gain * static_cast<Number>(at2 - at0);
    w[l] += a * slice.Map[0][l] + b * slice.Map[2][l];
    w[Lanes + l] += a * slice.Map[1][l] + b * slice.Map[3][l];
  }
}

/// What w of the columns [first, last), times a factor per lane, gives to the corners.
template <typename Slice, typename Number>
void Spread(const Slice& slice, int columns, int first, int last, const Number (&factors)[Lanes],
  const Number* w, Number* atCorners)
{
  for (int k = first; k < last; ++k)
  {
    const Number* const x = w + static_cast<std::ptrdiff_t>(2 * k) * Lanes;
    const Number* const y = x + Lanes;
    Number* const at0 = atCorners + static_cast<std::ptrdiff_t>(k) * Lanes;
    Number* const at1 = at0 + static_cast<std::ptrdiff_t>(columns) * Lanes;
    Number* const at2 = at1 + static_cast<std::ptrdiff_t>(columns) * Lanes;
    Number a[Lanes]; // the compiler knows that these overlap nothing
    Number b[Lanes];
    for (Index l = 0; l < Lanes; ++l)
    {
      a[l] = factors[l] * (slice.Map[0][l] * x[l] + slice.Map[1][l] * y[l]);
      b[l] = factors[l] * (slice.Map[2][l] * x[l] + slice.Map[3][l] * y[l]);
    }
    for (Index l = 0; l < Lanes; ++l)
    {
      at0[l] = -a[l] - b[l];
    }
    std::copy_n(a, Lanes, at1);
    std::copy_n(b, Lanes, at2);
  }
}

/// w and the corners of the slice. setShares(squares, shares): the share of the multiplier in w.
template <typename Slice, typename Number, typename SetShares>
void UpdateSlice(const Slice& slice, const Iteration<Number>& iteration, const SetShares& setShares,
  Number* w, Number* atCorners)
{
  const int columns = iteration.Columns;
  const int together = iteration.IsJoint ? columns : 1;
  for (int first = 0; first < columns; first += together)
  {
    Number squares[Lanes];
    Number shares[Lanes];
    Number* const begin = w + static_cast<std::ptrdiff_t>(2 * first) * Lanes;
    Number gain = iteration.Growth;
    if (iteration.HasP)
    {
      const Number relaxation = iteration.Relaxation;
      gain *= relaxation;
      SumSquares(begin, 2 * together, squares);
      setShares(squares, shares);
      for (int c = 0; c < 2 * together; ++c)
      {
        for (Index l = 0; l < Lanes; ++l)
        {
          begin[c * Lanes + l] *= relaxation * shares[l] + (1 - relaxation);
        }
      }
    }
    for (int k = first; k < first + together; ++k)
    {
      AddGradient(
        slice, iteration.U + k, columns, gain, w + static_cast<std::ptrdiff_t>(2 * k) * Lanes);
    }
    SumSquares(begin, 2 * together, squares);
    setShares(squares, shares);
    for (Index l = 0; l < Lanes; ++l)
    {
      shares[l] = slice.AreaOverPenalty[l] * (1 - 2 * shares[l]);
    }
    Spread(slice, columns, first, first + together, shares, w, atCorners);
  }
}

template <typename Number>
void SetSharesOfTotalVariation(const Number (&squares)[Lanes], Number (&shares)[Lanes])
{
  for (Index l = 0; l < Lanes; ++l)
  {
    shares[l] = 1 / std::max(Number(1), std::sqrt(squares[l]));
  }
}

template <typename Slice, typename Number>
void UpdateSlices(const Slice* slices, Index begin, Index end, const Iteration<Number>& iteration,
  Number* w, Number* atCorners)
{
  const std::ptrdiff_t size = static_cast<std::ptrdiff_t>(iteration.Columns) * Lanes;
  for (std::ptrdiff_t s = begin; s < end; ++s)
  {
    UpdateSlice(
      slices[s], iteration,
      [](const Number(&squares)[Lanes], Number(&shares)[Lanes])
      { SetSharesOfTotalVariation(squares, shares); },
      w + 2 * s * size, atCorners + 3 * s * size);
  }
}

// For total variation. An attribute of a template is not portable: a function for each precision.

SURFACEDIFFUSION_ANY_VECTORS void UpdateTotalVariation(const SlicedSplitting<float>::Slice* slices,
  Index begin, Index end, const Iteration<float>& iteration, float* w, float* atCorners)
{
  UpdateSlices(slices, begin, end, iteration, w, atCorners);
}

SURFACEDIFFUSION_ANY_VECTORS void UpdateTotalVariation(const SlicedSplitting<double>::Slice* slices,
  Index begin, Index end, const Iteration<double>& iteration, double* w, double* atCorners)
{
  UpdateSlices(slices, begin, end, iteration, w, atCorners);
}

} // namespace

/// act(s) for all slices.
template <typename Number>
template <typename Act>
void SlicedSplitting<Number>::ForEachSlice(const Act& act) const
{
  ForEachBlock(this->Parallel, this->Mesh->NumberOfTriangles(),
    [&](Index, Index begin, Index end)
    {
      for (Index t = begin; t < end; t += Lanes)
      {
        act(t / Lanes);
      }
    });
}

template <typename Number>
void SlicedSplitting<Number>::SetMesh(
  const TriangleMesh& mesh, const GradientMaps& gradients, const Vector& penalty)
{
  this->Mesh = &mesh;
  this->Penalty = &penalty;
  const Index triangles = mesh.NumberOfTriangles();
  this->Slices = Buffer<Slice>(static_cast<std::size_t>((triangles + Lanes - 1) / Lanes));
  this->ForEachSlice(
    [&](Index s)
    {
      Slice slice = {};
      for (Index l = 0; l < this->LanesOf(s); ++l)
      {
        const Index t = s * Lanes + l;
        const double area = mesh.Shapes()[t].Area();
        const double r = penalty[t] / area;
        const GradientMap map = gradients[t];
        for (int corner = 0; corner < 3; ++corner)
        {
          slice.Vertices[corner][l] = mesh.TriangleVertices()(t, corner);
        }
        for (int axis = 0; axis < 2; ++axis)
        {
          slice.Map[axis][l] = static_cast<Number>(r * map.First[axis]);
          slice.Map[2 + axis][l] = static_cast<Number>(r * map.Second[axis]);
        }
        slice.AreaOverPenalty[l] = static_cast<Number>(area / r);
      }
      this->Slices[s] = slice;
    });
  const auto& corners = mesh.VertexCorners();
  this->Places.resize(corners.size()); // finding them in every iteration costs more than reading
  ForEach(this->Parallel, static_cast<Index>(corners.size()),
    [&](Index c)
    {
      const Index t = corners[c] / 3;
      this->Places[c] = (t / Lanes * 3 + corners[c] % 3) * Lanes + t % Lanes;
    });
  this->IsComplete = true; // last: a mesh that was aborted is set again
}

template <typename Number>
bool SlicedSplitting<Number>::IsInRange() const
{
  // Products of two of these numbers and of W, which is of the size of 1, are far from the limits.
  const double largest = std::cbrt(static_cast<double>(std::numeric_limits<Number>::max()));
  return Max(this->Parallel, static_cast<Index>(this->Slices.size()),
           [&](Index s)
           {
             double extreme = 0.0;
             const auto include = [&extreme](Number number)
             {
               const double size = std::abs(static_cast<double>(number));
               extreme = std::max({ extreme, size, size > 0.0 ? 1.0 / size : 0.0 });
             };
             const Slice& slice = this->Slices[s];
             for (const auto& numbers : slice.Map)
             {
               std::for_each(std::begin(numbers), std::end(numbers), include);
             }
             std::for_each(
               std::begin(slice.AreaOverPenalty), std::end(slice.AreaOverPenalty), include);
             return extreme;
           }) <= largest;
}

/// The shares of the multipliers in the W of slice s with these squares.
template <typename Number>
void SlicedSplitting<Number>::SetShares(
  Index s, const Number (&squares)[Lanes], Number (&shares)[Lanes]) const
{
  if (this->Function.Kind == EdgeFunctionKind::TotalVariation)
  {
    SetSharesOfTotalVariation(squares, shares);
    return;
  }
  std::fill_n(shares, Lanes, Number(1));
  for (Index l = 0; l < this->LanesOf(s); ++l)
  {
    const Index t = s * Lanes + l;
    const double r = this->PenaltyGrowth * (*this->Penalty)[t] / this->Mesh->Shapes()[t].Area();
    const double norm = std::sqrt(static_cast<double>(squares[l])) / r;
    shares[l] = static_cast<Number>(1.0 - this->Function.Shrinkage(r, norm));
  }
}

/// act(first, last, shares) for the columns of slice s that share a norm.
template <typename Number>
template <typename Act>
void SlicedSplitting<Number>::ForNorms(Index s, const Act& act) const
{
  ForEachNorm(this->Coupling, this->Columns,
    [&](int first, int last)
    {
      Number shares[Lanes];
      std::fill_n(shares, Lanes, Number(1));
      if (this->HasP)
      {
        Number squares[Lanes];
        SumSquares(&this->W[this->Place(s, 2 * first, 0)], 2 * (last - first), squares);
        this->SetShares(s, squares, shares);
      }
      act(first, last, shares);
    });
}

/// W times factor(share).
template <typename Number>
template <typename Factor>
void SlicedSplitting<Number>::Scale(const Factor& factor)
{
  this->ForEachSlice(
    [&](Index s)
    {
      this->ForNorms(s,
        [&](int first, int last, const Number(&shares)[Lanes])
        {
          for (int c = 2 * first; c < 2 * last; ++c)
          {
            Number* const w = &this->W[this->Place(s, c, 0)];
            for (Index l = 0; l < Lanes; ++l)
            {
              w[l] *= factor(shares[l]);
            }
          }
        });
    });
}

template <typename Number>
void SlicedSplitting<Number>::Start(int columns, bool keepMultipliers)
{
  const std::size_t size = this->Slices.size() * static_cast<std::size_t>(columns) * Lanes;
  const bool fits = this->W.size() == 2 * size;
  if (!fits)
  {
    // W fits only where both do, also after one of them has found no memory.
    this->W = Buffer<Number>();
    this->AtCorners = Buffer<Number>(3 * size);
    this->W = Buffer<Number>(2 * size);
  }
  this->Columns = columns;
  if (!fits || !keepMultipliers)
  {
    this->ForEachSlice(
      [&](Index s) { std::fill_n(&this->W[this->Place(s, 0, 0)], 2 * columns * Lanes, 0); });
  }
  else if (this->HasP)
  {
    this->Scale([](Number share) { return share; });
  }
  this->HasP = false;
  this->PenaltyGrowth = 1.0; // an abort may have left another
}

template <typename Number>
void SlicedSplitting<Number>::SetGrowth(double growth)
{
  if (this->HasP && growth != this->PenaltyGrowth)
  {
    const auto factor = static_cast<Number>(growth / this->PenaltyGrowth);
    this->Scale([factor](Number share) { return factor + (1 - factor) * share; });
  }
  this->PenaltyGrowth = growth;
}

/// r on the triangles of a slice times factors.
template <typename Number>
void SlicedSplitting<Number>::ScalePenalty(Index s, const Number (&factors)[Lanes], Vector& scales)
{
  Slice& slice = this->Slices[s];
  for (auto& numbers : slice.Map)
  {
    for (Index l = 0; l < Lanes; ++l)
    {
      numbers[l] *= factors[l];
    }
  }
  for (Index l = 0; l < this->LanesOf(s); ++l)
  {
    slice.AreaOverPenalty[l] /= factors[l];
    scales[s * Lanes + l] *= factors[l];
  }
}

template <typename Number>
void SlicedSplitting<Number>::Balance(Vector& scales)
{
  if (!this->HasP)
  {
    return;
  }
  this->ForEachSlice(
    [&](Index s)
    {
      // Columns with norms of their own have one r: that for the steepest.
      Number least[Lanes];
      std::fill_n(least, Lanes, Number(1));
      this->ForNorms(s,
        [&](int, int, const Number(&shares)[Lanes])
        {
          for (Index l = 0; l < Lanes; ++l)
          {
            least[l] = std::min(least[l], shares[l]);
          }
        });
      Number factors[Lanes];
      std::fill_n(factors, Lanes, Number(1));
      for (Index l = 0; l < this->LanesOf(s); ++l)
      {
        const double scale = scales[s * Lanes + l];
        const double product = 1.0 / least[l] - 1.0; // |w| = r |p| + 1 where p is not 0
        if (product > LargestBalanced && scale * MostScale > 1.0)
        {
          factors[l] = Number(0.5);
        }
        else if (product < SmallestBalanced && scale < MostScale)
        {
          factors[l] = Number(2);
        }
      }
      this->ForNorms(s,
        [&](int first, int last, const Number(&shares)[Lanes])
        {
          for (int c = 2 * first; c < 2 * last; ++c)
          {
            Number* const w = &this->W[this->Place(s, c, 0)];
            for (Index l = 0; l < Lanes; ++l)
            {
              w[l] *= factors[l] + (1 - factors[l]) * shares[l];
            }
          }
        });
      this->ScalePenalty(s, factors, scales);
    });
}

template <typename Number>
void SlicedSplitting<Number>::Unbalance(Vector& scales)
{
  this->ForEachSlice(
    [&](Index s)
    {
      Number factors[Lanes];
      std::fill_n(factors, Lanes, Number(1));
      for (Index l = 0; l < this->LanesOf(s); ++l)
      {
        factors[l] = static_cast<Number>(1.0 / scales[s * Lanes + l]);
      }
      this->ScalePenalty(s, factors, scales);
    });
}

template <typename Number>
void SlicedSplitting<Number>::Update(const Values& u, double relaxation)
{
  const Iteration<Number> iteration{ u.data(), this->Columns,
    this->Coupling == ChannelCoupling::Joint, static_cast<Number>(relaxation),
    static_cast<Number>(this->PenaltyGrowth), this->HasP };
  if (this->Function.Kind == EdgeFunctionKind::TotalVariation)
  {
    ForEachBlock(this->Parallel, this->Mesh->NumberOfTriangles(),
      [&](Index, Index begin, Index end)
      {
        UpdateTotalVariation(this->Slices.data(), begin / Lanes, (end + Lanes - 1) / Lanes,
          iteration, this->W.data(), this->AtCorners.data());
      });
  }
  else
  {
    this->ForEachSlice(
      [&](Index s)
      {
        UpdateSlice(
          this->Slices[s], iteration,
          [this, s](const Number(&squares)[Lanes], Number(&shares)[Lanes])
          { this->SetShares(s, squares, shares); },
          &this->W[this->Place(s, 0, 0)], &this->AtCorners[this->Place(s, 0, 0) / 2 * 3]);
      });
  }
  this->HasP = true;
}

template <typename Number>
void SlicedSplitting<Number>::SpreadMultipliers()
{
  this->ForEachSlice(
    [&](Index s)
    {
      this->ForNorms(s,
        [&](int first, int last, Number(&shares)[Lanes])
        {
          for (Index l = 0; l < Lanes; ++l)
          {
            shares[l] *= this->Slices[s].AreaOverPenalty[l];
          }
          Spread(this->Slices[s], this->Columns, first, last, shares,
            &this->W[this->Place(s, 0, 0)], &this->AtCorners[this->Place(s, 0, 0) / 2 * 3]);
        });
    });
}

template <typename Number>
double SlicedSplitting<Number>::ConjugateEnergy() const
{
  if (this->Function.Kind == EdgeFunctionKind::TotalVariation)
  {
    return 0.0;
  }
  return Sum(this->Parallel, static_cast<Index>(this->Slices.size()),
    [&](Index s)
    {
      double energy = 0.0;
      this->ForNorms(s,
        [&](int first, int last, const Number(&shares)[Lanes])
        {
          Number squares[Lanes];
          SumSquares(&this->W[this->Place(s, 2 * first, 0)], 2 * (last - first), squares);
          for (Index l = 0; l < this->LanesOf(s); ++l)
          {
            const double squared = static_cast<double>(squares[l]) * shares[l] * shares[l];
            energy +=
              this->Mesh->Shapes()[s * Lanes + l].Area() * this->Function.Conjugate(squared);
          }
        });
      return energy;
    });
}

template <typename Number>
void SlicedSplitting<Number>::GetMultipliers(double* multipliers) const
{
  this->ForEachSlice(
    [&](Index s)
    {
      this->ForNorms(s,
        [&](int first, int last, const Number(&shares)[Lanes])
        {
          for (int c = 2 * first; c < 2 * last; ++c)
          {
            for (Index l = 0; l < this->LanesOf(s); ++l)
            {
              const auto t = static_cast<std::size_t>(s) * Lanes + l;
              multipliers[t * 2 * this->Columns + c] =
                this->W[this->Place(s, c, l)] * shares[l]; // as rounded as in Start()
            }
          }
        });
    });
}

template <typename Number>
void SlicedSplitting<Number>::SetMultipliers(const double* multipliers)
{
  this->ForEachSlice(
    [&](Index s)
    {
      for (Index l = 0; l < this->LanesOf(s); ++l)
      {
        const double* const y =
          multipliers + (static_cast<std::size_t>(s) * Lanes + l) * 2 * this->Columns;
        for (int c = 0; c < 2 * this->Columns; ++c)
        {
          this->W[this->Place(s, c, l)] = static_cast<Number>(y[c]);
        }
      }
    });
}

template class SlicedSplitting<float>;
template class SlicedSplitting<double>;

} // namespace SurfaceDiffusion
