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

void AddArray(Fingerprint& fingerprint, const InputArray& array)
{
  fingerprint.AddNumber(std::uint64_t{ array.dtype().bits });
  for (std::size_t axis = 0; axis < array.ndim(); ++axis)
  {
    fingerprint.AddNumber(static_cast<std::uint64_t>(array.shape(axis)));
  }
  if (array.nbytes() > 0)
  {
    fingerprint.AddBytes(array.data(), array.nbytes(), PythonThreads::Instance());
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

/// The rows of an array on faces that the triangles of the surface belong to.
template <typename Matrix>
Matrix ReadOnTriangles(const InputSurface& surface, const Matrix& array)
{
  Matrix rows(surface.GetTriangles().rows(), array.cols());
  for (Eigen::Index t = 0; t < rows.rows(); ++t)
  {
    rows.row(t) = array.row(static_cast<Eigen::Index>(surface.FaceOf(static_cast<Index>(t))));
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

std::vector<char> ReadFlags(const std::optional<FlagArray>& array)
{
  return array ? std::vector<char>(array->data(), array->data() + array->size())
               : std::vector<char>();
}

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

SurfaceArrays InputSurface::Read(const Located<std::vector<char>>& excluded) const
{
  SurfaceArrays arrays{ this->Coordinates, this->TriangleRows, this->Hidden, this->AreaFactors };
  if (!excluded.OnCells)
  {
    arrays.Excluded.resize(std::max(excluded.Values.size(), this->Hidden.size()), 0);
    for (std::size_t i = 0; i < arrays.Excluded.size(); ++i)
    {
      arrays.Excluded[i] = IsSet(this->Hidden, i) || IsSet(excluded.Values, i);
    }
    return arrays;
  }
  for (Index t = 0; t < static_cast<Index>(this->TriangleRows.rows()); ++t)
  {
    arrays.ExcludedTriangles.push_back(IsSet(excluded.Values, this->FaceOf(t)));
  }
  return arrays;
}

Fingerprint InputSurface::Version(const Located<std::vector<char>>& excluded) const
{
  Fingerprint version = this->Contents;
  version.AddBytes(excluded.Values.data(), excluded.Values.size(), PythonThreads::Instance());
  version.AddNumber(std::uint64_t{ excluded.OnCells ? 1U : 0U });
  return version;
}

void PythonFields::Set(
  const std::string& kind, InputArray array, bool onFaces, const std::string& name)
{
  this->Arrays.insert_or_assign(kind, Given{ std::move(array), onFaces, name });
}

const InputArray* PythonFields::Find(const char* kind) const
{
  const auto found = this->Arrays.find(kind);
  return found == this->Arrays.end() ? nullptr : &found->second.Array;
}

bool PythonFields::IsOnFaces(const char* kind) const
{
  const auto found = this->Arrays.find(kind);
  return found != this->Arrays.end() && found->second.OnFaces;
}

template <typename To, typename T>
Located<std::vector<To>> PythonFields::Read(const char* kind) const
{
  const InputArray* const array = this->Find(kind);
  if (!array)
  {
    return {};
  }
  if (array->dtype() != nb::dtype<T>())
  {
    throw nb::type_error((std::string(kind) + " has another type of elements").c_str());
  }
  const T* const data = static_cast<const T*>(array->data());
  return { { data, data + array->size() }, this->IsOnFaces(kind) };
}

FieldSummary PythonFields::Summarize() const
{
  FieldSummary summary;
  summary.Data = this->Data() || this->Samples;
  summary.DataComponents =
    this->Samples ? static_cast<int>(this->Samples->Given.cols()) : this->Components;
  summary.DataName = this->DataWord();
  summary.Sources = this->Sources != nullptr;
  summary.PathPoints = this->PathPoints != nullptr;
  summary.Speeds = this->Find("speeds") != nullptr;
  summary.AlongSpeeds = this->Find("along_speeds") != nullptr;
  summary.AcrossSpeeds = this->Find("across_speeds") != nullptr;
  summary.StartTimes =
    this->Find("start_times") || (this->Sources && !this->Sources->StartTimes.empty());
  if (const InputArray* const errors = this->Find("slope_errors"))
  {
    summary.SlopeErrorComponents = errors->ndim() == 1 ? 1 : static_cast<int>(errors->shape(1));
  }
  summary.Directions = this->Find("directions") != nullptr;
  summary.Fixed = this->Find("fixed") != nullptr;
  summary.Rates = this->Find("rates") != nullptr;
  summary.DataAreTerms = this->DataAreTerms;
  return summary;
}

Word PythonFields::WordOf(const char* kind, const char* property) const
{
  const auto found = this->Arrays.find(kind);
  const std::string name = found == this->Arrays.end() ? "" : found->second.Name;
  return Word::Array(property, name.empty() ? "" : " \"" + name + "\"");
}

Word PythonFields::DataWord() const
{
  return this->WordOf("data", this->DataAreTerms ? "DataTermArray" : "InputArray");
}

Values PythonFields::ReadData(Eigen::Index first, Eigen::Index count) const
{
  const InputArray& data = *this->Data();
  Values values(static_cast<Eigen::Index>(data.shape(0)), count);
  const auto stride = static_cast<Eigen::Index>(data.shape(1));
  VisitElements(data,
    [&](const auto* from)
    {
      ForEach(PythonThreads::Instance(), static_cast<Index>(values.rows()),
        [&](Index i)
        {
          for (Eigen::Index k = 0; k < count; ++k)
          {
            values(i, k) = static_cast<double>(from[i * stride + first + k]);
          }
        });
    });
  return values;
}

Fields PythonFields::Read() const
{
  Fields fields;
  if (const InputArray* const data = this->Data())
  {
    fields.DataName = this->DataWord();
    fields.DataAreTerms = this->DataAreTerms;
    fields.DataAreBytes = data->dtype() == nb::dtype<std::uint8_t>();
    fields.Data.OnCells = this->IsOnFaces("data");
    fields.Data.Values = this->ReadData(this->FirstColumn, this->Components);
  }
  if (this->Missing)
  {
    fields.FirstColumn = this->FirstColumn;
    fields.AllColumns = this->AllColumns;
    fields.Missing = *this->Missing;
  }
  fields.Samples = this->Samples;
  fields.Sources = this->Sources;
  fields.PathPoints = this->PathPoints;
  fields.Speeds = this->Read<double>("speeds");
  fields.AlongSpeeds = this->Read<double>("along_speeds");
  fields.AcrossSpeeds = this->Read<double>("across_speeds");
  fields.StartTimes = this->Read<double>("start_times").Values;
  if (const InputArray* const errors = this->Find("slope_errors"))
  {
    const std::vector<double> given = this->Read<double>("slope_errors").Values;
    const auto rows = static_cast<Eigen::Index>(errors->shape(0));
    fields.SlopeErrors = Eigen::Map<const Values>(given.data(), rows,
      static_cast<Eigen::Index>(given.size()) / std::max<Eigen::Index>(rows, 1));
  }
  if (this->Find("ids"))
  {
    fields.MakeIds = [ids = this->Read<std::int64_t>("ids").Values] { return ids; };
  }
  fields.Between = this->Read<char, std::uint8_t>("between").Values;
  fields.GivenCells = this->Read<Index, std::int64_t>("given_faces").Values;
  fields.Mask = this->Read<char, std::uint8_t>("mask");
  fields.Fixed = this->Read<char, std::uint8_t>("fixed");
  fields.Seeds = this->Find("creases")
    ? AsLabels(this->Read<double>("creases"), this->WordOf("creases", "CreaseArray"))
    : AsLabels(this->Read<double>("seeds"), this->WordOf("seeds", "SeedArray"));
  fields.FidelityFactors = this->Read<double>("fidelity");
  if (fields.HasCells())
  {
    fields.NumberOfCells = static_cast<Index>(this->Surface->NumberOfFaces());
    fields.Cells.resize(static_cast<std::size_t>(this->Surface->GetTriangles().rows()));
    for (std::size_t t = 0; t < fields.Cells.size(); ++t)
    {
      fields.Cells[t] = static_cast<Index>(this->Surface->FaceOf(static_cast<Index>(t)));
    }
  }
  if (this->Find("directions"))
  {
    const Located<std::vector<double>> given = this->Read<double>("directions");
    fields.Directions = { Eigen::Map<const Points>(given.Values.data(),
                            static_cast<Eigen::Index>(given.Values.size() / 3), 3),
      given.OnCells };
    RequireFiniteDirections(fields.Directions.Values, fields.Directions.OnCells,
      this->WordOf("directions", "DirectionArray"));
    if (given.OnCells)
    {
      fields.Directions.Values = ReadOnTriangles(*this->Surface, fields.Directions.Values);
    }
  }
  if (this->Find("rates"))
  {
    const std::vector<double> given = this->Read<double>("rates").Values;
    fields.Rates = ReadOnTriangles<Values>(*this->Surface,
      Eigen::Map<const Values>(given.data(), static_cast<Eigen::Index>(given.size() / 4), 4));
    RequireRates(fields.Rates, [&](Index t) { return this->Surface->FaceOf(t); });
  }
  return fields;
}

void PythonFields::SetSamples(const DoubleArray& places, const DoubleArray& values,
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

void PythonFields::SetSources(const std::optional<DoubleArray>& places,
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
  if (starts)
  {
    sources->StartTimes.assign(starts->data(), starts->data() + starts->size());
  }
  this->Sources = std::move(sources);
}

void PythonFields::SetPathPoints(const DoubleArray& places, const FlagArray& hidden)
{
  auto points = std::make_shared<SourceShapes>();
  points->Places =
    Eigen::Map<const Points>(places.data(), static_cast<Eigen::Index>(places.shape(0)), 3);
  points->Hidden = ReadFlags(hidden);
  this->PathPoints = std::move(points);
}

PythonFields PythonFields::Columns(int first, int count) const
{
  static std::atomic<std::uint64_t> panels{ 0 };
  if (!this->Found)
  {
    this->Found = std::make_shared<const std::vector<char>>(FindMissing(*this->Data()));
  }
  PythonFields panel = *this;
  panel.FirstColumn = first;
  panel.AllColumns = this->Components;
  panel.Components = count;
  panel.Missing = this->Found;
  panel.PanelNumber = ++panels;
  return panel;
}

Fingerprint PythonFields::Version() const
{
  Fingerprint version;
  version.AddNumber(this->PanelNumber);
  for (const auto& [kind, given] : this->Arrays)
  {
    version.AddBytes(kind.data(), kind.size());
    version.AddNumber(std::uint64_t{ given.OnFaces ? 1U : 0U });
    if (this->PanelNumber == 0 || kind != "data")
    {
      AddArray(version, given.Array);
    }
  }
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
  for (const SourceShapes* const shapes : { this->Sources.get(), this->PathPoints.get() })
  {
    version.AddNumber(std::uint64_t{ shapes ? 1U : 0U });
    if (shapes)
    {
      add(shapes->Places);
      add(shapes->Segments);
      add(shapes->Hidden);
      add(shapes->OfPoints);
      add(shapes->OfTriangles);
      add(shapes->StartTimes);
    }
  }
  version.AddNumber(std::uint64_t{ this->DataAreTerms ? 1U : 0U });
  return version;
}

BlockInput PythonFields::Describe(bool excludes) const
{
  const auto excluded =
    excludes ? this->Read<char, std::uint8_t>("mask") : Located<std::vector<char>>();
  BlockInput input;
  input.Name = this->Block;
  input.SurfaceVersion = this->Surface->Version(excluded);
  input.FieldsVersion = this->Version();
  input.ReadSurface = [this, excluded] { return this->Surface->Read(excluded); };
  input.ReadFields = [this] { return this->Read(); };
  return input;
}

std::vector<const PythonFields*> ListInputs(const nb::list& inputs)
{
  std::vector<const PythonFields*> list;
  for (const nb::handle& input : inputs)
  {
    list.push_back(nb::cast<const PythonFields*>(input));
  }
  return list;
}

} // namespace SurfaceDiffusion
