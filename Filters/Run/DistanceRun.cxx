// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/DistanceRun.h"

#include "Core/Geometry/Derivatives.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

constexpr double Never = std::numeric_limits<double>::infinity();

} // namespace

void DistanceSettings::Visit(SettingVisitor& visitor)
{
  visitor.Choice({ "Method", "",
                   "Heat: the heat method, with smooth level sets. Eikonal: fast marching, with "
                   "smaller errors, exact in planes; also with speeds and start times." },
    this->Method, { "Heat", "Eikonal" });
  visitor.Number({ "MaximumDistance", "coordinates",
                   "The largest distance of points and lines of sources from the surface, in the "
                   "unit of the coordinates: those farther away do not count. 0: any distance." },
    this->MaximumDistance, SettingRange::NonNegative());
  visitor.Number({ "AlongSpeed", "",
                   "Factor of the speed of fronts along the direction, above 0. If it differs from "
                   "AcrossSpeed, DirectionArray is required." },
    this->AlongSpeed, SettingRange::Positive());
  visitor.Number(
    { "AcrossSpeed", "", "Factor of the speed of fronts across the direction, above 0." },
    this->AcrossSpeed, SettingRange::Positive());
  visitor.Switch({ "ComputeGradient", "",
                   "On: the gradient of the result is added, vectors in the tangent planes that "
                   "point away from the sources." },
    this->ComputeGradient);
  VisitMerging(visitor, this->MergeCoincidentPoints, this->MergeTolerance);
}

void DistanceSettings::Check(const FieldSummary* fields, Problems& problems)
{
  CheckRanges(*this, problems);
  if (!fields)
  {
    return;
  }
  if (!fields->Data && !fields->Sources)
  {
    problems.push_back(Sentence(Word::Array("SourceArray"))
      << " is not set; allowed: an array on points, whose nonzero points are the sources, or "
         "sources as a second input");
  }
  const std::pair<bool, const char*> timing[] = { { fields->Speeds, "SpeedArray" },
    { fields->StartTimes, "SourceTimes" } };
  for (const auto& [isSet, name] : timing)
  {
    if (isSet)
    {
      RequireChoice("Method", this->Method, DistanceMethod::Eikonal, "Eikonal",
        Sentence(Word::Array(name)), problems);
    }
  }
  if (this->HasSpeed())
  {
    RequireChoice("Method", this->Method, DistanceMethod::Eikonal, "Eikonal",
      Sentence(Word::Setting("AlongSpeed"))
        << " " << this->AlongSpeed << " and " << Word::Setting("AcrossSpeed") << " "
        << this->AcrossSpeed,
      problems);
  }
  RequireDirections(
    *fields, "AlongSpeed", this->AlongSpeed, "AcrossSpeed", this->AcrossSpeed, problems);
}

Vector DistanceRun::SolveHeat(const SourceSet& sources, const ProgressMonitor& progress)
{
  const std::shared_ptr<const Assembler> operators = this->Domain->SharedAssembler();
  if (this->HeatOperators != operators)
  {
    this->HeatOperators.reset();
    this->Heat.reset();
    this->Heat = std::make_unique<const HeatDistance>(
      operators, HeatDistance::UsualStep, this->Parallel, progress.Part(0.0, 0.8));
    this->HeatOperators = operators;
  }
  return this->Heat->Find({ sources.Heat }, progress.Part(0.8, 1.0)).col(0);
}

/// Times per vertex, and the front that each comes from.
GeodesicDistance::Arrival DistanceRun::Solve(const SourceSet& sources, FrontShapes triangles,
  const DistanceSettings& settings, const ProgressMonitor& progress)
{
  const Surface& surface = *this->Domain;
  const auto n = static_cast<std::size_t>(surface.Mesh().NumberOfVertices());
  const bool byHeat = settings.Method == DistanceMethod::Heat;
  GeodesicDistance::Arrival arrival{ std::vector<double>(n, Never), std::vector<Index>(n, -1) };
  if (sources.Fronts.empty())
  {
    return arrival;
  }
  if (!byHeat || sources.NameOfLabel.size() > 1)
  {
    // Triangles of different speeds do not become others.
    const auto mesh = triangles.empty() ? surface.SharedMesh() : surface.SharedInputMesh();
    const GeodesicDistance fronts(mesh, std::move(triangles));
    arrival = fronts.FindNearest(sources.Fronts, progress.Part(0.0, byHeat ? 0.2 : 1.0));
  }
  if (byHeat)
  {
    const Vector distances = this->SolveHeat(sources, progress.Part(0.2, 1.0));
    for (std::size_t i = 0; i < n; ++i)
    {
      arrival.Times[i] = distances[static_cast<Eigen::Index>(i)];
      if (sources.NameOfLabel.size() == 1)
      {
        arrival.Sources[i] = arrival.Times[i] < Never ? 0 : -1;
      }
    }
  }
  return arrival;
}

/// The means at the vertices over the triangles that fronts cross.
Values DistanceRun::FindGradient(
  const std::vector<double>& times, const FrontShapes& triangles) const
{
  const TriangleMesh& mesh = this->Domain->InputMesh();
  const Points positions = VertexPositions(*this->Domain);
  const Derivatives operators(mesh, positions, this->Parallel);
  const Index n = mesh.NumberOfVertices();
  Values finite(n, 1);
  for (Index i = 0; i < n; ++i)
  {
    const double time = times[static_cast<std::size_t>(i)];
    finite(i, 0) = time < Never ? time : 0.0;
  }
  Values ofTriangles = operators.Gradients(finite);
  Vector areas = Vector::Zero(n);
  Vector crossed = Vector::Zero(n);
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const auto row = static_cast<std::size_t>(t);
    bool isCrossed = !IsBarrier(triangles, t);
    for (int a = 0; a < 3; ++a)
    {
      isCrossed =
        isCrossed && times[static_cast<std::size_t>(mesh.TriangleVertices()(t, a))] < Never;
    }
    const double area = mesh.Shapes()[row].Area();
    for (int a = 0; a < 3; ++a)
    {
      areas[mesh.TriangleVertices()(t, a)] += area;
      crossed[mesh.TriangleVertices()(t, a)] += isCrossed ? area : 0.0;
    }
    if (!isCrossed)
    {
      ofTriangles.row(t).setZero();
    }
  }
  Values gradient = operators.ToVertices(ofTriangles);
  for (Index i = 0; i < n; ++i)
  {
    gradient.row(i) *= crossed[i] > 0.0 ? areas[i] / crossed[i] : 0.0;
  }
  return gradient;
}

void DistanceRun::Update(const BlockInput& input, Settings& given, const ProgressMonitor& progress)
{
  auto& settings = static_cast<DistanceSettings&>(given);
  const BlockInput drawn = WithoutGivenAreas(input);
  SurfaceOptions options;
  options.MergeCoincidentPoints = settings.MergeCoincidentPoints;
  options.MergeTolerance = settings.MergeTolerance;
  options.IntrinsicDelaunay = true;
  options.Boundaries = BoundaryEdges::Keep; // no way leaves the surface
  if (!this->Prepare(drawn, settings, options, progress.Part(0.0, 0.2)))
  {
    return;
  }
  this->Results.clear();
  const Surface& surface = *this->Domain;
  const TriangleMesh& mesh = surface.InputMesh();
  const Fields fields = input.ReadFields();
  const FrontShapes triangles = this->MakeShapes(fields, settings);
  SourceSet sources =
    this->FindSources(drawn, fields, triangles, settings.MaximumDistance, progress.Part(0.2, 0.3));
  const GeodesicDistance::Arrival arrival =
    this->Solve(sources, triangles, settings, progress.Part(0.3, 0.95));

  const Index n = mesh.NumberOfVertices();
  Values times(n, 1);
  Values nearest(n, 1);
  const double none = sources.AreShapes ? -1.0 : 0.0;
  bool areIntegers = true;
  for (const double name : sources.NameOfLabel)
  {
    areIntegers =
      areIntegers && name == std::floor(name) && std::abs(name) <= std::numeric_limits<int>::max();
  }
  Index unreached = 0;
  for (Index i = 0; i < n; ++i)
  {
    const auto row = static_cast<std::size_t>(i);
    const Index front = arrival.Times[row] < Never ? arrival.Sources[row] : -1;
    times(i, 0) = arrival.Times[row] * mesh.LengthUnit();
    nearest(i, 0) = front < 0 ? none
                              : sources.NameOfLabel[static_cast<std::size_t>(
                                  sources.Fronts[static_cast<std::size_t>(front)].Label)];
    unreached += arrival.Times[row] < Never ? 0 : 1;
  }
  const bool areTimes =
    !fields.Speeds.Values.empty() || !fields.StartTimes.empty() || settings.HasSpeed();
  const auto add = [this](const char* name, OutputType type, Values rows, double elsewhere)
  {
    const Eigen::Index columns = rows.cols();
    this->Results.push_back({ name, Place::PerVertex, type, std::move(rows) });
    this->Results.back().Elsewhere = Values::Constant(1, columns, elsewhere);
  };
  add(areTimes ? "ArrivalTime" : "Distance", OutputType::Double, std::move(times), Never);
  this->Results.back().Active = Role::Scalars;
  this->Results.back().MayBeInfinite = true;
  add("NearestSource", areIntegers ? OutputType::Integer : OutputType::Double, std::move(nearest),
    none);
  if (settings.ComputeGradient)
  {
    add(areTimes ? "ArrivalTimeGradient" : "DistanceGradient", OutputType::Double,
      this->FindGradient(arrival.Times, triangles), 0.0);
  }
  this->AllAreSources = !areTimes && this->Domain->Mesh().NumberOfVertices() > 0 &&
    (this->Results.front().Rows.array() == 0.0).all();
  this->Results.push_back(
    Output::OfNumber("NumberOfSources", sources.Count, Combination::Sum, OutputType::Integer));
  this->Results.push_back(
    Output::OfNumber("NumberOfUnreachedPoints", unreached, Combination::Sum, OutputType::Integer));
  sources.Fronts = {};
  sources.Heat = {};
  this->Found = std::move(sources);
  this->Complete(drawn, settings);
}

void DistanceRun::RequireSource(const std::vector<const DistanceRun*>& runs)
{
  SourceSet all;
  Index vertices = 0;
  Index degenerate = 0;
  for (const DistanceRun* run : runs)
  {
    vertices += run->GetSurface().InputMesh().NumberOfVertices();
    degenerate += run->GetSurface().Diagnostics().DegenerateTriangles;
    all.Count += run->Found.Count;
    all.Given += run->Found.Given;
    all.TooFar += run->Found.TooFar;
    all.Outside += run->Found.Outside;
    all.AreShapes = run->Found.AreShapes;
  }
  // A surface whose triangles have no area is no error.
  if (all.Count > 0 || (vertices == 0 && degenerate > 0))
  {
    return;
  }
  const Sentence mask(Word::Array("MaskArray"));
  if (all.AreShapes)
  {
    throw InputError(Sentence("no source is on the surface: of the points and lines, ")
      << all.TooFar << " are farther than " << Word::Setting("MaximumDistance") << " and "
      << all.Outside << " where " << mask << " excludes the surface; allowed: one source on it");
  }
  const Sentence array(Word::Array("SourceArray"));
  if (all.Given == 0)
  {
    throw InputError(Sentence(array)
      << " marks no point; allowed: one or more, with a number other than 0 and NaN");
  }
  throw InputError(Sentence("all ")
    << all.Given << " nonzero points of " << array << " are where " << mask
    << " excludes the surface, or no triangle uses them; allowed: one of them on it");
}

std::vector<Warning> DistanceRun::FindOwnWarnings() const
{
  std::vector<Warning> warnings;
  Fingerprint inputs = this->SurfaceVersion;
  inputs.Add(this->FieldsVersion);
  if (this->Found.TooFar > 0)
  {
    Sentence text;
    text << this->Found.TooFar << " sources are farther than " << Word::Setting("MaximumDistance")
         << " from the surface and do not count";
    warnings.push_back({ text, inputs });
  }
  if (this->Found.Outside > 0)
  {
    Sentence text;
    text << this->Found.Outside << " sources are on no triangle that takes part and do not count";
    warnings.push_back({ text, inputs });
  }
  if (!this->Found.Farness.Words().empty())
  {
    warnings.push_back({ this->Found.Farness, inputs });
  }
  if (this->AllAreSources && !this->Found.AreShapes)
  {
    Sentence text("all points of the surface are sources: ");
    text << Word::Array("SourceArray") << " is 0 nowhere, and the distance 0 everywhere";
    warnings.push_back({ text, inputs });
  }
  return warnings;
}

} // namespace SurfaceDiffusion
