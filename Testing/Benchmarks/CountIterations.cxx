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

/// In double precision, with the preconditioner of the system.
template <typename System>
int Count(const System& system, const MatrixDiagonal& diagonal, const Values& b, Values x)
{
  ScaledResidual residual(diagonal, SerialFor(), Reduction::Serial());
  residual.Start<1>(system.Matrix, b, x);
  return ConjugateGradients<1, System>(system, residual.Entries, residual.Work, SerialFor())
    .Solve(x, Limits, ProgressMonitor())
    .Iterations;
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
      MatrixDiagonal diagonal(SerialFor(), Reduction::Serial());
      diagonal.Invert(system.Matrix);
      StrongLines lines(SerialFor());
      lines.Set(system.Matrix, diagonal.Inverse());
      const Values noise = Noise(*system.Mesh);
      const Values b = system.RightHandSide(noise);
      std::printf("{\"surface\": \"%s\", \"vertices\": %d, \"c\": %g, \"on_lines\": %.2f, "
                  "\"diagonal\": %d, \"lines\": %d}\n",
        surface.first.c_str(), system.Mesh->NumberOfVertices(), number,
        static_cast<double>(lines.Vertices().size()) / static_cast<double>(b.rows()),
        Count(MatrixSystem(system.Matrix, diagonal.Inverse()), diagonal, b, noise),
        Count(
          LineSystem(system.Matrix, diagonal.Inverse(), lines, SerialFor()), diagonal, b, noise));
    }
  }
  return 0;
}
