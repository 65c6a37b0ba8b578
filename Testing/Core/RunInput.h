// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Meshes.h"

#include "Run/Run.h"

#include <cmath>
#include <memory>
#include <vector>

namespace SurfaceDiffusion::Testing
{

/// One surface with one scalar per point, as arrays.
struct RunInput
{
  Points Vertices;
  Triangles Faces;
  Fields Data;

  explicit RunInput(const Surface& surface)
    : Vertices(surface.Vertices)
    , Faces(surface.Faces)
  {
    this->Data.Data.Values = Values(this->Vertices.rows(), 1);
    for (Eigen::Index i = 0; i < this->Vertices.rows(); ++i)
    {
      this->Data.Data.Values(i, 0) = this->Vertices(i, 2) + 0.1 * std::cos(7.0 * i);
    }
  }

  BlockInput Block() const
  {
    BlockInput block;
    const auto add = [](Fingerprint& fingerprint, const auto& matrix)
    {
      fingerprint.AddBytes(
        matrix.data(), static_cast<std::size_t>(matrix.size()) * sizeof(*matrix.data()));
    };
    add(block.SurfaceVersion, this->Vertices);
    add(block.SurfaceVersion, this->Faces);
    add(block.FieldsVersion, this->Data.Data.Values);
    add(block.FieldsVersion, this->Data.Directions.Values);
    block.FieldsVersion.AddBytes(this->Data.Mask.Values.data(), this->Data.Mask.Values.size());
    block.ReadSurface = [this] { return SurfaceArrays{ this->Vertices, this->Faces, {} }; };
    block.ReadFields = [this] { return this->Data; };
    return block;
  }
};

inline const Reduction& Alone = Reduction::Serial();

/// The state at the last step.
template <typename ModelSettings>
Values StateOf(
  SurfaceDiffusion::Run& run, const std::vector<BlockInput>& inputs, const ModelSettings& settings)
{
  run.Update(inputs, std::make_shared<ModelSettings>(settings), Alone, ProgressMonitor());
  run.Seek(settings.DescribeModel().NumberOfSteps, ProgressMonitor());
  return run.GetBlock(0).Path->State();
}

} // namespace SurfaceDiffusion::Testing
