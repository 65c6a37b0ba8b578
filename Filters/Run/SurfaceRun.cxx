// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/SurfaceRun.h"

namespace SurfaceDiffusion
{

bool SurfaceRun::Prepare(const BlockInput& input, Settings& settings, const SurfaceOptions& options,
  const ProgressMonitor& progress)
{
  const SettingsSnapshot surfaceSettings(settings, SettingScope::Surface);
  if (!this->Domain || this->SurfaceVersion != input.SurfaceVersion ||
    this->SurfaceSettings != surfaceSettings)
  {
    this->HasResult = false;
    this->Domain.reset();
    this->Domain =
      std::make_unique<Surface>(input.ReadSurface(), options, this->Parallel, progress);
    this->SurfaceVersion = input.SurfaceVersion;
    this->SurfaceSettings = surfaceSettings;
  }
  const bool isCurrent = this->HasResult && this->FieldsVersion == input.FieldsVersion &&
    this->ModelSettings == SettingsSnapshot(settings, SettingScope::Model);
  this->HasResult = isCurrent;
  return !isCurrent;
}

double SurfaceRun::MeanEdgeLength() const
{
  const TriangleMesh& mesh = this->Domain->InputMesh();
  const double edges = mesh.NumberOfEdges();
  return edges > 0.0 ? mesh.TotalEdgeLength() * mesh.LengthUnit() / edges : 1.0;
}

void SurfaceRun::Complete(const BlockInput& input, Settings& settings)
{
  this->FieldsVersion = input.FieldsVersion;
  this->ModelSettings = SettingsSnapshot(settings, SettingScope::Model);
  this->HasResult = true;
}

} // namespace SurfaceDiffusion
