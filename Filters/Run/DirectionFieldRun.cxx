// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/DirectionFieldRun.h"

#include "Core/Geometry/OrientedNormals.h"
#include "Core/Surface/TangentVectors.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// The default of SmoothingLength, in mean edge lengths.
constexpr double DefaultSmoothing = 4.0;

/// The connected components without a line, and their triangles.
std::pair<Index, Index> CountZeroParts(const TriangleMesh& mesh, const TangentVectors& field)
{
  const std::vector<Index>& begin = mesh.ComponentsBegin();
  std::vector<char> hasLine(static_cast<std::size_t>(mesh.NumberOfComponents()), 0);
  const auto partOf = [&](Index t)
  {
    const auto end = std::upper_bound(begin.begin(), begin.end(), mesh.TriangleVertices()(t, 0));
    return static_cast<std::size_t>(end - begin.begin() - 1);
  };
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    if ((field.row(t).array() != 0.0).any())
    {
      hasLine[partOf(t)] = 1;
    }
  }
  Index triangles = 0;
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    triangles += hasLine[partOf(t)] ? 0 : 1;
  }
  return { static_cast<Index>(std::count(hasLine.begin(), hasLine.end(), 0)), triangles };
}

double RadiansFromDegrees(double degrees)
{
  return degrees * std::acos(-1.0) / 180.0;
}

} // namespace

void DirectionFieldSettings::Visit(SettingVisitor& visitor)
{
  visitor.Choice({ "Method", "", "The method that computes the field." }, this->Method,
    { "PrincipalCurvature", "CurvatureAligned", "Smooth", "Hints" });
  visitor.Choice({ "PrincipalDirection", "",
                   "The principal direction: of minimum curvature (the axis of a cylinder) or of "
                   "maximum curvature, by absolute value. With Method Smooth it selects one of "
                   "several equally smooth fields.",
                   "Method!=Hints" },
    this->PrincipalDirection, { "Minimum", "Maximum" }, {});
  visitor.Number({ "SmoothingLength", "coordinates",
                   "Full width at half maximum of the blur of the normals before curvature is "
                   "measured, in the unit of the coordinates. 0: none. -1: four mean edge "
                   "lengths.",
                   "Method!=Hints" },
    this->SmoothingLength,
    SettingRange::NonNegativeOr(-1.0, "finite numbers, 0 or more, or -1: four mean edge lengths"));
  visitor.Number({ "HintWeight", "1/h^2",
                   "The weight of hints and curvature relative to smoothness, above 0, in 1/h^2, "
                   "where h is the mean edge length. The field follows them over lengths down to "
                   "h/sqrt(HintWeight). Used by CurvatureAligned and Hints.",
                   "Method=CurvatureAligned or Method=Hints" },
    this->HintWeight, SettingRange::Positive());
  visitor.Number({ "Angle", "degrees",
                   "The angle, in degrees, by which the field is rotated in the surface at the "
                   "end, counter-clockwise about the normals.",
                   SettingScope::Output },
    this->Angle, SettingRange::AnyFinite());
  VisitMerging(visitor, this->MergeCoincidentPoints, this->MergeTolerance);
}

void DirectionFieldSettings::Check(const FieldSummary* fields, Problems& problems)
{
  CheckRanges(*this, problems);
  if (fields && this->Method == DirectionMethod::Hints && !fields->Directions)
  {
    Sentence text = Word::Setting("Method");
    text << " is " << Word::Choice("Method", this->Method, "Hints") << " but "
         << Word::Array("DirectionArray")
         << " is not set; allowed: an array of directions on points or " << Word::Cells();
    problems.push_back(text);
  }
}

void DirectionFieldRun::Update(
  const BlockInput& input, Settings& given, const ProgressMonitor& progress)
{
  auto& settings = static_cast<DirectionFieldSettings&>(given);
  SurfaceOptions options;
  options.MergeCoincidentPoints = settings.MergeCoincidentPoints;
  options.MergeTolerance = settings.MergeTolerance;
  if (this->Prepare(input, settings, options, progress.Part(0.0, 0.1)))
  {
    this->MakeField(input, settings, progress.Part(0.1, 1.0));
    this->Complete(input, settings);
  }
  TangentVectors rotated = this->Field;
  RotateLines(rotated, RadiansFromDegrees(settings.Angle), this->Parallel);
  this->Turned = 0;
  constexpr double rightAngle = 90.0; // of lines both senses of it are the same
  if (std::fmod(settings.Angle, rightAngle) != 0.0)
  {
    this->RotateTurnedTriangles(RadiansFromDegrees(settings.Angle), rotated);
  }
  this->Results = { { "Direction", Place::PerTriangle, OutputType::Double, rotated,
    Role::Vectors } };
  this->Results.front().IsResult = true;
}

/// The sense of an angle is that around the normals of the whole surface.
void DirectionFieldRun::RotateTurnedTriangles(double angle, TangentVectors& lines)
{
  const Surface& surface = *this->Domain;
  const TriangleMesh& mesh = surface.Mesh();
  const OrientedNormals normals =
    FindOrientedNormals(mesh, VertexPositions(surface), this->Parallel);
  this->Turned = normals.TurnedTriangles;
  if (this->Turned == 0)
  {
    return;
  }
  TangentVectors opposite = this->Field;
  RotateLines(opposite, -angle, this->Parallel);
  const Triangles triangles = surface.MakeTriangles();
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const auto axes = TriangleAxes(mesh, surface.Points(), triangles, t);
    if (axes.col(0).cross(axes.col(1)).dot(normals.OfTriangles.row(t)) < 0.0)
    {
      lines.row(t) = opposite.row(t);
    }
  }
}

void DirectionFieldRun::MakeField(
  const BlockInput& input, const DirectionFieldSettings& settings, const ProgressMonitor& progress)
{
  const TriangleMesh& mesh = this->Domain->Mesh();
  const double h = this->MeanEdgeLength() / mesh.LengthUnit();
  DirectionSettings core;
  core.Method = settings.Method;
  core.Perpendicular = settings.PrincipalDirection == 1;
  core.SmoothingLength = settings.SmoothingLength == -1.0
    ? DefaultSmoothing * h
    : settings.SmoothingLength / mesh.LengthUnit();
  core.HintWeight = settings.HintWeight / (h * h);
  core.MaximumNumberOfSteps = settings.MaximumNumberOfSteps;
  const TangentVectors hints =
    MakeDirections(*this->Domain, this->ReadFields(input), this->Parallel);
  this->Field = MakeDirectionField(*this->Domain->SharedAssembler(), this->Domain->Points(),
    this->Domain->MakeTriangles(), hints, core, this->Parallel, progress, &this->Report);
  this->WithoutDirection = static_cast<Index>((this->Field.array() == 0.0).rowwise().all().count());
  this->Method = settings.Method;
  this->Parts = mesh.NumberOfComponents();
  this->PartsWithoutCurvature = 0;
  if (settings.Method == DirectionMethod::PrincipalCurvature ||
    settings.Method == DirectionMethod::CurvatureAligned)
  {
    const auto [parts, triangles] = CountZeroParts(mesh, this->Field);
    this->PartsWithoutCurvature = parts;
    this->WithoutDirection -= triangles;
  }
}

std::vector<Warning> DirectionFieldRun::FindOwnWarnings() const
{
  Fingerprint inputs = this->SurfaceVersion;
  inputs.Add(this->FieldsVersion);
  std::vector<Warning> warnings;
  const char* const triangles = this->WithoutDirection == 1 ? " triangle" : " triangles";
  if (this->WithoutDirection > 0 && this->Method == DirectionMethod::Hints)
  {
    warnings.push_back({ Sentence("no direction of ")
        << Word::Array("DirectionArray") << " reaches " << this->WithoutDirection << triangles
        << ", where the field is 0: directions along the surface spread across edges and fade",
      inputs });
  }
  if (this->PartsWithoutCurvature > 0)
  {
    Sentence sentence("the surface has");
    if (this->Parts > 1)
    {
      sentence = Sentence();
      sentence << this->PartsWithoutCurvature << " of " << this->Parts << " parts have";
    }
    sentence
      << " no direction of curvature: flat, equally curved in all directions, or of the size of "
      << Word::Setting("SmoothingLength") << " (for a field there, set " << Word::Setting("Method")
      << " to " << Word::Choice("Method", DirectionMethod::Smooth, "Smooth") << ")";
    warnings.push_back({ sentence, inputs });
  }
  if (this->WithoutDirection > 0 && this->Method == DirectionMethod::PrincipalCurvature)
  {
    Sentence text;
    text << this->WithoutDirection << triangles
         << " have the same curvature in all directions, up to what the rounding of the "
            "coordinates may cause, and the field is 0 there; "
         << Word::Setting("Method") << " "
         << Word::Choice("Method", DirectionMethod::CurvatureAligned, "CurvatureAligned")
         << " continues it";
    warnings.push_back({ text, inputs });
  }
  std::ostringstream text;
  this->AppendLongEdges(warnings);
  this->AppendMissedResidual(this->Report.MissedResidual, warnings);
  this->AppendTurnedTriangles(this->Turned, warnings);
  if (this->Report.UnsettledChange > 0.0)
  {
    text << "the search for the smoothest field ended at its largest number of steps; the last "
            "one changed the field by "
         << 100.0 * this->Report.UnsettledChange << " %";
    warnings.push_back({ text.str(), inputs });
  }
  return warnings;
}

} // namespace SurfaceDiffusion
