// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/DistributedMultigrid.h"

#ifdef SURFACEDIFFUSION_USE_HYPRE

#include "vtkMPI.h"
#include "vtkMPICommunicator.h"
#include "vtkMultiProcessController.h"

#include <HYPRE.h>
#include <HYPRE_IJ_mv.h>
#include <HYPRE_krylov.h>
#include <HYPRE_parcsr_ls.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#endif

namespace SurfaceDiffusion
{

#ifdef SURFACEDIFFUSION_USE_HYPRE

namespace
{

/// Null unless the processes communicate by MPI.
MPI_Comm* Communicator(const Processes& processes)
{
  vtkMPICommunicator* const communicator = processes.Controller()
    ? vtkMPICommunicator::SafeDownCast(processes.Controller()->GetCommunicator())
    : nullptr;
  return communicator ? communicator->GetMPIComm()->GetHandle() : nullptr;
}

HYPRE_Solver AsSolver(HYPRE_ParCSRMatrix matrix)
{
  return reinterpret_cast<HYPRE_Solver>(matrix);
}

class HypreSolver : public LinearSolver
{
public:
  explicit HypreSolver(std::shared_ptr<const DomainDecomposition> decomposition)
    : Domain(std::move(decomposition))
    , Comm(*Communicator(this->Domain->GetProcesses()))
  {
    HYPRE_Init();
  }
  ~HypreSolver() override { this->Clear(); }
  HypreSolver(const HypreSolver&) = delete;
  void operator=(const HypreSolver&) = delete;

  void SetMatrix(const SparseMatrix& matrix, const ProgressMonitor& progress) override
  {
    this->Clear();
    const auto n = static_cast<Index>(matrix.rows());
    this->NumberRows(n);
    HYPRE_IJMatrixCreate(this->Comm, this->First, this->Last, this->First, this->Last, &this->A);
    HYPRE_IJMatrixSetObjectType(this->A, HYPRE_PARCSR);
    HYPRE_IJMatrixInitialize(this->A);
    std::vector<HYPRE_BigInt> columns;
    for (Index i = 0; i < n; ++i)
    {
      const Index begin = matrix.outerIndexPtr()[i];
      HYPRE_Int count = matrix.outerIndexPtr()[i + 1] - begin;
      columns.clear();
      for (HYPRE_Int slot = 0; slot < count; ++slot)
      {
        columns.push_back(this->Rows[matrix.innerIndexPtr()[begin + slot]]);
      }
      HYPRE_IJMatrixAddToValues(
        this->A, 1, &count, &this->Rows[i], columns.data(), matrix.valuePtr() + begin);
    }
    HYPRE_IJMatrixAssemble(this->A);
    HYPRE_IJMatrixGetObject(this->A, reinterpret_cast<void**>(&this->Matrix));
    for (Column* column : { &this->B, &this->X, &this->R, &this->Z })
    {
      HYPRE_IJVectorCreate(this->Comm, this->First, this->Last, &column->IJ);
      HYPRE_IJVectorSetObjectType(column->IJ, HYPRE_PARCSR);
      HYPRE_IJVectorInitialize(column->IJ);
      HYPRE_IJVectorAssemble(column->IJ);
      HYPRE_IJVectorGetObject(column->IJ, reinterpret_cast<void**>(&column->Vector));
    }
    this->MakeSolver();
    progress.Report(1.0);
  }

  SolveReport Solve(const Values& b, Values& x, const ProgressMonitor& progress) override
  {
    SolveReport report;
    for (Eigen::Index k = 0; k < b.cols(); ++k)
    {
      this->SolveColumn(b, x, k, report, progress.Part(1.0 * k / b.cols(), (k + 1.0) / b.cols()));
      progress.Report((k + 1.0) / b.cols());
    }
    this->Domain->UpdateFromOwners(x);
    return report;
  }

  void Precondition(const Values& r, Values& z) override
  {
    for (Eigen::Index k = 0; k < r.cols(); ++k)
    {
      this->SetOwned(this->R, r, k);
      HYPRE_ParVectorSetConstantValues(this->Z.Vector, 0.0);
      this->ApplyPreconditioner(this->R.Vector, this->Z.Vector);
      this->GetOwned(this->Z, z, k);
    }
    this->Domain->UpdateFromOwners(z);
  }

private:
  struct Column
  {
    HYPRE_IJVector IJ = nullptr;
    HYPRE_ParVector Vector = nullptr;
  };

  /// Numbers the rows of the surface's matrix: each process has consecutive ones, of the vertices
  /// that it owns.
  void NumberRows(Index n)
  {
    Index owned = 0;
    for (Index i = 0; i < n; ++i)
    {
      owned += this->Domain->Owns(i) ? 1 : 0;
    }
    const Processes& processes = this->Domain->GetProcesses();
    const std::vector<Index> counts = processes.GatherAll({ owned });
    this->First = std::accumulate(
      counts.begin(), counts.begin() + processes.Rank(), static_cast<HYPRE_BigInt>(0));
    this->Last = this->First + owned - 1;
    std::vector<vtkIdType> numbers(n, -1);
    vtkIdType next = this->First;
    for (Index i = 0; i < n; ++i)
    {
      if (this->Domain->Owns(i))
      {
        numbers[i] = next++;
      }
    }
    this->Domain->UpdateFromOwners(numbers);
    this->Rows.resize(n);
    this->OwnRows.clear();
    this->OwnVertices.clear();
    for (Index i = 0; i < n; ++i)
    {
      this->Rows[i] = static_cast<HYPRE_BigInt>(numbers[i]);
      if (this->Domain->Owns(i))
      {
        this->OwnRows.push_back(this->Rows[i]);
        this->OwnVertices.push_back(i);
      }
    }
    this->Numbers.resize(n);
  }

  void MakeSolver()
  {
    HYPRE_ParCSRPCGCreate(this->Comm, &this->Krylov);
    HYPRE_BoomerAMGCreate(&this->Multigrid);
    HYPRE_BoomerAMGSetTol(this->Multigrid, 0.0);
    HYPRE_BoomerAMGSetMaxIter(this->Multigrid, 1);
    HYPRE_BoomerAMGSetCoarsenType(this->Multigrid, 10); // HMIS
    HYPRE_BoomerAMGSetRelaxType(this->Multigrid, 6); // symmetric, as conjugate gradients need
    HYPRE_BoomerAMGSetInterpType(this->Multigrid, 6);
    HYPRE_BoomerAMGSetPMaxElmts(this->Multigrid, 4);
    HYPRE_BoomerAMGSetup(this->Multigrid, this->Matrix, this->B.Vector, this->X.Vector);
    const auto nothing = [](HYPRE_Solver, HYPRE_Matrix, HYPRE_Vector, HYPRE_Vector)
    { return HYPRE_Int(0); };
    const auto precondition = [](HYPRE_Solver self, HYPRE_Matrix, HYPRE_Vector b, HYPRE_Vector x)
    {
      return reinterpret_cast<HypreSolver*>(self)->Iterate(
        reinterpret_cast<HYPRE_ParVector>(b), reinterpret_cast<HYPRE_ParVector>(x));
    };
    HYPRE_PCGSetPrecond(this->Krylov, precondition, nothing, reinterpret_cast<HYPRE_Solver>(this));
    HYPRE_ParCSRPCGSetup(this->Krylov, this->Matrix, this->B.Vector, this->X.Vector);
  }

  /// hypre calls it as the preconditioner in each iteration. All processes stop together.
  HYPRE_Int Iterate(HYPRE_ParVector r, HYPRE_ParVector z)
  {
    constexpr int iterationsPerCheck = 16;
    if (++this->Iterations % iterationsPerCheck == 0)
    {
      this->CurrentProgress.Report(
        1.0 - 1.0 / (1.0 + 0.01 * this->Iterations)); // their number is unknown
      this->IsAborted = this->Domain->IsAborted();
    }
    if (this->IsAborted)
    {
      return HYPRE_ParVectorSetConstantValues(z, 0.0); // ends the iteration
    }
    return this->ApplyPreconditioner(r, z);
  }

  HYPRE_Int ApplyPreconditioner(HYPRE_ParVector r, HYPRE_ParVector z)
  {
    return HYPRE_BoomerAMGSolve(this->Multigrid, this->Matrix, r, z);
  }

  void SetOwned(const Column& column, const Values& values, Eigen::Index k)
  {
    for (std::size_t i = 0; i < this->OwnVertices.size(); ++i)
    {
      this->Numbers[i] = values(this->OwnVertices[i], k);
    }
    HYPRE_IJVectorInitialize(column.IJ);
    HYPRE_IJVectorSetValues(column.IJ, static_cast<HYPRE_Int>(this->OwnRows.size()),
      this->OwnRows.data(), this->Numbers.data());
    HYPRE_IJVectorAssemble(column.IJ);
  }

  void GetOwned(const Column& column, Values& values, Eigen::Index k)
  {
    HYPRE_IJVectorGetValues(column.IJ, static_cast<HYPRE_Int>(this->OwnRows.size()),
      this->OwnRows.data(), this->Numbers.data());
    for (std::size_t i = 0; i < this->OwnVertices.size(); ++i)
    {
      values(this->OwnVertices[i], k) = this->Numbers[i];
    }
  }

  void SolveColumn(const Values& b, Values& x, Eigen::Index k, SolveReport& report,
    const ProgressMonitor& progress)
  {
    for (std::size_t i = 0; i < this->Rows.size(); ++i)
    {
      this->Numbers[i] = b(static_cast<Eigen::Index>(i), k);
    }
    HYPRE_IJVectorInitialize(this->B.IJ);
    HYPRE_ParVectorSetConstantValues(this->B.Vector, 0.0);
    HYPRE_IJVectorAddToValues(this->B.IJ, static_cast<HYPRE_Int>(this->Rows.size()),
      this->Rows.data(), this->Numbers.data());
    HYPRE_IJVectorAssemble(this->B.IJ);
    this->SetOwned(this->X, x, k);

    // hypre measures the residual in the norm of its preconditioner. The tolerance is meant in that
    // of the diagonal, so hypre is called again with a smaller one if need be.
    double tolerance = this->Limits.Tolerance;
    int iterations = 0;
    double residual = this->Residual();
    this->CurrentProgress = progress;
    this->Iterations = 0;
    this->IsAborted = false;
    for (int attempt = 0; attempt < 8 && residual > this->Limits.Tolerance; ++attempt)
    {
      HYPRE_PCGSetTol(this->Krylov, tolerance);
      HYPRE_PCGSetMaxIter(
        this->Krylov, std::max(1, this->Limits.MaximumNumberOfIterations - iterations));
      HYPRE_ParCSRPCGSolve(this->Krylov, this->Matrix, this->B.Vector, this->X.Vector);
      HYPRE_ClearAllErrors(); // reported below if it has not converged
      if (this->IsAborted)
      {
        throw Aborted();
      }
      HYPRE_Int done = 0;
      HYPRE_PCGGetNumIterations(this->Krylov, &done);
      iterations += done;
      residual = this->Residual();
      if (iterations >= this->Limits.MaximumNumberOfIterations)
      {
        break;
      }
      tolerance *= 0.1;
    }
    if (!std::isfinite(residual))
    {
      throw std::runtime_error("the linear system has no finite solution");
    }
    this->GetOwned(this->X, x, k);
    report.Iterations = std::max(report.Iterations, iterations);
    report.Residual = std::max(report.Residual, residual);
    report.Converged = report.Converged && residual <= this->Limits.Tolerance;
  }

  /// |b - A x| / |b| in the norm of diag(A)^-1.
  double Residual()
  {
    const auto square = [&](HYPRE_ParVector vector)
    {
      double product = 0.0;
      HYPRE_ParVectorSetConstantValues(this->Z.Vector, 0.0);
      HYPRE_ParCSRDiagScale(AsSolver(this->Matrix), this->Matrix, vector, this->Z.Vector);
      HYPRE_ParVectorInnerProd(vector, this->Z.Vector, &product);
      return product;
    };
    HYPRE_ParVectorCopy(this->B.Vector, this->R.Vector);
    HYPRE_ParCSRMatrixMatvec(-1.0, this->Matrix, this->X.Vector, 1.0, this->R.Vector);
    const double scale = square(this->B.Vector);
    return std::sqrt(square(this->R.Vector) / (scale > 0.0 ? scale : 1.0));
  }

  void Clear()
  {
    if (this->Krylov)
    {
      HYPRE_ParCSRPCGDestroy(this->Krylov);
      this->Krylov = nullptr;
    }
    if (this->Multigrid)
    {
      HYPRE_BoomerAMGDestroy(this->Multigrid);
      this->Multigrid = nullptr;
    }
    for (Column* column : { &this->B, &this->X, &this->R, &this->Z })
    {
      if (column->IJ)
      {
        HYPRE_IJVectorDestroy(column->IJ);
        *column = Column();
      }
    }
    if (this->A)
    {
      HYPRE_IJMatrixDestroy(this->A);
      this->A = nullptr;
    }
  }

  const std::shared_ptr<const DomainDecomposition> Domain;
  const MPI_Comm Comm;
  bool IsAborted = false;
  int Iterations = 0;
  ProgressMonitor CurrentProgress; ///< of the column that is solved
  HYPRE_BigInt First = 0;
  HYPRE_BigInt Last = -1;
  std::vector<HYPRE_BigInt> Rows; ///< per vertex
  std::vector<HYPRE_BigInt> OwnRows; ///< per vertex owned
  std::vector<Index> OwnVertices;
  std::vector<double> Numbers;
  HYPRE_IJMatrix A = nullptr;
  HYPRE_ParCSRMatrix Matrix = nullptr;
  Column B, X, R, Z;
  HYPRE_Solver Krylov = nullptr;
  HYPRE_Solver Multigrid = nullptr;
};

} // namespace

bool HasDistributedMultigrid(const Processes& processes)
{
  return Communicator(processes) != nullptr;
}

std::unique_ptr<LinearSolver> MakeDistributedMultigridSolver(
  std::shared_ptr<const DomainDecomposition> decomposition)
{
  return std::make_unique<HypreSolver>(std::move(decomposition));
}

#else

bool HasDistributedMultigrid(const Processes&)
{
  return false;
}

std::unique_ptr<LinearSolver> MakeDistributedMultigridSolver(
  std::shared_ptr<const DomainDecomposition>)
{
  return nullptr;
}

#endif

} // namespace SurfaceDiffusion
