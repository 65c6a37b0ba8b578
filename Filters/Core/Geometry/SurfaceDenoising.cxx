// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/SurfaceDenoising.h"

#include "Core/Geometry/CorrelatedVertexNoise.h"
#include "Core/Geometry/CreaseEdges.h"
#include "Core/Geometry/DenoisingScheme.h"
#include "Core/Geometry/InnerEdges.h"
#include "Core/Geometry/QuadricDistances.h"
#include "Core/Geometry/Spikes.h"
#include "Core/Geometry/SurfaceParts.h"
#include "Core/Geometry/VertexNoise.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// Estimates below this, in h, are taken for none: they are rounded coordinates, and turn normals
/// by half a degree.
constexpr double SmallestEstimate = 0.005;
/// A given level below this, in h, is none: that of points in single precision.
constexpr double SmallestNoise = 1e-4;
constexpr double SmallestNoiseLength = 0.5; ///< of noise that is not independent, in h
/// A displacement beyond this many noise levels is reported.
constexpr double FarDisplacement = 10.0;
/// Of two triangles, the fourth corner is that near to the plane of the first three, in noise levels,
/// at no more than 1 % of the edges under noise, and at a third of them and more where quadrilaterals
/// are cut in two. Steps of depth cameras leave up to a fifth.
constexpr double FlatDistance = 0.01;
constexpr double LargestFlatShare = 0.25;
/// Between them, displacements are those of noise and not of relief, see TailOfDisplacements().
constexpr double SmallestTail = 0.9;
constexpr double LargestTail = 1.15;

/// The standard deviation of the noise along the normals: that of `correlated` noise if some was found,
/// otherwise that of white noise. NaN if too few vertices are on smooth faces for an estimate.
double EstimateNoise(const TriangleMesh& mesh, const Points& points,
  const CorrelatedNoise& correlated, const ParallelFor& parallel)
{
  if (correlated.Length > 0.0)
  {
    return correlated.Level;
  }
  const double estimate = EstimateVertexNoise(mesh, points, parallel);
  return estimate < SmallestEstimate * mesh.MeanEdgeLength() ? 0.0 : estimate;
}

/// Whether neighbouring triangles lie in one plane so often that noise of this level, which leaves
/// none of them there, is no explanation: vertices are at corners and edges of the shape.
bool HasFlatFaces(const TriangleMesh& mesh, const Points& points, double noise)
{
  Index inner = 0;
  Index flat = 0;
  ForEachInnerEdge(mesh,
    [&](Index low, Index high, Index first, Index second)
    {
      const Eigen::RowVector3d from = points.row(low);
      const Eigen::RowVector3d along = points.row(high) - from;
      const Eigen::RowVector3d other = points.row(first) - from;
      const Eigen::RowVector3d normal = along.cross(other).stableNormalized();
      ++inner;
      flat += std::abs(normal.dot(points.row(second) - from)) < FlatDistance * noise;
    });
  return flat > LargestFlatShare * inner;
}

/// TailOfNormal() of the displacements along the normals of the moved surface: 1 for noise that is
/// everywhere the same.
double TailOfDisplacements(const TriangleMesh& mesh, const Points& from, const Points& to)
{
  std::vector<double> distances;
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    if (to.row(i) == from.row(i)) // fixed
    {
      continue;
    }
    Eigen::RowVector3d normal = Eigen::RowVector3d::Zero();
    for (Index k = mesh.VertexCornersBegin()[i]; k < mesh.VertexCornersBegin()[i + 1]; ++k)
    {
      const Index corner = mesh.VertexCorners()[k];
      const Eigen::RowVector3d a = to.row(mesh.OtherCorner(corner, 1)) - to.row(i);
      const Eigen::RowVector3d b = to.row(mesh.OtherCorner(corner, 2)) - to.row(i);
      normal += a.cross(b);
    }
    distances.push_back(std::abs((to.row(i) - from.row(i)).dot(normal.stableNormalized())));
  }
  return distances.empty() ? 1.0 : TailOfNormal(distances);
}

/// The enclosed volume of each connected component; 0 unless it is closed and consistently oriented.
/// places: per row of the input.
std::vector<double> VolumesOfComponents(const TriangleMesh& mesh, const Points& places)
{
  std::vector<std::pair<Index, Index>> sides, reversed;
  for (Index c = 0; c < 3 * mesh.NumberOfTriangles(); ++c)
  {
    const Index from = mesh.OtherCorner(c, 1);
    const Index to = mesh.OtherCorner(c, 2);
    sides.emplace_back(from, to);
    reversed.emplace_back(to, from);
  }
  std::sort(sides.begin(), sides.end());
  std::sort(reversed.begin(), reversed.end());
  const std::vector<Index>& begin = mesh.ComponentsBegin();
  std::vector<double> volumes;
  std::size_t first = 0;
  for (Index c = 0; c < mesh.NumberOfComponents(); ++c)
  {
    const auto at = [&](Index i) -> Eigen::RowVector3d
    { return places.row(mesh.InputVertex()[i]) - places.row(mesh.InputVertex()[begin[c]]); };
    bool isClosed = true;
    double volume = 0.0;
    for (; first < sides.size() && sides[first].first < begin[c + 1]; ++first)
    {
      isClosed = isClosed && sides[first] == reversed[first];
    }
    for (Index i = begin[c]; i < begin[c + 1] && isClosed; ++i)
    {
      // a third of the tetrahedra over the triangles around the vertex
      for (Index k = mesh.VertexCornersBegin()[i]; k < mesh.VertexCornersBegin()[i + 1]; ++k)
      {
        const Index corner = mesh.VertexCorners()[k];
        volume += at(i).dot(at(mesh.OtherCorner(corner, 1)).cross(at(mesh.OtherCorner(corner, 2))));
      }
    }
    volumes.push_back(isClosed ? volume / 18.0 : 0.0);
  }
  return volumes;
}

/// A displacement, shortened to the limit unless this is 0.
Eigen::RowVector3d WithinLimit(const Eigen::RowVector3d& step, double limit)
{
  const double length = step.norm();
  return limit > 0.0 && length > limit ? Eigen::RowVector3d(limit / length * step) : step;
}

/// What was found of a part, and the displacements of its rows.
struct DenoisedPart
{
  double NoiseLevel = 0.0;
  double CorrelationLength = 0.0;
  double Relief = 0.0, ReliefLength = 0.0, ReliefEdges = 0.0;
  double Tail = 1.0; ///< of independent noise whose level was estimated
  SurfaceType Type = SurfaceType::Automatic;
  bool IsCoarse = false; ///< its noise cannot be distinguished from its shape
  double VolumeChange = 0.0; ///< over the volume
  Points Displacements;
  std::vector<Index> Spikes; ///< rows
};

/// Move spikes between their neighbours. Returns their rows and displacements.
std::vector<std::pair<Index, Eigen::RowVector3d>> PlaceSpikes(const TriangleMesh& mesh,
  SurfacePart& part, const std::vector<char>& fixed, const ParallelFor& parallel)
{
  std::vector<std::pair<Index, Eigen::RowVector3d>> moved;
  for (const auto& [vertex, place] : FindSpikes(mesh, GatherVertices(mesh, part.Places), parallel))
  {
    const Index row = mesh.InputVertex()[vertex];
    if (fixed.empty() || !fixed[row])
    {
      moved.emplace_back(row, place - part.Places.row(row));
    }
  }
  for (const auto& [row, step] : moved)
  {
    part.Places.row(row) += step;
  }
  return moved;
}

/// What is known of the noise before it is measured, see DenoisingSettings; in the unit of the mesh.
CorrelatedNoise FindCorrelation(const TriangleMesh& mesh, const Points& points, double given,
  const DenoisingSettings& settings, const ParallelFor& parallel)
{
  if (settings.NoiseLength >= SmallestNoiseLength)
  {
    return NoiseOfLength(mesh, points, settings.NoiseLength, given, parallel);
  }
  const bool isIndependent =
    settings.NoiseLength > 0.0 || (given > 0.0 && settings.Type == SurfaceType::Organic);
  return isIndependent ? CorrelatedNoise() : EstimateCorrelatedNoise(mesh, points, given, parallel);
}

/// fixed: per row of the part, may be empty; creases: pairs of rows. The part loses its places and
/// faces, which the mesh has.
DenoisedPart DenoisePart(SurfacePart& part, const std::vector<char>& fixed,
  const VertexPairs& creasesOfRows, const DenoisingSettings& settings, const ParallelFor& parallel,
  const ProgressMonitor& progress)
{
  auto shape = std::make_unique<const TriangleMesh>(part.Places, part.Faces, parallel);
  std::vector<std::pair<Index, Eigen::RowVector3d>> spikes;
  if (!part.IsCoarse)
  {
    spikes = PlaceSpikes(*shape, part, fixed, parallel);
  }
  if (!spikes.empty())
  {
    shape = std::make_unique<const TriangleMesh>(part.Places, part.Faces, parallel);
  }
  const TriangleMesh& mesh = *shape;
  const double unit = mesh.LengthUnit();
  const Points points = GatherVertices(mesh, part.Places) / unit;
  const Eigen::Index rows = part.Places.rows();
  part.Places = Points();
  part.Faces = Triangles();
  progress.Report(0.02);
  const double given = settings.NoiseLevel / unit;
  const CorrelatedNoise correlated = FindCorrelation(mesh, points, given, settings, parallel);
  const double noise = given > 0.0 ? given : EstimateNoise(mesh, points, correlated, parallel);
  progress.Report(0.05);
  DenoisedPart result;
  result.Displacements = Points::Zero(rows, 3);
  const bool isFound = noise > SmallestNoise * mesh.MeanEdgeLength();
  const bool isEstimated = !(given > 0.0 || correlated.Level > 0.0);
  if (std::isnan(noise) || (isFound && isEstimated && HasFlatFaces(mesh, points, noise)))
  {
    result.IsCoarse = true;
    return result;
  }
  result.NoiseLevel = noise * unit;
  for (const auto& [row, step] : spikes)
  {
    result.Displacements.row(row) = step;
    result.Spikes.push_back(row);
  }
  if (!isFound)
  {
    return result;
  }
  const VertexPairs creases = FindCreases(mesh, points, settings.CreaseAngle, creasesOfRows);
  const auto count = static_cast<std::size_t>(mesh.NumberOfVertices());
  std::vector<char> isFixed(fixed.empty() && creases.empty() ? 0 : count, 0);
  for (std::size_t i = 0; i < count && !fixed.empty(); ++i)
  {
    isFixed[i] = fixed[mesh.InputVertex()[i]];
  }
  for (const auto& [i, j] : creases)
  {
    isFixed[i] = isFixed[j] = 1;
  }
  const double h = mesh.MeanEdgeLength();
  const bool isCorrelated = correlated.Length > 0.0;
  const DenoisingScheme scheme = isCorrelated ? SchemeForCorrelatedNoise(correlated.Length / h)
                                              : SchemeForIndependentNoise(noise / h);
  const SurfaceType type = isCorrelated ? SurfaceType::CAD : settings.Type;
  DenoisedSurface denoised = DenoiseWithScheme(
    mesh, points, isFixed, creases, noise, scheme, type, parallel, progress.Part(0.05, 1.0));
  const bool isCertain = !isEstimated && !correlated.MayBeRelief;
  const double tail = isCertain ? 1.0 : TailOfDisplacements(mesh, points, denoised.Moved);
  if (correlated.MayBeRelief && !(SmallestTail < tail && tail < LargestTail))
  {
    result.NoiseLevel = 0.0;
    result.Relief = noise * unit;
    result.ReliefLength = correlated.Length * unit;
    result.ReliefEdges = correlated.Length / (std::sqrt(2.0) * h);
    return result;
  }
  result.Tail = isEstimated ? tail : 1.0;
  result.Type = settings.Type == SurfaceType::Automatic ? denoised.Type : settings.Type;
  result.CorrelationLength = correlated.Length * unit;
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    denoised.Moved.row(i) = points.row(i) +
      WithinLimit(denoised.Moved.row(i) - points.row(i), settings.DisplacementLimit / unit);
  }
  Points places = Points::Zero(rows, 3);
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    places.row(mesh.InputVertex()[i]) = unit * points.row(i);
    result.Displacements.row(mesh.InputVertex()[i]) +=
      unit * (denoised.Moved.row(i) - points.row(i));
  }
  const std::vector<double> before = VolumesOfComponents(mesh, places);
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    places.row(mesh.InputVertex()[i]) = unit * denoised.Moved.row(i);
  }
  const std::vector<double> after = VolumesOfComponents(mesh, places);
  for (std::size_t c = 0; c < before.size(); ++c)
  {
    const double change = before[c] != 0.0 ? after[c] / before[c] - 1.0 : 0.0;
    if (std::abs(change) > std::abs(result.VolumeChange))
    {
      result.VolumeChange = change;
    }
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
  std::vector<SurfacePart> parts = DivideSurface(mesh, points, parallel);
  progress.Report(0.02);
  DenoisingReport found;
  TypeOfParts type;
  Points moved = points;
  const double count = std::max<Index>(1, mesh.NumberOfVertices());
  double done = 0.0;
  double variance = 0.0;
  const std::vector<VertexPairs> creases = DivideCreases(mesh, parts, settings.Creases);
  for (std::size_t p = 0; p < parts.size(); ++p)
  {
    SurfacePart& part = parts[p];
    const std::size_t size = part.Vertices.size();
    std::vector<char> isFixed;
    for (std::size_t i = 0; i < size && !fixed.empty(); ++i)
    {
      isFixed.push_back(fixed[part.Vertices[i]]);
    }
    found.Parts += part.Components;
    const double end = done + static_cast<double>(size) / count;
    const ProgressMonitor partProgress = progress.Part(0.02 + 0.98 * done, 0.02 + 0.98 * end);
    done = end;
    if (part.IsCoarse && !(settings.NoiseLevel > 0.0))
    {
      found.CoarseParts += part.Components;
      partProgress.Report(1.0);
      continue;
    }
    const DenoisedPart denoised =
      DenoisePart(part, isFixed, creases[p], settings, parallel, partProgress);
    found.CoarseParts += denoised.IsCoarse;
    found.VolumeChange = std::abs(denoised.VolumeChange) > std::abs(found.VolumeChange)
      ? denoised.VolumeChange
      : found.VolumeChange;
    found.CorrelationLength = std::max(found.CorrelationLength, denoised.CorrelationLength);
    found.Tail = std::max(found.Tail, denoised.Tail);
    if (denoised.Relief > found.Relief)
    {
      found.Relief = denoised.Relief;
      found.ReliefLength = denoised.ReliefLength;
      found.ReliefEdges = denoised.ReliefEdges;
    }
    type.Add(denoised.Type);
    const double level = denoised.NoiseLevel;
    for (std::size_t i = 0; i < size; ++i)
    {
      const Eigen::RowVector3d step =
        WithinLimit(denoised.Displacements.row(i), settings.DisplacementLimit);
      found.LimitedVertices +=
        settings.DisplacementLimit > 0.0 && step.norm() > (1.0 - 1e-9) * settings.DisplacementLimit;
      moved.row(part.Vertices[i]) += step;
      variance += level * level / count;
      found.MeanDisplacement += step.norm() / count;
      found.MaximumDisplacement = std::max(found.MaximumDisplacement, step.norm());
      found.FarVertices += step.norm() > FarDisplacement * level;
    }
    found.Spikes += static_cast<Index>(denoised.Spikes.size());
    for (const Index row : denoised.Spikes)
    {
      found.FarVertices -= denoised.Displacements.row(row).norm() > FarDisplacement * level;
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
