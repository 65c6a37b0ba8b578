// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/PointSamples.h"

#include "Core/Foundation/RobustRange.h"
#include "Core/Geometry/NearestPoints.h"
#include "Run/CellFields.h"
#include "Run/Fields.h"
#include "Run/Sentinels.h"
#include "Run/Surface.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

bool Counts(const PointSamples& samples, std::size_t i)
{
  return !samples.Given.row(static_cast<Eigen::Index>(i)).hasNaN() &&
    (samples.Weights.empty() || samples.Weights[i] > 0.0);
}

bool IsWithin(const ProjectedSample& sample, double maximumDistance)
{
  return maximumDistance == 0.0 || sample.Distance <= maximumDistance;
}

void CheckSamples(const PointSamples& samples)
{
  const auto fail = [](const Sentence& text, std::size_t i, const Sentence& allowed)
  { throw InputError(Sentence(text) << " at point " << i << " of the values; " << allowed); };
  for (std::size_t i = 0; i < static_cast<std::size_t>(samples.Given.rows()); ++i)
  {
    const auto row = static_cast<Eigen::Index>(i);
    if (!samples.Places.row(row).allFinite())
    {
      fail("a coordinate is not finite", i, "allowed: finite coordinates");
    }
    if (samples.Given.row(row).array().isInf().any())
    {
      fail("a value is infinite", i, "allowed: finite values and NaN");
    }
    if (!samples.Weights.empty() &&
      !(std::isfinite(samples.Weights[i]) && samples.Weights[i] >= 0.0))
    {
      fail(Sentence(Word::Array("FidelityArray")) << " is " << samples.Weights[i], i,
        AllowedFactors("FidelityArray"));
    }
  }
}

/// Collects values with their places.
class Collector
{
public:
  Collector(const Fields& fields, double unit)
    : Given(fields)
    , Unit(unit)
  {
  }

  void Add(const SurfacePoint& place, Eigen::Index row, double weight)
  {
    if (weight > 0.0)
    {
      this->Places.push_back(place);
      this->Rows.push_back(row);
      this->Weights.push_back(weight);
    }
  }

  ScatteredValues Take(const Values& from)
  {
    ScatteredValues values;
    values.Given.resize(static_cast<Eigen::Index>(this->Rows.size()), from.cols());
    for (std::size_t i = 0; i < this->Rows.size(); ++i)
    {
      values.Given.row(static_cast<Eigen::Index>(i)) = from.row(this->Rows[i]) / this->Unit;
    }
    values.Weights = Eigen::Map<const Vector>(
      this->Weights.data(), static_cast<Eigen::Index>(this->Weights.size()));
    values.Places = std::move(this->Places);
    return values;
  }

  std::vector<Eigen::Index> TakeRows() { return std::move(this->Rows); }

  /// Of a row of the data.
  double WeightOf(std::size_t row) const
  {
    return this->Given.FidelityFactors.Values.empty() ? 1.0
                                                      : this->Given.FidelityFactors.Values[row];
  }

private:
  const Fields& Given;
  double Unit;
  std::vector<SurfacePoint> Places;
  std::vector<Eigen::Index> Rows;
  std::vector<double> Weights;
};

/// Of merged points, those with the values and the weight of an earlier one are copies of it: what
/// was measured once may be stored with every triangle.
class FirstCopies
{
public:
  FirstCopies(const Surface& surface, const Fields& fields)
    : Domain(surface)
    , Given(fields)
    , Last(static_cast<std::size_t>(surface.Mesh().NumberOfVertices()), -1)
  {
  }

  /// To be called once for each point, in ascending order.
  bool IsFirst(std::size_t point)
  {
    Index& last =
      this->Last[static_cast<std::size_t>(this->Domain.VertexOf(static_cast<Index>(point)))];
    this->Before.resize(std::max(this->Before.size(), point + 1), -1);
    this->Before[point] = last;
    for (Index other = last; other >= 0; other = this->Before[static_cast<std::size_t>(other)])
    {
      if (this->AreEqual(static_cast<std::size_t>(other), point))
      {
        return false;
      }
    }
    last = static_cast<Index>(point);
    return true;
  }

private:
  bool AreEqual(std::size_t i, std::size_t j) const
  {
    const Values& rows = this->Given.Data.Values;
    const std::vector<double>& weights = this->Given.FidelityFactors.Values;
    return rows.row(static_cast<Eigen::Index>(i)) == rows.row(static_cast<Eigen::Index>(j)) &&
      (weights.empty() || weights[i] == weights[j]);
  }

  const Surface& Domain;
  const Fields& Given;
  std::vector<Index> Last; ///< per vertex: the last of its points that is no copy
  std::vector<Index> Before; ///< per point: that before it at the same vertex
};

/// The middle of each cell, whichever way polygons are cut. Of the cells that were cut from one, the one
/// that the middle of that lies in has it as its place; the vertices of others and of cells without a
/// triangle are -1.
std::vector<SurfacePoint> MiddlesOfCells(const Surface& surface, const Fields& fields)
{
  constexpr double equal = 1e-9; // round-off must not choose
  struct GivenCell
  {
    Eigen::RowVector3d Moment = Eigen::RowVector3d::Zero();
    double Area = 0.0;
    Index Triangles = 0;
    double Inside = -std::numeric_limits<double>::infinity(); ///< the least coordinate
    std::size_t Cell = 0;
    SurfacePoint Place;
  };
  const std::vector<Index>& numbers = fields.GivenCells;
  std::vector<GivenCell> givenCells(static_cast<std::size_t>(numbers.empty()
      ? fields.NumberOfCells
      : *std::max_element(numbers.begin(), numbers.end()) + 1));
  const TriangleMesh& mesh = surface.InputMesh();
  const auto cellOf = [&](Index t)
  {
    const Index row = mesh.InputTriangle()[static_cast<std::size_t>(t)];
    return static_cast<std::size_t>(
      fields.Cells[static_cast<std::size_t>(surface.InputTriangle(row))]);
  };
  const auto givenOf = [&](std::size_t cell) -> GivenCell&
  { return givenCells[numbers.empty() ? cell : static_cast<std::size_t>(numbers[cell])]; };
  const auto corner = [&](Index t, int a) -> Eigen::RowVector3d
  {
    const auto vertex = static_cast<std::size_t>(mesh.TriangleVertices()(t, a));
    return surface.Points().row(mesh.InputVertex()[vertex]);
  };
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    GivenCell& given = givenOf(cellOf(t));
    const double area = mesh.Shapes()[static_cast<std::size_t>(t)].Area();
    given.Moment += area / 3.0 * (corner(t, 0) + corner(t, 1) + corner(t, 2));
    given.Area += area;
    ++given.Triangles;
  }
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const std::size_t cell = cellOf(t);
    GivenCell& given = givenOf(cell);
    Eigen::Array3d coordinates = Eigen::Array3d::Constant(1.0 / 3.0);
    if (given.Triangles > 1)
    {
      Eigen::Matrix<double, 3, 2> sides;
      sides.col(0) = (corner(t, 1) - corner(t, 0)).transpose();
      sides.col(1) = (corner(t, 2) - corner(t, 0)).transpose();
      const Eigen::Vector3d offset = (given.Moment / given.Area - corner(t, 0)).transpose();
      const Eigen::Vector2d x =
        (sides.transpose() * sides).ldlt().solve(sides.transpose() * offset);
      coordinates << 1.0 - x.sum(), x[0], x[1];
    }
    if (coordinates.minCoeff() > given.Inside + equal)
    {
      given.Inside = coordinates.minCoeff();
      given.Cell = cell;
      const Eigen::Array3d within = coordinates.max(0.0);
      for (std::size_t a = 0; a < 3; ++a)
      {
        given.Place.Vertices[a] = mesh.TriangleVertices()(t, static_cast<Eigen::Index>(a));
        given.Place.Coordinates[a] = within[static_cast<Eigen::Index>(a)] / within.sum();
      }
    }
  }
  SurfacePoint none;
  none.Vertices.fill(-1);
  std::vector<SurfacePoint> middles(static_cast<std::size_t>(fields.NumberOfCells), none);
  for (const GivenCell& given : givenCells)
  {
    if (std::isfinite(given.Inside))
    {
      middles[given.Cell] = given.Place;
    }
  }
  return middles;
}

} // namespace

void ProjectSamples(const SurfaceArrays& arrays, double maximumDistance, Fields& fields)
{
  const PointSamples& samples = *fields.Samples;
  CheckSamples(samples);
  RequireFiniteCoordinates(arrays.Points);
  const NearestPoints nearest(arrays.Points, arrays.Triangles);
  auto projected =
    std::make_shared<std::vector<ProjectedSample>>(static_cast<std::size_t>(samples.Given.rows()));
  fields.Data.Values = Values::Constant(
    arrays.Points.rows(), samples.Given.cols(), std::numeric_limits<double>::quiet_NaN());
  bool isAnyKnown = false;
  bool isAnyLeft = false;
  for (std::size_t i = 0; i < projected->size(); ++i)
  {
    const auto row = static_cast<Eigen::Index>(i);
    ProjectedSample& sample = (*projected)[i];
    if (!Counts(samples, i))
    {
      continue;
    }
    isAnyKnown = true;
    const NearestPoint found = nearest.Find(samples.Places.row(row));
    if (found.Triangle < 0)
    {
      continue;
    }
    sample.Distance = std::sqrt(found.SquaredDistance);
    sample.Coordinates = found.Coordinates;
    sample.IsExcluded = IsSet(arrays.ExcludedTriangles, static_cast<std::size_t>(found.Triangle));
    for (std::size_t a = 0; a < 3; ++a)
    {
      sample.Points[a] = arrays.Triangles(found.Triangle, static_cast<Eigen::Index>(a));
      sample.IsExcluded =
        sample.IsExcluded || IsSet(arrays.Excluded, static_cast<std::size_t>(sample.Points[a]));
    }
    if (sample.IsExcluded || !IsWithin(sample, maximumDistance))
    {
      continue;
    }
    isAnyLeft = true;
    for (std::size_t a = 0; a < 3; ++a)
    {
      if (sample.Coordinates[a] != 0.0)
      {
        fields.Data.Values.row(sample.Points[a]) = samples.Given.row(row);
      }
    }
  }
  fields.Projected = std::move(projected);
  if (!isAnyKnown)
  {
    throw InputError(Sentence("no value is known: the values at points are ")
      << (samples.Given.rows() == 0 ? "none" : "all NaN or of weight 0")
      << "; allowed: one or more that are known");
  }
  if (!isAnyLeft)
  {
    throw InputError(Sentence("all values at points are outside of the surface: farther than ")
      << Word::Setting("MaximumDistance") << " " << maximumDistance << ", or where "
      << Word::Array("MaskArray") << " excludes it; allowed: one value on it");
  }
}

KnownValues FindKnownValues(
  const Surface& surface, const Fields& fields, bool inpaint, double unit, double maximumDistance)
{
  CheckFidelityFactors(fields);
  KnownValues known;
  Collector collector(fields, unit);
  if (fields.Samples)
  {
    const PointSamples& samples = *fields.Samples;
    known.AreSamples = true;
    known.SamplesName = samples.Name;
    known.SamplePlaces.resize(samples.Places.rows(), 3);
    for (std::size_t i = 0; i < fields.Projected->size(); ++i)
    {
      const ProjectedSample& sample = (*fields.Projected)[i];
      if (!Counts(samples, i))
      {
        continue;
      }
      known.SamplePlaces.row(static_cast<Eigen::Index>(known.SampleDistances.size())) =
        samples.Places.row(static_cast<Eigen::Index>(i));
      known.SampleDistances.push_back(sample.Distance);
      if (!IsWithin(sample, maximumDistance))
      {
        ++known.TooFar;
        continue;
      }
      SurfacePoint place;
      place.Coordinates = sample.Coordinates;
      bool takesPart = !sample.IsExcluded;
      for (std::size_t a = 0; a < 3 && takesPart; ++a)
      {
        place.Vertices[a] = surface.VertexOf(sample.Points[a]);
        takesPart = place.Vertices[a] >= 0 || place.Coordinates[a] == 0.0;
        place.Vertices[a] = std::max<Index>(place.Vertices[a], 0);
      }
      if (!takesPart)
      {
        ++known.Outside;
        continue;
      }
      collector.Add(
        place, static_cast<Eigen::Index>(i), samples.Weights.empty() ? 1.0 : samples.Weights[i]);
    }
    known.SamplePlaces.conservativeResize(
      static_cast<Eigen::Index>(known.SampleDistances.size()), 3);
    known.Values = collector.Take(samples.Given);
    known.Rows = collector.TakeRows();
    known.NumberOfRows = samples.Given.rows();
    return known;
  }
  // With data on cells, factors may still be on points.
  const bool factorsOfPoints = fields.Data.OnCells && !fields.FidelityFactors.OnCells &&
    !fields.FidelityFactors.Values.empty();
  const Vector ofVertices = factorsOfPoints ? MakeFidelityFactors(surface, fields) : Vector();
  const std::vector<SurfacePoint> middles =
    fields.Data.OnCells ? MiddlesOfCells(surface, fields) : std::vector<SurfacePoint>();
  FirstCopies copies(surface, fields);
  for (std::size_t i = 0; i < static_cast<std::size_t>(fields.Data.Values.rows()); ++i)
  {
    const auto row = static_cast<Eigen::Index>(i);
    if (IsSet(fields.Missing, i) || fields.Data.Values.row(row).hasNaN() ||
      (!fields.Data.OnCells && IsSet(fields.Between, i)) || fields.IsLeftOut(row, inpaint))
    {
      continue;
    }
    if (fields.Data.OnCells && middles[i].Vertices[0] >= 0)
    {
      const std::array<Index, 3>& corners = middles[i].Vertices;
      collector.Add(middles[i], row,
        factorsOfPoints
          ? (ofVertices[corners[0]] + ofVertices[corners[1]] + ofVertices[corners[2]]) / 3.0
          : collector.WeightOf(i));
    }
    else if (!fields.Data.OnCells && surface.VertexOf(static_cast<Index>(i)) >= 0 &&
      copies.IsFirst(i))
    {
      collector.Add(SurfacePoint::AtVertex(surface.VertexOf(static_cast<Index>(i))), row,
        collector.WeightOf(i));
    }
  }
  known.Values = collector.Take(fields.Data.Values);
  known.Rows = collector.TakeRows();
  known.NumberOfRows = fields.Data.Values.rows();
  known.OnCells = fields.Data.OnCells;
  return known;
}

} // namespace SurfaceDiffusion
