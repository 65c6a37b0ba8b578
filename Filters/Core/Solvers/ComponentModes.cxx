// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/ComponentModes.h"

#include "Core/Foundation/Random.h"
#include "Core/Foundation/SymmetricModes.h"
#include "Core/Solvers/KrylovBasis.h"
#include "Core/Solvers/NestedDissection.h"
#include "Core/Solvers/NotPositiveDefinite.h"
#include "Core/Solvers/SupernodalFactor.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

constexpr Index Block = KrylovBasis::BlockColumns;
/// A is applied so often in each step of the iteration.
constexpr int Power = 4;
/// Of a pair of A^Power, relative to its eigenvalue. The error of lambda is of second order in it.
constexpr double Tolerance = 1e-8;
/// Eigenvalues that agree so far may be one.
constexpr double Agreement = 1e-6;
/// The steps after which a new random block shows what the iteration has missed.
constexpr Index StepsOfSearch = 6;
/// With fewer rows the dense problem takes less time.
constexpr Index FewRows = 400;

/// The modes of one connected component, from S = M^-1/2 K M^-1/2, whose null space contains z.
class ComponentModes
{
public:
  ComponentModes(
    SparseMatrix stiffness, Vector areas, std::vector<Index> ids, const ParallelFor& parallel)
    : S(std::move(stiffness))
    , Roots(areas.cwiseSqrt())
    , Z(Roots / Roots.norm())
    , Ids(std::move(ids))
    , Parallel(parallel)
    , Basis(static_cast<Index>(Roots.size()), parallel)
  {
    for (Index j = 0; j < this->Size(); ++j)
    {
      for (SparseMatrix::InnerIterator entry(this->S, j); entry; ++entry)
      {
        entry.valueRef() /= this->Roots[entry.index()] * this->Roots[j];
      }
    }
    this->Area = areas.sum();
  }

  Eigenmodes Find(Index count, const ProgressMonitor& progress)
  {
    Values modes;
    if (this->Size() <= std::max(FewRows, 3 * count))
    {
      const SymmetricModes dense{ Eigen::MatrixXd(this->S) };
      if (!dense.Converged)
      {
        throw std::runtime_error("the eigenvalues of the surface did not converge");
      }
      modes = dense.Vectors.leftCols(count);
      modes.col(0) = this->Z;
    }
    else
    {
      modes = this->Iterate(count, progress);
    }
    return this->Finish(std::move(modes));
  }

private:
  Index Size() const { return static_cast<Index>(this->Roots.size()); }

  Values Iterate(Index count, const ProgressMonitor& progress)
  {
    Values modes(this->Size(), count);
    modes.col(0) = this->Z;
    const Index wanted = count - 1;
    if (wanted == 0)
    {
      return modes;
    }
    this->Factorize(wanted, progress.Part(0.0, 0.1));
    Values w(this->Size(), Block);
    this->StartRandomly(w);
    const Index most = (this->Size() - 1) / Block * Block;
    // Mostly enough for the last eigenvalue that is wanted
    Index enough = std::min(most, wanted + 3 * (wanted / 4) + 3 * Block);
    Vector before; // the eigenvalues at the last convergence
    while (true)
    {
      this->Basis.Append(w);
      const Index columns = this->Basis.NumberOfColumns();
      this->Apply(w);
      const KrylovBasis::Square coupling = this->TakeStep(w);
      progress.Report(0.1 + 0.8 * std::min(1.0, static_cast<double>(columns) / enough));
      if (columns < enough)
      {
        continue;
      }
      const SymmetricModes small(this->T.topLeftCorner(columns, columns));
      const Eigen::MatrixXd vectors = small.Vectors.rightCols(wanted).rowwise().reverse();
      const Vector values = small.Eigenvalues.tail(wanted).reverse();
      const Vector errors = (coupling * vectors.bottomRows(Block)).colwise().norm().transpose();
      if ((errors.array() <= Tolerance * values.array()).all())
      {
        const bool isConfirmed = before.size() > 0 &&
          ((values - before).array().abs() <= Agreement * values.array()).all();
        if (isConfirmed || !MayHaveMissed(values) || columns + StepsOfSearch * Block > most)
        {
          modes.rightCols(wanted) = this->Basis.Combine(vectors);
          return modes;
        }
        before = values;
        this->StartRandomly(w);
        enough = columns + StepsOfSearch * Block;
        continue;
      }
      if (columns + Block > most)
      {
        throw std::runtime_error("the eigenvalues of the surface did not converge");
      }
      enough = std::min(most, enough + std::max(2 * Block, wanted / 8));
    }
  }

  /// A block of Lanczos' method finds an eigenvalue as often as it has columns, and more often by
  /// round-off only.
  static bool MayHaveMissed(const Vector& descending)
  {
    Index same = 1;
    for (Eigen::Index k = 1; k < descending.size() && same < Block; ++k)
    {
      same = descending[k] > (1.0 - Agreement) * descending[k - 1] ? same + 1 : 1;
    }
    return same >= Block;
  }

  void Factorize(Index wanted, const ProgressMonitor& progress)
  {
    // A sixteenth of the largest eigenvalue that is wanted, by Weyl's law: smaller shifts separate
    // it hardly better from the next ones, but powers of A would lose its digits beside the
    // smallest.
    constexpr double share = 1.0 / 16.0;
    const double largest = 4.0 * std::acos(-1.0) * wanted / this->Area;
    SparseMatrix shifted = this->S;
    shifted.diagonal().array() += share * largest;
    constexpr double resolved = 1e-15;
    const PivotCounts pivots =
      this->Factor.Compute(shifted, IsRegular(shifted), resolved, this->Parallel, progress);
    if (pivots.Open > 0)
    {
      throw NotPositiveDefinite();
    }
  }

  void FillRandomly(Values& w, Index k)
  {
    ++this->RandomColumns;
    ForEach(this->Parallel, this->Size(),
      [&](Index i) { w(i, k) = UniformRandom(1, this->RandomColumns, this->Ids[i]) - 0.5; });
  }

  /// A random block that is orthogonal to the basis.
  void StartRandomly(Values& w)
  {
    for (Index k = 0; k < Block; ++k)
    {
      this->FillRandomly(w, k);
    }
    this->Basis.Project(w);
    this->Basis.Project(w);
    this->RemoveConstant(w);
    this->Orthonormalize(w);
  }

  void Apply(Values& w) const
  {
    for (int power = 0; power < Power; ++power)
    {
      this->Factor.Solve(w, this->Parallel);
    }
  }

  /// w becomes the next block Q of the basis, with A^Power V = V T + Q R for the last block V.
  /// Returns R.
  KrylovBasis::Square TakeStep(Values& w)
  {
    const Index columns = this->Basis.NumberOfColumns();
    // The three-term recurrence, then all of the basis
    const Index last = std::max(0, columns - 2 * Block);
    const KrylovBasis::Coefficients recent = this->Basis.Project(w, last);
    KrylovBasis::Coefficients all = this->Basis.Project(w);
    all.bottomRows(columns - last) += recent;
    this->RemoveConstant(w);
    this->T.conservativeResize(columns, columns);
    this->T.rightCols(Block) = all;
    this->T.bottomRows(Block) = all.transpose();
    const KrylovBasis::Square own = all.bottomRows(Block);
    this->T.bottomRightCorner(Block, Block) = 0.5 * (own + own.transpose());
    constexpr double roundOff = 1e-10; // of the remainder: not orthogonal to the basis
    return this->Orthonormalize(w, roundOff * own.norm());
  }

  /// w -= z (z^T w)
  void RemoveConstant(Values& w) const
  {
    using Row = Eigen::Matrix<double, 1, Block>;
    std::vector<Row> parts(static_cast<std::size_t>(NumberOfBlocks(this->Size())));
    ForEachBlock(this->Parallel, this->Size(),
      [&](Index block, Index begin, Index end)
      {
        Row& part = parts[static_cast<std::size_t>(block)];
        part.setZero();
        for (Index i = begin; i < end; ++i)
        {
          part += this->Z[i] * w.row(i);
        }
      });
    Row product = Row::Zero();
    for (const Row& part : parts)
    {
      product += part;
    }
    ForEach(this->Parallel, this->Size(), [&](Index i) { w.row(i) -= this->Z[i] * product; });
  }

  KrylovBasis::Square Gram(const Values& w) const
  {
    const Index blocks = NumberOfBlocks(this->Size());
    std::vector<KrylovBasis::Square> parts(static_cast<std::size_t>(blocks));
    ForEachBlock(this->Parallel, this->Size(),
      [&](Index block, Index begin, Index end)
      {
        const auto rows = w.middleRows(begin, end - begin);
        parts[static_cast<std::size_t>(block)].noalias() = rows.transpose() * rows;
      });
    KrylovBasis::Square sum = KrylovBasis::Square::Zero();
    for (const KrylovBasis::Square& part : parts)
    {
      sum += part;
    }
    return sum;
  }

  /// w = Q R, orthogonal to the basis and to z. Columns that depend on others, or are not longer than
  /// `least`, become random ones, with zeros in R. Returns R; w becomes Q.
  KrylovBasis::Square Orthonormalize(Values& w, double least = 0.0)
  {
    KrylovBasis::Square r = KrylovBasis::Square::Identity();
    // Cholesky's factor of W^T W has lost half of the digits; the second round has them all.
    bool isComplete = false;
    for (int round = 0; round < 4 && !(isComplete && round > 1); ++round)
    {
      const KrylovBasis::Square gram = this->Gram(w);
      KrylovBasis::Square upper = KrylovBasis::Square::Zero();
      std::vector<Index> dependent;
      for (Index k = 0; k < Block; ++k)
      {
        const double pivot = gram(k, k) - upper.col(k).head(k).squaredNorm();
        constexpr double negligible = 1e-12;
        const double smallest = round == 0 ? least * least : 0.0;
        if (!(pivot > std::max(negligible * gram(k, k), smallest)))
        {
          dependent.push_back(k);
          continue;
        }
        upper(k, k) = std::sqrt(pivot);
        for (Index l = k + 1; l < Block; ++l)
        {
          upper(k, l) = (gram(k, l) - upper.col(k).head(k).dot(upper.col(l).head(k))) / upper(k, k);
        }
      }
      r = (upper * r).eval();
      for (const Index k : dependent)
      {
        this->FillRandomly(w, k);
        upper.col(k).setZero();
        upper(k, k) = 1.0;
      }
      const KrylovBasis::Square inverse =
        upper.triangularView<Eigen::Upper>().solve(KrylovBasis::Square::Identity());
      ForEachBlock(this->Parallel, this->Size(),
        [&](Index, Index begin, Index end)
        {
          const Values rows = w.middleRows(begin, end - begin);
          w.middleRows(begin, end - begin).noalias() = rows * inverse;
        });
      if (!dependent.empty())
      {
        this->Basis.Project(w);
        this->Basis.Project(w);
        this->RemoveConstant(w);
      }
      isComplete = dependent.empty();
    }
    return r;
  }

  /// From vectors of S to modes, with Rayleigh's quotients as eigenvalues, in their order.
  Eigenmodes Finish(Values y)
  {
    const auto count = static_cast<Index>(y.cols());
    Values product(y.rows(), y.cols());
    Multiply(this->S, y, product, this->Parallel);
    Vector values(count);
    ForEachTask(this->Parallel, count,
      [&](Index k)
      { values[k] = k == 0 ? 0.0 : y.col(k).dot(product.col(k)) / y.col(k).squaredNorm(); });
    std::vector<Index> order(static_cast<std::size_t>(count));
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(
      order.begin() + 1, order.end(), [&](Index a, Index b) { return values[a] < values[b]; });
    Eigenmodes found{ Vector(count), std::move(product) };
    for (Index k = 0; k < count; ++k)
    {
      found.Eigenvalues[k] = std::max(0.0, values[order[k]]);
    }
    ForEach(this->Parallel, this->Size(),
      [&](Index i)
      {
        for (Index k = 0; k < count; ++k)
        {
          found.Modes(i, k) = y(i, order[k]) / this->Roots[i];
        }
      });
    return found;
  }

  SparseMatrix S;
  Vector Roots; ///< of the areas
  Vector Z; ///< the constant, times the roots, of norm 1
  std::vector<Index> Ids; ///< numbers of the points
  const ParallelFor& Parallel;
  KrylovBasis Basis;
  SupernodalFactor Factor;
  double Area = 0.0; ///< of the component
  Eigen::MatrixXd T; ///< V^T A^Power V
  Index RandomColumns = 0;
};

} // namespace

Eigenmodes FindComponentModes(SparseMatrix stiffness, Vector areas, std::vector<Index> ids,
  Index count, const ParallelFor& parallel, const ProgressMonitor& progress)
{
  return ComponentModes(std::move(stiffness), std::move(areas), std::move(ids), parallel)
    .Find(count, progress);
}

} // namespace SurfaceDiffusion
