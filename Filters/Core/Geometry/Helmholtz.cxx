// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/Helmholtz.h"

#include "Core/Operators/Assembler.h"
#include "Core/Operators/CotanWeights.h"
#include "Core/Solvers/SolverChoice.h"

#include <Eigen/Geometry>

#include <algorithm>

namespace SurfaceDiffusion
{

namespace
{

using Row = Eigen::RowVector3d;

constexpr double Tolerance = 1e-12; ///< parts are orthogonal to as much

/// n x v per triangle; 0 on surfaces with one side.
Values Turned(const TriangleMesh& mesh, const OrientedNormals& normals, Values ofTriangles,
  const ParallelFor& parallel)
{
  ForEach(parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      const Row n = normals.IsOnOneSide(mesh.TriangleVertices()(t, 0))
        ? Row(Row::Zero())
        : Row(normals.OfTriangles.row(t));
      for (Eigen::Index k = 0; k + 3 <= ofTriangles.cols(); k += 3)
      {
        const Row v = ofTriangles.row(t).segment<3>(k);
        ofTriangles.row(t).segment<3>(k) = n.cross(v);
      }
    });
  return ofTriangles;
}

/// The sum over triangles of a_t v_t . grad(phi_i).
Values WeakDivergence(const TriangleMesh& mesh, const Derivatives& operators,
  const Values& ofTriangles, const ParallelFor& parallel)
{
  Values sums = Values::Zero(mesh.NumberOfVertices(), ofTriangles.cols() / 3);
  ForEach(parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      for (Index c = mesh.VertexCornersBegin()[i]; c < mesh.VertexCornersBegin()[i + 1]; ++c)
      {
        const Index corner = mesh.VertexCorners()[c];
        const Index t = corner / 3;
        const Row gradient = mesh.Shapes()[t].Area() * operators.BasisGradient(t, corner % 3);
        for (Eigen::Index k = 0; k < sums.cols(); ++k)
        {
          sums(i, k) += gradient.dot(ofTriangles.row(t).segment<3>(3 * k));
        }
      }
    });
  return sums;
}

/// Solves K x = b where x is 0 at the fixed vertices of a component, or otherwise of the mean 0.
class PotentialSolver
{
public:
  PotentialSolver(std::shared_ptr<const TriangleMesh> mesh, const ParallelFor& parallel)
    : Surface(std::move(mesh))
    , Operators(this->Surface, parallel)
    , Parallel(parallel)
  {
    SolverTask task;
    task.NumberOfVertices = this->Surface->NumberOfVertices();
    task.DiffusionNumber.reset();
    task.Tolerance = Tolerance;
    this->Solver = MakeSolver(ChooseSolver(SolverMethod::Automatic, task), parallel);
    this->Solver->SetLimits({ Tolerance });
    this->Operators.TakePattern(this->Stiffness, parallel);
    this->Operators.Fill(this->Stiffness, Vector::Zero(this->Surface->NumberOfVertices()), 1.0,
      CotanWeights(*this->Surface, parallel), nullptr, parallel);
  }

  Values Solve(Values b, Flags fixed, double& missedResidual, const ProgressMonitor& progress)
  {
    const std::vector<Index>& begin = this->Surface->ComponentsBegin();
    std::vector<char> isFree(begin.size(), 0);
    for (std::size_t c = 0; c + 1 < begin.size(); ++c)
    {
      const Index size = begin[c + 1] - begin[c];
      isFree[c] = !fixed.segment(begin[c], size).any();
      fixed[begin[c]] = fixed[begin[c]] || isFree[c] != 0;
    }
    this->Matrix = this->Stiffness;
    Values load;
    this->Operators.Constrain(
      this->Matrix, fixed, Values::Zero(b.rows(), b.cols()), load, this->Parallel);
    for (Index i = 0; i < static_cast<Index>(b.rows()); ++i)
    {
      b.row(i) *= fixed[i] ? 0.0 : 1.0;
    }
    this->Solver->SetMatrix(this->Matrix, progress.Part(0.0, 0.7));
    Values x = Values::Zero(b.rows(), b.cols());
    const SolveReport report = this->Solver->Solve(b, x, progress.Part(0.7, 1.0));
    RequireAnswer(report, this->Solver->GetLimits());
    missedResidual = std::max(missedResidual, report.Converged ? 0.0 : report.Residual);
    for (std::size_t c = 0; c + 1 < begin.size(); ++c)
    {
      if (isFree[c])
      {
        const Index size = begin[c + 1] - begin[c];
        const auto areas = this->Surface->ControlAreas().segment(begin[c], size);
        const Eigen::RowVectorXd mean =
          areas.transpose() * x.middleRows(begin[c], size) / areas.sum();
        x.middleRows(begin[c], size).rowwise() -= mean;
      }
    }
    return x;
  }

private:
  std::shared_ptr<const TriangleMesh> Surface;
  Assembler Operators;
  const ParallelFor& Parallel;
  std::shared_ptr<LinearSolver> Solver;
  SparseMatrix Stiffness;
  SparseMatrix Matrix; ///< with the fixed vertices, which the solver may compare with the next
};

} // namespace

HelmholtzParts DecomposeVectors(std::shared_ptr<const TriangleMesh> mesh,
  const Derivatives& operators, const Values& ofTriangles, const ParallelFor& parallel,
  const ProgressMonitor& progress)
{
  const OrientedNormals& normals = operators.Normals();
  // The part in the plane of each triangle, also on surfaces with one side.
  Values u = ofTriangles;
  ForEach(parallel, mesh->NumberOfTriangles(),
    [&](Index t)
    {
      const Row n = normals.OfTriangles.row(t);
      for (Eigen::Index k = 0; k + 3 <= u.cols(); k += 3)
      {
        const Row v = u.row(t).segment<3>(k);
        u.row(t).segment<3>(k) = v - v.dot(n) * n;
      }
    });
  PotentialSolver solver(mesh, parallel);
  HelmholtzParts parts;
  const Flags none = Flags::Constant(mesh->NumberOfVertices(), false);
  parts.GradientPotential = solver.Solve(WeakDivergence(*mesh, operators, u, parallel), none,
    parts.MissedResidual, progress.Part(0.0, 0.5));
  Flags boundary = none;
  for (const Index i : mesh->BoundaryVertices())
  {
    boundary[i] = true;
  }
  // u . (n x grad) = -(n x u) . grad
  parts.CurlPotential =
    solver.Solve(-WeakDivergence(*mesh, operators, Turned(*mesh, normals, u, parallel), parallel),
      boundary, parts.MissedResidual, progress.Part(0.5, 1.0));
  parts.GradientPart = operators.Gradients(parts.GradientPotential);
  parts.CurlPart = Turned(*mesh, normals, operators.Gradients(parts.CurlPotential), parallel);
  parts.HarmonicPart = u - parts.GradientPart - parts.CurlPart;
  return parts;
}

} // namespace SurfaceDiffusion
