// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The engine of the page: the functions of Engine.h in JavaScript. An error of the library is thrown
// as an Error with its sentence.

#include "Engine.h"

#include <emscripten/bind.h>

#include <exception>
#include <new>

using emscripten::val;
using namespace SurfaceDiffusion;

namespace
{

Engine& TheEngine()
{
  static Engine engine;
  return engine;
}

/// work(), whose exceptions become those of JavaScript.
template <typename Work>
auto Guarded(const Work& work) -> decltype(work())
{
  std::string problem;
  try
  {
    return work();
  }
  catch (const std::bad_alloc&)
  {
    problem = "the memory of a page, 2 GB, does not suffice; allowed: surfaces with fewer points";
  }
  catch (const std::exception& error)
  {
    problem = error.what();
  }
  val::global("Error").new_(problem).throw_();
}

/// A copy in the memory of JavaScript.
template <typename T>
val Copy(const T* numbers, std::size_t count)
{
  return val(emscripten::typed_memory_view(count, numbers)).call<val>("slice");
}

template <typename T>
val Copy(const std::vector<T>& numbers)
{
  return Copy(numbers.data(), numbers.size());
}

std::string Open(const std::string& name, const val& bytes)
{
  return Guarded(
    [&] {
      return TheEngine().Open(name, emscripten::convertJSArrayToNumberVector<std::uint8_t>(bytes));
    });
}

std::string RunModel(const std::string& model, const std::string& json)
{
  return Guarded(
    [&]
    {
      // A callable of the page gets the fraction done, and returns true to cancel.
      const val report = val::module_property("onProgress");
      const bool isThere = report.typeOf().as<std::string>() == "function";
      return TheEngine().Run(model, val::global("JSON").call<val>("parse", json),
        [&](double fraction) { return !isThere || !report(fraction).as<bool>(); });
    });
}

val CopyPoints(const Domain& domain)
{
  return Copy(domain.Points.data(), static_cast<std::size_t>(domain.Points.size()));
}

val CopyTriangles(const Domain& domain)
{
  return Copy(reinterpret_cast<const std::uint32_t*>(domain.Triangles.data()),
    static_cast<std::size_t>(domain.Triangles.size()));
}

val CopyCells(const std::vector<Index>& cells)
{
  return Copy(reinterpret_cast<const std::uint32_t*>(cells.data()), cells.size());
}

val GetPoints()
{
  return CopyPoints(TheEngine().Surface());
}

val GetTriangles()
{
  return CopyTriangles(TheEngine().Surface());
}

val GetCellOfTriangle()
{
  return CopyCells(TheEngine().Surface().Cells);
}

val GetResultTriangles()
{
  return CopyTriangles(TheEngine().ResultSurface());
}

val GetResultCellOfTriangle()
{
  return CopyCells(TheEngine().ResultSurface().OwnCells());
}

val GetArray(const std::string& name, const std::string& association)
{
  return Guarded([&] { return Copy(TheEngine().Array(name, association).Numbers); });
}

val GetResultArray(const std::string& name)
{
  return Guarded([&] { return Copy(TheEngine().ResultArray(name).Numbers); });
}

val GetResultPoints()
{
  const double* const points = TheEngine().ResultPoints();
  const auto size = static_cast<std::size_t>(TheEngine().ResultSurface().Points.size());
  return points ? Copy(points, size) : val::null();
}

val WriteSurface(const std::string& name)
{
  return Guarded([&] { return Copy(TheEngine().Write(name)); });
}

val WritePaths(const std::string& name)
{
  return Guarded([&] { return Copy(TheEngine().WritePaths(name)); });
}

} // namespace

EMSCRIPTEN_BINDINGS(engine)
{
  emscripten::function("describe", &DescribeModels);
  emscripten::function("open", &Open);
  emscripten::function("points", &GetPoints);
  emscripten::function("triangles", &GetTriangles);
  emscripten::function("cellOfTriangle", &GetCellOfTriangle);
  emscripten::function("array", &GetArray);
  emscripten::function("run", &RunModel);
  emscripten::function("resultArray", &GetResultArray);
  emscripten::function("resultPoints", &GetResultPoints);
  emscripten::function("resultTriangles", &GetResultTriangles);
  emscripten::function("resultCellOfTriangle", &GetResultCellOfTriangle);
  emscripten::function("write", &WriteSurface);
  emscripten::function("writePaths", &WritePaths);
}
