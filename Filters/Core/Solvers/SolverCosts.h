// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Written by Testing/Benchmarks/CalibrateSolvers: seconds on one core, of which only the ratios
/// matter. s: the number of vertices over Size; c: the diffusion number; digits: the decimal digits
/// of the tolerance over 10.
namespace SurfaceDiffusion::SolverCosts
{

constexpr double Size = 44000.0;

constexpr double Factor = 0.112; // x s^1.5
constexpr double Substitution = 0.0027; // x s^1.4
constexpr double LocalSubstitution = 0.004; // x c^0.2 s: in short steps the factor is sparser

// Of conjugate gradients with Jacobi
constexpr double SingleIteration = 2.0e-4; // x s
constexpr double DoubleIteration = 4.2e-4; // x s
constexpr double Iterations = 67.0; // x digits c^0.4 s^0.1
constexpr double IterationsAcross = 6.5; // x digits sqrt(n), at most: across the whole surface

// Of multigrid
constexpr double Hierarchy = 0.036; // x s
constexpr double Cycle = 2.9e-3; // x s
constexpr double Cycles = 9.5; // x digits, at c = 1
constexpr double CyclesPerDecade = 2.7; // x digits log10(c)

// What a further column costs of the first one, of 8: those of a panel share a pass over the matrix
// or the factor.
constexpr double SubstitutionColumn = 0.2;
constexpr double SingleIterationColumn = 1.0;
constexpr double DoubleIterationColumn = 0.3;
constexpr double CycleColumn = 0.4;

} // namespace SurfaceDiffusion::SolverCosts
