// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/SparseFactor.h"

#include <Eigen/SparseCholesky>

namespace SurfaceDiffusion
{

namespace
{

class EigenFactor : public SparseFactor
{
public:
  void Analyze(const SparseMatrix& matrix) override { this->Decomposition.analyzePattern(matrix); }

  bool Factorize(const SparseMatrix& matrix, double diagonal) override
  {
    this->Decomposition.setShift(0.0, diagonal);
    this->Decomposition.factorize(matrix);
    if (this->Decomposition.info() != Eigen::Success)
    {
      return false;
    }
    SparseMatrix& l = this->Decomposition.L();
    this->Place = this->Decomposition.permutationP().indices().data();
    this->D = this->Decomposition.vectorD();
    this->Begin.assign(l.outerIndexPtr(), l.outerIndexPtr() + l.cols() + 1);
    this->Rows = l.innerIndexPtr();
    this->Entries = l.valuePtr();
    return true;
  }

private:
  /// Eigen's decomposition, whose factor can be changed.
  struct LDLT : Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower, Eigen::AMDOrdering<Index>>
  {
    SparseMatrix& L() { return this->m_matrix; }
  };

  LDLT Decomposition;
};

} // namespace

std::unique_ptr<SparseFactor> MakeSparseFactor()
{
  return std::make_unique<EigenFactor>();
}

} // namespace SurfaceDiffusion
