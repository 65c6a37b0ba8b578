// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/PointSamples.h"

#include "Core/Geometry/NearestPoints.h"
#include "Run/CellFields.h"
#include "Run/Fields.h"
#include "Run/Surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

bool IsSet(const std::vector<char>& flags, std::size_t i)
{
  return !flags.empty() && flags[i] != 0;
}

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
  const auto fail = [](const Sentence& text, std::size_t i, const char* allowed)
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
        "allowed: finite numbers, 0 or more");
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

/// Of merged points, those with the values and the weight of an earlier one are copies of it: what was
/// measured once may be stored with every triangle.
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

/// Of the cells that were cut from one, only the value of the cell nearest to its middle is kept.
void LeaveOneOfEach(
  const Surface& surface, const Fields& fields, std::vector<SurfacePoint>& middles)
{
  struct Given
  {
    Eigen::RowVector3d Moment = Eigen::RowVector3d::Zero();
    double Area = 0.0;
    double Least = std::numeric_limits<double>::infinity();
    Index Nearest = -1;
  };
  std::map<Index, Given> ofCells;
  const TriangleMesh& mesh = surface.InputMesh();
  const auto pointOf = [&](Index vertex)
  { return surface.Points().row(mesh.InputVertex()[static_cast<std::size_t>(vertex)]); };
  for (Index t = 0; t < mesh.NumberOfTriangles() && !fields.GivenCells.empty(); ++t)
  {
    const Index row = mesh.InputTriangle()[static_cast<std::size_t>(t)];
    const Index cell = fields.Cells[static_cast<std::size_t>(surface.InputTriangle(row))];
    Given& given = ofCells[fields.GivenCells[static_cast<std::size_t>(cell)]];
    const double area = mesh.Shapes()[static_cast<std::size_t>(t)].Area();
    for (int a = 0; a < 3; ++a)
    {
      given.Moment += area / 3.0 * pointOf(mesh.TriangleVertices()(t, a));
    }
    given.Area += area;
  }
  const auto forEach = [&](const auto& f)
  {
    for (std::size_t c = 0; c < fields.GivenCells.size(); ++c)
    {
      if (middles[c].Vertices[0] >= 0)
      {
        f(static_cast<Index>(c), ofCells[fields.GivenCells[c]]);
      }
    }
  };
  forEach(
    [&](Index cell, Given& given)
    {
      const std::array<Index, 3>& corners = middles[static_cast<std::size_t>(cell)].Vertices;
      const Eigen::RowVector3d middle =
        (pointOf(corners[0]) + pointOf(corners[1]) + pointOf(corners[2])) / 3.0;
      const double distance = (middle - given.Moment / given.Area).norm();
      given.Nearest = distance < given.Least ? cell : given.Nearest;
      given.Least = std::min(given.Least, distance);
    });
  forEach(
    [&](Index cell, const Given& given)
    {
      middles[static_cast<std::size_t>(cell)].Vertices[0] =
        given.Nearest == cell ? middles[static_cast<std::size_t>(cell)].Vertices[0] : -1;
    });
}

/// The middle of the largest triangle of each cell, of the first one among triangles of equal size,
/// as those of a square; the vertices of cells without one are -1. Of the cells that were cut from
/// one, those of the others are -1, too.
std::vector<SurfacePoint> MiddlesOfCells(const Surface& surface, const Fields& fields)
{
  constexpr double equal = 1e-9; // round-off must not choose
  const TriangleMesh& mesh = surface.InputMesh();
  SurfacePoint none;
  none.Vertices.fill(-1);
  std::vector<SurfacePoint> middles(static_cast<std::size_t>(fields.NumberOfCells), none);
  std::vector<double> largest(middles.size(), -1.0);
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const Index row = mesh.InputTriangle()[static_cast<std::size_t>(t)];
    const auto cell =
      static_cast<std::size_t>(fields.Cells[static_cast<std::size_t>(surface.InputTriangle(row))]);
    const double area = mesh.Shapes()[static_cast<std::size_t>(t)].Area();
    if (area > (1.0 + equal) * largest[cell])
    {
      largest[cell] = area;
      for (std::size_t a = 0; a < 3; ++a)
      {
        middles[cell].Vertices[a] = mesh.TriangleVertices()(t, static_cast<Eigen::Index>(a));
        middles[cell].Coordinates[a] = 1.0 / 3.0;
      }
    }
  }
  LeaveOneOfEach(surface, fields, middles);
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
    for (std::size_t i = 0; i < fields.Projected->size(); ++i)
    {
      const ProjectedSample& sample = (*fields.Projected)[i];
      if (!Counts(samples, i))
      {
        continue;
      }
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
    known.Values = collector.Take(samples.Given);
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
      (!fields.Data.OnCells && IsSet(fields.Between, i)) ||
      (inpaint && IsSet(fields.Mask.Values, i)))
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
  return known;
}

} // namespace SurfaceDiffusion
