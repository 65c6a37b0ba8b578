// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceOperators.h"

#include "Core/Operators/GradientMap.h"
#include "Core/Solvers/Eigenmodes.h"
#include "Core/Surface/TangentVectors.h"
#include "NewArrays.h"
#include "PythonProgress.h"
#include "Threads.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace nb = nanobind;

namespace SurfaceDiffusion
{

namespace
{

/// Rows of a sparse matrix, which are appended one after another.
struct CompressedRows
{
  std::vector<double> Data;
  std::vector<Index> Columns;
  std::vector<Index> Begin = { 0 };

  /// Append a row of (column, entry), and sort it.
  template <typename Entries>
  void Append(Entries& entries)
  {
    std::sort(entries.begin(), entries.end());
    for (const auto& [column, entry] : entries)
    {
      this->Columns.push_back(column);
      this->Data.push_back(entry);
    }
    this->Begin.push_back(static_cast<Index>(this->Columns.size()));
  }

  nb::tuple Give()
  {
    return nb::make_tuple(NewArray(std::move(this->Data)), NewArray(std::move(this->Columns)),
      NewArray(std::move(this->Begin)));
  }
};

} // namespace

SurfaceOperators::SurfaceOperators(std::shared_ptr<const InputSurface> surface,
  const std::optional<FlagArray>& mask, bool maskOnFaces, bool intrinsicDelaunay,
  bool joinShortEdges, const nb::object& progress)
  : Input(std::move(surface))
{
  SurfaceOptions options;
  options.IntrinsicDelaunay = intrinsicDelaunay;
  options.Boundaries = BoundaryEdges::Keep; // linear functions have their energy, also beside it
  options.JoinShortEdges = joinShortEdges;
  PythonProgress(progress).Run(
    [&](const ProgressMonitor& monitor)
    {
      this->Built = std::make_unique<const SurfaceDiffusion::Surface>(
        this->Input->Read({ ReadFlags(mask), maskOnFaces }), options, PythonThreads::Instance(),
        monitor);
    });
}

nb::object SurfaceOperators::Masses() const
{
  const TriangleMesh& mesh = this->Built->Mesh();
  std::vector<double> masses(this->Input->NumberOfPoints(), 0.0);
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    masses[static_cast<std::size_t>(mesh.InputVertex()[i])] =
      mesh.ControlAreas()[i] * mesh.LengthUnit() * mesh.LengthUnit();
  }
  return NewArray(std::move(masses));
}

/// c_ij = -area grad(phi_i) . D grad(phi_j) with the part of D in the plane of each triangle.
CornerWeights SurfaceOperators::Coefficients(const std::optional<DoubleArray>& diffusivity) const
{
  const TriangleMesh& mesh = this->Built->Mesh();
  if (!diffusivity)
  {
    return CotanWeights(mesh, PythonThreads::Instance());
  }
  const Triangles triangles = this->Built->MakeTriangles();
  CornerWeights weights(mesh.NumberOfTriangles(), 3);
  ForEach(PythonThreads::Instance(), mesh.NumberOfTriangles(),
    [&](Index t)
    {
      using Tensor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
      const Index row = this->Built->InputTriangle(mesh.InputTriangle()[t]);
      const Eigen::Map<const Tensor> inSpace(diffusivity->data() + 9 * this->Input->FaceOf(row));
      const Eigen::Matrix<double, 3, 2> axes =
        TriangleAxes(mesh, this->Built->Points(), triangles, t);
      const Eigen::Matrix2d d = axes.transpose() * inSpace * axes;
      weights.row(t) =
        TensorWeights(mesh.Shapes()[t], { d(0, 0), 0.5 * (d(0, 1) + d(1, 0)), d(1, 1) });
    });
  return weights;
}

nb::tuple SurfaceOperators::Stiffness(const std::optional<DoubleArray>& diffusivity) const
{
  CompressedRows rows;
  PythonProgress(nb::none())
    .Run(
      [&](const ProgressMonitor&)
      {
        const TriangleMesh& mesh = this->Built->Mesh();
        const auto assembler = this->Built->SharedAssembler();
        SparseMatrix matrix = ZeroMatrix(assembler->Pattern());
        assembler->Fill(matrix, Vector::Zero(mesh.NumberOfVertices()), 1.0,
          this->Coefficients(diffusivity), nullptr, PythonThreads::Instance());
        std::vector<std::pair<Index, double>> row;
        for (Index point = 0; point < static_cast<Index>(this->Input->NumberOfPoints()); ++point)
        {
          row.clear();
          const Index vertex = this->Built->VertexOf(point);
          for (SparseMatrix::InnerIterator entry(matrix, std::max(0, vertex)); vertex >= 0 && entry;
               ++entry)
          {
            row.emplace_back(mesh.InputVertex()[entry.index()], entry.value());
          }
          rows.Append(row);
        }
      });
  return rows.Give();
}

nb::tuple SurfaceOperators::Gradient() const
{
  CompressedRows rows;
  PythonProgress(nb::none())
    .Run(
      [&](const ProgressMonitor&)
      {
        const auto mesh = this->Built->SharedMesh();
        const Triangles triangles = this->Built->MakeTriangles();
        const GradientMaps maps(mesh);
        std::vector<Index> used(static_cast<std::size_t>(this->Input->GetTriangles().rows()), -1);
        for (Index t = 0; t < mesh->NumberOfTriangles(); ++t)
        {
          const Index row = this->Built->InputTriangle(mesh->InputTriangle()[t]);
          used[static_cast<std::size_t>(row)] = t;
        }
        std::array<std::pair<Index, double>, 3> row;
        std::array<std::pair<Index, double>, 0> none;
        for (const Index t : used)
        {
          if (t < 0)
          {
            rows.Append(none);
            rows.Append(none);
            rows.Append(none);
            continue;
          }
          const Eigen::Matrix<double, 3, 2> axes =
            TriangleAxes(*mesh, this->Built->Points(), triangles, t);
          const GradientMap map = maps[t];
          Eigen::Matrix3d columns;
          for (int a = 0; a < 3; ++a)
          {
            columns.col(a) = axes * map.OfCorner(a) / mesh->LengthUnit();
          }
          for (int axis = 0; axis < 3; ++axis)
          {
            for (int a = 0; a < 3; ++a)
            {
              row[a] = { mesh->InputVertex()[mesh->TriangleVertices()(t, a)], columns(axis, a) };
            }
            rows.Append(row);
          }
        }
      });
  return rows.Give();
}

nb::tuple SurfaceOperators::Modes(
  const std::optional<DoubleArray>& diffusivity, Index count, const nb::object& progress) const
{
  const TriangleMesh& mesh = this->Built->Mesh();
  const double unit = mesh.LengthUnit();
  std::vector<double> eigenvalues;
  const std::size_t n = this->Input->NumberOfPoints();
  std::vector<double> modes(n * static_cast<std::size_t>(count), 0.0);
  PythonProgress(progress).Run(
    [&](const ProgressMonitor& monitor)
    {
      const Eigenmodes found = FindEigenmodes(*this->Built->SharedAssembler(),
        this->Coefficients(diffusivity), count, PythonThreads::Instance(), monitor);
      const Vector values = found.Eigenvalues / unit / unit;
      eigenvalues.assign(values.begin(), values.end());
      ForEach(PythonThreads::Instance(), static_cast<Index>(n),
        [&](Index point)
        {
          const Index i = this->Built->VertexOf(point);
          for (Index k = 0; i >= 0 && k < count; ++k)
          {
            const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(point) * count;
            modes[static_cast<std::size_t>(row + k)] = found.Modes(i, k) / unit;
          }
        });
    });
  return nb::make_tuple(NewArray(std::move(eigenvalues)),
    NewArray(std::move(modes), { n, static_cast<std::size_t>(count) }));
}

} // namespace SurfaceDiffusion
