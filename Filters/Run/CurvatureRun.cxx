// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/CurvatureRun.h"

namespace SurfaceDiffusion
{

void CurvatureSettings::Visit(SettingVisitor& visitor)
{
  visitor.Number({ "FWHM", "coordinates",
                   "The scale: full width at half maximum of the Gaussian on the surface that "
                   "weighs the normals, in the unit of the coordinates. 0: that of the mesh, "
                   "vertices of at most two edges from each other." },
    this->FWHM, SettingRange::NonNegative());
  VisitMerging(visitor, this->MergeCoincidentPoints, this->MergeTolerance);
}

void CurvatureRun::Update(const BlockInput& input, Settings& given, const ProgressMonitor& progress)
{
  auto& settings = static_cast<CurvatureSettings&>(given);
  SurfaceOptions options;
  options.MergeCoincidentPoints = settings.MergeCoincidentPoints;
  options.MergeTolerance = settings.MergeTolerance;
  options.IntrinsicDelaunay = true; // its weights are not negative
  if (!this->Prepare(WithoutGivenAreas(input), settings, options, progress.Part(0.0, 0.2)))
  {
    return;
  }
  const Surface& surface = *this->Domain;
  const TriangleMesh& mesh = surface.InputMesh();
  const double unit = mesh.LengthUnit();
  this->Found = EstimateCurvature(mesh, VertexPositions(surface), settings.FWHM / unit,
    surface.SharedAssembler().get(), this->Parallel, progress.Part(0.2, 1.0));
  const Index n = mesh.NumberOfVertices();
  Values shapeIndex(n, 1);
  Values curvedness(n, 1);
  for (Index i = 0; i < n; ++i)
  {
    shapeIndex(i, 0) = this->Found.ShapeIndex(i);
    curvedness(i, 0) = this->Found.Curvedness(i) / unit;
  }
  this->Results.clear();
  const auto add = [this](const char* name, Values rows, Role role) {
    this->Results.push_back({ name, Place::PerVertex, OutputType::Double, std::move(rows), role });
  };
  add("MeanCurvature", this->Found.Mean / unit, Role::Scalars);
  add("GaussianCurvature", this->Found.Gaussian / unit / unit, Role::None);
  add("PrincipalCurvatures", this->Found.Principal / unit, Role::None);
  add("ShapeIndex", std::move(shapeIndex), Role::None);
  add("Curvedness", std::move(curvedness), Role::None);
  this->Complete(input, settings);
}

std::vector<Warning> CurvatureRun::FindOwnWarnings() const
{
  std::vector<Warning> warnings;
  AppendTurnedTriangles(this->Found.TurnedTriangles, warnings);
  AppendMissedResidual(this->Found.MissedResidual, warnings);
  return warnings;
}

} // namespace SurfaceDiffusion
