// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "DistributedSolver.h"

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
#include <vector>

using namespace SurfaceDiffusion;

namespace
{

/// Null where the processes do not talk by MPI.
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
  HypreSolver(std::shared_ptr<const PiecePartition> partition, bool multigrid)
    : Pieces(std::move(partition))
    , Comm(*Communicator(this->Pieces->GetProcesses()))
    , IsMultigrid(multigrid)
  {
    HYPRE_Init();
  }
  ~HypreSolver() override { this->Clear(); }
  HypreSolver(const HypreSolver&) = delete;
  void operator=(const HypreSolver&) = delete;

  void SetMatrix(const SparseMatrix& matrix, const Monitor& monitor) override
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
    monitor.Report(1.0);
  }

  SolveReport Solve(const Values& b, Values& x, const Monitor& monitor) override
  {
    SolveReport report;
    for (Eigen::Index k = 0; k < b.cols(); ++k)
    {
      this->SolveColumn(b, x, k, report);
      monitor.Report((k + 1.0) / b.cols());
    }
    this->Pieces->TakeFromOwners(x);
    return report;
  }

private:
  struct Column
  {
    HYPRE_IJVector IJ = nullptr;
    HYPRE_ParVector Vector = nullptr;
  };

  /// Rows of the whole: each process has those of the vertices that it owns, one after the other.
  void NumberRows(Index n)
  {
    Index owned = 0;
    for (Index i = 0; i < n; ++i)
    {
      owned += this->Pieces->Owns(i) ? 1 : 0;
    }
    const Processes& processes = this->Pieces->GetProcesses();
    const std::vector<double> counts = processes.GatherAll({ static_cast<double>(owned) });
    this->First = 0;
    for (int p = 0; p < processes.Rank(); ++p)
    {
      this->First += static_cast<HYPRE_BigInt>(counts[p]);
    }
    this->Last = this->First + owned - 1;
    Values numbers(n, 1);
    HYPRE_BigInt next = this->First;
    for (Index i = 0; i < n; ++i)
    {
      numbers(i, 0) = this->Pieces->Owns(i) ? static_cast<double>(next++) : -1.0;
    }
    this->Pieces->TakeFromOwners(numbers);
    this->Rows.resize(n);
    this->OwnRows.clear();
    this->OwnVertices.clear();
    for (Index i = 0; i < n; ++i)
    {
      this->Rows[i] = static_cast<HYPRE_BigInt>(numbers(i, 0));
      if (this->Pieces->Owns(i))
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
    if (this->IsMultigrid)
    {
      HYPRE_BoomerAMGCreate(&this->Multigrid);
      HYPRE_BoomerAMGSetTol(this->Multigrid, 0.0);
      HYPRE_BoomerAMGSetMaxIter(this->Multigrid, 1);
      HYPRE_BoomerAMGSetCoarsenType(this->Multigrid, 10); // HMIS
      HYPRE_BoomerAMGSetRelaxType(this->Multigrid, 6); // symmetric: as conjugate gradients need
      HYPRE_BoomerAMGSetInterpType(this->Multigrid, 6);
      HYPRE_BoomerAMGSetPMaxElmts(this->Multigrid, 4);
      HYPRE_PCGSetPrecond(this->Krylov,
        reinterpret_cast<HYPRE_PtrToSolverFcn>(HYPRE_BoomerAMGSolve),
        reinterpret_cast<HYPRE_PtrToSolverFcn>(HYPRE_BoomerAMGSetup), this->Multigrid);
    }
    else
    {
      HYPRE_PCGSetPrecond(this->Krylov,
        reinterpret_cast<HYPRE_PtrToSolverFcn>(HYPRE_ParCSRDiagScale),
        reinterpret_cast<HYPRE_PtrToSolverFcn>(HYPRE_ParCSRDiagScaleSetup), AsSolver(this->Matrix));
    }
    HYPRE_ParCSRPCGSetup(this->Krylov, this->Matrix, this->B.Vector, this->X.Vector);
  }

  void SolveColumn(const Values& b, Values& x, Eigen::Index k, SolveReport& report)
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
    const auto owned = static_cast<HYPRE_Int>(this->OwnRows.size());
    for (HYPRE_Int i = 0; i < owned; ++i)
    {
      this->Numbers[i] = x(this->OwnVertices[i], k);
    }
    HYPRE_IJVectorInitialize(this->X.IJ);
    HYPRE_IJVectorSetValues(this->X.IJ, owned, this->OwnRows.data(), this->Numbers.data());
    HYPRE_IJVectorAssemble(this->X.IJ);

    // hypre stops by the norm of its preconditioner: what is asked for is that of the diagonal.
    double tolerance = this->Limits.Tolerance;
    int iterations = 0;
    double residual = this->Residual();
    for (int attempt = 0; attempt < 8 && residual > this->Limits.Tolerance; ++attempt)
    {
      HYPRE_PCGSetTol(this->Krylov, tolerance);
      HYPRE_PCGSetMaxIter(
        this->Krylov, std::max(1, this->Limits.MaximumNumberOfIterations - iterations));
      HYPRE_ParCSRPCGSolve(this->Krylov, this->Matrix, this->B.Vector, this->X.Vector);
      HYPRE_ClearAllErrors(); // not to converge is told below
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
    HYPRE_IJVectorGetValues(this->X.IJ, owned, this->OwnRows.data(), this->Numbers.data());
    for (HYPRE_Int i = 0; i < owned; ++i)
    {
      x(this->OwnVertices[i], k) = this->Numbers[i];
    }
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

  const std::shared_ptr<const PiecePartition> Pieces;
  const MPI_Comm Comm;
  const bool IsMultigrid;
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

bool HasDistributedSolver(const Processes& processes)
{
  return Communicator(processes) != nullptr;
}

std::unique_ptr<LinearSolver> MakeDistributedSolver(
  std::shared_ptr<const PiecePartition> partition, bool multigrid)
{
  return std::make_unique<HypreSolver>(std::move(partition), multigrid);
}

#else

bool HasDistributedSolver(const Processes&)
{
  return false;
}

std::unique_ptr<SurfaceDiffusion::LinearSolver> MakeDistributedSolver(
  std::shared_ptr<const PiecePartition>, bool)
{
  return nullptr;
}

#endif
