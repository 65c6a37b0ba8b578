// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// CountIterations prints how many iterations conjugate gradients take on surfaces with narrow
// triangles and without, with the diagonal alone and with the lines of StrongLines, for a step of
// c h^2 from noise to a residual of 1e-6: a line of JSON per surface and c.

#include "HeatSystem.h"
#include "NeedleMeshes.h"

#include "Core/Solvers/ConjugateGradients.h"
#include "Core/Solvers/ScaledResidual.h"

#include <cstdio>
#include <string>
#include <utility>
#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

constexpr IterationLimits Limits{ 1e-6, 100000 };

int CountWithDiagonal(const SparseMatrix& matrix, const Values& b, Values x)
{
  MatrixDiagonal diagonal(SerialFor(), Reduction::Serial());
  diagonal.Invert(matrix);
  ScaledResidual residual(diagonal, SerialFor(), Reduction::Serial());
  residual.Start<1>(matrix, b, x);
  const MatrixSystem system(matrix, diagonal.Inverse());
  return ConjugateGradients<1, MatrixSystem>(system, residual.Entries, residual.Work, SerialFor())
    .Solve(x, Limits, ProgressMonitor())
    .Iterations;
}

int CountWithLines(const SparseMatrix& matrix, const Values& b, Values x)
{
  const auto solver = MakeConjugateGradientSolver();
  solver->SetLimits(Limits);
  solver->SetMatrix(matrix);
  return solver->Solve(b, x).Iterations;
}

double ShareOnLines(const SparseMatrix& matrix)
{
  const Vector inverse = matrix.diagonal().cwiseInverse();
  StrongLines lines(SerialFor());
  lines.Set(matrix, inverse);
  return static_cast<double>(lines.Vertices().size()) / static_cast<double>(matrix.rows());
}

} // namespace

int main()
{
  std::vector<std::pair<std::string, Surface>> surfaces;
  surfaces.emplace_back("icosphere", Icosphere(6));
  surfaces.emplace_back("sphere of meridians", LatitudeLongitudeSphere(300, 300));
  surfaces.emplace_back("cylinder with fans", CylinderWithFans(600, 60));
  surfaces.emplace_back("contour of a grid", ContourOfGrid(60));
  surfaces.emplace_back("torus with a seam of round-off", TorusWithSeam(200));
  if (HaveMeshFiles())
  {
    surfaces.emplace_back("refined elephant", ReadMeshFile("refined_elephant"));
    surfaces.emplace_back("camel", ReadMeshFile("camel"));
    surfaces.emplace_back("blade, a CAD part", ReadMeshFile("blade"));
  }
  for (const auto& surface : surfaces)
  {
    HeatSystem system(surface.second);
    for (const double number : { 1.0, 30.0, 300.0 })
    {
      system.SetDiffusionNumber(number);
      const Values noise = Noise(*system.Mesh);
      const Values b = system.RightHandSide(noise);
      std::printf("{\"surface\": \"%s\", \"vertices\": %d, \"c\": %g, \"on_lines\": %.2f, "
                  "\"diagonal\": %d, \"lines\": %d}\n",
        surface.first.c_str(), system.Mesh->NumberOfVertices(), number, ShareOnLines(system.Matrix),
        CountWithDiagonal(system.Matrix, b, noise), CountWithLines(system.Matrix, b, noise));
    }
  }
  return 0;
}
