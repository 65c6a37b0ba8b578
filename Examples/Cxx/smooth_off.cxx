// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Smooths values on a surface without VTK, by SurfaceDiffusion::Core alone: the heat equation
// u_t = Laplace-Beltrami u on the triangles of an OFF file, up to the time t at which a point
// source on a plane has the full width at half maximum FWHM = 4 sqrt(t ln 2).
//
//   smooth_off SURFACE.off FWHM [VALUES] > SMOOTHED
//
// VALUES has one number for each vertex; without it the z coordinates are smoothed. The output has
// one number a line. The integral over the surface stays, and so do values of unused vertices.

#include "Core/Models/LinearDiffusion.h"
#include "Core/Operators/CotanWeights.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

using namespace SurfaceDiffusion;

namespace
{

/// An OFF file without comments. Polygons are cut into triangles that share their first vertex.
void ReadSurface(const std::string& path, Points& points, Triangles& triangles)
{
  std::ifstream file(path);
  std::string format;
  Index vertices = 0, polygons = 0, edges = 0;
  file >> format >> vertices >> polygons >> edges;
  points.resize(vertices, 3);
  for (Index i = 0; i < vertices; ++i)
  {
    file >> points(i, 0) >> points(i, 1) >> points(i, 2);
  }
  std::vector<std::array<Index, 3>> list;
  for (Index p = 0, count = 0; p < polygons && file >> count; ++p)
  {
    std::vector<Index> corners(count);
    for (Index& corner : corners)
    {
      file >> corner;
    }
    for (Index k = 2; k < count; ++k)
    {
      list.push_back({ corners[0], corners[k - 1], corners[k] });
    }
  }
  if (format != "OFF" || !file)
  {
    throw std::runtime_error(path + " is not an OFF file");
  }
  triangles.resize(list.size(), 3);
  for (std::size_t t = 0; t < list.size(); ++t)
  {
    triangles.row(t) << list[t][0], list[t][1], list[t][2];
  }
}

void Smooth(const Points& points, const Triangles& triangles, double fwhm, Values& u)
{
  const auto mesh = std::make_shared<TriangleMesh>(points, triangles);
  const auto assembler = std::make_shared<Assembler>(mesh);
  const int steps = 20;
  LinearDiffusion::Settings settings; // second order in time, lengths in mesh->LengthUnit()
  settings.TimeStep = std::pow(fwhm / mesh->LengthUnit(), 2) / (16.0 * std::log(2.0)) / steps;
  LinearDiffusion heat(assembler, CotanWeights(*mesh),
    PointData::FromValues(GatherVertices(*mesh, u)), settings, MakeCholeskySolver());
  for (int step = 0; step < steps; ++step)
  {
    heat.Advance(ProgressMonitor());
  }
  for (Index v = 0; v < mesh->NumberOfVertices(); ++v)
  {
    u.row(mesh->InputVertex()[v]) = heat.State().row(v);
  }
}

} // namespace

int main(int argc, char* argv[])
{
  const double fwhm = argc > 2 ? std::atof(argv[2]) : 0.0;
  if (argc > 4 || !(fwhm > 0.0))
  {
    std::fprintf(stderr, "usage: smooth_off SURFACE.off FWHM [VALUES] > SMOOTHED; FWHM above 0\n");
    return EXIT_FAILURE;
  }
  try
  {
    Points points;
    Triangles triangles;
    ReadSurface(argv[1], points, triangles);
    Values u = points.col(2);
    if (argc == 4)
    {
      std::ifstream values(argv[3]);
      for (Index i = 0; i < u.rows(); ++i)
      {
        values >> u(i, 0);
      }
      if (!values)
      {
        throw std::runtime_error(std::string(argv[3]) +
          " has fewer numbers than the surface has "
          "vertices");
      }
    }
    Smooth(points, triangles, fwhm, u);
    for (Index i = 0; i < u.rows(); ++i)
    {
      std::printf("%.17g\n", u(i, 0));
    }
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "smooth_off: %s\n", error.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
