// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/ReliefRun.h"

#include "Run/CellFields.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// The part of the points with relief that edges make lower without a warning.
constexpr double ExpectedToBeLow = 0.05;

/// What the user should know, each in a sentence of its own. wanted: the heights before any was
/// lowered.
std::vector<Sentence> DescribeRelief(const Relief& relief, const Vector& wanted)
{
  std::vector<Sentence> sentences;
  Sentence text;
  if (relief.OpenEdges > 0)
  {
    text << "the surface has " << relief.OpenEdges
         << " open edges, where there is no relief: it is not closed, as printing requires";
    sentences.push_back(text);
  }
  if (relief.NonManifoldEdges > 0)
  {
    text = Sentence();
    text << "the surface has " << relief.NonManifoldEdges
         << " edges of more than two triangles, where there is no relief";
    sentences.push_back(text);
  }
  if (relief.RepeatedTriangles > 0)
  {
    text = Sentence();
    text
      << relief.RepeatedTriangles
      << " triangles have the same corners as others, and count once: printing wants each one once";
    sentences.push_back(text);
  }
  if (relief.OverlappingBodies > 0)
  {
    text = Sentence();
    text << "pairs of bodies that overlap: " << relief.OverlappingBodies
         << "; slicers unite them, and what is inside another body has no relief";
    sentences.push_back(text);
  }
  if (relief.CrossingTrianglesBefore > 0)
  {
    text = Sentence();
    text << "the surface crosses itself at " << relief.CrossingTrianglesBefore
         << " triangles without the relief";
    sentences.push_back(text);
  }
  if (relief.CrossingTriangles > relief.CrossingTrianglesBefore)
  {
    text = Sentence();
    text << "the relief crosses itself at " << relief.CrossingTriangles << " triangles";
    sentences.push_back(text);
  }
  const Eigen::ArrayXd heights = wanted.array().abs();
  const double largest = heights.size() > 0 ? heights.maxCoeff() : 0.0;
  const Eigen::Index low = (heights - relief.Heights.array().abs() > 0.5 * largest).count();
  const Eigen::Index raised = (heights > 0.0).count();
  if (static_cast<double>(low) > ExpectedToBeLow * static_cast<double>(raised))
  {
    text = Sentence();
    text << "the relief of up to " << largest << " is lowered by more than half of that at " << low
         << " of " << heights.size() << " points, where a wall or an edge is near";
    sentences.push_back(text);
  }
  return sentences;
}

} // namespace

void ReliefSettings::Visit(SettingVisitor& visitor)
{
  visitor.Number({ "Height", "coordinates",
                   "The height of the value 1 above that of 0, in the unit of the coordinates. "
                   "Below 0 it is carved." },
    this->Height, SettingRange::AnyFinite());
  visitor.Number(
    { "Base", "coordinates", "The height of the value 0, in the unit of the coordinates." },
    this->Base, SettingRange::AnyFinite());
  visitor.Choice({ "Levels", "",
                   "Smooth: the height is Base + Height times the value. Two: it is Base where "
                   "the value is below Threshold, and Base + Height above." },
    this->Levels, { "Smooth", "Two" }, {});
  visitor.Number({ "Threshold", "",
                   "The value in the middle between two levels, in the unit of the array. Used by "
                   "Levels Two.",
                   "Levels=Two" },
    this->Threshold, SettingRange::AnyFinite());
  visitor.Number({ "Flank", "coordinates",
                   "The width of the slope between two levels along the surface, in the unit of "
                   "the coordinates. 0: a step. Used by Levels Two.",
                   "Levels=Two" },
    this->Flank, SettingRange::NonNegative());
  SettingRange angles = SettingRange::Between(0.0, 90.0, "0 to 90 degrees, or -1: off");
  angles.HasSpecial = true;
  angles.Special = -1.0;
  visitor.Number({ "Overhang", "degrees",
                   "Faces that face down more steeply than this angle, in degrees between the "
                   "normal and the horizontal, have no relief. 0: no face that faces down. -1: "
                   "all faces may have relief." },
    this->Overhang, angles);
  visitor.Numbers({ "UpDirection", "", "The direction of printing, for Overhang.", "Overhang!=-1" },
    this->UpDirection, SettingRange::AnyFinite());
  VisitMerging(visitor, this->MergeCoincidentPoints, this->MergeTolerance);
}

void ReliefSettings::Check(const FieldSummary* fields, Problems& problems)
{
  CheckRanges(*this, problems);
  if (fields && fields->DataComponents > 1)
  {
    problems.push_back(
      Sentence(fields->DataName) << " has " << fields->DataComponents << " components; allowed: 1");
  }
  if (this->UpDirection.size() != 3)
  {
    problems.push_back(Sentence(Word::Setting("UpDirection"))
      << " has " << static_cast<Index>(this->UpDirection.size())
      << " components; allowed: three numbers that are not all 0");
    return;
  }
  if (std::all_of(this->UpDirection.begin(), this->UpDirection.end(),
        [](double component) { return component == 0.0; }))
  {
    problems.push_back(
      Sentence(Word::Setting("UpDirection")) << " is 0; allowed: three numbers that are not all 0");
  }
}

void ReliefRun::Update(const BlockInput& input, Settings& given, const ProgressMonitor& progress)
{
  auto& settings = static_cast<ReliefSettings&>(given);
  SurfaceOptions options;
  options.MergeCoincidentPoints = settings.MergeCoincidentPoints;
  options.MergeTolerance = settings.MergeTolerance;
  if (!this->Prepare(input, settings, options, progress.Part(0.0, 0.1)))
  {
    return;
  }
  const Surface& surface = *this->Domain;
  const Triangles triangles = surface.MakeTriangles();
  const Vector heights = this->MakeHeights(input, settings, triangles);
  const Relief relief =
    MakeRelief(surface.Points(), triangles, heights, this->Parallel, progress.Part(0.1, 1.0));
  this->Sentences = DescribeRelief(relief, heights);
  this->Walls = relief.Walls;
  this->ListResults(triangles, relief);
  this->Complete(input, settings);
}

/// Per point; those that others represent have the heights of their representatives.
Vector ReliefRun::MakeHeights(
  const BlockInput& input, const ReliefSettings& settings, const Triangles& triangles)
{
  const Surface& surface = *this->Domain;
  const Points& points = surface.Points();
  Fields fields = this->ReadFields(input, "if it stands for no value, set a number in its place");
  MoveMarksToData(surface, fields, Reduction::Serial(), this->Parallel);
  Vector values = fields.Data.Values.col(0);
  for (Eigen::Index p = 0; p < values.size(); ++p)
  {
    if (surface.VertexOf(static_cast<Index>(p)) < 0)
    {
      values[p] = 0.0; // not used: the point is not moved, and may have NaN
    }
    else if (!std::isfinite(values[p]))
    {
      throw ErrorAt(
        fields.DataName, Sentence("is ") << values[p], false, p, "allowed: finite numbers");
    }
  }
  Vector heights = ReliefHeights(points, triangles, values,
    { settings.Height, settings.Base, settings.Levels == 1, settings.Threshold, settings.Flank });
  for (Eigen::Index p = 0; p < heights.size(); ++p)
  {
    heights[p] = surface.VertexOf(static_cast<Index>(p)) < 0 ? 0.0 : heights[p];
  }
  const double largest = heights.cwiseAbs().maxCoeff();
  const double extent = (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
  if (!(largest <= extent))
  {
    throw InputError(Sentence(Word::Setting("Height"))
      << " is " << settings.Height << ", which makes a relief of up to " << largest << " of "
      << fields.DataName << " on a surface of " << extent
      << " from corner to corner; allowed: a relief that is less");
  }
  if (settings.Overhang >= 0.0)
  {
    const std::vector<char> overhangs = FindOverhangs(points, triangles,
      { settings.UpDirection[0], settings.UpDirection[1], settings.UpDirection[2] },
      settings.Overhang);
    for (Eigen::Index p = 0; p < heights.size(); ++p)
    {
      heights[p] = overhangs[static_cast<std::size_t>(p)] ? 0.0 : heights[p];
    }
  }
  for (std::size_t p = 0; p < fields.Mask.Values.size(); ++p)
  {
    if (fields.Mask.Values[p])
    {
      heights[static_cast<Eigen::Index>(p)] = 0.0;
    }
  }
  return heights;
}

void ReliefRun::ListResults(const Triangles& triangles, const Relief& relief)
{
  const Surface& surface = *this->Domain;
  const TriangleMesh& mesh = surface.InputMesh();
  Points moved = surface.Points();
  Vector heights = relief.Heights;
  for (Index p = 0; p < static_cast<Index>(moved.rows()); ++p)
  {
    const Index vertex = surface.VertexOf(p);
    if (vertex >= 0)
    {
      const Index representative = mesh.InputVertex()[static_cast<std::size_t>(vertex)];
      heights[p] = relief.Heights[representative];
      const Eigen::RowVector3d offset =
        surface.Points().row(p) - surface.Points().row(representative);
      moved.row(p) = relief.Places.row(representative) + offset; // the same bits if it is 0
    }
  }
  this->Turned.assign(static_cast<std::size_t>(surface.NumberOfTriangles()), 0);
  for (Index t = 0; t < static_cast<Index>(triangles.rows()); ++t)
  {
    const auto row = relief.Faces.row(t);
    const bool same = (triangles(t, 0) == row[0] && triangles(t, 1) == row[1]) ||
      (triangles(t, 0) == row[1] && triangles(t, 1) == row[2]) ||
      (triangles(t, 0) == row[2] && triangles(t, 1) == row[0]);
    this->Turned[static_cast<std::size_t>(t)] = !same;
  }
  this->Results.clear();
  this->Results.push_back(
    { "Points", Place::PerPoint, OutputType::Double, moved, Role::Coordinates });
  this->Results.push_back({ "ReliefHeight", Place::PerPoint, OutputType::Double, heights });
  this->Results.back().IsResult = true;
  const auto add = [this](const char* name, double value, Combination over)
  { this->Results.push_back(Output::OfNumber(name, value, over)); };
  const auto count = [&](const char* name, Index value)
  {
    add(name, value, Combination::Sum);
    this->Results.back().Type = OutputType::Integer;
  };
  add("VolumeChange", relief.OpenEdges == 0 ? relief.VolumeChange : 0.0, Combination::Sum);
  add("SmallestWall", relief.SmallestWall, Combination::Smallest);
  count("LoweredPoints", relief.LoweredVertices);
  count("OpenEdges", relief.OpenEdges);
  count("NonManifoldEdges", relief.NonManifoldEdges);
  count("CrossingTrianglesBefore", relief.CrossingTrianglesBefore);
  count("CrossingTriangles", relief.CrossingTriangles);
}

std::vector<Warning> ReliefRun::FindOwnWarnings() const
{
  std::vector<Warning> warnings;
  for (const Sentence& sentence : this->Sentences)
  {
    warnings.push_back({ sentence, this->SurfaceVersion });
  }
  return warnings;
}

} // namespace SurfaceDiffusion
