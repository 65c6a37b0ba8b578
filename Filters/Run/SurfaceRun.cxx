// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/SurfaceRun.h"

#include "Core/Surface/EdgeLengths.h"
#include "Run/BlockSentences.h"
#include "Run/InputSentences.h"
#include "Run/Outputs.h"
#include "Run/Sentinels.h"
#include "Run/UnlikeEdges.h"

#include <algorithm>

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

namespace
{

double MeanEdgeLengthOf(const std::vector<const SurfaceRun*>& runs)
{
  double length = 0.0;
  double edges = 0.0;
  for (const SurfaceRun* const run : runs)
  {
    const TriangleMesh& mesh = run->GetSurface().InputMesh();
    length += mesh.TotalEdgeLength() * mesh.LengthUnit();
    edges += mesh.NumberOfEdges();
  }
  return edges > 0.0 ? length / edges : 1.0;
}

} // namespace

double SurfaceRun::MeanEdgeLength() const
{
  return MeanEdgeLengthOf({ this });
}

std::map<std::string, Values> SurfaceRun::FindAllNumbers(const std::vector<const SurfaceRun*>& runs)
{
  std::vector<const OutputList*> surfaces;
  for (const SurfaceRun* const run : runs)
  {
    surfaces.push_back(&run->Outputs());
  }
  std::map<std::string, Values> numbers = CombineNumbers(surfaces, 0);
  numbers["MeanEdgeLength"] = Values::Constant(1, 1, MeanEdgeLengthOf(runs));
  return numbers;
}

std::vector<Warning> SurfaceRun::FindAllWarnings(
  const std::vector<const SurfaceRun*>& runs, const std::vector<std::string>& blocks)
{
  SurfaceDiagnostics sum;
  Fingerprint surfaces, causes;
  BlockSentences ofRuns;
  for (std::size_t r = 0; r < runs.size(); ++r)
  {
    const SurfaceDiagnostics& found = runs[r]->Domain->Diagnostics();
    sum.DegenerateTriangles += found.DegenerateTriangles;
    sum.CoincidentBoundaryPoints += found.CoincidentBoundaryPoints;
    sum.CoincidenceDistance = std::max(sum.CoincidenceDistance, found.CoincidenceDistance);
    sum.MergesPoints = found.MergesPoints;
    surfaces.Add(runs[r]->SurfaceVersion);
    for (const Sentence& sentence : runs[r]->Sentinels)
    {
      ofRuns.Add(sentence, blocks[r]);
      causes.Add(runs[r]->FieldsVersion);
    }
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
  if (sum.DegenerateTriangles > 0)
  {
    Sentence text;
    text << sum.DegenerateTriangles << " triangles of zero area " << runs.front()->OfDegenerate;
    warnings.push_back({ text, surfaces });
  }
  const char* const ofCoincident = runs.empty() ? nullptr : runs.front()->OfCoincident;
  if (sum.CoincidentBoundaryPoints > 0 && ofCoincident)
  {
    Sentence text;
    text << sum.CoincidentBoundaryPoints << SentenceOfCoincidence(sum, ofCoincident);
    warnings.push_back({ text, surfaces });
  }
  return warnings;
}

BlockInput SurfaceRun::WithoutGivenAreas(const BlockInput& input)
{
  BlockInput drawn = input;
  drawn.ReadSurface = [read = input.ReadSurface]
  {
    SurfaceArrays arrays = read();
    arrays.AreaFactors.clear();
    return arrays;
  };
  return drawn;
}

void SurfaceRun::AppendTurnedTriangles(Index count, std::vector<Warning>& warnings) const
{
  if (count > 0)
  {
    Sentence text;
    text << count
         << " triangles have another orientation than their neighbours and count as turned: signs "
            "follow the larger part of the area";
    warnings.push_back({ text, this->SurfaceVersion });
  }
}

void SurfaceRun::AppendMissedResidual(double residual, std::vector<Warning>& warnings) const
{
  if (residual > 0.0)
  {
    Fingerprint inputs = this->SurfaceVersion;
    inputs.Add(this->FieldsVersion);
    warnings.push_back({ Say("Missed", residual), inputs });
  }
}

void SurfaceRun::AppendLongEdges(std::vector<Warning>& warnings) const
{
  const double count = CountLongEdges(this->Domain->InputMesh(), this->Parallel);
  if (count > 0.0)
  {
    warnings.push_back({ SentenceOfLongEdges(count), this->SurfaceVersion });
  }
}

Fields SurfaceRun::ReadFields(const BlockInput& input, const Sentence& aboutData)
{
  Fields fields = input.ReadFields();
  this->Sentinels =
    AskForSentinels(*this->Domain, fields, this->Domain->InputMesh().GetReduction(), aboutData);
  return fields;
}

void SurfaceRun::Complete(const BlockInput& input, Settings& settings)
{
  this->FieldsVersion = input.FieldsVersion;
  this->ModelSettings = SettingsSnapshot(settings, SettingScope::Model);
  this->HasResult = true;
}

} // namespace SurfaceDiffusion
