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

/// Make the shapes of the triangles as fronts measure them, and forget what belongs to other ones.
void DistanceRun::TakeSpeeds(const Fields& fields, const DistanceSettings& settings)
{
  if (this->MeshOfSolvers != this->Domain->SharedInputMesh())
  {
    this->MeshOfSolvers = this->Domain->SharedInputMesh();
    this->Eikonal.reset();
    this->Exact.reset();
    this->Heat.reset();
    this->Projection.reset();
  }
  this->Shapes = this->MakeShapes(fields, settings);
  Fingerprint speeds;
  speeds.AddBytes(this->Shapes.data(), this->Shapes.size() * sizeof(TriangleMesh::Shape));
  if (this->Speeds != speeds)
  {
    this->Eikonal.reset();
    this->Speeds = speeds;
  }
}

DistanceMethod DistanceRun::FindMethod(DistanceMethod given, bool areTimes, double work) const
{
  if (given != DistanceMethod::Automatic)
  {
    return given;
  }
  const bool isExact = !areTimes && ExactDistance::TakesAtMostASecond(*this->MeshOfSolvers, work);
  return isExact ? DistanceMethod::Exact : DistanceMethod::Eikonal;
}

const EikonalDistance& DistanceRun::TakeEikonal(const ProgressMonitor& progress)
{
  if (!this->Eikonal)
  {
    this->Eikonal =
      std::make_unique<const EikonalDistance>(this->MeshOfSolvers, this->Domain->SharedMesh(),
        VertexPositions(*this->Domain), this->Shapes, this->Parallel, progress);
  }
  return *this->Eikonal;
}

const ExactDistance& DistanceRun::TakeExact()
{
  if (!this->Exact)
  {
    this->Exact = std::make_unique<const ExactDistance>(this->MeshOfSolvers);
  }
  return *this->Exact;
}

Vector DistanceRun::SolveHeat(const SourceSet& sources, const ProgressMonitor& progress)
{
  if (!this->Heat)
  {
    this->Heat = std::make_unique<const HeatDistance>(this->Domain->SharedAssembler(),
      HeatDistance::UsualStep, this->Parallel, progress.Part(0.0, 0.8));
  }
  std::vector<HeatSource> heat;
  for (const SourcePiece& piece : sources.Pieces)
  {
    AppendHeat(*this->MeshOfSolvers, piece, heat);
  }
  return this->Heat->Find({ heat }, progress.Part(0.8, 1.0)).col(0);
}

bool DistanceRun::SourceSet::HaveOneName() const
{
  return std::all_of(this->Names.begin(), this->Names.end(),
    [this](double name) { return name == this->Names.front(); });
}

OutputType DistanceRun::SourceSet::TypeOfNames() const
{
  const bool areIntegers = std::all_of(this->Names.begin(), this->Names.end(),
    [](double name)
    { return name == std::floor(name) && std::abs(name) <= std::numeric_limits<int>::max(); });
  return areIntegers ? OutputType::Integer : OutputType::Double;
}

/// Times per vertex, and the piece of a source that each comes from.
GeodesicDistance::Arrival DistanceRun::Solve(
  const SourceSet& sources, DistanceMethod method, const ProgressMonitor& progress)
{
  const auto n = static_cast<std::size_t>(this->MeshOfSolvers->NumberOfVertices());
  if (sources.Pieces.empty())
  {
    return { std::vector<double>(n, Never), std::vector<Index>(n, -1) };
  }
  if (method == DistanceMethod::Exact)
  {
    return this->TakeExact().Find(sources.Pieces, Never, progress);
  }
  if (method == DistanceMethod::Eikonal)
  {
    const EikonalDistance& eikonal = this->TakeEikonal(progress.Part(0.0, 0.2));
    return eikonal.Find(sources.Pieces, sources.Starts, progress.Part(0.2, 1.0));
  }
  GeodesicDistance::Arrival arrival{ std::vector<double>(n, Never), std::vector<Index>(n, 0) };
  if (!sources.HaveOneName())
  {
    arrival = this->Solve(
      sources, this->FindMethod(DistanceMethod::Automatic, false, 1.0), progress.Part(0.0, 0.2));
  }
  const Vector distances = this->SolveHeat(sources, progress.Part(0.2, 1.0));
  for (std::size_t i = 0; i < n; ++i)
  {
    arrival.Times[i] = distances[static_cast<Eigen::Index>(i)];
    arrival.Sources[i] = arrival.Times[i] < Never ? arrival.Sources[i] : -1;
  }
  return arrival;
}

/// The means at the vertices over the triangles that fronts cross.
Values DistanceRun::FindGradient(const std::vector<double>& times) const
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
    bool isCrossed = !IsBarrier(this->Shapes, t);
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

bool DistanceRun::PrepareSurface(
  const BlockInput& drawn, DistanceSettings& settings, const ProgressMonitor& progress)
{
  SurfaceOptions options;
  options.MergeCoincidentPoints = settings.MergeCoincidentPoints;
  options.MergeTolerance = settings.MergeTolerance;
  options.IntrinsicDelaunay = true;
  options.Boundaries = BoundaryEdges::Keep; // no way leaves the surface
  return this->Prepare(drawn, settings, options, progress);
}

void DistanceRun::Update(const BlockInput& input, Settings& given, const ProgressMonitor& progress)
{
  auto& settings = static_cast<DistanceSettings&>(given);
  const BlockInput drawn = WithoutGivenAreas(input);
  if (!this->PrepareSurface(drawn, settings, progress.Part(0.0, 0.2)))
  {
    return;
  }
  this->Results.clear();
  const TriangleMesh& mesh = this->Domain->InputMesh();
  const Fields fields = this->ReadFields(input);
  this->TakeSpeeds(fields, settings);
  const ProgressMonitor ofSources = progress.Part(0.2, 0.3);
  SourceSet sources = settings.Signed
    ? this->FindSigned(drawn, fields, ofSources)
    : this->FindSources(drawn, fields, settings.MaximumDistance, ofSources);
  const bool haveStarts =
    !fields.StartTimes.empty() || (fields.Sources && !fields.Sources->StartTimes.empty());
  const bool areTimes = haveStarts || fields.HasSpeeds() || settings.HasSpeed();
  const DistanceMethod method = this->FindMethod(settings.Method, areTimes, 1.0);
  const double solved = fields.PathPoints ? 0.6 : 0.95;
  GeodesicDistance::Arrival arrival = this->Solve(sources, method, progress.Part(0.3, solved));
  for (std::size_t i = 0; i < sources.Inside.size(); ++i)
  {
    const bool isInside = sources.Inside[i] && arrival.Times[i] < Never && arrival.Times[i] > 0.0;
    arrival.Times[i] = isInside ? -arrival.Times[i] : arrival.Times[i];
  }

  const Index n = mesh.NumberOfVertices();
  Values times(n, 1);
  Values nearest(n, 1);
  const double none = sources.AreShapes ? -1.0 : 0.0;
  const OutputType typeOfNames = sources.TypeOfNames();
  Index unreached = 0;
  for (Index i = 0; i < n; ++i)
  {
    const auto row = static_cast<std::size_t>(i);
    const Index piece = arrival.Times[row] < Never ? arrival.Sources[row] : -1;
    times(i, 0) = arrival.Times[row] * mesh.LengthUnit();
    nearest(i, 0) = piece < 0 ? none : sources.Names[static_cast<std::size_t>(piece)];
    unreached += arrival.Times[row] < Never ? 0 : 1;
  }
  const auto add = [this](const char* name, OutputType type, Values rows, double elsewhere)
  {
    const Eigen::Index columns = rows.cols();
    this->Results.push_back({ name, Place::PerVertex, type, std::move(rows) });
    this->Results.back().Elsewhere = Values::Constant(1, columns, elsewhere);
  };
  add(areTimes ? "ArrivalTime" : "Distance", OutputType::Double, std::move(times), Never);
  this->Results.back().Active = Role::Scalars;
  this->Results.back().MayBeInfinite = true;
  add("NearestSource", typeOfNames, std::move(nearest), none);
  if (settings.ComputeGradient)
  {
    add(areTimes ? "ArrivalTimeGradient" : "DistanceGradient", OutputType::Double,
      this->FindGradient(arrival.Times), 0.0);
  }
  this->AllAreSources = !areTimes && this->Domain->Mesh().NumberOfVertices() > 0 &&
    (this->Results.front().Rows.array() == 0.0).all();
  this->Results.push_back(
    Output::OfNumber("NumberOfSources", sources.Count, Combination::Sum, OutputType::Integer));
  this->Results.push_back(
    Output::OfNumber("NumberOfUnreachedPoints", unreached, Combination::Sum, OutputType::Integer));
  this->Results.push_back(Output::OfNumber(
    "EffectiveMethod", static_cast<double>(method), Combination::Smallest, OutputType::Integer));
  this->OfPaths = {};
  if (fields.PathPoints)
  {
    this->AddPaths(drawn, *fields.PathPoints, sources, progress.Part(solved, 0.95));
  }
  sources.Pieces = {};
  sources.Starts = {};
  sources.Names = {};
  sources.Inside = {};
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
    all.IsSigned = run->Found.IsSigned;
  }
  // A surface whose triangles have no area is no error.
  if (all.Count > 0 || (vertices == 0 && degenerate > 0))
  {
    return;
  }
  const Sentence mask(Word::Array("MaskArray"));
  if (all.IsSigned && all.Given > all.Outside)
  {
    throw InputError(Sentence("the region of ")
      << Word::Array("SourceArray")
      << " has no boundary on the surface: it is all of it; allowed together with "
      << Word::Setting("Signed") << ": a region with points of the surface around it");
  }
  if (all.AreShapes && all.TooFar == 0)
  {
    throw InputError(Sentence("no source is on the surface: ")
      << all.Outside << " are on no triangle that " << mask
      << " and speeds above 0 leave; allowed: one source on such a triangle");
  }
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
  if (!this->OfPaths.Words().empty())
  {
    warnings.push_back({ this->OfPaths, inputs });
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
