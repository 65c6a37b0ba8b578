// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "MeshFiles.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

namespace SurfaceDiffusion::Testing
{

/// Calls the function with the surface of every file of at most 100 kB, or with
/// SURFACEDIFFUSION_LONG in the environment of every file, with its name in the messages of
/// failures.
template <typename Function>
void ForEachMeshFile(Function function)
{
  if (!HaveMeshFiles())
  {
    GTEST_SKIP() << "SURFACEDIFFUSION_MESH_DIR is not set";
  }
  int surfaces = 0;
  const bool all = std::getenv("SURFACEDIFFUSION_LONG") != nullptr;
  for (const auto& entry : std::filesystem::directory_iterator(SURFACEDIFFUSION_MESH_DIR))
  {
    if (entry.path().extension() == ".off" && (all || entry.file_size() < 100000))
    {
      SCOPED_TRACE(entry.path().stem());
      const Surface surface = ReadOff(entry.path().string());
      if (TriangleMesh(surface.Vertices, surface.Faces).NumberOfTriangles() > 0)
      {
        ++surfaces;
        function(surface);
      }
    }
  }
  EXPECT_GT(surfaces, 0) << "no surface in " << SURFACEDIFFUSION_MESH_DIR;
}

} // namespace SurfaceDiffusion::Testing
