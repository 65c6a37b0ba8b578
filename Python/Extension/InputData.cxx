// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "InputData.h"

#include "Core/Surface/Polygons.h"
#include "Run/FieldChecks.h"
#include "Threads.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace nb = nanobind;

namespace SurfaceDiffusion
{

namespace
{

template <typename Array>
void AddArray(Fingerprint& fingerprint, const std::optional<Array>& array)
{
  fingerprint.AddNumber(std::uint64_t{ array ? 1U : 0U });
  if (!array)
  {
    return;
  }
  fingerprint.AddNumber(std::uint64_t{ array->dtype().bits });
  for (std::size_t axis = 0; axis < array->ndim(); ++axis)
  {
    fingerprint.AddNumber(static_cast<std::uint64_t>(array->shape(axis)));
  }
  if (array->nbytes() > 0)
  {
    fingerprint.AddBytes(array->data(), array->nbytes(), PythonThreads::Instance());
  }
}

/// Per row, whether any number is NaN.
std::vector<char> FindMissing(const InputArray& array)
{
  const auto columns = static_cast<Eigen::Index>(array.shape(1));
  std::vector<char> missing(array.shape(0));
  VisitElements(array,
    [&](const auto* numbers)
    {
      ForEach(PythonThreads::Instance(), static_cast<Index>(missing.size()),
        [&](Index i)
        {
          const auto* const row = numbers + i * columns;
          missing[static_cast<std::size_t>(i)] =
            std::any_of(row, row + columns, [](auto number) { return number != number; });
        });
    });
  return missing;
}

std::vector<char> ReadFlags(const std::optional<FlagArray>& array)
{
  return array ? std::vector<char>(array->data(), array->data() + array->size())
               : std::vector<char>();
}

std::vector<double> ReadNumbers(const std::optional<FactorArray>& array)
{
  return array ? std::vector<double>(array->data(), array->data() + array->size())
               : std::vector<double>();
}

/// The rows of an array that the triangles of the surface belong to.
template <typename Matrix>
Matrix ReadOnTriangles(const InputSurface& surface, const DoubleArray& array)
{
  const auto columns = static_cast<Eigen::Index>(array.shape(1));
  Matrix rows(surface.GetTriangles().rows(), columns);
  for (Eigen::Index t = 0; t < rows.rows(); ++t)
  {
    const double* const from = array.data() + surface.FaceOf(static_cast<Index>(t)) * columns;
    rows.row(t) = Eigen::Map<const Eigen::RowVectorXd>(from, columns);
  }
  return rows;
}

/// Throws std::runtime_error.
void RequireIndices(std::size_t count, const char* what)
{
  if (count > static_cast<std::size_t>(std::numeric_limits<Index>::max()))
  {
    throw std::runtime_error(
      std::string("the surface has more ") + what + " than this library can number");
  }
}

} // namespace

InputSurface::InputSurface(
  const DoubleArray& points, const LongArray& connectivity, const LongArray& offsets)
  : Coordinates(
      Eigen::Map<const Points>(points.data(), static_cast<Eigen::Index>(points.shape(0)), 3))
  , FaceCount(offsets.size() - 1)
{
  RequireIndices(points.shape(0), "points");
  RequireIndices(this->FaceCount, "faces");
  RequireFiniteCoordinates(this->Coordinates);
  std::vector<Corners> triangles;
  std::vector<Eigen::RowVector3d> polygon;
  std::vector<Index> cut;
  cut.reserve(3 * this->FaceCount);
  bool onlyTriangles = true;
  for (std::size_t p = 0; p < this->FaceCount; ++p)
  {
    const std::int64_t* const corners = connectivity.data() + offsets.data()[p];
    const auto size = static_cast<std::size_t>(offsets.data()[p + 1] - offsets.data()[p]);
    onlyTriangles = onlyTriangles && size == 3;
    if (size == 3)
    {
      triangles.assign({ { 0, 1, 2 } });
    }
    else
    {
      polygon.clear();
      for (std::size_t i = 0; i < size; ++i)
      {
        polygon.emplace_back(this->Coordinates.row(static_cast<Eigen::Index>(corners[i])));
      }
      triangles = CutPolygon(polygon);
    }
    for (const Corners& triangle : triangles)
    {
      for (const int corner : triangle)
      {
        cut.push_back(static_cast<Index>(corners[corner]));
      }
      this->Faces.push_back(static_cast<std::int64_t>(p));
    }
  }
  if (onlyTriangles)
  {
    this->Faces = std::vector<std::int64_t>();
  }
  this->TriangleRows =
    Eigen::Map<const Triangles>(cut.data(), static_cast<Eigen::Index>(cut.size() / 3), 3);
  const auto add = [this](const void* data, std::size_t size)
  { this->Contents.AddBytes(data, size, PythonThreads::Instance()); };
  add(
    this->Coordinates.data(), sizeof(double) * static_cast<std::size_t>(this->Coordinates.size()));
  add(
    this->TriangleRows.data(), sizeof(Index) * static_cast<std::size_t>(this->TriangleRows.size()));
}

InputSurface::InputSurface(const DoubleArray& points, const LongArray& triangles,
  const LongArray& faces, std::size_t numberOfFaces, const std::optional<FlagArray>& hidden)
  : Coordinates(
      Eigen::Map<const Points>(points.data(), static_cast<Eigen::Index>(points.shape(0)), 3))
  , Faces(faces.data(), faces.data() + faces.size())
  , FaceCount(numberOfFaces)
  , Hidden(ReadFlags(hidden))
{
  RequireIndices(points.shape(0), "points");
  RequireIndices(numberOfFaces, "cells");
  RequireIndices(triangles.size() / 3, "triangles");
  RequireFiniteCoordinates(this->Coordinates);
  const auto count = static_cast<Eigen::Index>(triangles.size() / 3);
  this->TriangleRows = Eigen::Map<const Eigen::Matrix<std::int64_t, -1, 3, Eigen::RowMajor>>(
    triangles.data(), count, 3)
                         .cast<Index>();
  const auto add = [this](const void* data, std::size_t size)
  { this->Contents.AddBytes(data, size, PythonThreads::Instance()); };
  add(points.data(), points.nbytes());
  add(triangles.data(), triangles.nbytes());
  add(faces.data(), faces.nbytes());
  add(this->Hidden.data(), this->Hidden.size());
  this->Contents.AddNumber(std::uint64_t{ numberOfFaces });
}

void InputSurface::SetAreaFactors(const FactorArray& factors)
{
  this->AreaFactors.assign(factors.data(), factors.data() + factors.size());
  this->Contents.AddBytes(
    this->AreaFactors.data(), sizeof(double) * this->AreaFactors.size(), PythonThreads::Instance());
}

SurfaceArrays InputSurface::Read(const Located<std::optional<FlagArray>>& excluded) const
{
  SurfaceArrays arrays{ this->Coordinates, this->TriangleRows, this->Hidden, this->AreaFactors };
  if (!excluded.OnCells)
  {
    const std::vector<char> masked = ReadFlags(excluded.Values);
    arrays.Excluded.resize(std::max(masked.size(), this->Hidden.size()), 0);
    for (std::size_t i = 0; i < masked.size(); ++i)
    {
      arrays.Excluded[i] = arrays.Excluded[i] != 0 || masked[i] != 0;
    }
    return arrays;
  }
  for (Index t = 0; excluded.Values && t < static_cast<Index>(this->TriangleRows.rows()); ++t)
  {
    arrays.ExcludedTriangles.push_back(excluded.Values->data()[this->FaceOf(t)] != 0);
  }
  return arrays;
}

Fingerprint InputSurface::Version(const Located<std::optional<FlagArray>>& excluded) const
{
  Fingerprint version = this->Contents;
  AddArray(version, excluded.Values);
  version.AddNumber(std::uint64_t{ excluded.OnCells ? 1U : 0U });
  return version;
}

FieldSummary InputFields::Summarize() const
{
  FieldSummary summary;
  summary.Data = this->Data.Values.has_value();
  summary.DataComponents = this->Components;
  if (this->Samples)
  {
    summary.Data = true;
    summary.DataComponents = static_cast<int>(this->Samples->Given.cols());
  }
  summary.DataName = this->DataWord();
  summary.Sources = this->Sources != nullptr;
  summary.Speeds = this->Speeds.Values.has_value();
  summary.StartTimes =
    this->StartTimes.has_value() || (this->Sources && !this->Sources->StartTimes.empty());
  summary.Directions = this->Directions.Values.has_value();
  summary.Fixed = this->Fixed.Values.has_value();
  summary.Rates = this->Rates.has_value();
  summary.DataAreTerms = this->DataAreTerms;
  return summary;
}

Word InputFields::DataWord() const
{
  return Word::Array(this->DataAreTerms ? "DataTermArray" : "InputArray",
    this->Name.empty() ? "" : " \"" + this->Name + "\"");
}

Fields InputFields::Read() const
{
  Fields fields;
  fields.Data.OnCells = this->Data.OnCells;
  if (this->Data.Values)
  {
    fields.DataName = this->DataWord();
    fields.DataAreTerms = this->DataAreTerms;
    fields.DataAreBytes = this->Data.Values->dtype() == nb::dtype<std::uint8_t>();
    Values& values = fields.Data.Values;
    values.resize(static_cast<Eigen::Index>(this->Data.Values->shape(0)), this->Components);
    const auto stride = static_cast<Eigen::Index>(this->Data.Values->shape(1));
    VisitElements(*this->Data.Values,
      [&](const auto* from)
      {
        ForEach(PythonThreads::Instance(), static_cast<Index>(values.rows()),
          [&](Index i)
          {
            for (Eigen::Index k = 0; k < values.cols(); ++k)
            {
              values(i, k) = static_cast<double>(from[i * stride + this->FirstColumn + k]);
            }
          });
      });
  }
  if (this->Missing)
  {
    fields.FirstColumn = this->FirstColumn;
    fields.AllColumns = this->AllColumns;
    fields.Missing = *this->Missing;
  }
  fields.Samples = this->Samples;
  fields.Sources = this->Sources;
  fields.Speeds = { ReadNumbers(this->Speeds.Values), this->Speeds.OnCells };
  fields.StartTimes = ReadNumbers(this->StartTimes);
  if (this->Ids)
  {
    fields.MakeIds = [ids = *this->Ids]
    { return std::vector<std::int64_t>(ids.data(), ids.data() + ids.size()); };
  }
  fields.Between = ReadFlags(this->Between);
  if (this->GivenFaces)
  {
    fields.GivenCells.assign(
      this->GivenFaces->data(), this->GivenFaces->data() + this->GivenFaces->size());
  }
  fields.Mask = { ReadFlags(this->Mask.Values), this->Mask.OnCells };
  fields.Fixed = { ReadFlags(this->Fixed.Values), this->Fixed.OnCells };
  fields.FidelityFactors.OnCells = this->FidelityFactors.OnCells;
  fields.Seeds =
    AsLabels({ ReadNumbers(this->Seeds.Values), this->Seeds.OnCells }, Word::Array("SeedArray"));
  if (fields.HasCells())
  {
    fields.NumberOfCells = static_cast<Index>(this->Surface->NumberOfFaces());
    fields.Cells.resize(static_cast<std::size_t>(this->Surface->GetTriangles().rows()));
    for (std::size_t t = 0; t < fields.Cells.size(); ++t)
    {
      fields.Cells[t] = static_cast<Index>(this->Surface->FaceOf(static_cast<Index>(t)));
    }
  }
  if (const auto& given = this->Directions.Values)
  {
    fields.Directions = { Eigen::Map<const Points>(
                            given->data(), static_cast<Eigen::Index>(given->shape(0)), 3),
      this->Directions.OnCells };
    RequireFiniteDirections(
      fields.Directions.Values, fields.Directions.OnCells, Word::Array("DirectionArray"));
    if (this->Directions.OnCells)
    {
      fields.Directions.Values = ReadOnTriangles<Points>(*this->Surface, *given);
    }
  }
  if (this->Rates)
  {
    fields.Rates = ReadOnTriangles<Values>(*this->Surface, *this->Rates);
    RequireRates(fields.Rates, [&](Index t) { return this->Surface->FaceOf(t); });
  }
  fields.FidelityFactors.Values = ReadNumbers(this->FidelityFactors.Values);
  return fields;
}

void InputFields::SetSamples(const DoubleArray& places, const DoubleArray& values,
  const std::optional<FactorArray>& weights, const std::string& name)
{
  const auto count = static_cast<Eigen::Index>(values.shape(0));
  auto samples = std::make_shared<PointSamples>();
  samples->Places = Eigen::Map<const Points>(places.data(), count, 3);
  samples->Given =
    Eigen::Map<const Values>(values.data(), count, static_cast<Eigen::Index>(values.shape(1)));
  if (weights)
  {
    samples->Weights.assign(weights->data(), weights->data() + weights->size());
  }
  samples->Name = name;
  this->Samples = std::move(samples);
}

void InputFields::SetSources(const std::optional<DoubleArray>& places,
  const std::optional<LongArray>& segments, const std::optional<FlagArray>& hidden,
  const std::optional<LongArray>& rows, const std::optional<FactorArray>& starts)
{
  auto sources = std::make_shared<SourceShapes>();
  if (places)
  {
    sources->Places =
      Eigen::Map<const Points>(places->data(), static_cast<Eigen::Index>(places->shape(0)), 3);
  }
  for (std::size_t k = 0; segments && k + 1 < segments->size(); k += 2)
  {
    sources->Segments.push_back(
      { static_cast<Index>(segments->data()[k]), static_cast<Index>(segments->data()[k + 1]) });
  }
  sources->Hidden = ReadFlags(hidden);
  if (rows)
  {
    std::vector<Index>& numbers = places ? sources->OfTriangles : sources->OfPoints;
    numbers.assign(rows->data(), rows->data() + rows->size());
  }
  sources->StartTimes = ReadNumbers(starts);
  this->Sources = std::move(sources);
}

InputFields InputFields::Columns(int first, int count) const
{
  static std::atomic<std::uint64_t> panels{ 0 };
  if (!this->Found)
  {
    this->Found = std::make_shared<const std::vector<char>>(FindMissing(*this->Data.Values));
  }
  InputFields panel = *this;
  panel.FirstColumn = first;
  panel.AllColumns = this->Components;
  panel.Components = count;
  panel.Missing = this->Found;
  panel.PanelNumber = ++panels;
  return panel;
}

Fingerprint InputFields::Version() const
{
  Fingerprint version;
  version.AddNumber(this->PanelNumber);
  if (this->PanelNumber == 0)
  {
    AddArray(version, this->Data.Values);
  }
  AddArray(version, this->Mask.Values);
  AddArray(version, this->Fixed.Values);
  AddArray(version, this->Directions.Values);
  AddArray(version, this->Rates);
  AddArray(version, this->FidelityFactors.Values);
  AddArray(version, this->Seeds.Values);
  AddArray(version, this->Speeds.Values);
  AddArray(version, this->StartTimes);
  AddArray(version, this->Ids);
  AddArray(version, this->Between);
  AddArray(version, this->GivenFaces);
  const auto add = [&](const auto& numbers)
  {
    const auto count = static_cast<std::size_t>(numbers.size());
    version.AddNumber(std::uint64_t{ count });
    version.AddBytes(numbers.data(), count * sizeof(*numbers.data()), SerialFor());
  };
  if (this->Samples)
  {
    add(this->Samples->Places);
    add(this->Samples->Given);
    add(this->Samples->Weights);
  }
  if (this->Sources)
  {
    add(this->Sources->Places);
    add(this->Sources->Segments);
    add(this->Sources->Hidden);
    add(this->Sources->OfPoints);
    add(this->Sources->OfTriangles);
    add(this->Sources->StartTimes);
  }
  version.AddNumber(std::uint64_t{ this->DataAreTerms ? 1U : 0U });
  for (const bool onFaces :
    { this->Speeds.OnCells, this->Directions.OnCells, this->Data.OnCells, this->Mask.OnCells,
      this->Fixed.OnCells, this->FidelityFactors.OnCells, this->Seeds.OnCells })
  {
    version.AddNumber(std::uint64_t{ onFaces ? 1U : 0U });
  }
  return version;
}

BlockInput InputFields::Describe(bool excludes) const
{
  auto excluded = this->Mask;
  if (!excludes)
  {
    excluded.Values.reset();
  }
  BlockInput input;
  input.Name = this->Block;
  input.SurfaceVersion = this->Surface->Version(excluded);
  input.FieldsVersion = this->Version();
  input.ReadSurface = [this, excluded] { return this->Surface->Read(excluded); };
  input.ReadFields = [this] { return this->Read(); };
  return input;
}

std::vector<const InputFields*> ListInputs(const nb::list& inputs)
{
  std::vector<const InputFields*> list;
  for (const nb::handle& input : inputs)
  {
    list.push_back(nb::cast<const InputFields*>(input));
  }
  return list;
}

} // namespace SurfaceDiffusion
