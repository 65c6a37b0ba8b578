// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// SegmentationSettings: the results, per vertex or cell and per region.

#include "Core/Geometry/RegionBoundaries.h"
#include "Core/Statistics/RegionMeans.h"
#include "Run/ModelInputs.h"
#include "Run/SegmentationSettings.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

/// u at the input's points; 0 at points of no triangle.
Values StateOfPoints(const Surface& surface, const Values& state)
{
  Values u = Values::Zero(surface.Points().rows(), state.cols());
  for (Index i = 0; i < static_cast<Index>(u.rows()); ++i)
  {
    const Index v = surface.VertexOf(i);
    if (v >= 0)
    {
      u.row(i) = state.row(v);
    }
  }
  return u;
}

/// The areas of control cells over those of the drawn surface, per point.
Vector AreaFactorsOfPoints(const Surface& surface)
{
  const TriangleMesh& mesh = surface.InputMesh();
  Vector factors = Vector::Ones(surface.Points().rows());
  for (Index i = 0; i < static_cast<Index>(factors.size()); ++i)
  {
    const Index v = surface.VertexOf(i);
    if (v >= 0)
    {
      factors[i] = mesh.ControlAreas()[v] / mesh.ThirdOfTriangles(v);
    }
  }
  return factors;
}

/// The mean of the region of each label; zero for label 0.
Values MeansOfLabels(const Values& means, const Values& labels)
{
  Values rows = Values::Zero(labels.rows(), means.cols());
  for (Eigen::Index i = 0; i < labels.rows(); ++i)
  {
    if (labels(i, 0) > 0.0)
    {
      rows.row(i) = means.row(static_cast<Eigen::Index>(labels(i, 0)) - 1);
    }
  }
  return rows;
}

Values AsColumn(const std::vector<Index>& numbers)
{
  return Eigen::Map<const Eigen::VectorXi>(
    numbers.data(), static_cast<Eigen::Index>(numbers.size()))
    .cast<double>();
}

/// Add the curves between regions. Returns the length of the boundary of each region.
Values AddBoundaries(
  const RegionBoundaries& boundaries, Eigen::Index regions, std::vector<Output>& outputs)
{
  const auto count = static_cast<Eigen::Index>(boundaries.Curves.size());
  Curves curves;
  curves.Points = boundaries.Points;
  Values ofCurves(count, 2), lengths(count, 1), sums = Values::Zero(regions, 1);
  for (Eigen::Index c = 0; c < count; ++c)
  {
    const RegionBoundary& curve = boundaries.Curves[static_cast<std::size_t>(c)];
    curves.Corners.insert(curves.Corners.end(), curve.Points.begin(), curve.Points.end());
    curves.Begin.push_back(static_cast<Index>(curves.Corners.size()));
    lengths(c, 0) = curve.Length;
    for (int side = 0; side < 2; ++side)
    {
      ofCurves(c, side) = curve.Regions[side];
      sums(curve.Regions[side] - 1, 0) += curve.Length;
    }
  }
  outputs.push_back(Output::OfCurves("Boundaries", std::move(curves)));
  outputs.push_back({ "Regions", Place::PerCurve, OutputType::Integer, std::move(ofCurves) });
  outputs.push_back({ "Length", Place::PerCurve, OutputType::Double, std::move(lengths) });
  return sums;
}

/// Add the measures of the regions and their boundaries. Returns the number of connected components
/// of each region.
std::vector<Index> AddRegions(
  const RunState& state, const Values& labels, const Values& means, std::vector<Output>& outputs)
{
  const Surface& surface = state.Surface;
  const Values u = StateOfPoints(surface, state.Path.State());
  const Triangles triangles = surface.MakeTriangles();
  const Eigen::Index count = u.cols();
  const Values lengths =
    AddBoundaries(FindRegionBoundaries(surface.Points(), triangles, u), count, outputs);
  const std::vector<Index> components =
    CountRegionComponents(surface.InputMesh().TriangleVertices(),
      std::vector<Index>(labels.data(), labels.data() + labels.size()), static_cast<Index>(count));
  const auto addColumn = [&](const std::string& name, OutputType type, Values rows) {
    outputs.push_back({ name, Place::Column, type, std::move(rows) });
  };
  addColumn(
    "Region", OutputType::Integer, Vector::LinSpaced(count, 1.0, static_cast<double>(count)));
  addColumn("Area", OutputType::Double,
    RegionAreas(surface.Points(), triangles, u, AreaFactorsOfPoints(surface), state.Parallel));
  addColumn("BoundaryLength", OutputType::Double, lengths);
  addColumn("Components", OutputType::Integer, AsColumn(components));
  for (Eigen::Index k = 0; k < means.cols(); ++k)
  {
    addColumn("Mean_" + std::to_string(k), OutputType::Double, means.col(k));
  }
  return components;
}

void WarnOfEmptyRegions(
  const std::vector<Index>& components, const Values& means, RunResult& result)
{
  std::string empty;
  int count = 0;
  const Eigen::Index used = UsedMeans(means).rows();
  for (std::size_t k = 0; k < components.size(); ++k)
  {
    const bool isUsed = means.rows() == 0 || IsUsed(means, static_cast<Eigen::Index>(k));
    if (isUsed && components[k] == 0)
    {
      empty += (empty.empty() ? "" : ", ") + std::to_string(k + 1);
      ++count;
    }
  }
  if (used < means.rows())
  {
    result.WarnOnce(Sentence("only ")
      << used << " of " << means.rows() << " regions " << (used == 1 ? "is" : "are")
      << " used: the data have no more different values (the means of the others are NaN)");
  }
  if (!empty.empty())
  {
    result.WarnOnce(Sentence("no point is in the region")
      << (count == 1 ? " " : "s ") << empty << " (to keep smaller regions, turn off "
      << Word::Setting("AutomaticFidelity") << " and raise " << Word::Setting("FidelityWeight")
      << ")");
  }
}

} // namespace

std::vector<Output> SegmentationSettings::Finish(const RunState& state, RunResult& result) const
{
  const std::map<std::string, Values> found = state.Path.CurrentModel().Results();
  const double unit = state.Units.ValueUnit;
  const Values means = found.at("Means") * unit;
  const Values& ofVertices = found.at("Labels");
  const Place place = state.Cells ? Place::PerCell : Place::PerVertex;
  const Values labels =
    state.Cells ? AsColumn(MakeCellLabels(*state.Cells, state.Path.State())) : ofVertices;
  std::vector<Output> outputs;
  if (means.rows() > 0)
  {
    outputs.push_back(
      Output::OfData(this->DescribeModel().ResultSuffix, place, MeansOfLabels(means, labels)));
    outputs.back().Active = Role::None;
  }
  outputs.push_back(Output::OfColumns("RegionProbability", 0, 0));
  outputs.push_back({ "RegionId", place, OutputType::Integer, labels, Role::Scalars });
  const std::vector<Index> components =
    AddRegions(state, ofVertices, found.at("DataMeans") * unit, outputs);

  const bool isDone = state.Path.Step() > 0;
  for (const char* const name : { "Gap", "LabelGap", "NumberOfAlternations" })
  {
    outputs.push_back(
      Output::OfNumber(name, isDone ? found.at(name)(0, 0) : 0.0, Combination::Largest));
  }
  outputs.back().Type = OutputType::Integer;
  outputs.push_back({ "Means", Place::Number, OutputType::Double, means });
  outputs.back().Rows.conservativeResize(this->NumberOfRegions, Eigen::NoChange);
  if (isDone)
  {
    WarnOfEmptyRegions(components, means, result);
  }
  const double gap = FindNumber(outputs, "Gap");
  if (gap > this->StopTolerance)
  {
    result.WarnOnce(
      Sentence("the minimisation ended at its largest number of iterations with a relative duality "
               "gap of ")
      << gap << ", above " << Word::Setting("StopTolerance"));
  }
  return outputs;
}

} // namespace SurfaceDiffusion
