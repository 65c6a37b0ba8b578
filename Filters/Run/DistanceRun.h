// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geodesics/EikonalDistance.h"
#include "Core/Geodesics/ExactDistance.h"
#include "Core/Geodesics/GeodesicPath.h"
#include "Run/DistanceSources.h"
#include "Run/SurfaceRun.h"
#include "Run/WarningLog.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace SurfaceDiffusion
{

enum class DistanceMethod
{
  Heat,
  Eikonal,
  Exact,
  Automatic
};

/// Distances from sources in the user's terms.
struct DistanceSettings : Settings
{
  DistanceMethod Method = DistanceMethod::Automatic;
  double MaximumDistance = 0.0;
  double AlongSpeed = 1.0;
  double AcrossSpeed = 1.0;
  bool ComputeGradient = false;
  bool Signed = false;
  bool MergeCoincidentPoints = false;
  double MergeTolerance = 0.0;

  void Visit(SettingVisitor& visitor) override;
  void Check(const FieldSummary* fields, Problems& problems) override;

  bool IsDirected() const { return this->AlongSpeed != this->AcrossSpeed; }
  /// Whether fronts have another speed than 1, apart from that of an array.
  bool HasSpeed() const { return this->AlongSpeed != 1.0 || this->AcrossSpeed != 1.0; }
};

/// A place that the user gives: a point of the surface, or barycentric coordinates in a triangle of
/// the input, or the place of the surface that is nearest to a point in space.
struct SurfacePlace
{
  std::string Name; ///< for messages
  Index Point = -1; ///< -1: it is no point of the surface
  Index Triangle = -1; ///< -1: Coordinates are those of a point in space
  Eigen::RowVector3d Coordinates = { 0.0, 0.0, 0.0 };
};

/// A path on a surface, straight in each triangle.
struct SurfacePath
{
  SurfaceDiffusion::Points Points; ///< k x 3, coordinates
  std::vector<Index> Triangles; ///< of the input, per segment
  double Length = 0.0; ///< coordinate units
};

/// The part of a surface within a distance of a place.
struct SurfaceDisk
{
  double Area = 0.0; ///< in squares of the coordinate unit
  std::vector<Points> Boundary; ///< curves; closed ones end with the point that they begin with
};

/// Distances or arrival times on one surface, kept as long as neither inputs nor settings change.
class DistanceRun : public SurfaceRun
{
public:
  explicit DistanceRun(const ParallelFor& parallel)
    : SurfaceRun(parallel, "are barriers", ", across which no path leads")
  {
  }

  /// Data, with a row per point, or Sources, and Speeds, StartTimes and PathPoints of the fields are
  /// read. A surface without source has infinite distances.
  void Update(const BlockInput& input, Settings& given, const ProgressMonitor& progress) override;
  bool ExcludesMasked() const override { return true; }

  /// A sparse matrix by rows.
  struct Matrix
  {
    std::vector<double> Data;
    std::vector<Index> Columns; ///< ascending in each row
    std::vector<std::int64_t> Begin = { 0 };
  };

  /// The distances up to a cutoff, in coordinate units or time, from each of several points of the
  /// input, one row each; empty: from all. Rows of points that are on no triangle that fronts cross are empty.
  /// Settings and inputs are those of Update(), but for the sources.
  Matrix FindEach(const BlockInput& input, Settings& given, const std::vector<Index>& points,
    double cutoff, const ProgressMonitor& progress);

  /// The shortest path through places, one or more, one after the other, and back to the first if it is
  /// closed: see GeodesicPath. Settings and inputs are those of Update(), but for speeds and
  /// sources. Throws InputError if no triangle that takes part has a place, or no path leads there.
  SurfacePath FindPath(const BlockInput& input, Settings& given,
    const std::vector<SurfacePlace>& places, bool isClosed, const ProgressMonitor& progress);

  /// The places that are no farther from one of them than radius, in coordinate units: see
  /// GeodesicDisk. As FindPath().
  SurfaceDisk FindDisk(const BlockInput& input, Settings& given, const SurfacePlace& center,
    double radius, const ProgressMonitor& progress);

  /// Throws InputError, which says why, if none of the surfaces has a source. If all triangles that
  /// the mask leaves have no area, that is no error.
  static void RequireSource(const std::vector<const DistanceRun*>& runs);

private:
  struct SourceSet
  {
    std::vector<SourcePiece> Pieces; ///< on triangles of InputMesh()
    std::vector<double> Starts; ///< per piece, in units of the mesh; empty: 0
    std::vector<double> Names; ///< per piece, what NearestSource says
    Index Count = 0; ///< of sources on the surface
    Index Given = 0; ///< of all
    Index TooFar = 0, Outside = 0;
    bool AreShapes = false;
    bool IsSigned = false;
    std::vector<char> Inside; ///< of signed distances, per vertex: nonzero where they are below 0
    Sentence Farness; ///< of shapes: a warning, or empty

    bool HaveOneName() const;
    OutputType TypeOfNames() const;
  };

  std::vector<Warning> FindOwnWarnings() const override;
  bool PrepareSurface(
    const BlockInput& drawn, DistanceSettings& settings, const ProgressMonitor& progress);
  FrontShapes MakeShapes(const Fields& fields, const DistanceSettings& settings) const;
  void TakeSpeeds(const Fields& fields, const DistanceSettings& settings);
  SourceSet FindSources(const BlockInput& input, const Fields& fields, double maximumDistance,
    const ProgressMonitor& progress);
  void AddPaths(const BlockInput& drawn, const SourceShapes& from, const SourceSet& sources,
    const ProgressMonitor& progress);
  SourceSet FindMarked(const Fields& fields) const;
  SourceSet FindPlaced(const SourceShapes& shapes) const;
  SourceSet FindProjected(const BlockInput& input, const SourceShapes& shapes,
    double maximumDistance, bool arePathPoints, const ProgressMonitor& progress);
  SourceSet FindSigned(
    const BlockInput& drawn, const Fields& fields, const ProgressMonitor& progress);
  SourceSet FindClosedLines(
    const BlockInput& drawn, const SourceShapes& shapes, const ProgressMonitor& progress);
  void MoveToBoundary(SourceSet& set) const;
  GeodesicPath::Path FindLeg(GeodesicPath& finder, const std::vector<SurfacePlace>& places,
    const std::vector<MeshPlace>& stops, std::size_t from, std::size_t to,
    const ProgressMonitor& progress) const;
  std::vector<MeshPlace> PreparePlaces(const BlockInput& input, Settings& given,
    const std::vector<SurfacePlace>& places, const ProgressMonitor& progress);
  std::vector<MeshPlace> FindPlaces(const BlockInput& drawn,
    const std::vector<SurfacePlace>& places, const ProgressMonitor& progress);
  Index CornerOf(Index point) const;
  static SourcePiece PieceAt(Index corner, Index number);
  /// That is taken. areTimes: there are speeds or start times. work: how often the whole surface is
  /// passed over.
  DistanceMethod FindMethod(DistanceMethod given, bool areTimes, double work) const;
  const EikonalDistance& TakeEikonal(const ProgressMonitor& progress);
  const ExactDistance& TakeExact();
  GeodesicDistance::Arrival Solve(
    const SourceSet& sources, DistanceMethod method, const ProgressMonitor& progress);
  Vector SolveHeat(const SourceSet& sources, const ProgressMonitor& progress);
  Values FindGradient(const std::vector<double>& times) const;

  SourceSet Found; ///< without its pieces
  Sentence OfPaths; ///< a warning, or empty
  bool AllAreSources = false;
  /// Of the mesh and the speeds, kept for other sources.
  std::shared_ptr<const TriangleMesh> MeshOfSolvers;
  Fingerprint Speeds;
  FrontShapes Shapes; ///< of InputMesh(); empty: its own
  std::unique_ptr<const EikonalDistance> Eikonal;
  std::unique_ptr<const ExactDistance> Exact;
  std::unique_ptr<const HeatDistance> Heat;
  std::unique_ptr<const SourceProjection> Projection;
};

} // namespace SurfaceDiffusion
