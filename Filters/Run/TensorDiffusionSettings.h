// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/BeltramiFlow.h"
#include "Core/Models/StructureDiffusion.h"
#include "Run/RunSettings.h"

#include <memory>

namespace SurfaceDiffusion
{

enum class TensorModel
{
  Beltrami,
  CoherenceEnhancing,
  EdgeEnhancing
};

/// Diffusion whose tensor follows from the data; see BeltramiFlow and StructureDiffusion.
struct TensorDiffusionSettings : DataSettings
{
  TensorModel Model = TensorModel::Beltrami;
  double ColorScale = 10.0; ///< measured: see vtkTensorDiffusionFilter
  BeltramiFlow::Metric Metric = BeltramiFlow::Metric::Induced;
  double NoiseScale = 1.0;
  double IntegrationScale = 4.0;
  double Contrast = 0.05; ///< measured: see vtkTensorDiffusionFilter
  double Alpha = 1e-3;
  bool DiffusionAxes = false;

  TensorDiffusionSettings()
  {
    this->Tolerance = 1e-6;
    this->InitialFill = SurfaceDiffusion::InitialFill::Harmonic; // jumps at holes would be kept
  }

  void Visit(SettingVisitor& visitor) override;
  ModelTraits DescribeModel() const override;
  std::unique_ptr<SurfaceDiffusion::Model> Make(
    ModelInputs& inputs, RunResult& result) const override;
  std::vector<Output> Finish(const RunState& state, RunResult& result) const override;

protected:
  void CheckTogether(const FieldSummary* fields, Problems& problems) const override;

private:
  std::unique_ptr<StructureTensor> MakeStructure(ModelInputs& inputs) const;
};

} // namespace SurfaceDiffusion
