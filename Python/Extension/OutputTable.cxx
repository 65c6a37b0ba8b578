// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OutputTable.h"

#include "SettingsTable.h"
#include "Threads.h"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstdint>
#include <type_traits>

namespace nb = nanobind;

namespace SurfaceDiffusion
{

namespace
{

const char* NameOf(OutputType type)
{
  switch (type)
  {
    case OutputType::Data:
      return "data";
    case OutputType::Real:
      return "real";
    case OutputType::Integer:
      return "integer";
    case OutputType::Byte:
      return "byte";
    default:
      return "double";
  }
}

const char* NameOf(Role role)
{
  switch (role)
  {
    case Role::Scalars:
      return "scalars";
    case Role::Vectors:
      return "vectors";
    case Role::Coordinates:
      return "coordinates";
    default:
      return "";
  }
}

const char* NameOf(const Output& output, bool onCells)
{
  switch (output.Where)
  {
    case Place::PerCurvePoint:
      return "curve points";
    case Place::PerCurve:
      return "curves";
    case Place::Column:
      return "column";
    case Place::PerSample:
      return "samples";
    case Place::Number:
      return "number";
    default:
      return onCells ? "faces" : "points";
  }
}

} // namespace

nb::list ListOutputs(const OutputList& outputs, const Run::Block* block, const ModelTraits& traits)
{
  nb::list list;
  for (const Output& output : outputs)
  {
    nb::dict entry;
    entry["name"] = output.Name;
    entry["place"] = NameOf(output, IsOnCells(output, block, traits));
    entry["kind"] = NameOf(output.Type);
    entry["role"] = NameOf(output.Active);
    entry["is_result"] = output.IsResult;
    entry["is_beside_result"] = output.IsBesideResult;
    entry["data_name"] = output.DataName;
    entry["rows"] = output.Lines ? output.Lines->Points.rows() : output.Rows.rows();
    entry["columns"] = CountColumns(output, block);
    if (output.Lines)
    {
      entry["begin"] = nb::cast(output.Lines->Begin);
      entry["corners"] = nb::cast(output.Lines->Corners);
    }
    list.append(entry);
  }
  return list;
}

namespace
{

template <typename Matrix>
void WriteMatrix(const Matrix& from, const OutputArray& output)
{
  VisitElements(output,
    [&](auto* to)
    {
      using T = std::remove_pointer_t<decltype(to)>;
      // Infinity is a number in a table, and no overflow.
      std::transform(from.data(), from.data() + from.size(), to,
        [](double x)
        { return std::is_same_v<T, double> ? static_cast<T>(x) : ConvertValue<T>(x); });
    });
}

} // namespace

void WriteOutput(const Output& from, OutputSource& source, const PythonFields& input,
  const OutputArray& output, int first)
{
  if (from.Lines)
  {
    WriteMatrix(from.Lines->Points, output);
    return;
  }
  if (from.Where > Place::PerTriangle)
  {
    WriteMatrix(from.Rows, output);
    return;
  }
  source.NumberOfCells = static_cast<std::int64_t>(input.Surface->NumberOfFaces());
  source.CellOf = [&](Index t) { return input.Surface->FaceOf(t); };
  const OutputRows rows(from, source);
  const auto stride = static_cast<Eigen::Index>(output.shape(1));
  const auto write = [&](const auto& given)
  {
    VisitElements(
      output, [&](auto* to) { rows.Write(to, stride, first, given, PythonThreads::Instance()); });
  };
  if (!rows.TakesGiven())
  {
    write([](Index, Eigen::Index) { return 0.0; });
    return;
  }
  const auto columns = static_cast<Eigen::Index>(input.Data()->shape(1));
  const Eigen::Index start = std::max(first, 0);
  VisitElements(*input.Data(),
    [&](const auto* old)
    {
      write(
        [&](Index i, Eigen::Index k) { return static_cast<double>(old[i * columns + start + k]); });
    });
}

nb::dict ListNumbers(const std::map<std::string, Values>& numbers)
{
  nb::dict all;
  for (const auto& [name, matrix] : numbers)
  {
    nb::list rows;
    for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    {
      nb::list row;
      for (Eigen::Index k = 0; k < matrix.cols(); ++k)
      {
        row.append(matrix(i, k));
      }
      rows.append(row);
    }
    all[name.c_str()] = rows;
  }
  return all;
}

nb::list ListSentences(const std::vector<Warning>& warnings)
{
  nb::list sentences;
  for (const Warning& warning : warnings)
  {
    sentences.append(ListWords(warning.Sentence));
  }
  return sentences;
}

nb::list ListSentences(const std::vector<Sentence>& sentences)
{
  nb::list list;
  for (const Sentence& sentence : sentences)
  {
    list.append(ListWords(sentence));
  }
  return list;
}

} // namespace SurfaceDiffusion
