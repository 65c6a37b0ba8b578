// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/PointIdentity.h"
#include "Distributed/Processes.h"
#include "Distributed/SurfacePieces.h"

#include "vtkAlgorithm.h"
#include "vtkSmartPointer.h"

#include <cstddef>
#include <memory>
#include <new>
#include <string>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

/// Surfaces whose pieces lie in several objects or processes, sewn together in process 0, and the
/// way back. The whole has its points in the order of their ids and its cells in that of their
/// points, so that it is the same whatever the partition.
class GatheredSurfaces
{
public:
  GatheredSurfaces();
  ~GatheredSurfaces();

  /// Sew the pieces together, with the arrays that the filter has been told to process, unless
  /// nothing has changed in any process. Collective.
  void Update(const Processes& processes, const std::vector<SurfacePiece>& pieces, double tolerance,
    vtkAlgorithm* filter);

  /// Process 0: the surfaces, each with an output that is a shallow copy. Elsewhere none.
  std::vector<SurfacePiece> MakeOutputs();

  /// Give the outputs of all pieces what process 0 has added to those of MakeOutputs(): arrays, and
  /// points that have moved. Collective.
  void Scatter(const Processes& processes, const std::vector<SurfacePiece>& pieces);

private:
  struct Part;
  struct Whole;

  std::string Key;
  std::vector<std::unique_ptr<Whole>> Wholes; ///< process 0: one per surface
  /// Process 0: all parts, by process, within it as its pieces.
  std::vector<std::pair<const Whole*, std::size_t>> Order;
};

/// An update of a filter on pieces: execute(surfaces), on each surface in one piece, in process 0,
/// which tells all errors. Collective.
template <typename Execute>
void UpdateOfPieces(vtkAlgorithm* filter, const Processes& processes,
  const std::vector<SurfacePiece>& pieces, double tolerance,
  std::unique_ptr<GatheredSurfaces>& gathered, const Execute& execute)
{
  const bool first = processes.Rank() == 0;
  if (!processes.Any(first ? HasSurfaceInPieces(pieces) : HasPoints(pieces)))
  {
    gathered.reset();
    if (first)
    {
      execute(pieces);
    }
    return;
  }
  if (!gathered)
  {
    gathered = std::make_unique<GatheredSurfaces>();
  }
  gathered->Update(processes, pieces, tolerance, filter);
  if (first)
  {
    try
    {
      execute(gathered->MakeOutputs());
    }
    catch (const std::bad_alloc&)
    {
      vtkErrorWithObjectMacro(filter, << "not enough memory for the whole surface in process 0");
    }
  }
  gathered->Scatter(processes, pieces);
}

} // namespace SurfaceDiffusion
