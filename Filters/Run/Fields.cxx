// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/Fields.h"

#include "Core/Surface/TangentVectors.h"
#include "Run/FieldChecks.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// The labels of the cells around each vertex, if they are the same or 0.
std::vector<Index> MakeSeedsOfCells(const Surface& surface, const Fields& fields)
{
  const TriangleMesh& mesh = surface.InputMesh();
  constexpr Index none = 0, several = -1;
  std::vector<Index> seeds(static_cast<std::size_t>(mesh.NumberOfVertices()), none);
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const Index row = mesh.InputTriangle()[static_cast<std::size_t>(t)];
    const Index cell = fields.Cells[static_cast<std::size_t>(surface.InputTriangle(row))];
    const Index label = fields.Seeds.Values[static_cast<std::size_t>(cell)];
    for (int a = 0; a < 3 && label != none; ++a)
    {
      Index& seed = seeds[static_cast<std::size_t>(mesh.TriangleVertices()(t, a))];
      seed = seed == none || seed == label ? label : several;
    }
  }
  std::replace(seeds.begin(), seeds.end(), several, none);
  return seeds;
}

/// The area of the surface that each row of the data stands for; 0 of rows that take no part, and
/// where another process owns the vertex. Collective.
std::vector<double> FindAreas(const Surface& surface, const Fields& fields)
{
  const TriangleMesh& mesh = surface.InputMesh();
  std::vector<double> areas(static_cast<std::size_t>(fields.Data.Values.rows()), 0.0);
  if (fields.Data.OnCells)
  {
    for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
    {
      const Index row = mesh.InputTriangle()[static_cast<std::size_t>(t)];
      const Index cell = fields.Cells[static_cast<std::size_t>(surface.InputTriangle(row))];
      areas[static_cast<std::size_t>(cell)] += mesh.Shapes()[t].Area();
    }
    return areas;
  }
  const Reduction& reduction = mesh.GetReduction();
  Vector storage;
  const Vector& ofVertices = reduction.Accumulated(mesh.ControlAreas(), storage);
  for (std::size_t i = 0; i < areas.size(); ++i)
  {
    const Index v = surface.VertexOf(static_cast<Index>(i));
    areas[i] = v >= 0 && reduction.Owns(v) ? ofVertices[v] : 0.0;
  }
  return areas;
}

/// Per vertex, whether all of its points are in between; no entries if no point can be.
Flags FindVerticesBetween(const Surface& surface, const Fields& fields)
{
  const bool anyBetween = !fields.Between.empty();
  Flags isBetween = Flags::Constant(anyBetween ? surface.Mesh().NumberOfVertices() : 0, true);
  for (std::size_t i = 0; i < fields.Between.size(); ++i)
  {
    const Index v = surface.VertexOf(static_cast<Index>(i));
    if (v >= 0 && !fields.Between[i])
    {
      isBetween[v] = false;
    }
  }
  return isBetween;
}

} // namespace

InputError ErrorAt(const Sentence& name, const Sentence& found, bool onCells, Eigen::Index row,
  const Sentence& allowed)
{
  const Sentence place = onCells ? Sentence(Word::Cell()) : Sentence("point");
  return InputError(
    Sentence(name) << " " << found << " at " << place << " " << row << "; " << allowed);
}

void CheckFidelityFactors(const Fields& fields)
{
  for (std::size_t i = 0; i < fields.FidelityFactors.Values.size(); ++i)
  {
    const double factor = fields.FidelityFactors.Values[i];
    if (!(std::isfinite(factor) && factor >= 0.0))
    {
      throw ErrorOfFactor(Word::Array("FidelityArray"), factor, fields.FidelityFactors.OnCells,
        static_cast<Eigen::Index>(i));
    }
  }
}

Vector MakeFidelityFactors(const Surface& surface, const Fields& fields)
{
  CheckFidelityFactors(fields);
  const std::vector<double>& ofPoints = fields.FidelityFactors.Values;
  const Index n = surface.Mesh().NumberOfVertices();
  Vector factors = Vector::Zero(n);
  Vector counts = Vector::Zero(n);
  for (std::size_t i = 0; i < ofPoints.size(); ++i)
  {
    const Index v = surface.VertexOf(static_cast<Index>(i));
    if (v >= 0)
    {
      factors[v] += ofPoints[i];
      counts[v] += 1.0;
    }
  }
  return factors.cwiseQuotient(counts);
}

std::vector<char> FindParticipatingRows(const Surface& surface, const Fields& fields)
{
  std::vector<char> found(static_cast<std::size_t>(fields.Data.Values.rows()), 0);
  if (fields.Data.OnCells)
  {
    for (const Index row : surface.InputMesh().InputTriangle())
    {
      const Index cell = fields.Cells[static_cast<std::size_t>(surface.InputTriangle(row))];
      found[static_cast<std::size_t>(cell)] = 1;
    }
    return found;
  }
  for (std::size_t i = 0; i < found.size(); ++i)
  {
    found[i] = surface.VertexOf(static_cast<Index>(i)) >= 0;
  }
  return found;
}

void ValueStatistics::Widen(
  std::vector<ValueBounds>& bounds, std::size_t component, const ValueBounds& other)
{
  bounds.resize(std::max(bounds.size(), component + 1));
  bounds[component].Widen(other);
}

void ValueStatistics::Add(
  const Surface& surface, const Fields& fields, bool inpaint, const Reduction& processes)
{
  const Values& values = fields.Data.Values;
  const std::vector<char> participates = FindParticipatingRows(surface, fields);
  const bool fixedHere = fields.Fixed.OnCells == fields.Data.OnCells;
  std::vector<Index> known;
  double largest[2] = { this->Largest, static_cast<double>(values.cols()) };
  for (Eigen::Index i = 0; i < values.rows(); ++i)
  {
    if (!IsSet(participates, i) || IsSet(fields.Missing, i) || !values.row(i).allFinite())
    {
      continue;
    }
    largest[0] = std::max(largest[0], values.row(i).cwiseAbs().maxCoeff());
    if (!fields.IsLeftOut(i, inpaint) || (fixedHere && IsSet(fields.Fixed.Values, i)))
    {
      known.push_back(static_cast<Index>(i));
    }
  }
  processes.Max(largest, 2); // a process without data has no components
  this->Largest = largest[0];
  const std::vector<double> areas = FindAreas(surface, fields);
  std::vector<double> ofKnown;
  for (const Index i : known)
  {
    if (areas[static_cast<std::size_t>(i)] > 0.0)
    {
      ofKnown.push_back(areas[static_cast<std::size_t>(i)]);
    }
  }
  constexpr double most = 30.0; // in medians: a spike is not the surface that the others are not
  const double bound = most * Median(ofKnown, processes);
  std::vector<AreaOfValue> column;
  for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(largest[1]); ++k)
  {
    ValueBounds bounds;
    column.clear();
    for (const Index i : known)
    {
      const double value = k < values.cols() ? values(i, k) : 0.0;
      bounds.Widen({ value, value });
      column.push_back({ value, std::min(areas[static_cast<std::size_t>(i)], bound) });
    }
    bounds = OfAllProcesses(bounds, processes);
    Widen(this->All, static_cast<std::size_t>(k), bounds);
    Widen(this->Robust, static_cast<std::size_t>(k), BoundsOfMost(column, bounds, processes));
  }
}

void ValueStatistics::Merge(const ValueStatistics& other)
{
  this->Largest = std::max(this->Largest, other.Largest);
  for (std::size_t k = 0; k < other.All.size(); ++k)
  {
    Widen(this->All, k, other.All[k]);
    Widen(this->Robust, k, other.Robust[k]);
  }
}

double ValueStatistics::Range() const
{
  constexpr double shareOfOutliers = 0.1;
  double range = 0.0;
  for (std::size_t k = 0; k < this->All.size(); ++k)
  {
    const double all = this->All[k].Width();
    const double robust = this->Robust[k].Width();
    range = std::max(range, robust <= shareOfOutliers * all ? robust : all);
  }
  return range > 0.0 ? range : 1.0;
}

double ValueStatistics::WholeRange() const
{
  double range = 0.0;
  for (const ValueBounds& bounds : this->All)
  {
    range = std::max(range, bounds.Width());
  }
  return range;
}

double ValueStatistics::RobustRange() const
{
  double range = 0.0;
  for (const ValueBounds& bounds : this->Robust)
  {
    range = std::max(range, bounds.Width());
  }
  return range;
}

PointData MakePointData(const Surface& surface, const Fields& fields, bool inpaint, double unit)
{
  const Index n = surface.Mesh().NumberOfVertices();
  const Values& values = fields.Data.Values;
  PointData data;
  data.Given = Values::Zero(n, values.cols());
  data.Missing = Flags::Constant(n, true);
  data.Fixed = Flags::Constant(n, false);
  Values damaged; // the values of vertices without any known point, if there are such
  std::vector<Index> known(static_cast<std::size_t>(n), 0);
  const Flags isBetween = FindVerticesBetween(surface, fields);
  for (Eigen::Index i = 0; i < values.rows(); ++i)
  {
    if (values.row(i).array().isInf().any())
    {
      throw ErrorAt(fields.DataName, "is infinite", false, i, "allowed: finite values and NaN");
    }
    const Index v = surface.VertexOf(static_cast<Index>(i));
    if (v < 0 || (IsSet(fields.Between, i) && !isBetween[v]))
    {
      continue; // a point on an edge that another triangle's corner is merged with
    }
    const bool isFixed = IsSet(fields.Fixed.Values, i);
    const bool isNaN = IsSet(fields.Missing, i) || values.row(i).hasNaN();
    if (isFixed && isNaN)
    {
      throw ErrorAt(fields.DataName,
        Sentence("is NaN where ") << Word::Array("FixedArray") << " holds it", false, i,
        "allowed there: finite values");
    }
    data.Fixed[v] = data.Fixed[v] || isFixed;
    if (isFixed || !(isNaN || fields.IsLeftOut(i, inpaint)))
    {
      data.Given.row(v) += values.row(i) / unit;
      data.Missing[v] = false;
      ++known[static_cast<std::size_t>(v)];
      continue;
    }
    if (damaged.rows() == 0)
    {
      damaged.setZero(n, values.cols());
    }
    damaged.row(v) = values.row(i) / unit;
  }
  for (Index v = 0; v < n; ++v)
  {
    const Index count = known[static_cast<std::size_t>(v)];
    if (count == 0 && damaged.rows() > 0)
    {
      data.Given.row(v) = damaged.row(v);
    }
    else if (count > 1)
    {
      data.Given.row(v) /= count;
    }
  }
  if (!fields.FidelityFactors.Values.empty())
  {
    data.FidelityFactors = MakeFidelityFactors(surface, fields);
  }
  return data;
}

std::shared_ptr<const MeasuredVertices> FindMeasured(const Surface& surface, const Fields& fields)
{
  const bool anyBetween = std::any_of(
    fields.Between.begin(), fields.Between.end(), [](char between) { return between != 0; });
  if (!anyBetween || !surface.Mesh().GetReduction().IsSerial())
  {
    return nullptr;
  }
  return std::make_shared<const MeasuredVertices>(
    FindMeasuredVertices(surface.SharedAssembler()->Pattern(), VertexPositions(surface),
      FindVerticesBetween(surface, fields)));
}

TangentVectors MakeInputDirections(
  const Surface& surface, const Fields& fields, const ParallelFor& parallel)
{
  if (fields.Directions.Values.rows() == 0)
  {
    return TangentVectors(0, 2);
  }
  if (!fields.Directions.OnCells)
  {
    return TangentVectorsFromPointVectors(surface.InputMesh(), surface.Points(),
      surface.MakeTriangles(), fields.Directions.Values, parallel);
  }
  SurfaceDiffusion::Points ofTriangles(surface.NumberOfTriangles(), 3);
  for (Eigen::Index t = 0; t < ofTriangles.rows(); ++t)
  {
    ofTriangles.row(t) = fields.Directions.Values.row(surface.InputTriangle(static_cast<Index>(t)));
  }
  return TangentVectorsFromTriangleVectors(
    surface.InputMesh(), surface.Points(), surface.MakeTriangles(), ofTriangles, parallel);
}

TangentVectors MakeDirections(
  const Surface& surface, const Fields& fields, const ParallelFor& parallel)
{
  TangentVectors ofInput = MakeInputDirections(surface, fields, parallel);
  return ofInput.rows() == 0 ? ofInput : TransportToMesh(surface, ofInput);
}

std::vector<Index> MakeSeeds(const Surface& surface, const Fields& fields)
{
  if (fields.Seeds.Values.empty())
  {
    return {};
  }
  if (fields.Seeds.OnCells)
  {
    return MakeSeedsOfCells(surface, fields);
  }
  std::vector<Index> seeds(static_cast<std::size_t>(surface.Mesh().NumberOfVertices()), 0);
  for (std::size_t i = 0; i < fields.Seeds.Values.size(); ++i)
  {
    const Index v = surface.VertexOf(static_cast<Index>(i));
    if (v < 0 || fields.Seeds.Values[i] == 0)
    {
      continue;
    }
    Index& seed = seeds[static_cast<std::size_t>(v)];
    if (seed != 0 && seed != fields.Seeds.Values[i])
    {
      throw InputError(Sentence(Word::Array("SeedArray"))
        << " is " << seed << " and " << fields.Seeds.Values[i]
        << " at points that are merged into one, point " << i
        << " among them; allowed: one label there");
    }
    seed = fields.Seeds.Values[i];
  }
  return seeds;
}

} // namespace SurfaceDiffusion
