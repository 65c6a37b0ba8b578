// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/PackedPiece.h"
#include "Distributed/Processes.h"
#include "Distributed/StitchedSurface.h"
#include "Distributed/SurfacePieces.h"

#include "vtkAlgorithm.h"

#include <cstddef>
#include <memory>
#include <new>
#include <optional>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

/// Surfaces whose pieces lie in several objects or processes, gathered in process 0, and their
/// results, scattered back to the pieces. Points and cells of a gathered surface do not depend on
/// the partition, and so neither do the bits of its results.
class GatheredSurfaces
{
public:
  /// Gathers the pieces, with the arrays that the filter processes, unless nothing has changed in
  /// any process. Collective.
  void Update(const Processes& processes, const std::vector<SurfacePiece>& pieces, double tolerance,
    vtkAlgorithm* filter);

  /// Process 0: the surfaces, each with an output that is a shallow copy of it. Elsewhere none.
  std::vector<SurfacePiece> MakeOutputs();

  /// Adds the arrays and moved points that process 0 has added to the outputs of MakeOutputs() to
  /// the outputs of all pieces. Collective.
  void ScatterResults(const Processes& processes, const std::vector<SurfacePiece>& pieces);

private:
  void GatherPieces(const Processes& processes, const std::vector<SurfacePiece>& pieces,
    double tolerance, vtkAlgorithm* filter);
  StitchedSurface& FindSurface(std::size_t number);

  /// The hash of what this process has contributed; nothing if there is nothing to be kept.
  std::optional<Fingerprint> Gathered;
  std::vector<std::unique_ptr<StitchedSurface>> Surfaces; ///< process 0: by number, some null
  /// Process 0: surface and number in it of each piece, as all processes list them.
  std::vector<std::pair<StitchedSurface*, std::size_t>> Order;
};

/// One update of a filter whose input is in pieces: calls execute(surfaces) in process 0 with each
/// surface in one piece, and scatters the results. Want of memory is reported there, by
/// report(text). Collective.
template <typename Execute, typename Report>
void UpdateOfPieces(vtkAlgorithm* filter, const Processes& processes,
  const std::vector<SurfacePiece>& pieces, double tolerance,
  std::unique_ptr<GatheredSurfaces>& gathered, const Execute& execute, const Report& report)
{
  const bool isFirst = processes.Rank() == 0;
  if (!processes.Any(isFirst ? HasSurfaceInPieces(pieces) : HasPoints(pieces)))
  {
    gathered.reset();
    if (isFirst)
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
  if (isFirst)
  {
    try
    {
      execute(gathered->MakeOutputs());
    }
    catch (const std::bad_alloc&)
    {
      report("not enough memory for the whole surface in process 0");
    }
  }
  gathered->ScatterResults(processes, pieces);
}

} // namespace SurfaceDiffusion
