// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceFields.h"

#include "Core/Foundation/Columns.h"
#include "Core/Models/Fields/CellScaleFilter.h"
#include "Core/Models/Fields/ScaleFilter.h"
#include "Core/Operators/CotanWeights.h"
#include "NewArrays.h"
#include "PythonProgress.h"
#include "Threads.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace nb = nanobind;

namespace SurfaceDiffusion
{

SurfaceFields::SurfaceFields(std::shared_ptr<const InputSurface> surface,
  const std::optional<FlagArray>& mask, bool maskOnFaces, bool merges, double tolerance,
  const nb::object& progress)
  : Input(std::move(surface))
{
  SurfaceOptions options;
  options.MergeCoincidentPoints = merges;
  options.MergeTolerance = tolerance;
  PythonProgress(progress).Run(
    [&](const ProgressMonitor& monitor)
    {
      this->Built =
        std::make_unique<const Surface>(this->Input->Read({ ReadFlags(mask), maskOnFaces }),
          options, PythonThreads::Instance(), monitor);
    });
}

void SurfaceFields::Prepare(double width, double nu, bool unitVariance, const nb::object& progress,
  bool shares, const std::optional<FactorArray>& ranges)
{
  const UseGuard guard(this->InUse);
  const std::vector<double> given = ranges
    ? std::vector<double>(ranges->data(), ranges->data() + ranges->shape(0))
    : std::vector<double>();
  const std::tuple<double, double, bool, bool, std::vector<double>> wanted{ width, nu, unitVariance,
    shares, given };
  if (this->Field && this->Prepared == wanted)
  {
    return;
  }
  const TriangleMesh& mesh = this->Built->Mesh();
  RandomField::Settings settings;
  settings.Covariance = nu == 0.0 ? FieldCovariance::Gaussian : FieldCovariance::Matern;
  settings.Width = width / mesh.LengthUnit();
  settings.Range = settings.Width;
  if (ranges)
  {
    settings.Ranges = this->LengthsOfVertices(*ranges);
  }
  settings.Nu = nu;
  settings.HasUnitVariance = unitVariance;
  this->Field.reset();
  const std::tuple<double, double, bool> covariance{ width, nu, shares };
  const auto known = ranges ? this->Deviations.end() : this->Deviations.find(covariance);
  PythonProgress(progress).Run(
    [&](const ProgressMonitor& monitor)
    {
      this->Field = std::make_unique<RandomField>(this->Built->SharedAssembler(),
        CotanWeights(mesh, PythonThreads::Instance()), settings,
        MakeVertexIds(*this->Built, Fields()),
        unitVariance && known != this->Deviations.end() ? known->second : Vector(),
        PythonThreads::Instance(), monitor, shares ? &this->Poles : nullptr);
    });
  this->Prepared = wanted;
  constexpr std::size_t most = 16; // covariances, with a number per point each
  if (unitVariance && !ranges && known == this->Deviations.end() && this->Deviations.size() < most)
  {
    this->Deviations[covariance] = this->Field->Deviations();
  }
}

template <typename Run>
double SurfaceFields::InPanels(
  const ColumnArray& columns, const nb::object& progress, const Run& run)
{
  const UseGuard guard(this->InUse);
  double missed = 0.0;
  PythonProgress(progress).Run(
    [&](const ProgressMonitor& monitor)
    {
      const auto width = static_cast<Eigen::Index>(columns.shape(1));
      const auto all = static_cast<double>(width);
      for (Eigen::Index start = 0; start < width; start += ColumnPanel)
      {
        const Eigen::Index count = std::min<Eigen::Index>(ColumnPanel, width - start);
        const Values panel = run(start, count,
          monitor.Part(static_cast<double>(start) / all, static_cast<double>(start + count) / all));
        missed = std::max(missed, this->Field->MissedResidual());
        this->Write(panel, start, columns);
      }
    });
  return missed;
}

double SurfaceFields::Draw(
  std::int64_t seed, std::int64_t first, const ColumnArray& fields, const nb::object& progress)
{
  return this->InPanels(fields, progress,
    [&](Eigen::Index start, Eigen::Index count, const ProgressMonitor& part)
    {
      Values panel(this->NumberOfVertices(), count);
      this->Field->Draw(seed, first + start, panel, part);
      return panel;
    });
}

double SurfaceFields::ApplyTransposed(const ColumnArray& weights, const nb::object& progress)
{
  return this->InPanels(weights, progress,
    [&](Eigen::Index start, Eigen::Index count, const ProgressMonitor& part)
    {
      Values panel = this->Read(weights, start, count);
      this->Field->ApplyTransposed(panel, part);
      return panel;
    });
}

double SurfaceFields::FilterScales(const ColumnArray& values, const FactorArray& wavelengths,
  int order, const nb::object& progress) const
{
  double missed = 0.0;
  PythonProgress(progress).Run(
    [&](const ProgressMonitor& monitor)
    {
      ScaleFilter filter(this->Built->SharedAssembler(), this->LengthsOfVertices(wavelengths),
        order, PythonThreads::Instance());
      const auto columns = static_cast<Eigen::Index>(values.shape(1));
      const auto all = static_cast<double>(columns);
      for (Eigen::Index start = 0; start < columns; start += ColumnPanel)
      {
        const Eigen::Index count = std::min<Eigen::Index>(ColumnPanel, columns - start);
        Values panel = this->Read(values, start, count);
        filter.Apply(panel,
          monitor.Part(static_cast<double>(start) / all, static_cast<double>(start + count) / all));
        this->Write(panel, start, values);
      }
      missed = filter.MissedResidual();
    });
  return missed;
}

double SurfaceFields::FilterScalesOfFaces(const ColumnArray& values, const FactorArray& wavelengths,
  int order, const nb::object& progress) const
{
  double missed = 0.0;
  PythonProgress(progress).Run(
    [&](const ProgressMonitor& monitor)
    {
      const auto faces = static_cast<Index>(values.shape(0));
      CellScaleFilter filter(this->Built->SharedAssembler(), this->Built->Points(),
        this->FacesOfTriangles(), faces, this->LengthsOfVertices(wavelengths), order,
        PythonThreads::Instance());
      Eigen::Map<Values> columns(values.data(), faces, static_cast<Eigen::Index>(values.shape(1)));
      Values filtered = columns;
      filter.Apply(filtered, monitor);
      columns = filtered;
      for (Index face = 0; face < faces; ++face)
      {
        if (!(filter.CellAreas()[face] > 0.0))
        {
          columns.row(face).setConstant(std::numeric_limits<double>::quiet_NaN());
        }
      }
      missed = filter.MissedResidual();
    });
  return missed;
}

nb::object SurfaceFields::FaceAreas() const
{
  const auto faces = static_cast<Index>(this->Input->NumberOfFaces());
  const CellTransfer transfer(
    this->Built->Mesh(), this->FacesOfTriangles(), faces, PythonThreads::Instance());
  const Vector& areas = transfer.CellAreas();
  return NewArray(std::vector<double>(areas.data(), areas.data() + areas.size()));
}

Vector SurfaceFields::LengthsOfVertices(const FactorArray& lengths) const
{
  const TriangleMesh& mesh = this->Built->Mesh();
  Vector ofVertices(mesh.NumberOfVertices());
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    ofVertices[i] = lengths.data()[mesh.InputVertex()[i]] / mesh.LengthUnit();
  }
  return ofVertices;
}

std::vector<Index> SurfaceFields::FacesOfTriangles() const
{
  std::vector<Index> faces(static_cast<std::size_t>(this->Built->NumberOfTriangles()));
  for (std::size_t row = 0; row < faces.size(); ++row)
  {
    faces[row] =
      static_cast<Index>(this->Input->FaceOf(this->Built->InputTriangle(static_cast<Index>(row))));
  }
  return faces;
}

void SurfaceFields::AddTo(NoiseWidth& widths, const ColumnArray& values) const
{
  const nb::gil_scoped_release release;
  widths.Add(this->Read(values, 0, static_cast<Eigen::Index>(values.shape(1))));
}

nb::object SurfaceFields::Areas() const
{
  const TriangleMesh& mesh = this->Built->Mesh();
  std::vector<double> areas(static_cast<std::size_t>(this->Built->Points().rows()), 0.0);
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    areas[static_cast<std::size_t>(mesh.InputVertex()[i])] = mesh.ControlAreas()[i];
  }
  return NewArray(std::move(areas));
}

double SurfaceFields::MeanEdgeLength() const
{
  const TriangleMesh& mesh = this->Built->InputMesh();
  double drawn = 0.0;
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    drawn += mesh.Shapes()[t].Area();
  }
  const double edges = mesh.NumberOfEdges();
  return edges > 0.0 ? mesh.TotalEdgeLength() * mesh.LengthUnit() / edges *
      std::sqrt(mesh.ControlAreas().sum() / drawn)
                     : 1.0;
}

Values SurfaceFields::Read(const ColumnArray& columns, Eigen::Index first, Eigen::Index count) const
{
  const TriangleMesh& mesh = this->Built->Mesh();
  const auto width = static_cast<std::ptrdiff_t>(columns.shape(1));
  Values ofVertices(mesh.NumberOfVertices(), count);
  ForEach(PythonThreads::Instance(), mesh.NumberOfVertices(),
    [&](Index i)
    {
      const double* const row = columns.data() + mesh.InputVertex()[i] * width + first;
      std::copy_n(row, count, &ofVertices(i, 0));
    });
  return ofVertices;
}

void SurfaceFields::Write(
  const Values& ofVertices, Eigen::Index first, const ColumnArray& columns) const
{
  const auto width = static_cast<std::ptrdiff_t>(columns.shape(1));
  ForEach(PythonThreads::Instance(), static_cast<Index>(columns.shape(0)),
    [&](Index point)
    {
      double* const row = columns.data() + point * width + first;
      const Index vertex = this->Built->VertexOf(point);
      if (vertex >= 0)
      {
        std::copy_n(&ofVertices(vertex, 0), ofVertices.cols(), row);
      }
      else
      {
        std::fill_n(row, ofVertices.cols(), std::numeric_limits<double>::quiet_NaN());
      }
    });
}

} // namespace SurfaceDiffusion
