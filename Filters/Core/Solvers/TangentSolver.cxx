// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/TangentSolver.h"

#include "Core/Foundation/Resize.h"
#include "Core/Operators/SparsePattern.h"
#include "Core/Solvers/ConjugateGradients.h"

namespace SurfaceDiffusion
{

namespace
{

/// Row `at`; K columns, known to the compiler unless K is 0.
template <int K, typename Number>
auto Row(Number* at, Eigen::Index columns)
{
  using Numbers = Eigen::Matrix<double, 1, K == 0 ? Eigen::Dynamic : K>;
  return Eigen::Map<std::conditional_t<std::is_const<Number>::value, const Numbers, Numbers>>(
    at, 1, columns);
}

struct ProjectedSystem : MatrixSystem
{
  static constexpr bool IsCoupled = true;
  static constexpr bool IsProjected = true;

  const Values& U;
  const Flags& Fixed;
  const Values* Normals;
  LinearSolver* Preconditioner;

  bool HasPreconditioner() const { return this->Preconditioner != nullptr; }
  void Precondition(const Values& r, const std::vector<double>&, Values& z) const
  {
    this->Preconditioner->Precondition(r, z);
  }

  /// Take from a row what is not tangential to the sphere at u_i; all of it if i is fixed.
  template <int K>
  void Project(Index i, double* row) const
  {
    const Eigen::Index columns = this->U.cols();
    auto x = Row<K>(row, columns);
    const auto u = Row<K>(&this->U(i, 0), columns);
    if (this->Fixed[i])
    {
      x.setZero();
      return;
    }
    x -= (x.dot(u) / u.squaredNorm()) * u;
    if (this->Normals)
    {
      const auto normal = Row<K>(&(*this->Normals)(i, 0), columns);
      x -= x.dot(normal) * normal;
    }
  }
};

} // namespace

SolveReport TangentSolver::Solve(const TangentSystem& system, Values& x,
  LinearSolver* preconditioner, const IterationLimits& limits, const ProgressMonitor& progress)
{
  return ForColumns(system.U.cols(),
    [&](auto k) {
      return this->SolveColumns<decltype(k)::value>(system, x, preconditioner, limits, progress);
    });
}

template <int K>
SolveReport TangentSolver::SolveColumns(const TangentSystem& system, Values& x,
  LinearSolver* preconditioner, const IterationLimits& limits, const ProgressMonitor& progress)
{
  const SparseMatrix& matrix = system.Matrix;
  const Reduction& reduction = system.Reduction;
  const auto n = static_cast<Index>(system.B.rows());
  const auto columns = static_cast<int>(system.B.cols());
  Resize(x, n, columns);
  Resize(this->Residual, n, columns);
  ForEachBlock(this->Parallel, n,
    [&](Index, Index begin, Index end)
    {
      x.middleRows(begin, end - begin).setZero();
      this->Residual.middleRows(begin, end - begin) = system.B.middleRows(begin, end - begin);
    });
  reduction.Accumulate(this->Residual);
  const Vector& inertia = reduction.Accumulated(system.Inertia, this->Inertia);
  this->InverseDiagonal.resize(n);
  ForEach(this->Parallel, n, [&](Index i) { this->InverseDiagonal[i] = DiagonalEntry(matrix, i); });
  reduction.Accumulate(this->InverseDiagonal);
  const ProjectedSystem projected{ { matrix, this->InverseDiagonal, reduction }, system.U,
    system.Fixed, system.Normals, preconditioner };

  const double scale = reduction.SumOverVertices(this->Parallel, n,
    [&](Index i)
    {
      this->InverseDiagonal[i] = 1.0 / this->InverseDiagonal[i];
      return inertia[i] * inertia[i] * this->InverseDiagonal[i] *
        Row<K>(&system.U(i, 0), columns).squaredNorm();
    });
  const double start = reduction.SumOverVertices(this->Parallel, n,
    [&](Index i)
    {
      // Twice: near rest the first leaves as much round-off as there is residual.
      double* const r = &this->Residual(i, 0);
      projected.Project<K>(i, r);
      projected.Project<K>(i, r);
      return this->InverseDiagonal[i] * Row<K>(r, columns).squaredNorm();
    });

  const double reference = std::max(scale, start);
  this->Work.Resize(n, columns, 1);
  this->Work.Reference[0] = reference > 0.0 ? reference : 1.0;
  return ConjugateGradients<K, ProjectedSystem>(
    projected, this->Residual, this->Work, this->Parallel)
    .Solve(x, limits, progress);
}

} // namespace SurfaceDiffusion
