// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The extension module surfacediffusion._core: runs, surfaces and settings for the functions in
// Python, which check types and shapes and word the errors.

#include "InputData.h"
#include "ModelRun.h"
#include "NewArrays.h"
#include "PythonRuns.h"
#include "Run/PythonNames.h"
#include "Run/RunSettings.h"
#include "SettingsTable.h"
#include "ShapeFunctions.h"
#include "SurfaceFields.h"
#include "SurfaceOperators.h"
#include "Threads.h"

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace nb = nanobind;
using namespace SurfaceDiffusion;
using namespace nanobind::literals;

namespace
{

/// Of an object with SurfaceDiagnostics: the number of coincident boundary points and how far apart
/// they are.
template <typename T>
nb::tuple SeamsOf(const T& built)
{
  const SurfaceDiagnostics& found = built.Diagnostics();
  return nb::make_tuple(found.CoincidentBoundaryPoints, found.CoincidenceDistance);
}

nb::object GetTriangles(const std::shared_ptr<InputSurface>& surface)
{
  const Triangles& triangles = surface->GetTriangles();
  return nb::cast(nb::ndarray<nb::numpy, const Index, nb::shape<-1, 3>>(
    triangles.data(), { static_cast<std::size_t>(triangles.rows()), 3 }, nb::cast(surface)));
}

/// The face of each triangle.
nb::object GetFaces(const InputSurface& surface)
{
  std::vector<std::int64_t> faces;
  for (Index t = 0; t < static_cast<Index>(surface.GetTriangles().rows()); ++t)
  {
    faces.push_back(surface.FaceOf(t));
  }
  return NewArray(std::move(faces));
}

/// InputError becomes an exception of Python with the words of its message.
void TranslateInputError(const std::exception_ptr& error, void* type)
{
  try
  {
    std::rethrow_exception(error);
  }
  catch (const InputError& found)
  {
    nb::object raised = nb::handle(static_cast<PyObject*>(type))(found.what());
    raised.attr("words") = ListWords(found.Message());
    PyErr_SetObject(static_cast<PyObject*>(type), raised.ptr());
  }
}

} // namespace

NB_MODULE(_core, m)
{
  m.doc() = "Runs of the numerics on arrays.";
  m.attr("build") = SURFACEDIFFUSION_BUILD;
  // ParaView ends Python before it deletes the filters of its plugin, which have runs.
  nb::set_leak_warnings(false);

  nb::object inputError = nb::steal(PyErr_NewExceptionWithDoc("surfacediffusion._core.InputError",
    "An error of the input. words: the words of its message, as in Run/Sentence.h: tuples of a "
    "kind, the spelling in VTK, the name of a setting or array, and a value.",
    PyExc_ValueError, nullptr));
  m.attr("InputError") = inputError;
  nb::register_exception_translator(TranslateInputError, inputError.release().ptr());

  m.def("python_name", &PythonName, "name"_a);
  m.def(
    "list_settings", [](const std::string& model) { return ListSettings(*MakeSettings(model)); },
    "model"_a);
  m.def("list_found", &ListFound, "model"_a);
  m.def(
    "find_problems",
    [](const std::string& model, const nb::dict& settings, const PythonFields* fields)
    {
      const FieldSummary summary = fields ? fields->Summarize() : FieldSummary();
      return FindProblems(model, settings, fields ? &summary : nullptr);
    },
    "model"_a, "settings"_a, "fields"_a.none());
  m.def("find_times", &FindTimes, "model"_a, "settings"_a, "last"_a = -1);
  m.def("find_time_step", &FindTimeStep, "model"_a, "settings"_a);
  m.def("has_independent_columns", &HasIndependentColumns, "model"_a, "settings"_a);
  m.def("find_step", &FindStep, "model"_a, "settings"_a, "time"_a, "last"_a);
  m.def("number_of_threads", [] { return PythonThreads::Instance().NumberOfThreads(); });
  m.def(
    "set_number_of_threads",
    [](int number)
    {
      const nb::gil_scoped_release released;
      PythonThreads::Instance().SetNumberOfThreads(number);
    },
    "number"_a);
  m.def("after_fork", [] { PythonThreads::Instance().AfterFork(); });

  nb::class_<InputSurface>(m, "Surface")
    .def(nb::init<const DoubleArray&, const LongArray&, const LongArray&>(), "points"_a,
      "connectivity"_a, "offsets"_a)
    .def(nb::init<const DoubleArray&, const LongArray&, const LongArray&, std::size_t,
           const std::optional<FlagArray>&>(),
      "points"_a, "triangles"_a, "faces"_a, "number_of_faces"_a, "hidden"_a.none())
    .def("set_area_factors", &InputSurface::SetAreaFactors, "factors"_a)
    .def("triangles", &GetTriangles)
    .def("faces", &GetFaces);

  nb::class_<PythonFields>(m, "Fields")
    .def(nb::init<std::shared_ptr<const InputSurface>, int, bool, std::string>(), "surface"_a,
      "components"_a, "data_are_terms"_a, "block"_a = "")
    .def("set", &PythonFields::Set, "kind"_a, "array"_a, "on_faces"_a = false, "name"_a = "")
    .def("set_samples", &PythonFields::SetSamples, "places"_a, "values"_a, "weights"_a.none(),
      "name"_a = "")
    .def("set_sources", &PythonFields::SetSources, "places"_a.none(), "segments"_a.none(),
      "hidden"_a.none(), "rows"_a.none() = nb::none(), "starts"_a.none() = nb::none())
    .def("set_path_points", &PythonFields::SetPathPoints, "places"_a, "hidden"_a)
    .def("columns", &PythonFields::Columns, "first"_a, "count"_a);

  nb::class_<ModelRun>(m, "ModelRun")
    .def(nb::init<std::string>(), "model"_a)
    .def("update", &ModelRun::Update, "blocks"_a, "settings"_a, "progress"_a.none(),
      "history"_a = true)
    .def("seek", &ModelRun::Seek, "step"_a, "progress"_a.none())
    .def("find_last_step", &ModelRun::FindLastStep, "progress"_a.none())
    .def("numbers", &ModelRun::GetNumbers)
    .def("clear", &ModelRun::Clear)
    .def("number_of_steps", &ModelRun::NumberOfSteps)
    .def("warnings", &ModelRun::GetWarnings)
    .def("new_warnings", &ModelRun::GetNewWarnings)
    .def("forget_warnings", &ModelRun::ForgetWarnings)
    .def("history", &ModelRun::GetHistory)
    .def("results", &ModelRun::GetResults, "block"_a)
    .def("outputs", &ModelRun::ListOutputs, "block"_a)
    .def("write", &ModelRun::Write, "block"_a, "number"_a, "output"_a, "source"_a, "first"_a = -1,
      "integers"_a = false);

  nb::class_<SurfaceOperators>(m, "Operators")
    .def(nb::init<std::shared_ptr<const InputSurface>, const std::optional<FlagArray>&, bool, bool,
           bool, const nb::object&>(),
      "surface"_a, "mask"_a.none(), "mask_on_faces"_a, "intrinsic_delaunay"_a, "join_short_edges"_a,
      "progress"_a.none())
    .def("masses", &SurfaceOperators::Masses)
    .def("stiffness", &SurfaceOperators::Stiffness, "diffusivity"_a.none())
    .def("gradient", &SurfaceOperators::Gradient)
    .def("modes", &SurfaceOperators::Modes, "diffusivity"_a.none(), "count"_a, "progress"_a.none())
    .def("number_of_vertices", &SurfaceOperators::NumberOfVertices)
    .def("seams", &SeamsOf<SurfaceOperators>);

  nb::class_<SurfaceFields>(m, "SurfaceFields")
    .def(nb::init<std::shared_ptr<const InputSurface>, const std::optional<FlagArray>&, bool, bool,
           double, const nb::object&>(),
      "surface"_a, "mask"_a.none(), "mask_on_faces"_a, "merges"_a, "tolerance"_a,
      "progress"_a.none())
    .def("prepare", &SurfaceFields::Prepare, "width"_a, "nu"_a, "unit_variance"_a,
      "progress"_a.none(), "shares"_a = false, "ranges"_a = nb::none())
    .def("end_sharing", &SurfaceFields::EndSharing)
    .def("draw", &SurfaceFields::Draw, "seed"_a, "first"_a, "fields"_a, "progress"_a.none())
    .def("apply_transposed", &SurfaceFields::ApplyTransposed, "weights"_a, "progress"_a.none())
    .def("filter_scales", &SurfaceFields::FilterScales, "values"_a, "wavelengths"_a, "order"_a,
      "progress"_a.none())
    .def("filter_scales_of_faces", &SurfaceFields::FilterScalesOfFaces, "values"_a, "wavelengths"_a,
      "order"_a, "progress"_a.none())
    .def("areas", &SurfaceFields::Areas)
    .def("face_areas", &SurfaceFields::FaceAreas)
    .def("number_of_vertices", &SurfaceFields::NumberOfVertices)
    .def("seams", &SeamsOf<SurfaceFields>)
    .def("length_unit", &SurfaceFields::LengthUnit)
    .def("mean_edge_length", &SurfaceFields::MeanEdgeLength);

  nb::class_<NoiseWidth>(m, "NoiseWidth")
    .def(
      "__init__",
      [](NoiseWidth* self, const SurfaceFields& surface, bool subtractsMean)
      { new (self) NoiseWidth(surface.Mesh(), subtractsMean); },
      "surface"_a, "subtracts_mean"_a, nb::keep_alive<1, 2>())
    .def(
      "add",
      [](NoiseWidth& self, const SurfaceFields& surface, const ColumnArray& values)
      { surface.AddTo(self, values); },
      "surface"_a, "values"_a)
    .def("of_columns", &NoiseWidth::OfColumns)
    .def("of_all", &NoiseWidth::OfAll)
    .def("largest_of_columns", &NoiseWidth::LargestOfColumns);
  nb::class_<WidthCorrection>(m, "WidthCorrection")
    .def(nb::init<double, double, double>(), "wanted"_a, "found"_a, "area"_a)
    .def("width", &WidthCorrection::Width)
    .def("take", &WidthCorrection::Take, "reached"_a)
    .def("largest_reached", &WidthCorrection::LargestReached);

  nb::class_<PythonRuns>(m, "SurfaceRuns")
    .def(nb::init<std::string>(), "function"_a)
    .def("update", &PythonRuns::Update, "surfaces"_a, "settings"_a, "progress"_a.none())
    .def("clear", &PythonRuns::Clear)
    .def("warnings", &PythonRuns::GetWarnings)
    .def("new_warnings", &PythonRuns::GetNewWarnings)
    .def("numbers", &PythonRuns::GetNumbers)
    .def("outputs", &PythonRuns::ListOutputs, "surface"_a)
    .def("write", &PythonRuns::Write, "surface"_a, "number"_a, "output"_a, "source"_a)
    .def("find_each", &PythonRuns::FindEach, "surface"_a, "settings"_a, "points"_a.none(),
      "cutoff"_a, "progress"_a.none())
    .def("find_path", &PythonRuns::FindPath, "surface"_a, "settings"_a, "names"_a, "points"_a,
      "triangles"_a, "coordinates"_a, "closed"_a, "progress"_a.none())
    .def("find_disk", &PythonRuns::FindDisk, "surface"_a, "settings"_a, "names"_a, "points"_a,
      "triangles"_a, "coordinates"_a, "radius"_a, "progress"_a.none())
    .def("turned_triangles", &PythonRuns::TurnedTriangles, "surface"_a)
    .def("walls", &PythonRuns::Walls, "surface"_a);
  BindShapeFunctions(m);
  BindPieceFunctions(m);
  BindResamplingFunctions(m);
}
