// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/SurfaceRun.h"

#include "Run/BlockSentences.h"

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

std::vector<Warning> SurfaceRun::FindAllWarnings(
  const std::vector<const SurfaceRun*>& runs, const std::vector<std::string>& blocks)
{
  Index degenerate = 0;
  Fingerprint surfaces, causes;
  BlockSentences ofRuns;
  for (std::size_t r = 0; r < runs.size(); ++r)
  {
    degenerate += runs[r]->Domain->Diagnostics().DegenerateTriangles;
    surfaces.Add(runs[r]->SurfaceVersion);
    for (const Warning& warning : runs[r]->FindOwnWarnings())
    {
      ofRuns.Add(warning.Sentence, blocks[r]);
      causes.Add(warning.Cause);
    }
  }
  std::vector<Sentence> sentences;
  ofRuns.AppendTo(sentences, runs.size());
  std::vector<Warning> warnings;
  for (const Sentence& sentence : sentences)
  {
    warnings.push_back({ sentence, causes });
  }
  if (degenerate > 0)
  {
    Sentence text;
    text << degenerate << " triangles of zero area " << runs.front()->OfDegenerate;
    warnings.push_back({ text, surfaces });
  }
  return warnings;
}

void SurfaceRun::Complete(const BlockInput& input, Settings& settings)
{
  this->FieldsVersion = input.FieldsVersion;
  this->ModelSettings = SettingsSnapshot(settings, SettingScope::Model);
  this->HasResult = true;
}

} // namespace SurfaceDiffusion
