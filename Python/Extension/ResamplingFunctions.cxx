// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ShapeFunctions.h"

#include "Core/Geometry/Resampling.h"
#include "Core/Geometry/ResamplingWeights.h"
#include "InputData.h"
#include "NewArrays.h"
#include "PythonProgress.h"
#include "Threads.h"

#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>

#include <optional>
#include <type_traits>
#include <vector>

namespace nb = nanobind;
using namespace nanobind::literals;

namespace SurfaceDiffusion
{

namespace
{

using IndexArray = nb::ndarray<const Index, nb::ndim<1>, nb::device::cpu, nb::c_contig>;
template <typename T>
using Columns = nb::ndarray<T, nb::ndim<2>, nb::device::cpu, nb::c_contig>;

AreaSphere ReadSphere(const InputSurface& surface, const FactorArray& areas)
{
  return { surface.Read({}).Points, surface.GetTriangles(),
    Eigen::Map<const Vector>(areas.data(), static_cast<Eigen::Index>(areas.size())) };
}

template <typename T>
nb::object Copy(const T* numbers, Eigen::Index count)
{
  return NewArray(std::vector<T>(numbers, numbers + count));
}

/// The csr arrays of the weights: data, indices and indptr.
nb::tuple FindWeights(bool isAdaptive, const InputSurface& source, const FactorArray& sourceAreas,
  const InputSurface& target, const FactorArray& targetAreas, const std::optional<FlagArray>& mask,
  const nb::object& progress)
{
  RowMatrix weights;
  const std::vector<char> flags = ReadFlags(mask);
  PythonProgress(progress).Run(
    [&](const ProgressMonitor& monitor)
    {
      const Eigen::Map<const Eigen::Array<char, Eigen::Dynamic, 1>> isLeftOut(
        flags.data(), static_cast<Eigen::Index>(flags.size()));
      weights = ResamplingWeights(
        isAdaptive ? ResamplingMethod::AdaptiveBarycentricArea : ResamplingMethod::Barycentric,
        ReadSphere(source, sourceAreas), ReadSphere(target, targetAreas), isLeftOut != 0,
        PythonThreads::Instance(), monitor);
    });
  return nb::make_tuple(Copy(weights.valuePtr(), weights.nonZeros()),
    Copy(weights.innerIndexPtr(), weights.nonZeros()),
    Copy(weights.outerIndexPtr(), weights.rows() + 1));
}

/// The values (n, k) of the source at the target's vertices (p, k). weights: csr arrays.
template <typename T>
void Apply(const FactorArray& data, const IndexArray& indices, const IndexArray& begin,
  const Columns<const T>& values, const Columns<T>& found, bool areLabels)
{
  const nb::gil_scoped_release released;
  const RowWeights weights(static_cast<Eigen::Index>(found.shape(0)),
    static_cast<Eigen::Index>(values.shape(0)), static_cast<Eigen::Index>(data.size()),
    begin.data(), indices.data(), data.data());
  const auto columns = static_cast<Eigen::Index>(values.shape(1));
  const ColumnView<const T> source{ values.data(), columns, columns };
  const ColumnView<T> target{ found.data(), columns, columns };
  if constexpr (std::is_same_v<T, double>)
  {
    if (areLabels)
    {
      ResampleLabels(weights, source, target, PythonThreads::Instance());
      return;
    }
  }
  ResampleMeans(weights, source, target, PythonThreads::Instance());
}

} // namespace

void BindResamplingFunctions(nb::module_& m)
{
  m.def("resampling_weights", &FindWeights, "is_adaptive"_a, "source"_a, "source_areas"_a,
    "target"_a, "target_areas"_a, "mask"_a.none(), "progress"_a.none());
  m.def("resample", &Apply<double>, "data"_a, "indices"_a, "begin"_a, "values"_a, "found"_a,
    "are_labels"_a);
  m.def("resample", &Apply<float>, "data"_a, "indices"_a, "begin"_a, "values"_a, "found"_a,
    "are_labels"_a);
}

} // namespace SurfaceDiffusion
