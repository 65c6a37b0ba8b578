// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Foundation/SymmetricModes.h"

#include <Eigen/Eigenvalues>

namespace SurfaceDiffusion
{

using Solver = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;

namespace
{

void Take(const Solver& solver, SymmetricModes& modes)
{
  modes.Eigenvalues = solver.eigenvalues();
  modes.Vectors = solver.eigenvectors();
  modes.Converged = solver.info() == Eigen::Success;
}

} // namespace

SymmetricModes::SymmetricModes(const Eigen::MatrixXd& matrix)
{
  Take(Solver(matrix), *this);
}

SymmetricModes::SymmetricModes(const Vector& diagonal, const Vector& below)
{
  Solver solver;
  solver.computeFromTridiagonal(diagonal, below);
  Take(solver, *this);
}

Vector SymmetricEigenvalues(const Eigen::MatrixXd& matrix)
{
  return Solver(matrix, Eigen::EigenvaluesOnly).eigenvalues();
}

} // namespace SurfaceDiffusion
