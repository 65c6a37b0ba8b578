// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/SurfaceDenoising.h"

#include "Core/Geometry/DenoisingScheme.h"
#include "Core/Geometry/SurfaceParts.h"
#include "Core/Geometry/VertexNoise.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// Estimates below this, in h, are taken for none: they are rounded coordinates, and turn normals
/// by half a degree.
constexpr double SmallestEstimate = 0.005;
/// A given level below this, in h, is none: that of points in single precision.
constexpr double SmallestNoise = 1e-4;
/// A displacement beyond this many noise levels is reported.
constexpr double FarDisplacement = 10.0;

/// correlated: what was found of it.
double EstimateNoise(const TriangleMesh& mesh, const Points& points,
  const CorrelatedNoise& correlated, const ParallelFor& parallel)
{
  if (correlated.Level > 0.0)
  {
    return correlated.Level;
  }
  const double estimate = EstimateVertexNoise(mesh, points, parallel);
  return estimate < SmallestEstimate * mesh.MeanEdgeLength() ? 0.0 : estimate;
}

/// What was found of a part, and the displacements of its rows in their units.
struct DenoisedPart
{
  double NoiseLevel = 0.0; ///< in Units
  double CorrelationLength = 0.0; ///< the same
  SurfaceType Type = SurfaceType::Automatic;
  Points Displacements;
};

/// fixed: per row of the part, may be empty. The part loses its places and faces, which the mesh
/// has.
DenoisedPart DenoisePart(SurfacePart& part, const std::vector<char>& fixed,
  const DenoisingSettings& settings, const ParallelFor& parallel, const ProgressMonitor& progress)
{
  const TriangleMesh mesh(part.Places, part.Faces, parallel);
  const double unit = mesh.LengthUnit();
  const Points points = GatherVertices(mesh, part.Places) / unit;
  const Eigen::Index rows = part.Places.rows();
  part.Places = Points();
  part.Faces = Triangles();
  progress.Report(0.02);
  const double given = settings.NoiseLevel / unit;
  const CorrelatedNoise correlated = given > 0.0 && settings.Type == SurfaceType::Organic
    ? CorrelatedNoise()
    : EstimateCorrelatedNoise(mesh, points, given, parallel);
  const double noise = given > 0.0 ? given : EstimateNoise(mesh, points, correlated, parallel);
  progress.Report(0.05);
  DenoisedPart result;
  result.NoiseLevel = noise * unit;
  result.Displacements = Points::Zero(rows, 3);
  if (!(noise > SmallestNoise * mesh.MeanEdgeLength()))
  {
    return result;
  }
  std::vector<char> isFixed;
  for (Index i = 0; i < mesh.NumberOfVertices() && !fixed.empty(); ++i)
  {
    isFixed.push_back(fixed[mesh.InputVertex()[i]]);
  }
  const double h = mesh.MeanEdgeLength();
  const bool isCorrelated = correlated.Length > 0.0;
  const DenoisingScheme scheme = isCorrelated ? SchemeForCorrelatedNoise(correlated.Length / h)
                                              : SchemeForIndependentNoise(noise / h);
  const SurfaceType type = isCorrelated ? SurfaceType::CAD : settings.Type;
  const DenoisedSurface denoised = DenoiseWithScheme(
    mesh, points, isFixed, noise, scheme, type, parallel, progress.Part(0.05, 1.0));
  result.Type = settings.Type == SurfaceType::Automatic ? denoised.Type : settings.Type;
  result.CorrelationLength = correlated.Length * unit;
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    result.Displacements.row(mesh.InputVertex()[i]) =
      unit * (denoised.Moved.row(i) - points.row(i));
  }
  return result;
}

/// Joins the types of parts, some of which have none.
class TypeOfParts
{
public:
  void Add(SurfaceType type)
  {
    if (type != SurfaceType::Automatic)
    {
      this->Differ = this->Differ || (this->Known != SurfaceType::Automatic && this->Known != type);
      this->Known = type;
    }
  }
  SurfaceType Common() const { return this->Differ ? SurfaceType::Automatic : this->Known; }

private:
  SurfaceType Known = SurfaceType::Automatic;
  bool Differ = false;
};

} // namespace

Points DenoiseSurface(const TriangleMesh& mesh, const Points& points,
  const std::vector<char>& fixed, const DenoisingSettings& settings, DenoisingReport* report,
  const ParallelFor& parallel, const ProgressMonitor& progress)
{
  std::vector<SurfacePart> parts = DivideSurface(
    mesh, points, settings.NoiseLevel > 0.0 ? PartUnit::Common : PartUnit::OwnEdges, parallel);
  progress.Report(0.02);
  DenoisingReport found;
  TypeOfParts type;
  Points moved = points;
  const double count = std::max<Index>(1, mesh.NumberOfVertices());
  double done = 0.0;
  double variance = 0.0;
  for (SurfacePart& part : parts)
  {
    const std::size_t size = part.Vertices.size();
    std::vector<char> isFixed;
    for (std::size_t i = 0; i < size && !fixed.empty(); ++i)
    {
      isFixed.push_back(fixed[part.Vertices[i]]);
    }
    const double end = done + static_cast<double>(size) / count;
    const DenoisedPart denoised = DenoisePart(
      part, isFixed, settings, parallel, progress.Part(0.02 + 0.98 * done, 0.02 + 0.98 * end));
    done = end;
    type.Add(denoised.Type);
    for (std::size_t i = 0; i < size; ++i)
    {
      const Eigen::RowVector3d step = part.Units[i] * denoised.Displacements.row(i);
      const double level = part.Units[i] * denoised.NoiseLevel;
      moved.row(part.Vertices[i]) += step;
      variance += level * level / count;
      found.CorrelationLength =
        std::max(found.CorrelationLength, part.Units[i] * denoised.CorrelationLength);
      found.MeanDisplacement += step.norm() / count;
      found.MaximumDisplacement = std::max(found.MaximumDisplacement, step.norm());
      found.FarVertices += step.norm() > FarDisplacement * level;
    }
  }
  found.NoiseLevel = settings.NoiseLevel > 0.0 ? settings.NoiseLevel : std::sqrt(variance);
  found.Type = type.Common();
  if (report)
  {
    *report = found;
  }
  progress.Report(1.0);
  return moved;
}

} // namespace SurfaceDiffusion
