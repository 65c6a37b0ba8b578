// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/SparseFactor.h"

#include "Core/Solvers/NestedDissection.h"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

/// Eigen's decomposition, with its factor open to changes.
struct SparseFactor::Decomposition
  : Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower, Eigen::AMDOrdering<Index>>
{
  SparseMatrix& L() { return this->m_matrix; }

  /// Order the rows and find the pattern of the factor. On regular triangulations nested dissection
  /// takes about 40 n^1.5 operations, and minimum degree from 20 n^1.5 on subdivided scans to 110
  /// n^1.5 on icospheres.
  void Analyze(const SparseMatrix& matrix)
  {
    constexpr double ofDissection = 40.0;
    this->analyzePattern(matrix);
    const double operations = this->Operations();
    if (operations < ofDissection * std::pow(static_cast<double>(matrix.rows()), 1.5) ||
      !IsRegular(matrix))
    {
      return;
    }
    const Order byDegree = this->m_P.indices();
    const std::vector<Index> places = NestedDissection(matrix);
    this->AnalyzeInOrder(matrix, Eigen::Map<const Order>(places.data(), matrix.rows()));
    if (this->Operations() > operations)
    {
      this->AnalyzeInOrder(matrix, byDegree);
    }
  }

private:
  using Order = Eigen::Matrix<Index, Eigen::Dynamic, 1>;

  /// Of the factorisation, in the order that was analysed.
  double Operations() const { return this->m_nonZerosPerCol.template cast<double>().squaredNorm(); }

  void AnalyzeInOrder(const SparseMatrix& matrix, const Order& places)
  {
    this->m_P.indices() = places;
    this->m_Pinv = this->m_P.inverse();
    SparseMatrix ordered(matrix.rows(), matrix.cols());
    ordered.selfadjointView<Eigen::Upper>() =
      matrix.selfadjointView<Eigen::Lower>().twistedBy(this->m_P);
    this->analyzePattern_preordered(ordered, true);
  }
};

SparseFactor::SparseFactor()
  : LDL(std::make_unique<Decomposition>())
{
}

SparseFactor::~SparseFactor() = default;

bool SparseFactor::HasPatternOf(const SparseMatrix& matrix) const
{
  return this->Matrix.rows() == matrix.rows() && this->Matrix.nonZeros() == matrix.nonZeros() &&
    std::equal(matrix.outerIndexPtr(), matrix.outerIndexPtr() + matrix.rows(),
      this->Matrix.outerIndexPtr()) &&
    std::equal(matrix.innerIndexPtr(), matrix.innerIndexPtr() + matrix.nonZeros(),
      this->Matrix.innerIndexPtr());
}

bool SparseFactor::HasValuesOf(const SparseMatrix& matrix) const
{
  return this->HasPatternOf(matrix) &&
    std::equal(matrix.valuePtr(), matrix.valuePtr() + matrix.nonZeros(), this->Matrix.valuePtr());
}

void SparseFactor::Compute()
{
  constexpr double resolved = 1e-14;
  SparseMatrix pruned;
  const double* values = this->Matrix.valuePtr();
  const auto zeros = std::count(values, values + this->Matrix.nonZeros(), 0.0);
  const bool prune = zeros > this->Matrix.nonZeros() / 20;
  if (prune)
  {
    pruned = this->Matrix;
    pruned.prune([](Index, Index, double value) { return value != 0.0; });
  }
  const SparseMatrix& matrix = prune ? pruned : this->Matrix;
  if (!this->IsAnalyzed || prune || this->IsPruned)
  {
    this->LDL->Analyze(matrix);
    this->IsAnalyzed = true;
    this->IsPruned = prune;
  }
  this->Succeeded = this->Factorize(matrix, 1.0);
  if (!this->HasPivotsAbove(resolved))
  {
    this->Succeeded = this->Factorize(matrix, 1.0 + resolved);
  }
  this->InverseDiagonal = this->Matrix.diagonal().cwiseInverse();
  if (this->Succeeded)
  {
    this->InverseD = this->D.cwiseInverse();
    this->DropNegligible();
    this->FindPanels();
    this->OrderPanels();
  }
}

/// With the diagonal of the matrix times `diagonalFactor`; false if the factorisation broke down.
bool SparseFactor::Factorize(const SparseMatrix& matrix, double diagonalFactor)
{
  this->LDL->setShift(0.0, diagonalFactor);
  this->LDL->factorize(matrix);
  if (this->LDL->info() != Eigen::Success)
  {
    return false;
  }
  SparseMatrix& l = this->LDL->L();
  this->Place = this->LDL->permutationP().indices().data();
  this->D = this->LDL->vectorD();
  this->Begin.assign(l.outerIndexPtr(), l.outerIndexPtr() + l.cols() + 1);
  this->Rows = l.innerIndexPtr();
  this->Entries = l.valuePtr();
  return true;
}

/// Whether every pivot is above `bound` times its diagonal entry.
bool SparseFactor::HasPivotsAbove(double bound) const
{
  if (!this->Succeeded)
  {
    return false;
  }
  const Vector diagonal = this->Matrix.diagonal();
  for (Eigen::Index i = 0; i < diagonal.size(); ++i)
  {
    if (!(this->D[this->Place[i]] > bound * std::abs(diagonal[i])))
    {
      return false;
    }
  }
  return true;
}

/// The smaller the time step, the faster the influence of vertices on each other falls off with
/// distance: at steps of h^2/D and less, a third to two thirds of the entries are negligible. The
/// others move together in place.
void SparseFactor::DropNegligible()
{
  constexpr double lastPlace = 1e-16;
  const auto n = static_cast<Index>(this->D.size());
  Index* const rows = this->LDL->L().innerIndexPtr();
  double* const entries = this->LDL->L().valuePtr();
  Index kept = 0;
  for (Index j = 0, begin = 0; j < n; ++j)
  {
    const Index end = this->Begin[j + 1];
    for (Index slot = begin; slot < end; ++slot)
    {
      const Index i = rows[slot];
      const double value = entries[slot];
      if (!(value * value * std::abs(this->D[j]) < lastPlace * lastPlace * std::abs(this->D[i])))
      {
        rows[kept] = i;
        entries[kept] = value;
        ++kept;
      }
    }
    begin = end;
    this->Begin[j + 1] = kept;
  }
}

void SparseFactor::FindPanels()
{
  const auto n = static_cast<Index>(this->D.size());
  const auto nested = [&](Index j) // the columns j and j + 1
  {
    const Index begin = this->Begin[j];
    const Index next = this->Begin[j + 1];
    return next > begin && this->Rows[begin] == j + 1 &&
      next - begin - 1 == this->Begin[j + 2] - next &&
      std::equal(this->Rows + begin + 1, this->Rows + next, this->Rows + next);
  };
  this->Panels.clear();
  for (Index j = 0; j < n;)
  {
    this->Panels.push_back(j);
    Index width = 1;
    while (width < WidestPanel && j + width < n && nested(j + width - 1))
    {
      ++width;
    }
    j += width;
  }
  this->Panels.push_back(n);
}

/// From column by column to the order of SparseFactor::Begin, in place: substitution then reads the
/// factor as one stream.
void SparseFactor::OrderPanels()
{
  double* const entries = this->LDL->L().valuePtr();
  std::vector<double> columns;
  for (std::size_t p = 0; p + 1 < this->Panels.size(); ++p)
  {
    const Index first = this->Panels[p];
    const Index width = this->Panels[p + 1] - first;
    const Index begin = this->Begin[first];
    columns.assign(entries + begin, entries + this->Begin[first + width]);
    const Index rows = width + this->Begin[first + width] - this->Begin[first + width - 1];
    double* next = entries + begin;
    for (Index row = 1; row < rows; ++row)
    {
      for (Index a = 0; a < std::min(row, width); ++a)
      {
        *next++ = columns[static_cast<std::size_t>(this->Begin[first + a] - begin + row - a - 1)];
      }
    }
  }
}

} // namespace SurfaceDiffusion
