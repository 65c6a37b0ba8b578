// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/MumfordShah.h"

#include "Core/Models/InitialState.h"
#include "Core/Operators/CotanWeights.h"
#include "Core/Operators/DirichletEnergy.h"
#include "Core/Operators/SparsePattern.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// Stages before the last one end at this multiple of StopTolerance. Measured on scans and strips:
/// the result is the same, after a tenth of the steps.
constexpr double EarlyTolerance = 100.0;

/// -K u at vertex i and column k, from differences along edges, with the stiffness matrix K whose
/// off-diagonal entries are those of the matrix.
double Flow(const SparseMatrix& matrix, const Values& u, Index i, Eigen::Index k)
{
  double flow = 0.0;
  for (Index slot = matrix.outerIndexPtr()[i]; slot < matrix.outerIndexPtr()[i + 1]; ++slot)
  {
    flow -= matrix.valuePtr()[slot] * (u(matrix.innerIndexPtr()[slot], k) - u(i, k));
  }
  return flow;
}

} // namespace

MumfordShah::MumfordShah(std::shared_ptr<const Assembler> assembler, CornerWeights coefficients,
  PointData data, const Settings& settings, std::shared_ptr<LinearSolver> smoothing,
  std::shared_ptr<LinearSolver> edges, const ParallelFor& parallel, Flags cuts)
  : StateModel(data.Start)
  , Assembly(std::move(assembler))
  , Coefficients(std::move(coefficients))
  , Isotropic(CotanWeights(this->Assembly->Mesh(), parallel))
  , Data(std::move(data))
  , Fit(this->Data, { settings.Fidelity })
  , Options(settings)
  , Parallel(parallel)
  , Smoothing(this->Assembly, std::move(smoothing), parallel)
  , EdgeSystem(this->Assembly, std::move(edges), parallel)
  , Conserved(this->Assembly->Mesh(), this->Data, this->Fit.IsPresent(), parallel)
  , Cuts(std::move(cuts))
  , V(Values::Ones(this->U.rows(), 1))
  , OfTriangles(this->Coefficients.rows())
  , Diagonal(this->U.rows())
  , Change(this->U.rows(), this->U.cols())
  , RightHandSide(this->U.rows(), this->U.cols())
  , EdgeChange(this->U.rows(), 1)
  , EdgeRightHandSide(this->U.rows(), 1)
{
  if (!settings.ValueScales.empty())
  {
    const std::vector<Index>& begin = this->Assembly->Mesh().ComponentsBegin();
    this->Scales.resize(this->U.rows());
    for (std::size_t c = 0; c < settings.ValueScales.size(); ++c)
    {
      this->Scales.segment(begin[c], begin[c + 1] - begin[c]).setConstant(settings.ValueScales[c]);
    }
  }
  FixFreeComponents(this->Assembly->Mesh(), this->Data, settings.Fidelity);
  if (this->Data.Fixed.any())
  {
    this->NoChange = Values::Zero(this->U.rows(), this->U.cols());
  }
  if (this->Cuts.any())
  {
    this->NoEdgeChange = Values::Zero(this->U.rows(), 1);
    this->V.col(0).array() *= (!this->Cuts).cast<double>();
  }
  this->SquareGradients();
  this->CurrentEnergy = this->MeasureEnergy();
}

StepReport MumfordShah::Advance(const ProgressMonitor& progress)
{
  if (this->IsSettled && !this->IsLastStage())
  {
    ++this->Stage;
    this->SquareGradients();
    this->CurrentEnergy = this->MeasureEnergy();
  }
  StepReport report;
  this->SmoothData(report, progress.Part(0.0, 0.5));
  this->FindEdges(report, progress.Part(0.5, 1.0));
  const double before = this->CurrentEnergy;
  this->CurrentEnergy = this->MeasureEnergy();
  const double tolerance =
    this->Options.StopTolerance * (this->IsLastStage() ? 1.0 : EarlyTolerance);
  this->IsSettled = before - this->CurrentEnergy <= tolerance * this->CurrentEnergy;
  return report;
}

/// (lambda M chi + K(w)) u = lambda M chi f.
void MumfordShah::SmoothData(StepReport& report, const ProgressMonitor& progress)
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  ForEach(this->Parallel, mesh.NumberOfTriangles(),
    [&](Index t) { this->OfTriangles[t] = this->Weight(t); });
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      this->Diagonal[i] = mesh.ControlAreas()[i] * this->Fit.Weight(i);
      if (this->Data.Fixed[i])
      {
        this->U.row(i) = this->Data.Start.row(i);
      }
    });
  this->Smoothing.Assemble(this->Diagonal, 1.0, this->Coefficients, this->OfTriangles.data());
  const SparseMatrix& matrix = this->Smoothing.GetMatrix();
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      const double fidelity = this->Diagonal[i];
      for (Eigen::Index k = 0; k < this->U.cols(); ++k)
      {
        const double pull =
          fidelity > 0.0 ? fidelity * (this->Data.Given(i, k) - this->U(i, k)) : 0.0;
        this->RightHandSide(i, k) = this->Scale(i) * (pull + Flow(matrix, this->U, i, k));
      }
    });
  if (this->NoChange.size() > 0)
  {
    this->Smoothing.Constrain(this->Data.Fixed, this->NoChange);
  }
  this->Smoothing.SetUpSolver(progress.Part(0.0, 0.5));
  this->Change.setZero();
  this->Smoothing.Solve(this->RightHandSide, this->Change, report, progress.Part(0.5, 1.0));
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i) { this->U.row(i) += this->Change.row(i) / this->Scale(i); });
  this->Conserved.Restore(mesh, this->U, this->Parallel);
}

/// (Q + beta/(2 eps) M + 2 beta eps K) v = beta/(2 eps) M 1.
void MumfordShah::FindEdges(StepReport& report, const ProgressMonitor& progress)
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  const double eps = this->CurrentEdgeWidth();
  const double restoring = this->Options.EdgeCost / (2.0 * eps);
  this->SquareGradients();
  this->AssembleEdgeStiffness();
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      double q = 0.0;
      for (Index c = mesh.VertexCornersBegin()[i]; c < mesh.VertexCornersBegin()[i + 1]; ++c)
      {
        q += this->OfTriangles[mesh.VertexCorners()[c] / 3];
      }
      q /= 3.0;
      const double pull = restoring * mesh.ControlAreas()[i];
      this->Diagonal[i] = q + pull + this->EdgeStiffness[i];
      this->EdgeRightHandSide(i, 0) = pull * (1.0 - this->V(i, 0)) - q * this->V(i, 0);
    });
  this->EdgeSystem.SetDiagonal(this->Diagonal);
  const SparseMatrix& matrix = this->EdgeSystem.GetMatrix();
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i) { this->EdgeRightHandSide(i, 0) += Flow(matrix, this->V, i, 0); });
  if (this->NoEdgeChange.size() > 0)
  {
    this->EdgeSystem.Constrain(this->Cuts, this->NoEdgeChange);
  }
  this->EdgeSystem.SetUpSolver(progress.Part(0.0, 0.5));
  this->EdgeChange.setZero();
  this->EdgeSystem.Solve(
    this->EdgeRightHandSide, this->EdgeChange, report, progress.Part(0.5, 1.0));
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i) { this->V(i, 0) += this->EdgeChange(i, 0); });
}

/// 2 beta eps K, which is the same in all steps of a stage unless Dirichlet conditions changed it.
void MumfordShah::AssembleEdgeStiffness()
{
  if (this->EdgeStage == this->Stage && !this->Cuts.any())
  {
    return;
  }
  this->EdgeStage = -1; // an abort leaves neither this stage's matrix nor the last one's
  const Index n = this->Assembly->Mesh().NumberOfVertices();
  this->EdgeStiffness.setZero(n);
  this->EdgeSystem.Assemble(
    this->EdgeStiffness, 2.0 * this->Options.EdgeCost * this->CurrentEdgeWidth(), this->Isotropic);
  const SparseMatrix& matrix = this->EdgeSystem.GetMatrix();
  ForEach(this->Parallel, n, [&](Index i) { this->EdgeStiffness[i] = DiagonalEntry(matrix, i); });
  this->EdgeStage = this->Stage;
}

/// OfTriangles: int D grad u . grad u over triangle t, the sum of c_ij |u_i - u_j|^2 over its
/// edges, of u times its scale.
void MumfordShah::SquareGradients()
{
  const Triangles& corners = this->Assembly->Mesh().TriangleVertices();
  ForEach(this->Parallel, static_cast<Index>(this->OfTriangles.size()),
    [&](Index t)
    {
      const auto u = [&](int a) { return this->U.row(corners(t, a)); };
      const double sum = this->Coefficients(t, 0) * (u(1) - u(2)).squaredNorm() +
        this->Coefficients(t, 1) * (u(2) - u(0)).squaredNorm() +
        this->Coefficients(t, 2) * (u(0) - u(1)).squaredNorm();
      const double scale = this->Scale(corners(t, 0));
      this->OfTriangles[t] =
        std::max(scale * scale * sum, 0.0); // of obtuse triangles round-off may be left
    });
}

/// w_t.
double MumfordShah::Weight(Index t) const
{
  const Triangles& corners = this->Assembly->Mesh().TriangleVertices();
  const double v0 = this->V(corners(t, 0), 0);
  const double v1 = this->V(corners(t, 1), 0);
  const double v2 = this->V(corners(t, 2), 0);
  return this->Options.Leakage + (v0 * v0 + v1 * v1 + v2 * v2) / 3.0;
}

/// E, after SquareGradients().
double MumfordShah::MeasureEnergy() const
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  const double ofGradients = 0.5 *
    Sum(this->Parallel, mesh.NumberOfTriangles(),
      [&](Index t) { return this->Weight(t) * this->OfTriangles[t]; });
  return this->EdgeEnergy() + mesh.GetReduction().Sum(ofGradients + this->FidelityEnergy());
}

double MumfordShah::FidelityEnergy() const
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  if (this->Scales.size() == 0)
  {
    return this->Fit.Energy(mesh, this->U, this->Parallel);
  }
  return 0.5 *
    Sum(this->Parallel, mesh.NumberOfVertices(),
      [&](Index i)
      {
        const double weight = mesh.ControlAreas()[i] * this->Fit.Weight(i);
        return weight > 0.0 ? weight * this->Scales[i] * this->Scales[i] *
            (this->U.row(i) - this->Data.Given.row(i)).squaredNorm()
                            : 0.0;
      });
}

double MumfordShah::EdgeEnergy() const
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  const double eps = this->CurrentEdgeWidth();
  const double ofDistance = Sum(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      const double distance = 1.0 - this->V(i, 0);
      return mesh.ControlAreas()[i] * distance * distance;
    });
  const double slope = 2.0 * eps * DirichletEnergy(mesh, this->Isotropic, this->V, this->Parallel);
  return this->Options.EdgeCost * mesh.GetReduction().Sum(slope + ofDistance / (4.0 * eps));
}

DiffusionStep MumfordShah::Diffusion() const
{
  DiffusionStep step;
  step.TimeStep = InfiniteTime;
  step.Fidelity = this->Options.Fidelity;
  return step;
}

const CornerWeights& MumfordShah::DiffusionWeights(Eigen::Index /*column*/)
{
  this->Weighted.resize(this->Coefficients.rows(), 3);
  ForEach(this->Parallel, static_cast<Index>(this->Coefficients.rows()),
    [&](Index t) { this->Weighted.row(t) = this->Weight(t) * this->Coefficients.row(t); });
  return this->Weighted;
}

double MumfordShah::CurrentEdgeWidth() const
{
  return std::ldexp(this->Options.EdgeWidth, this->Options.NumberOfStages - 1 - this->Stage);
}

Vector MumfordShah::Edges() const
{
  return (1.0 - this->V.col(0).array()).max(0.0).min(1.0);
}

std::size_t MumfordShah::CheckpointSize() const
{
  return StateModel::CheckpointSize() + static_cast<std::size_t>(this->V.size()) + 3;
}

void MumfordShah::Save(double* checkpoint) const
{
  StateModel::Save(checkpoint);
  checkpoint += this->U.size();
  checkpoint = std::copy(this->V.data(), this->V.data() + this->V.size(), checkpoint);
  checkpoint[0] = this->Stage;
  checkpoint[1] = this->IsSettled ? 1.0 : 0.0;
  checkpoint[2] = this->CurrentEnergy;
}

void MumfordShah::Restore(const double* checkpoint)
{
  StateModel::Restore(checkpoint);
  checkpoint += this->U.size();
  std::copy(checkpoint, checkpoint + this->V.size(), this->V.data());
  checkpoint += this->V.size();
  this->Stage = static_cast<int>(checkpoint[0]);
  this->IsSettled = checkpoint[1] != 0.0;
  this->CurrentEnergy = checkpoint[2];
}

} // namespace SurfaceDiffusion
