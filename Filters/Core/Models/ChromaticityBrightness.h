// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Harmonic/HarmonicMap.h"
#include "Core/Models/Model.h"
#include "Core/Operators/Assembler.h"

#include <functional>
#include <memory>

namespace SurfaceDiffusion
{

/// Diffusion of colours u = B C as brightness B = |u| >= 0 and chromaticity C = u/|u|, a map into
/// the unit sphere, by the gradient flow, or for steady states a minimiser, of
///   E(B, C) = int psi(|grad B|) + mu int |grad C|^p / p + lambda/2 int w chi |B C - B_f C_f|^2
/// (T. Chan, S. Kang, J. Shen, J. Vis. Commun. Image Represent. 12, 2001; B. Tang, G. Sapiro,
/// V. Caselles, IEEE Trans. Image Process. 10, 2001), with f = B_f C_f, the factors w of the data
/// and the indicator chi of their known part. A model of scalar data takes care of B and
/// HarmonicMap of C. They alternate, since the fidelity is that of each for fixed values of the
/// other:
///   |B C - f|^2 = (B - B_f (C . C_f))^2 + a term without B
///               = B B_f |C - C_f|^2 + (B - B_f)^2:
/// - for fixed C the data of B are B_f (C . C_f), with the weight lambda w;
/// - for fixed B the data of C are C_f, with the weight lambda w B B_f, so that dark vertices,
///   whose hue is mostly noise, hardly bind it. Where f = 0 the data of C are missing.
///
/// Each of the two steps decreases E, so that E never grows, on any mesh and for any time step, if
/// the steps of B decrease their energy, as those of NonlinearDiffusion and TotalVariationFlow do.
/// B that falls below 0 becomes 0 (it can if f has negative values). A step of B that raises E,
/// which an inexact minimisation may do near the minimum, is not taken.
///
/// The time step of C is that of the metric |dB|^2 + R^2 |dC|^2 with the range R of the values. The
/// steady state is that of alternated steps which are so long that each nearly minimises E:
/// proximal alternating minimisation (H. Attouch et al., Math. Oper. Res. 35(2), 2010). E is not
/// convex, and the steady state is a stationary point that depends on the start.
class ChromaticityBrightness : public Model
{
public:
  struct Settings
  {
    double Fidelity = 0.0; ///< lambda, of B
    double ChromaticityWeight = 1.0; ///< mu
    bool SteadyState = false;
    double StopTolerance = 1e-4; ///< of steady states, see Advance()
    int MaximumNumberOfAlternations = 1000;
  };

  /// Models for their data. That of B must not correct its total to that of its start if there is
  /// fidelity. The lambda of C is lambda/mu, and its time step is that of B times mu/R^2.
  using BrightnessMaker = std::function<std::unique_ptr<DataModel>(PointData brightness)>;
  using ChromaticityMaker = std::function<std::unique_ptr<HarmonicMap>(PointData chromaticity)>;

  /// data: with any number of columns from two on.
  ChromaticityBrightness(std::shared_ptr<const Assembler> assembler, PointData data,
    const Settings& settings, const BrightnessMaker& makeBrightness,
    const ChromaticityMaker& makeChromaticity, const ParallelFor& parallel = SerialFor());

  const Values& State() const override { return this->U; }

  /// One step of B and one of C. For steady states alternations until one decreases E by less than
  /// StopTolerance E; the residual of the report is this decrease relative to E. That of time steps
  /// is the one of B.
  StepReport Advance(const ProgressMonitor& progress) override;

  /// E(B, C).
  double Energy() const override;

  /// Those of B.
  DiffusionStep Diffusion() const override;
  const CornerWeights& DiffusionWeights(Eigen::Index /*column*/) override
  {
    return this->BrightnessModel->DiffusionWeights(0);
  }

  /// B, one column, and C.
  const Values& Brightness() const { return this->BrightnessModel->State(); }
  const Values& Chromaticity() const { return this->ChromaticityModel->State(); }

  std::size_t CheckpointSize() const override;
  void Save(double* checkpoint) const override;
  void Restore(const double* checkpoint) override;

private:
  PointData BrightnessData(const PointData& data);
  PointData ChromaticityData(const PointData& data) const;
  double Agreement(Index i) const;
  void Alternate(StepReport& report, const ProgressMonitor& progress);
  void StepBrightness(StepReport& report, const ProgressMonitor& progress);
  void StepToSteadyState(StepReport& report, const ProgressMonitor& progress);
  void UpdateBrightnessData();
  void UpdateChromaticityWeights();
  void UpdateState();

  std::shared_ptr<const Assembler> Assembly;
  Settings Options;
  const ParallelFor& Parallel;
  Values Start;
  Flags Fixed;
  Values GivenBrightness; ///< B_f, 0 where missing
  Values GivenChromaticity; ///< C_f
  Vector Weights; ///< w chi
  std::unique_ptr<DataModel> BrightnessModel;
  std::unique_ptr<HarmonicMap> ChromaticityModel;
  bool Started = false; ///< before, the state is the start to the last bit
  Values U, OldBrightness, BrightnessTarget;
  Vector ChromaticityWeights;
};

} // namespace SurfaceDiffusion
