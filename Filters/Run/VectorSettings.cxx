// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/VectorSettings.h"

#include "Core/Models/Harmonic/UnitVectors.h"
#include "Core/Operators/CellTransfer.h"
#include "Run/ModelInputs.h"

#include <Eigen/Eigenvalues>

#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

constexpr double LargestSine = 0.0871557; ///< of 5 degrees

/// Whether the rows are the coordinates, but for an offset and round-off.
bool AreCoordinates(const Surface& surface, const Values& values)
{
  const Points& points = surface.Points();
  if (values.rows() != points.rows())
  {
    return false;
  }
  const Eigen::RowVector3d offset = values.row(0) - points.row(0);
  const double size = (points.rowwise() - points.row(0)).cwiseAbs().maxCoeff();
  return ((values - points).rowwise() - offset).cwiseAbs().maxCoeff() <= 1e-6 * size;
}

void Count(
  const Eigen::RowVector3d& value, const Eigen::Vector3d& normal, double area, TangentShare& share)
{
  const double length = value.norm();
  if (length > 0.0 && std::isfinite(length))
  {
    share.Known += area;
    const double alongNormal = std::abs(value.dot(normal)) / length;
    share.Tangent += alongNormal <= LargestSine ? area : 0.0;
    share.Normal += alongNormal >= std::sqrt(1.0 - LargestSine * LargestSine) ? area : 0.0;
  }
}

TangentShare SumOver(const Reduction& processes, const TangentShare& share)
{
  std::array<double, 3> sums{ share.Known, share.Tangent, share.Normal };
  processes.Sum(sums.data(), 3);
  return { sums[0], sums[1], sums[2] };
}

} // namespace

void VectorSettings::Visit(SettingVisitor& visitor)
{
  visitor.Choice(
    { "VectorType", "",
      "How data of three components are taken. Tangent: as vectors in the tangent plane "
      "of the surface, such as wind, currents, wall shear stress, fibres; of 6, 9, ... "
      "components as several. They are moved along the surface from point to point, and "
      "stay in its plane. Components: each component as a scalar. Automatic: Tangent if "
      "there are three floating-point components, and the vectors lie within 5 degrees of "
      "the surface on nine tenths of it, which is said in a warning; otherwise "
      "Components." },
    this->Type, { "Automatic", "Components", "Tangent" });
  visitor.Choice(
    { "VectorLaplacian", "",
      "The Laplacian of tangent vectors. Connection: that of the parallel transport, for "
      "smoothing and denoising. Hodge: commutes with divergence and curl. Viscous: that of "
      "a viscous flow, which keeps rigid rotations.",
      "VectorType!=Components" },
    this->Laplacian, { "Connection", "Hodge", "Viscous" });
  visitor.Choice(
    { "NormalPart", "",
      "What becomes of the part of tangent vectors along the normal of the surface. Drop: it "
      "is left out. Keep: it stays as it is. Diffuse: it is diffused as a scalar.",
      "VectorType!=Components" },
    this->NormalPart, { "Drop", "Keep", "Diffuse" });
}

void VectorSettings::CheckTogether(const FieldSummary* fields, const RunSettings& settings,
  bool isDirected, Problems& problems) const
{
  if (this->Type != VectorType::Tangent)
  {
    return;
  }
  const Sentence purpose = Sentence(Word::Setting("VectorType"))
    << " " << Word::Choice("VectorType", this->Type, "Tangent");
  if (fields && fields->Data && fields->DataComponents % 3 != 0)
  {
    problems.push_back(Sentence(fields->DataName)
      << " has " << fields->DataComponents << " components; allowed together with " << purpose
      << ": 3, or a multiple of 3");
  }
  Require(!settings.IntrinsicDelaunay, Word::Setting("IntrinsicDelaunay"), Word::SwitchNumber(true),
    Sentence(Word::SwitchNumber(false)) << " together with " << purpose, problems);
  Require(!isDirected || this->Laplacian == VectorLaplacian::Connection,
    Word::Setting("VectorLaplacian"), Word::Number("VectorLaplacian", this->Laplacian),
    Sentence(Word::NumberedChoice("VectorLaplacian", VectorLaplacian::Connection, "Connection"))
      << " together with other diffusivities than 1",
    problems);
}

TangentShare MeasureTangents(const Surface& surface, const Fields& fields,
  const Reduction& processes, const ParallelFor& parallel)
{
  TangentShare share;
  const TriangleMesh& mesh = surface.InputMesh();
  const Values& values = fields.Data.Values;
  if (values.cols() == 3 && values.rows() > 0 && !fields.DataAreBytes &&
    (fields.Data.OnCells || !AreCoordinates(surface, values)))
  {
    const TangentPlanes planes(surface.SharedInputMesh(), VertexPositions(surface), parallel);
    for (Index i = 0; i < mesh.NumberOfVertices() && !fields.Data.OnCells; ++i)
    {
      if (!IsSet(fields.Missing, mesh.InputVertex()[i]))
      {
        Count(values.row(mesh.InputVertex()[i]), planes.Normal(i), mesh.ControlAreas()[i], share);
      }
    }
    for (Index t = 0; t < mesh.NumberOfTriangles() && fields.Data.OnCells; ++t)
    {
      const Index triangle = surface.InputTriangle(mesh.InputTriangle()[t]);
      const Index cell = fields.Cells[static_cast<std::size_t>(triangle)];
      Count(values.row(cell), planes.TriangleNormal(t), mesh.Shapes()[t].Area(), share);
    }
  }
  return SumOver(processes, share);
}

TangentShare MeasureTangents(
  const TangentPlanes& planes, const PointData& data, const Reduction& processes)
{
  TangentShare share;
  for (Index i = 0; i < planes.Mesh().NumberOfVertices(); ++i)
  {
    if (!data.Missing[i])
    {
      Count(data.Given.row(i), planes.Normal(i), planes.Mesh().ControlAreas()[i], share);
    }
  }
  return SumOver(processes, share);
}

void WarnOfVectors(const Word& name, const TangentShare& share, bool areTangent, RunResult& result)
{
  Sentence text(name);
  if (areTangent)
  {
    result.WarnOnce(
      text << " has vectors that lie in the surface, which are moved along it and stay in it "
              "(to take each component as a scalar, set "
           << Word::Setting("VectorType") << " to "
           << Word::Choice("VectorType", VectorType::Components, "Components") << ")");
  }
  else if (share.AreTangent() || share.IsPartly())
  {
    result.WarnOnce(
      text << " has vectors that lie in the surface on "
           << std::round(100.0 * share.Tangent / share.Known)
           << " % of it, and their components are taken as scalars (if they are tangent "
              "vectors, set "
           << Word::Setting("VectorType") << " to "
           << Word::Choice("VectorType", VectorType::Tangent, "Tangent") << ")");
  }
}

void ProjectIntoCells(const Surface& surface, const CellTransfer& cells, bool areUnitVectors,
  Values& vectors, const ParallelFor& parallel)
{
  const Points positions = VertexPositions(surface);
  ForEach(parallel, cells.NumberOfCells(),
    [&](Index c)
    {
      if (!cells.Participates(c))
      {
        return;
      }
      Eigen::RowVector3d mean = Eigen::RowVector3d::Zero();
      double count = 0.0;
      cells.ForEachVertexOf(c,
        [&](Index i)
        {
          mean += positions.row(i);
          count += 1.0;
        });
      mean /= count;
      Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
      cells.ForEachVertexOf(c,
        [&](Index i)
        {
          const Eigen::RowVector3d offset = positions.row(i) - mean;
          spread += offset.transpose() * offset;
        });
      const Eigen::Vector3d normal =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(0);
      for (Eigen::Index k = 0; k + 3 <= vectors.cols(); k += 3)
      {
        auto vector = vectors.row(c).segment<3>(k);
        vector -= vector.dot(normal.transpose()) * normal.transpose();
        if (areUnitVectors)
        {
          Normalize(vector);
        }
      }
    });
}

} // namespace SurfaceDiffusion
