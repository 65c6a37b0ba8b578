// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Written by Testing/Benchmarks/CalibrateSolvers: seconds on one core, of which only the ratios
/// matter. s: the number of vertices over Size; c: the diffusion number; digits: the decimal digits
/// of the tolerance over 10.
namespace SurfaceDiffusion::SolverCosts
{

constexpr double Size = 44000.0;

constexpr double Factor = 0.088; // x s^1.35
constexpr double Substitution = 0.003; // x s^1.4
constexpr double LocalSubstitution = 0.0028; // x c^0.2 s: in short steps the factor is sparser

// Of conjugate gradients with Jacobi
constexpr double SingleIteration = 0.00015; // x s^1.1
constexpr double DoubleIteration = 0.00031; // x s^1.1
constexpr double Iterations = 69; // x digits c^0.4 s^0.1
constexpr double IterationsAcross = 5.8; // x digits sqrt(n), at most: across the whole surface

// Of multigrid
constexpr double Hierarchy = 0.033; // x s
constexpr double Cycle = 0.0017; // x s^1.2
constexpr double Cycles = 9.4; // x digits, at c = 1
constexpr double CyclesPerDecade = 1.6; // x digits log10(c)

// What a further column costs of the first one, of 8: those of a panel share a pass over the matrix
// or the factor, but for iterations in single precision.
constexpr double SubstitutionColumn = 0.18;
constexpr double SingleIterationColumn = 1.1;
constexpr double DoubleIterationColumn = 0.49;
constexpr double CycleColumn = 0.37;

} // namespace SurfaceDiffusion::SolverCosts
