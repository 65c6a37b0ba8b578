// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/EdgeFunctions.h"
#include "Core/Models/Harmonic/HarmonicMap.h"
#include "Core/Models/NonlinearDiffusion.h"
#include "Core/Models/TotalVariation/TotalVariationFlow.h"
#include "Run/ModelInputs.h"

#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

class MedialMesh;
struct TotalVariationSettings;

/// Makes the models that TotalVariationSettings ask for. Models of values at edges
/// (CrouzeixRaviart) and of colours are made of models of their channels.
class TotalVariationModels
{
public:
  TotalVariationModels(const TotalVariationSettings& options, ModelInputs& inputs);

  /// One unit of FidelityWeight in units of the numerics.
  double FidelityUnit() const;

  /// The lambda of AutomaticFidelity, in units of the numerics: that of the model and steps of the
  /// run itself.
  double FindFidelityWeight(RunResult& result) const;

  /// Prepares the edges for CrouzeixRaviart. This takes seconds for a million vertices. In the
  /// background it does not delay an abort.
  void MakeEdges();

  /// The model of the settings, with its steady states and implicit steps to the tolerance.
  std::unique_ptr<Model> Make(PointData data, double fidelity, double tolerance) const;

private:
  struct EdgeUnknowns
  {
    std::shared_ptr<const MedialMesh> Mesh;
    std::shared_ptr<const Assembler> Operators;
  };
  /// What the models of one run on one mesh have in common.
  struct Task
  {
    std::shared_ptr<const Assembler> Operators;
    double Fidelity;
    double Tolerance;
    double TimeStep; ///< not of steady states
    bool IsSteady;
    bool ConservesTotal;
    std::vector<double> ChannelWeights; ///< see Fidelity
  };

  std::unique_ptr<Model> MakeOn(std::shared_ptr<const Assembler> assembler, PointData data,
    double fidelity, double tolerance) const;
  std::unique_ptr<Model> MakeOfChannels(const Task& task, PointData data) const;
  std::unique_ptr<Model> MakeChromaticityBrightness(Task task, PointData data) const;
  std::unique_ptr<HarmonicMap> MakeChromaticity(const Task& task, PointData data) const;
  std::unique_ptr<DataModel> MakeDiffusion(const Task& task, PointData data) const;
  std::unique_ptr<NonlinearDiffusion> MakeLagged(const Task& task, PointData data) const;
  TotalVariationFlow::Settings MakeFlowSettings(const Task& task) const;
  EdgeFunction MakeEdgeFunction(EdgeFunctionKind kind) const;
  double ChromaticityWeight() const;
  TangentVectors Directions() const;

  const TotalVariationSettings& Options;
  ModelInputs& Inputs;
  const UnitSystem& Units;
  const Dimension Time;
  std::shared_ptr<const EdgeUnknowns> Edges; ///< of CrouzeixRaviart
};

} // namespace SurfaceDiffusion
