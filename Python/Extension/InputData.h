// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/DistanceSources.h"
#include "Run/Fields.h"
#include "Run/Fingerprint.h"
#include "Run/Run.h"

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

using InputArray = nanobind::ndarray<nanobind::ro, nanobind::device::cpu, nanobind::c_contig>;
using OutputArray = nanobind::ndarray<nanobind::device::cpu, nanobind::c_contig>;
using DoubleArray =
  nanobind::ndarray<const double, nanobind::ndim<2>, nanobind::device::cpu, nanobind::c_contig>;
using LongArray = nanobind::ndarray<const std::int64_t, nanobind::ndim<1>, nanobind::device::cpu,
  nanobind::c_contig>;
using FactorArray =
  nanobind::ndarray<const double, nanobind::ndim<1>, nanobind::device::cpu, nanobind::c_contig>;
using FlagArray = nanobind::ndarray<const std::uint8_t, nanobind::ndim<1>, nanobind::device::cpu,
  nanobind::c_contig>;

/// Call f(pointer to the elements of an array of one of the types that a result can have).
template <typename Array, typename F>
void VisitElements(const Array& array, const F& f)
{
  constexpr bool readOnly = std::is_same_v<Array, InputArray>;
  const auto call = [&](auto example)
  {
    using T = decltype(example);
    using Pointer = std::conditional_t<readOnly, const T*, T*>;
    f(static_cast<Pointer>(array.data()));
  };
  if (array.dtype() == nanobind::dtype<double>())
  {
    call(double());
  }
  else if (array.dtype() == nanobind::dtype<float>())
  {
    call(float());
  }
  else if (array.dtype() == nanobind::dtype<std::uint8_t>())
  {
    call(std::uint8_t());
  }
  else if (!readOnly && array.dtype() == nanobind::dtype<std::int32_t>())
  {
    call(std::int32_t());
  }
  else
  {
    throw nanobind::type_error("an array is not of type float64, float32 or uint8");
  }
}

/// The arrays of a surface, with its polygons cut into triangles.
class InputSurface
{
public:
  /// Polygon p has the points connectivity[offsets[p]] to connectivity[offsets[p + 1] - 1].
  InputSurface(const DoubleArray& points, const LongArray& connectivity, const LongArray& offsets);
  /// Triangles, as rows of three points, and the face of each, below numberOfFaces: faces may have
  /// several triangles or none. hidden: per point, nonzero for those that take no part.
  InputSurface(const DoubleArray& points, const LongArray& triangles, const LongArray& faces,
    std::size_t numberOfFaces, const std::optional<FlagArray>& hidden);

  std::size_t NumberOfPoints() const { return static_cast<std::size_t>(this->Coordinates.rows()); }
  std::size_t NumberOfFaces() const { return this->FaceCount; }
  const Triangles& GetTriangles() const { return this->TriangleRows; }
  /// The polygon that triangle t was cut from.
  std::int64_t FaceOf(Index t) const
  {
    return this->Faces.empty() ? t : this->Faces[static_cast<std::size_t>(t)];
  }

  /// See SurfaceArrays::AreaFactors; one per point.
  void SetAreaFactors(const FactorArray& factors);

  /// excluded: per point or face (cell), nonzero for those that are left out; may be empty.
  SurfaceArrays Read(const Located<std::vector<char>>& excluded) const;
  Fingerprint Version(const Located<std::vector<char>>& excluded) const;

private:
  Points Coordinates;
  Triangles TriangleRows;
  std::vector<std::int64_t> Faces; ///< per triangle; empty if all polygons are triangles
  std::size_t FaceCount = 0;
  std::vector<char> Hidden; ///< per point; may be empty
  std::vector<double> AreaFactors;
  Fingerprint Contents;
};

std::vector<char> ReadFlags(const std::optional<FlagArray>& array);

/// References to the input arrays of a run on one surface. Sizes have been checked in Python.
class PythonFields
{
public:
  PythonFields(std::shared_ptr<const InputSurface> surface, int components, bool dataAreTerms,
    std::string block)
    : Surface(std::move(surface))
    , Block(std::move(block))
    , Components(components)
    , DataAreTerms(dataAreTerms)
  {
  }

  /// kind: "data" and "slope_errors" (rows x columns), "directions" (rows x 3), and "rates" (faces x 4), float64 but for
  /// the data; "mask", "fixed", and "between", uint8; "fidelity", "seeds", "speeds", "along_speeds",
  /// "across_speeds", and "start_times", float64; "ids" and "given_faces", int64. name: for messages; may be empty.
  void Set(const std::string& kind, InputArray array, bool onFaces, const std::string& name = {});

  std::shared_ptr<const InputSurface> Surface;
  std::string Block; ///< the name of the surface among several, for messages; may be empty
  int Components; ///< of the data, alpha not counted
  /// Null without data.
  const InputArray* Data() const { return this->Find("data"); }

  void SetSamples(const DoubleArray& places, const DoubleArray& values,
    const std::optional<FactorArray>& weights, const std::string& name);
  /// places: coordinates or, with rows, barycentric coordinates in these triangles; none: rows are
  /// points. segments: pairs of rows of `places`, the straight parts of lines.
  void SetSources(const std::optional<DoubleArray>& places,
    const std::optional<LongArray>& segments, const std::optional<FlagArray>& hidden,
    const std::optional<LongArray>& rows, const std::optional<FactorArray>& starts);

  void SetPathPoints(const DoubleArray& places, const FlagArray& hidden);

  /// The same with a panel of the data's columns, which Components counts.
  PythonFields Columns(int first, int count) const;
  FieldSummary Summarize() const;
  /// For a run, as long as this object lives. excludes: whether masked triangles are left out;
  /// otherwise the surface does not depend on the mask.
  BlockInput Describe(bool excludes) const;
  Fields Read() const;
  /// Columns of the data.
  Values ReadData(Eigen::Index first, Eigen::Index count) const;
  Fingerprint Version() const;

private:
  struct Given
  {
    InputArray Array;
    bool OnFaces;
    std::string Name;
  };
  /// Null if it is not set.
  const InputArray* Find(const char* kind) const;
  bool IsOnFaces(const char* kind) const;
  /// Empty if it is not set. T: the type of the elements.
  template <typename To, typename T = To>
  Located<std::vector<To>> Read(const char* kind) const;
  Word WordOf(const char* kind, const char* property) const;
  Word DataWord() const;

  bool DataAreTerms; ///< the data are the data terms of a segmentation
  std::map<std::string, Given> Arrays; ///< by kind
  std::shared_ptr<const PointSamples> Samples; ///< in place of data
  std::shared_ptr<const SourceShapes> Sources; ///< of distances, in place of data
  std::shared_ptr<const SourceShapes> PathPoints; ///< of distances
  int FirstColumn = 0;
  int AllColumns = 0; ///< 0: no panel
  std::shared_ptr<const std::vector<char>> Missing; ///< as in Fields
  std::uint64_t PanelNumber = 0; ///< of all panels of this process: arrays are not compared
  // Of the input that a panel was taken from: found once.
  mutable std::shared_ptr<const std::vector<char>> Found;
};

/// The inputs of a run, from a list in Python.
std::vector<const PythonFields*> ListInputs(const nanobind::list& inputs);

} // namespace SurfaceDiffusion
