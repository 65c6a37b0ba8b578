// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/SparseFactor.h"

#include <cholmod.h>

#include <new>

namespace SurfaceDiffusion
{

namespace
{

/// CHOLMOD factorises by supernodes (dense blocks) where that pays, and then lays the factor out by
/// columns, which substitute faster for few right-hand sides.
class CholmodFactor : public SparseFactor
{
public:
  CholmodFactor()
  {
    cholmod_start(&this->Common);
    this->Common.print = 0;
    this->Common.nmethods = 1;
    this->Common.method[0].ordering = CHOLMOD_AMD; // METIS takes longer than it saves
    this->Common.final_asis = 0; // L D L^T by columns
    this->Common.final_super = 0;
    this->Common.final_ll = 0;
    this->Common.final_pack = 1;
    this->Common.final_monotonic = 1;
  }

  ~CholmodFactor() override
  {
    cholmod_free_factor(&this->Numeric, &this->Common);
    cholmod_free_factor(&this->Symbolic, &this->Common);
    cholmod_finish(&this->Common);
  }

  CholmodFactor(const CholmodFactor&) = delete;
  CholmodFactor& operator=(const CholmodFactor&) = delete;

  void Analyze(const SparseMatrix& matrix) override
  {
    cholmod_free_factor(&this->Symbolic, &this->Common);
    cholmod_sparse view = View(matrix);
    this->Symbolic = cholmod_analyze(&view, &this->Common);
    this->CheckMemory();
  }

  bool Factorize(const SparseMatrix& matrix, double diagonal) override
  {
    SparseMatrix scaled;
    if (diagonal != 1.0)
    {
      scaled = matrix;
      scaled.diagonal() *= diagonal;
    }
    cholmod_sparse view = View(diagonal != 1.0 ? scaled : matrix);
    cholmod_free_factor(&this->Numeric, &this->Common);
    this->Numeric = cholmod_copy_factor(this->Symbolic, &this->Common);
    this->CheckMemory();
    cholmod_factorize(&view, this->Numeric, &this->Common);
    this->CheckMemory();
    const std::size_t n = this->Numeric->n;
    if (this->Numeric->minor < n)
    {
      return false;
    }
    this->Place = static_cast<const Index*>(this->InversePermutation());
    this->Rows = static_cast<Index*>(this->Numeric->i);
    this->Entries = static_cast<double*>(this->Numeric->x);
    this->TakeOutDiagonal();
    return true;
  }

private:
  static cholmod_sparse View(const SparseMatrix& matrix)
  {
    cholmod_sparse view{};
    view.nrow = static_cast<std::size_t>(matrix.rows());
    view.ncol = static_cast<std::size_t>(matrix.cols());
    view.nzmax = static_cast<std::size_t>(matrix.nonZeros());
    // CHOLMOD reads only
    view.p = const_cast<Index*>(matrix.outerIndexPtr());
    view.i = const_cast<Index*>(matrix.innerIndexPtr());
    view.x = const_cast<double*>(matrix.valuePtr());
    view.stype = -1; // the lower triangle
    view.itype = CHOLMOD_INT;
    view.xtype = CHOLMOD_REAL;
    view.dtype = CHOLMOD_DOUBLE;
    view.sorted = 0; // not promised
    view.packed = 1;
    return view;
  }

  void CheckMemory() const
  {
    if (this->Common.status == CHOLMOD_OUT_OF_MEMORY || this->Common.status == CHOLMOD_TOO_LARGE)
    {
      throw std::bad_alloc();
    }
  }

  const Index* InversePermutation()
  {
    const auto* permutation = static_cast<const Index*>(this->Numeric->Perm);
    this->Inverse.resize(this->Numeric->n);
    for (std::size_t k = 0; k < this->Numeric->n; ++k)
    {
      this->Inverse[permutation[k]] = static_cast<Index>(k);
    }
    return this->Inverse.data();
  }

  /// CHOLMOD keeps D in the first entry of each column.
  void TakeOutDiagonal()
  {
    const auto* columns = static_cast<const Index*>(this->Numeric->p);
    const Index n = static_cast<Index>(this->Numeric->n);
    this->D.resize(n);
    this->Begin.resize(this->Numeric->n + 1);
    Index kept = 0;
    for (Index j = 0; j < n; ++j)
    {
      this->Begin[j] = kept;
      this->D[j] = this->Entries[columns[j]];
      for (Index slot = columns[j] + 1; slot < columns[j + 1]; ++slot, ++kept)
      {
        this->Rows[kept] = this->Rows[slot];
        this->Entries[kept] = this->Entries[slot];
      }
    }
    this->Begin[n] = kept;
  }

  cholmod_common Common;
  cholmod_factor* Symbolic = nullptr;
  cholmod_factor* Numeric = nullptr;
  std::vector<Index> Inverse;
};

} // namespace

std::unique_ptr<SparseFactor> MakeSparseFactor()
{
  return std::make_unique<CholmodFactor>();
}

} // namespace SurfaceDiffusion
