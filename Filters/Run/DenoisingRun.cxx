// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/DenoisingRun.h"

#include "Core/Geometry/VertexUpdating.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// Nonzero at the vertices of points with nonzero values; empty without values.
template <typename Value>
std::vector<char> MarkVertices(const Surface& surface, const std::vector<Value>& values)
{
  const Index count = surface.InputMesh().NumberOfVertices();
  std::vector<char> marks(values.empty() ? 0 : static_cast<std::size_t>(count), 0);
  for (std::size_t p = 0; p < values.size(); ++p)
  {
    const Index vertex = surface.VertexOf(static_cast<Index>(p));
    if (vertex >= 0 && values[p] != 0)
    {
      marks[static_cast<std::size_t>(vertex)] = 1;
    }
  }
  return marks;
}

/// The edges that CreaseArray marks, by vertices of the mesh: those between two marked points, or
/// between cells of different labels.
VertexPairs FindCreases(const Surface& surface, const Fields& fields)
{
  VertexPairs creases;
  const std::vector<Index>& labels = fields.Seeds.Values;
  if (labels.empty())
  {
    return creases;
  }
  const TriangleMesh& mesh = surface.InputMesh();
  const std::vector<char> marks =
    fields.Seeds.OnCells ? std::vector<char>() : MarkVertices(surface, labels);
  const auto labelOf = [&](Index triangle)
  {
    const Index row = surface.InputTriangle(mesh.InputTriangle()[triangle]);
    return labels[static_cast<std::size_t>(fields.Cells[static_cast<std::size_t>(row)])];
  };
  std::map<std::pair<Index, Index>, Index> firstLabels;
  for (Index c = 0; c < 3 * mesh.NumberOfTriangles(); ++c)
  {
    const std::pair<Index, Index> edge =
      std::minmax({ mesh.OtherCorner(c, 1), mesh.OtherCorner(c, 2) });
    const bool isCrease = fields.Seeds.OnCells
      ? firstLabels.emplace(edge, labelOf(c / 3)).first->second != labelOf(c / 3)
      : marks[edge.first] != 0 && marks[edge.second] != 0;
    if (isCrease)
    {
      creases.push_back(edge);
    }
  }
  return creases;
}

} // namespace

void DenoisingRunSettings::Visit(SettingVisitor& visitor)
{
  visitor.Number(
    { "NoiseLevel", "coordinates",
      "How much noise is removed: the standard deviation of the displacement of the "
      "points along the normal, in the unit of the coordinates. 0: measured. Noise "
      "that neighbouring points share, as that of depth cameras, may need it: "
      "measured, it resembles details. With the SurfaceType Organic, the level is that of "
      "independent noise." },
    this->NoiseLevel, SettingRange::NonNegative());
  visitor.Number(
    { "NoiseLength", "",
      "Over how many edges points share their noise, as those of depth cameras do: the "
      "standard deviation, in units of the mean edge length, of the kernel that makes "
      "such noise of independent noise. Below 0.5 the noise is independent. 0: measured, "
      "as far as it can be distinguished from relief." },
    this->NoiseLength, SettingRange::NonNegative());
  visitor.Choice({ "SurfaceType", "",
                   "CAD: smooth faces, which may meet in sharp edges. Organic: shapes with details "
                   "of the size of a few triangles, such as scans. Automatic: CAD unless details "
                   "would be lost." },
    this->SurfaceType, { "Automatic", "CAD", "Organic" });
  visitor.Number(
    { "CreaseAngle", "degrees",
      "Edges between triangles whose normals differ by this angle and more, in degrees, are "
      "creases: they stay as they are, and the two sides are smoothed apart. On surfaces with "
      "strong noise this is so at every edge. 0: none are held; sharp edges are found and kept "
      "while noise is removed from them, too." },
    this->CreaseAngle, SettingRange::Between(0.0, 180.0, "0 to 180"));
  visitor.Number(
    { "DisplacementLimit", "coordinates",
      "No point moves farther than this, in the unit of the coordinates. 0: no limit." },
    this->DisplacementLimit, SettingRange::NonNegative());
  VisitMerging(visitor, this->MergeCoincidentPoints, this->MergeTolerance);
}

std::vector<Warning> DenoisingRun::FindOwnWarnings() const
{
  std::vector<Warning> warnings;
  if (this->Found.CoarseParts > 0)
  {
    Sentence text;
    if (this->Found.Parts > 1)
    {
      text << this->Found.CoarseParts << " of " << this->Found.Parts << " parts have";
    }
    else
    {
      text << "the surface has";
    }
    text << " too few points on smooth faces to tell noise from shape, so that none of them moves "
            "(to remove noise, set "
         << Word::Setting("NoiseLevel") << ")";
    warnings.push_back({ text, this->SurfaceVersion });
  }
  else if (this->Found.Type == SurfaceType::Automatic && this->Found.MaximumDisplacement == 0.0 &&
    this->Found.Relief == 0.0)
  {
    Sentence text("no noise was found, so that no point moves (to remove some, set ");
    text << Word::Setting("NoiseLevel") << ")";
    if (this->Found.NoiseLevel > 0.0) // given
    {
      text = Sentence(Word::Setting("NoiseLevel"));
      text << " is " << this->Found.NoiseLevel
           << ", less than 1e-4 mean edge lengths, so that no point moves";
    }
    warnings.push_back({ text, this->SurfaceVersion });
  }
  if (this->Found.Relief > 0.0)
  {
    Sentence text;
    text << "a part varies by " << this->Found.Relief << " over lengths of "
         << this->Found.ReliefLength
         << ", which is correlated noise or relief, and stays (to remove it, set "
         << Word::Setting("NoiseLevel") << " to " << this->Found.Relief << " and "
         << Word::Setting("NoiseLength") << " to " << this->Found.ReliefEdges << ")";
    warnings.push_back({ text, this->SurfaceVersion });
  }
  this->AppendLongEdges(warnings);
  if (this->Found.LimitedVertices > 0)
  {
    Sentence text;
    text << this->Found.LimitedVertices << " points move as far as "
         << Word::Setting("DisplacementLimit")
         << " allows, and keep noise (to remove it, raise this)";
    warnings.push_back({ text, this->SurfaceVersion });
  }
  if (this->Found.CorrelationLength > 0.0)
  {
    Sentence text;
    text << "the noise is correlated over a length of " << this->Found.CorrelationLength
         << ": details of that size are removed with it";
    warnings.push_back({ text, this->SurfaceVersion });
  }
  if (std::abs(this->Found.VolumeChange) > LargestVolumeChange)
  {
    Sentence text("the volume of a part changes by ");
    text << 100.0 * this->Found.VolumeChange
         << " %: shape was taken for noise (to remove less, set " << Word::Setting("NoiseLevel")
         << ")";
    warnings.push_back({ text, this->SurfaceVersion });
  }
  if (this->Found.Spikes > 0)
  {
    Sentence text;
    text << this->Found.Spikes
         << " points were far outside of their neighbours and were moved between them (to hold "
            "points, set "
         << Word::Array("FixedArray") << ")";
    warnings.push_back({ text, this->SurfaceVersion });
  }
  constexpr double largestTail = 1.3;
  if (this->Found.Tail > largestTail)
  {
    Sentence text("points move by more in some places than in others, by up to ");
    text << this->Found.MaximumDisplacement
         << ", as noise that is everywhere the same does not: relief may be removed with it (to "
            "remove "
            "less, set "
         << Word::Setting("NoiseLevel") << ")";
    warnings.push_back({ text, this->SurfaceVersion });
  }
  else if (this->Found.FarVertices > 0)
  {
    Sentence text;
    text << this->Found.FarVertices
         << " points moved by more than 10 times the noise level, the farthest of all points by "
         << this->Found.MaximumDisplacement
         << ": points at sharpened edges or of thin triangles (to hold points, set "
         << Word::Array("FixedArray") << ")";
    warnings.push_back({ text, this->SurfaceVersion });
  }
  return warnings;
}

void DenoisingRun::Update(const BlockInput& input, Settings& given, const ProgressMonitor& progress)
{
  auto& settings = static_cast<DenoisingRunSettings&>(given);
  SurfaceOptions options;
  options.MergeCoincidentPoints = settings.MergeCoincidentPoints;
  options.MergeTolerance = settings.MergeTolerance;
  if (!this->Prepare(input, settings, options, progress.Part(0.0, 0.1)))
  {
    return;
  }
  const Surface& surface = *this->Domain;
  const TriangleMesh& mesh = surface.InputMesh();
  const double unit = mesh.LengthUnit();
  const Index count = mesh.NumberOfVertices();
  Points points(count, 3);
  for (Index i = 0; i < count; ++i)
  {
    points.row(i) = surface.Points().row(mesh.InputVertex()[i]) / unit;
  }
  Fields fields = this->ReadFields(input);
  MoveMarksToData(surface, fields, Reduction::Serial(), this->Parallel);
  const std::vector<char> fixed = MarkVertices(surface, fields.Fixed.Values);
  const auto numberOfPoints = static_cast<Index>(surface.Points().rows());
  DenoisingSettings core;
  core.NoiseLength = settings.NoiseLength;
  core.CreaseAngle = settings.CreaseAngle;
  core.Creases = FindCreases(surface, fields);
  core.DisplacementLimit = settings.DisplacementLimit / unit;
  core.NoiseLevel = settings.NoiseLevel / unit;
  core.Type = settings.SurfaceType;
  const Points moved = DenoiseSurface(
    mesh, points, fixed, core, &this->Found, this->Parallel, progress.Part(0.1, 1.0));
  this->Found.NoiseLevel *= unit;
  this->Found.CorrelationLength *= unit;
  this->Found.Relief *= unit;
  this->Found.ReliefLength *= unit;
  this->Found.MeanDisplacement *= unit;
  this->Found.MaximumDisplacement *= unit;
  Points all = surface.Points();
  for (Index p = 0; p < numberOfPoints; ++p)
  {
    const Index vertex = surface.VertexOf(p);
    if (vertex >= 0)
    {
      all.row(p) += unit * (moved.row(vertex) - points.row(vertex));
    }
  }
  this->ListResults(all);
  this->Complete(input, settings);
}

void DenoisingRun::ListResults(const Points& moved)
{
  const Surface& surface = *this->Domain;
  const TriangleMesh& mesh = surface.InputMesh();
  this->Results.clear();
  if (this->Found.MaximumDisplacement > 0.0)
  {
    this->Results.push_back(
      { "Points", Place::PerPoint, OutputType::Double, moved, Role::Coordinates });
  }
  this->Results.push_back(
    { "Displacement", Place::PerPoint, OutputType::Double, moved - surface.Points() });
  this->Results.back().IsResult = true;
  const auto add = [this](const char* name, double value, Combination over)
  { this->Results.push_back(Output::OfNumber(name, value, over)); };
  add("EffectiveNoiseLevel", this->Found.NoiseLevel, Combination::Largest);
  add("CorrelationLength", this->Found.CorrelationLength, Combination::Largest);
  add("EffectiveSurfaceType", static_cast<double>(this->Found.Type), Combination::Common);
  this->Results.back().Type = OutputType::Integer;
  add("MeanDisplacement", this->Found.MeanDisplacement, Combination::Mean);
  this->Results.back().Weight = mesh.NumberOfVertices();
  add("MaximumDisplacement", this->Found.MaximumDisplacement, Combination::Largest);
  add("VolumeBefore", EnclosedVolume(mesh, surface.Points(), this->Parallel), Combination::Sum);
  add("VolumeAfter", EnclosedVolume(mesh, moved, this->Parallel), Combination::Sum);
}

} // namespace SurfaceDiffusion
