// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Fidelity.h"
#include "Core/Operators/MeanCorrection.h"

namespace SurfaceDiffusion
{

/// The columns of a step of LinearDiffusion that are advanced together: few enough that their rows
/// stay in the cache from loop to loop. Every loop passes over the vertices once, for a number of
/// columns that the compiler knows, and adds the corrections of the solve before it on the way.
/// Values are measured from the mean of the start, so that the errors of a solve are relative to
/// the contrast of the data.
class DiffusionPanel
{
public:
  /// The arguments must outlive the panel. start: all columns at t = 0.
  DiffusionPanel(const TriangleMesh& mesh, const PointData& data, const Fidelity& fit,
    const Values& start, const ParallelFor& parallel);

  /// The means of the start, per column.
  const Eigen::RowVectorXd& Means() const { return this->Origin; }

  /// Take columns first .. first + count - 1 of u into Solution, and
  /// RightHandSide = M (inertia u + dt lambda chi f).
  void StartStage(
    const Values& u, Eigen::Index first, Eigen::Index count, double inertia, double dt);

  /// After the first stage: RightHandSide = M (u + ratio (Solution - u) + dt lambda chi f).
  /// Solution is extrapolated linearly to the end of the step, from where a solve needs a tenth
  /// fewer iterations in steps of up to 10 h^2.
  void StartSecondStage(const Values& u, double ratio, double dt);

  /// Between a start of a stage or a term and its solve: RightHandSide gains what `difference` in
  /// the place of M makes of the state in it, but not of f.
  void AddMass(const SparseMatrix& difference) { this->AddProduct(difference, this->Solution); }
  void AddMassOfSecondStage(const SparseMatrix& difference, const Values& u, double ratio);

  /// After StartStage(): the sum of an ExponentialSeries, of which the term T_0 is Solution.
  void StartSeries();
  /// Solution is Y T_(k-1): add T_k to the sum and make it Solution, and
  /// RightHandSide = M (T_k + dt lambda chi f). After the last term the sum is Solution.
  void AddTerm(int k, double dt);

  /// Give Solution the mean that the sum of the equations determines, once it has been computed.
  void Correct(MeanCorrection& correction);

  /// Put Solution into the columns of u, with the values of fixed vertices, and the integrals over
  /// the surface that `conserved` restores.
  void Finish(TotalCorrection& conserved, Values& u);

  Eigen::Index First() const { return this->FirstColumn; }

  Values Solution, RightHandSide;

private:
  template <int K>
  void FillFirst(const Values& u, double inertia, double dt);
  template <int K>
  void FillSecond(const Values& u, double ratio, double dt);
  template <int K>
  void FillTerm(int term, double dt);
  template <int K>
  void AddShifts();
  void AddProduct(const SparseMatrix& matrix, const Values& x);
  template <int K>
  void Store(Values& u);
  /// Call body(i, Shifts of the component of i) for every vertex i.
  template <typename Body>
  void ForEachShifted(const Body& body) const;
  const double* FirstOrigin() const { return this->Origin.data() + this->FirstColumn; }

  const TriangleMesh& Mesh;
  const PointData& Data;
  const Fidelity& Fit;
  const ParallelFor& Parallel;
  Eigen::RowVectorXd Origin;
  Eigen::Index FirstColumn = 0;
  Values LastTerm, TermBefore, Sum; ///< of a series
  Values Product;
  Values Shifts; ///< of the last correction, component x column: the loop that follows adds them
};

} // namespace SurfaceDiffusion
