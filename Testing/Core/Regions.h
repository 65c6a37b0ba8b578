// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geometry/RegionBoundaries.h"
#include "Core/Models/Segmentation.h"
#include "TotalVariation.h"

#include <cmath>
#include <vector>

/// Segmentations for tests: surfaces, runs and their curves.
namespace SurfaceDiffusion::Testing
{

/// A surface with its operators, and lengths in units of its coordinates.
struct Domain
{
  explicit Domain(const Surface& s)
    : Shape(s)
    , Operators(MakeAssembler(s))
    , Mesh(this->Operators->Mesh())
    , Unit(this->Mesh.LengthUnit())
    , EdgeLength(MeanEdge(this->Mesh) * this->Unit)
  {
  }

  Surface Shape;
  std::shared_ptr<const Assembler> Operators;
  const TriangleMesh& Mesh;
  double Unit, EdgeLength;
};

/// A segmentation after its step.
struct Segmented
{
  Segmented(const Domain& domain, Segmentation::Input input, double fidelity,
    Segmentation::Settings settings = {}, const ParallelFor& parallel = SerialFor())
    : Model(domain.Operators, std::move(input), WithFidelity(settings, fidelity * domain.Unit),
        parallel)
    , Report(this->Model.Advance(ProgressMonitor()))
    , U(ToInput(domain.Mesh, this->Model.State(), domain.Shape.NumberOfVertices()))
    , Energy(this->Model.Energy() * domain.Unit)
    , Boundaries(FindRegionBoundaries(domain.Shape.Vertices, domain.Shape.Faces, this->U))
    , Areas(RegionAreas(domain.Shape.Vertices, domain.Shape.Faces, this->U, Vector(), parallel))
  {
  }

  double BoundaryLength() const
  {
    double length = 0.0;
    for (const RegionBoundary& curve : this->Boundaries.Curves)
    {
      length += curve.Length;
    }
    return length;
  }

  Segmentation Model;
  StepReport Report;
  Values U; ///< in the numbering of the surface
  double Energy; ///< in the length unit of the coordinates
  RegionBoundaries Boundaries;
  Vector Areas;

private:
  static Segmentation::Settings WithFidelity(Segmentation::Settings settings, double fidelity)
  {
    settings.Fidelity = fidelity;
    return settings;
  }
};

inline Segmentation::Input WithMeans(Values f, const std::vector<double>& means)
{
  Segmentation::Input input;
  input.Data = PointData::FromValues(std::move(f));
  input.Means = Eigen::Map<const Vector>(means.data(), static_cast<Eigen::Index>(means.size()));
  return input;
}

/// Noise of a normal distribution, tied to the input's numbering (G. Box, M. Muller, 1958).
inline Values NormalNoise(const TriangleMesh& mesh, double deviation, std::int64_t seed = 5)
{
  Values noise(mesh.NumberOfVertices(), 1);
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    const Index id = mesh.InputVertex()[i];
    noise(i, 0) = deviation * std::sqrt(-2.0 * std::log1p(-UniformRandom(seed, 0, id))) *
      std::cos(2.0 * Pi * UniformRandom(seed, 1, id));
  }
  return noise;
}

} // namespace SurfaceDiffusion::Testing
