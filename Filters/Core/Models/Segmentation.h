// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Model.h"
#include "Core/Models/TotalVariation/TotalVariationMinimizer.h"

#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// Regions of a surface by the convex Chan-Vese model (T. Chan, S. Esedoglu, M. Nikolova, SIAM J.
/// Appl. Math. 66, 2006) and its extension to K regions, a convex relaxation of Potts' model (on
/// surfaces C. Wu, J. Zhang, Y. Duan, X.-C. Tai, J. Sci. Comput. 50, 2012): the minimum over u, one
/// probability u_k per region at each vertex, of
///
///   E(u) = 1/2 sum_k int |grad u_k| + lambda sum_k int chi w u_k r_k,   u_k >= 0,   sum_k u_k = 1,
///
/// with data terms r_k = |f - c_k|^2, or given ones, and the fidelity factors w of the data. Each
/// boundary counts once, since two of the u_k jump there. TotalVariationMinimizer finds it by ADMM,
/// with the clamp to [0, 1] of u_1 = 1 - u_2 for two regions, and the projection onto the simplex
/// for more. The duality gap bounds E(u) - min E.
///
/// With unknown means c_k, minimisations over u and over c alternate: for fixed u the best c_k is
/// the mean of f with the weights A_i w_i u_k,i. E never rises. It is not convex in u and c
/// together, so that the result is a local minimum. Without seeds the regions are then in ascending
/// order of their means.
///
/// The steady state is reached in one step. The start is the label of the smallest data term, and
/// 1/K at missing vertices.
class Segmentation : public Model
{
public:
  struct Settings
  {
    double Fidelity = 1.0; ///< lambda
    bool UpdateMeans = false; ///< alternate between u and c
    double StopTolerance = 1e-3; ///< of the duality gap, relative to E - lambda int chi min_k r_k
    int MaximumNumberOfIterations = 10000; ///< of one minimisation
    int MaximumNumberOfAlternations = 100;
    bool UseSimplex = false; ///< for K = 2, too
  };

  /// What the regions are found from.
  struct Input
  {
    /// f or, without means, the r_k of K columns; finite. Missing and w = 0: chi = 0.
    PointData Data;
    /// c, a row per region, NaN for one that is not used; no row: the r_k are given.
    Values Means;
    /// Per vertex the label 1 .. K that it keeps, or 0; may be empty.
    std::vector<Index> Seeds;
  };

  Segmentation(std::shared_ptr<const Assembler> assembler, Input input, const Settings& settings,
    const ParallelFor& parallel = SerialFor());

  /// u, one column per region.
  const Values& State() const override { return this->U; }
  /// Reports the iterations of all minimisations, and as the residual the gap of the last.
  StepReport Advance(const ProgressMonitor& progress) override;
  /// E(u) with the present means.
  double Energy() const override;
  std::size_t CheckpointSize() const override;
  void Save(double* checkpoint) const override;
  void Restore(const double* checkpoint) override;

  /// c, a row per region; no row if the r_k are given.
  const Values& Means() const { return this->C; }
  /// The mean of f over the known vertices of each label, c for one without; no row if the r_k are
  /// given.
  Values DataMeans() const;
  /// Minimisations over u in the last step; 0 at the start.
  int NumberOfAlternations() const { return this->Alternations; }
  /// Labels, Means and DataMeans, Gap and LabelGap, NumberOfAlternations.
  std::map<std::string, Values> Results() const override;

  /// The labels 1 .. K of the largest u_k.
  std::vector<Index> Labels() const;
  /// The relative duality gap of the last minimisation; 0 at the start.
  double Gap() const { return this->GapOfState; }
  /// E after each minimisation of the last step, and each update of the means.
  const std::vector<double>& Energies() const { return this->EnergiesOfStep; }
  /// E of the labels as functions on the mesh, above the lower bound of E that the minimisation
  /// found, relative to the former in the way of StopTolerance. Such functions have boundaries that
  /// are too long by a tenth on any mesh.
  double LabelGap() const { return this->GapOfLabels; }

private:
  Index NumberOfRegions() const { return static_cast<Index>(this->U.cols()); }
  double DataTerm(Index i, Index region) const;
  void SetStart();
  void UpdateCosts();
  double ConstantEnergy() const;
  double EnergyOf(const Values& relaxed) const;
  bool UpdateMeans();
  void SortRegions();
  void TakeState();
  TotalVariationMinimizer::Report Minimize(const ProgressMonitor& progress, bool isFirst);
  void MeasureLabels(const TotalVariationMinimizer::Report& report);

  std::shared_ptr<const Assembler> Assembly;
  Input Given;
  Settings Options;
  const ParallelFor& Parallel;
  double Farthest = 0.0; ///< the data term of regions that are not used: no other is larger
  double EnergyFactor; ///< the energy of the minimiser over E
  Values U, C;
  Values Relaxed; ///< u as the minimiser has it: u_1 alone, or U
  Values Costs; ///< of the minimiser
  Values Former;
  Values Sums; ///< of UpdateMeans()
  std::unique_ptr<TotalVariationMinimizer> Minimizer;
  std::vector<double> EnergiesOfStep;
  int Alternations = 0;
  double GapOfState = 0.0;
  double GapOfLabels = 0.0;
};

} // namespace SurfaceDiffusion
