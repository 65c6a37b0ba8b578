// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// CompareLibraries [<largest level>] compares the linear solvers of this library with those of
// others, on backward Euler steps of c h^2 from noise, with one and with three columns. It prints a
// line of JSON per size, c, number of columns and solver: CPU milliseconds of the set-up, of one
// solve to a relative residual of 1e-10, and that residual, in the norm of SolveReport; and, for
// the solvers of this library, whether Automatic selects it for 1 and for 10 steps. All solvers
// start from the same data and run on one thread. The sizes are those of SurfaceOfLevel(), by
// default up to level 2.

#include "HeatSystem.h"
#include "ProcessTime.h"

#include "Core/Solvers/SolverChoice.h"

#include <Eigen/CholmodSupport>
#include <Eigen/SparseCholesky>

#include <HYPRE.h>
#include <HYPRE_IJ_mv.h>
#include <HYPRE_krylov.h>
#include <HYPRE_parcsr_ls.h>

#ifdef HAVE_AMGCL
#include <amgcl/adapter/zero_copy.hpp>
#include <amgcl/amg.hpp>
#include <amgcl/backend/builtin.hpp>
#include <amgcl/coarsening/smoothed_aggregation.hpp>
#include <amgcl/make_solver.hpp>
#include <amgcl/relaxation/gauss_seidel.hpp>
#include <amgcl/solver/cg.hpp>
#endif

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>
#include <string>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

constexpr double Tolerance = 1e-10;
constexpr int ManyIterations = 100000;

/// A solver of this or of another library.
class Candidate
{
public:
  virtual ~Candidate() = default;
  virtual void SetUp(const SparseMatrix& matrix) = 0;
  /// x: the start of an iteration on entry, the solution on return.
  virtual void Solve(const Values& b, Values& x) = 0;
};

class Ours : public Candidate
{
public:
  explicit Ours(SolverMethod method)
    : Solver(MakeSolver(method))
  {
    this->Solver->SetLimits({ Tolerance, ManyIterations });
  }

  void SetUp(const SparseMatrix& matrix) override { this->Solver->SetMatrix(matrix); }
  void Solve(const Values& b, Values& x) override { this->Solver->Solve(b, x); }

private:
  std::unique_ptr<LinearSolver> Solver;
};

class EigenCholesky : public Candidate
{
public:
  void SetUp(const SparseMatrix& matrix) override { this->Factor.compute(matrix); }
  void Solve(const Values& b, Values& x) override { x = this->Factor.solve(b); }

private:
  Eigen::SimplicialLDLT<SparseMatrix> Factor;
};

class Cholmod : public Candidate
{
public:
  explicit Cholmod(int ordering)
  {
    this->Factor.cholmod().nmethods = 1;
    this->Factor.cholmod().method[0].ordering = ordering;
  }

  void SetUp(const SparseMatrix& matrix) override { this->Factor.compute(matrix); }
  void Solve(const Values& b, Values& x) override
  {
    x = this->Factor.solve(Eigen::MatrixXd(b)); // which takes columns, not rows
  }

private:
  Eigen::CholmodDecomposition<SparseMatrix> Factor;
};

/// Conjugate gradients with a cycle of BoomerAMG, set up as for two-dimensional diffusion.
class Hypre : public Candidate
{
public:
  ~Hypre() override
  {
    HYPRE_ParCSRPCGDestroy(this->Krylov);
    HYPRE_BoomerAMGDestroy(this->Multigrid);
    HYPRE_IJVectorDestroy(this->B);
    HYPRE_IJVectorDestroy(this->X);
    HYPRE_IJMatrixDestroy(this->A);
  }

  void SetUp(const SparseMatrix& matrix) override
  {
    const int last = static_cast<int>(matrix.rows()) - 1;
    this->Rows.resize(static_cast<std::size_t>(matrix.rows()));
    std::iota(this->Rows.begin(), this->Rows.end(), 0);
    std::vector<HYPRE_Int> counts(this->Rows.size());
    for (std::size_t i = 0; i < counts.size(); ++i)
    {
      counts[i] = matrix.outerIndexPtr()[i + 1] - matrix.outerIndexPtr()[i];
    }
    HYPRE_IJMatrixCreate(MPI_COMM_SELF, 0, last, 0, last, &this->A);
    HYPRE_IJMatrixSetObjectType(this->A, HYPRE_PARCSR);
    HYPRE_IJMatrixSetRowSizes(this->A, counts.data());
    HYPRE_IJMatrixInitialize(this->A);
    HYPRE_IJMatrixSetValues(this->A, last + 1, counts.data(), this->Rows.data(),
      matrix.innerIndexPtr(), matrix.valuePtr()); // symmetric: columns are rows
    HYPRE_IJMatrixAssemble(this->A);
    HYPRE_IJMatrixGetObject(this->A, reinterpret_cast<void**>(&this->Matrix));
    for (HYPRE_IJVector* vector : { &this->B, &this->X })
    {
      HYPRE_IJVectorCreate(MPI_COMM_SELF, 0, last, vector);
      HYPRE_IJVectorSetObjectType(*vector, HYPRE_PARCSR);
      HYPRE_IJVectorInitialize(*vector);
      HYPRE_IJVectorAssemble(*vector);
    }
    HYPRE_BoomerAMGCreate(&this->Multigrid);
    HYPRE_BoomerAMGSetTol(this->Multigrid, 0.0);
    HYPRE_BoomerAMGSetMaxIter(this->Multigrid, 1);
    HYPRE_BoomerAMGSetCoarsenType(this->Multigrid, 10); // HMIS
    HYPRE_BoomerAMGSetInterpType(this->Multigrid, 6); // extended+i
    HYPRE_BoomerAMGSetPMaxElmts(this->Multigrid, 4);
    HYPRE_BoomerAMGSetRelaxType(this->Multigrid, 6); // symmetric Gauss-Seidel
    HYPRE_ParCSRPCGCreate(MPI_COMM_SELF, &this->Krylov);
    HYPRE_PCGSetTwoNorm(this->Krylov, 1);
    HYPRE_PCGSetTol(this->Krylov, Tolerance);
    HYPRE_PCGSetMaxIter(this->Krylov, ManyIterations);
    HYPRE_PCGSetPrecond(this->Krylov, reinterpret_cast<HYPRE_PtrToSolverFcn>(HYPRE_BoomerAMGSolve),
      reinterpret_cast<HYPRE_PtrToSolverFcn>(HYPRE_BoomerAMGSetup), this->Multigrid);
    HYPRE_ParCSRPCGSetup(this->Krylov, this->Matrix, this->Vector(this->B), this->Vector(this->X));
  }

  void Solve(const Values& b, Values& x) override
  {
    const auto count = static_cast<HYPRE_Int>(b.rows());
    for (Eigen::Index k = 0; k < b.cols(); ++k)
    {
      Eigen::VectorXd right = b.col(k);
      Eigen::VectorXd left = x.col(k);
      HYPRE_IJVectorSetValues(this->B, count, this->Rows.data(), right.data());
      HYPRE_IJVectorSetValues(this->X, count, this->Rows.data(), left.data());
      HYPRE_ParCSRPCGSolve(
        this->Krylov, this->Matrix, this->Vector(this->B), this->Vector(this->X));
      HYPRE_IJVectorGetValues(this->X, count, this->Rows.data(), left.data());
      x.col(k) = left;
    }
  }

private:
  static HYPRE_ParVector Vector(HYPRE_IJVector vector)
  {
    void* object = nullptr;
    HYPRE_IJVectorGetObject(vector, &object);
    return static_cast<HYPRE_ParVector>(object);
  }

  std::vector<HYPRE_BigInt> Rows;
  HYPRE_IJMatrix A = nullptr;
  HYPRE_ParCSRMatrix Matrix = nullptr;
  HYPRE_IJVector B = nullptr, X = nullptr;
  HYPRE_Solver Multigrid = nullptr;
  HYPRE_Solver Krylov = nullptr;
};

#ifdef HAVE_AMGCL
/// Conjugate gradients with a cycle of smoothed aggregation.
class Amgcl : public Candidate
{
public:
  void SetUp(const SparseMatrix& matrix) override
  {
    const auto n = static_cast<std::size_t>(matrix.rows());
    const auto entries = static_cast<std::size_t>(matrix.nonZeros());
    this->Begin.assign(matrix.outerIndexPtr(), matrix.outerIndexPtr() + n + 1);
    this->Columns.assign(matrix.innerIndexPtr(), matrix.innerIndexPtr() + entries);
    this->Entries.assign(matrix.valuePtr(), matrix.valuePtr() + entries);
    typename Solver::params parameters;
    parameters.solver.tol = Tolerance;
    parameters.solver.maxiter = ManyIterations;
    this->Iteration = std::make_unique<Solver>(
      amgcl::adapter::zero_copy(n, this->Begin.data(), this->Columns.data(), this->Entries.data()),
      parameters);
  }

  void Solve(const Values& b, Values& x) override
  {
    const auto n = static_cast<std::size_t>(b.rows());
    for (Eigen::Index k = 0; k < b.cols(); ++k)
    {
      std::vector<double> right(n), left(n);
      Eigen::Map<Eigen::VectorXd>(right.data(), b.rows()) = b.col(k);
      Eigen::Map<Eigen::VectorXd>(left.data(), b.rows()) = x.col(k);
      (*this->Iteration)(right, left);
      x.col(k) = Eigen::Map<const Eigen::VectorXd>(left.data(), b.rows());
    }
  }

private:
  using Backend = amgcl::backend::builtin<double>;
  using Solver = amgcl::make_solver<
    amgcl::amg<Backend, amgcl::coarsening::smoothed_aggregation, amgcl::relaxation::gauss_seidel>,
    amgcl::solver::cg<Backend>>;
  std::vector<std::ptrdiff_t> Begin, Columns; ///< the integers of AMGCL
  std::vector<double> Entries;
  std::unique_ptr<Solver> Iteration;
};
#endif

double Residual(const SparseMatrix& matrix, const Values& b, const Values& x)
{
  const Vector diagonal = matrix.diagonal();
  const Values r = b - matrix * x;
  double largest = 0.0;
  for (Eigen::Index k = 0; k < b.cols(); ++k)
  {
    const auto square = [&](const Values& v)
    { return (v.col(k).array().square() / diagonal.array()).sum(); };
    largest = std::max(largest, std::sqrt(square(r) / square(b)));
  }
  return largest;
}

void Measure(const char* name, const HeatSystem& system, double number, Eigen::Index columns,
  const std::function<std::unique_ptr<Candidate>()>& make, const char* selected = "")
{
  const Values u = Noise(*system.Mesh, columns);
  const Values b = system.RightHandSide(u);
  double setUp = std::numeric_limits<double>::infinity();
  double solve = setUp;
  double residual = 0.0;
  // The minimum of short runs, since other work on the machine only adds time.
  for (int repetition = 0; repetition == 0 || (repetition < 3 && setUp + solve < 1.0); ++repetition)
  {
    const auto candidate = make();
    double start = Now();
    candidate->SetUp(system.Matrix);
    setUp = std::min(setUp, Now() - start);
    Values x = u;
    start = Now();
    candidate->Solve(b, x);
    solve = std::min(solve, Now() - start);
    residual = Residual(system.Matrix, b, x);
  }
  std::printf("{\"vertices\": %d, \"c\": %g, \"columns\": %d, \"solver\": \"%s\", "
              "\"setup\": %.4g, \"solve\": %.4g, \"residual\": %.2g%s}\n",
    system.Mesh->NumberOfVertices(), number, static_cast<int>(columns), name, 1e3 * setUp,
    1e3 * solve, residual, selected);
  std::fflush(stdout);
}

void Compare(HeatSystem& system, double number, Eigen::Index columns)
{
  system.SetDiffusionNumber(number);
  const auto selected = [&](int steps)
  {
    SolverTask task;
    task.NumberOfVertices = system.Mesh->NumberOfVertices();
    task.DiffusionNumber = number;
    task.NumberOfSolves = steps;
    task.NumberOfColumns = static_cast<int>(columns);
    return ChooseSolver(SolverMethod::Automatic, task).Method;
  };
  const auto ours = [&](const char* name, SolverMethod method)
  {
    const std::string isSelected = std::string(", \"selected1\": ") +
      (selected(1) == method ? "true" : "false") +
      ", \"selected10\": " + (selected(10) == method ? "true" : "false");
    Measure(
      name, system, number, columns, [method] { return std::make_unique<Ours>(method); },
      isSelected.c_str());
  };
  ours("ours, Direct", SolverMethod::Direct);
  ours("ours, ConjugateGradient", SolverMethod::ConjugateGradient);
  ours("ours, Multigrid", SolverMethod::Multigrid);
  Measure("Eigen SimplicialLDLT", system, number, columns,
    [] { return std::make_unique<EigenCholesky>(); });
  Measure(
    "CHOLMOD, AMD", system, number, columns, [] { return std::make_unique<Cholmod>(CHOLMOD_AMD); });
  Measure("CHOLMOD, METIS", system, number, columns,
    [] { return std::make_unique<Cholmod>(CHOLMOD_METIS); });
  Measure(
    "hypre BoomerAMG + CG", system, number, columns, [] { return std::make_unique<Hypre>(); });
#ifdef HAVE_AMGCL
  Measure("AMGCL + CG", system, number, columns, [] { return std::make_unique<Amgcl>(); });
#endif
}

} // namespace

int main(int argc, char** argv)
{
  MPI_Init(&argc, &argv);
  HYPRE_Init();
  const int last = argc > 1 ? std::atoi(argv[1]) : 2;
  for (int level = 0; level <= last; ++level)
  {
    HeatSystem system(SurfaceOfLevel(level));
    for (const double number : { 1.0, 100.0, 1e4 })
    {
      for (const Eigen::Index columns : { 1, 3 })
      {
        Compare(system, number, columns);
      }
    }
  }
  HYPRE_Finalize();
  MPI_Finalize();
  return 0;
}
