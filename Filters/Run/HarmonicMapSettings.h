// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geometry/VertexUpdating.h"
#include "Core/Models/Harmonic/HarmonicMap.h"
#include "Run/RunSettings.h"

namespace SurfaceDiffusion
{

/// What unit vectors are tangent to.
enum class TangentTo
{
  None,
  Surface
};

/// The flow of p-harmonic maps into the unit sphere,
/// u_t = div(|grad u|^(p-2) grad u) + u |grad u|^p + lambda chi (f - u), |u| = 1: (20), (21).
struct HarmonicMapSettings : DataSettings
{
  SurfaceDiffusion::TimeIntegrator TimeIntegrator = SurfaceDiffusion::TimeIntegrator::FirstOrder;
  double Exponent = 1.0;
  double Beta = 1e-6;
  HarmonicMap::Scheme Scheme = HarmonicMap::Scheme::TangentPlane;
  bool ConsistentReaction = false;
  bool ProjectToSphere = true;
  bool LineField = false;
  SurfaceDiffusion::TangentTo TangentTo = SurfaceDiffusion::TangentTo::None;
  bool MoveVertices = false;
  int MaximumNumberOfRepetitions = 50; ///< of MinimizingMovement; no property

  HarmonicMapSettings()
  {
    this->Tolerance = 1e-6;
    this->TimeStep = 0.1;
    this->NumberOfTimeSteps = 3;
  }

  void Visit(SettingVisitor& visitor) override;
  ModelTraits DescribeModel() const override;
  std::unique_ptr<Model> Make(ModelInputs& inputs, RunResult& result) const override;
  std::vector<Output> Finish(const RunState& state, RunResult& result) const override;

protected:
  void CheckTogether(const FieldSummary* fields, Problems& problems) const override;

private:
  Values PrepareTangents(ModelInputs& inputs, RunResult& result) const;
  Points MovePoints(const RunState& state, VertexMotion& motion) const;
  SolverTask MakeTask(const ModelInputs& inputs, double timeStep) const;
};

} // namespace SurfaceDiffusion
