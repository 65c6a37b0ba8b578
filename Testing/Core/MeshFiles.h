// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Meshes.h"

#include <array>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

/// Real meshes, from the folder that the build was told of.
namespace SurfaceDiffusion::Testing
{

/// False where the build was told of no folder: tests that need real meshes are skipped.
inline bool HaveMeshFiles()
{
  return std::string(SURFACEDIFFUSION_MESH_DIR) != "";
}

/// An OFF file; polygons as fans of triangles.
inline Surface ReadOff(const std::string& path)
{
  std::ifstream file(path);
  std::stringstream text; // without comments
  for (std::string line; std::getline(file, line);)
  {
    text << line.substr(0, line.find('#')) << '\n';
  }
  std::string format;
  std::size_t points = 0, polygons = 0, edges = 0;
  text >> format >> points >> polygons >> edges;
  std::vector<Eigen::RowVector3d> vertices(points);
  for (auto& v : vertices)
  {
    text >> v[0] >> v[1] >> v[2];
    if (format == "COFF")
    {
      text.ignore(1000, '\n'); // colours
    }
  }
  std::vector<std::array<Index, 3>> faces;
  for (std::size_t p = 0; p < polygons; ++p)
  {
    Index count = 0;
    text >> count;
    std::vector<Index> corners(count);
    for (Index& corner : corners)
    {
      text >> corner;
    }
    for (Index a = 2; a < count; ++a)
    {
      faces.push_back({ corners[0], corners[a - 1], corners[a] });
    }
    text.ignore(1000, '\n'); // colours
  }
  if ((format != "OFF" && format != "COFF") || !text)
  {
    throw std::runtime_error("cannot read the mesh " + path);
  }
  return MakeSurface(vertices, faces);
}

/// `name`.off as it is on disk.
inline Surface ReadMeshFile(const std::string& name)
{
  return ReadOff(std::string(SURFACEDIFFUSION_MESH_DIR) + "/" + name + ".off");
}

} // namespace SurfaceDiffusion::Testing
